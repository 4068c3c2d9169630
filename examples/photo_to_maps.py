# SPDX-License-Identifier: MIT
"""Two photographs of a figurine, by a flash and by a window, to a picture like the README's: photograph, albedo, normals,
roughness / depth, reconstruction, light from the left and from the right. Cells for an editor or a notebook; as a
program, `python3 examples/photo_to_maps.py`, it writes maps.png and lamp.png into the current folder."""

# %% The package, and where the photographs are
import os

import merlin
import numpy as np

here = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else "examples"
model = merlin.Model()  # of any light; it has another for flashes

# %% A photograph's maps: numpy arrays of its size
flash = model.estimate(os.path.join(here, "demo.png"))
window = model.estimate(os.path.join(here, "window.png"))
for maps in (flash, window):
    print(f"{maps.width} x {maps.height} by {maps.model_name}: {maps.light_words or 'a flash alone'}")


# %% Numbers as shades of grey or colours
def shown(values):
    """What write_image, which encodes linear light as sRGB, shows as these values in [0, 1]."""
    values = np.clip(values, 0, 1)
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def grey(values):
    """H x W to H x W x 3."""
    return np.repeat(values[:, :, None], 3, axis=2)


def near_is_bright(depth, mask):
    """Depth from white, nearest, to grey, farthest."""
    near, far = depth[mask].min(), depth[mask].max()
    return np.where(mask, 1 - 0.6 * (depth - near) / max(far - near, 1e-6), 0)


# %% Eight pictures of a photograph
def pictures(maps):
    """Two rows of four."""
    mask = maps.mask > 0.5
    return [[maps.photo, maps.albedo, shown((maps.normal + 1) / 2 * mask[:, :, None]), shown(grey(maps.roughness))],
            [shown(grey(near_is_bright(maps.depth, mask))), maps.reconstruction, maps.relight((-0.67, 0.47, -0.43)),
             maps.relight((0.77, 0.28, -0.43))]]


def sheet(rows, gap=8):
    """The pictures beside and below one another, with gaps."""
    padded = [[np.pad(picture, ((gap, gap), (gap, gap), (0, 0)), constant_values=0.013) for picture in row]
              for row in rows]
    return np.vstack([np.hstack(row) for row in padded])


merlin.write_image("maps.png", sheet(pictures(flash) + pictures(window)))

# %% A lamp that goes from left to right: one relighter, many lights
relighter = flash.relighter(256)
turns = np.radians(np.linspace(-70, 70, 8))
lit = [relighter((0.9 * np.sin(turn), 0.3, 0.9 * np.cos(turn) - 1)) for turn in turns]
merlin.write_image("lamp.png", sheet([lit[:4], lit[4:]], gap=4))
