# SPDX-License-Identifier: MIT
"""Two photographs of a figurine, by a flash and by a window, to the README's picture: photograph, albedo, normals,
roughness, depth, reconstruction, light from the left and from the right. Cells for an editor or a notebook; as a
program, `python3 examples/photo_to_maps.py`, it writes flash.png, window.png and lamp.webp into the current folder."""

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
    """What a picture, which encodes linear light as sRGB, shows as these values in [0, 1]."""
    values = np.clip(values, 0, 1)
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def near_is_bright(depth, mask):
    """Depth from white, nearest, to grey, farthest."""
    near, far = depth[mask].min(), depth[mask].max()
    return np.where(mask, 1 - 0.6 * (depth - near) / max(far - near, 1e-6), 0)


# %% Eight pictures of each photograph
def tiles(maps, of):
    """Two rows of four, by what stands below them."""
    mask = maps.mask > 0.5
    return {f"photograph by {of}": maps.photo, "albedo": maps.albedo,
            "normal": shown((maps.normal + 1) / 2 * mask[:, :, None]), "roughness": shown(maps.roughness),
            "depth": shown(near_is_bright(maps.depth, mask)), "reconstruction": maps.reconstruction,
            "light from the left": maps.relight((-0.67, 0.47, -0.43)),
            "light from the right": maps.relight((0.77, 0.28, -0.43))}


merlin.write_sheet("flash.png", tiles(flash, "flash"))
merlin.write_sheet("window.png", tiles(window, "window"))

# %% A lamp that goes from left to right: one relighter, many lights
relighter = flash.relighter(256)
turns = np.radians(np.concatenate([np.linspace(-70, 70, 15), np.linspace(60, -60, 13)]))
merlin.write_animation("lamp.webp", [relighter((0.9 * np.sin(turn), 0.3, 0.9 * np.cos(turn) - 1)) for turn in turns])
