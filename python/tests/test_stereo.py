# SPDX-License-Identifier: MIT
"""Surfaces from pictures under many lights, and the lights from pictures of a ball."""
import struct
import warnings
import zlib

import numpy as np
import pytest

import merlin


@pytest.fixture(autouse=True)
def no_warnings():
    """Of pictures as small as these."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", merlin.MerlinWarning)
        yield


def error_degrees(surface, truth, inside):
    """Mean angle between normals."""
    on = inside & (surface.mask > 0)
    return np.degrees(np.arccos(np.clip((surface.normal[on] * truth[on]).sum(axis=-1), -1, 1))).mean()


def test_a_ball_under_known_lights_is_a_ball(sphere):
    """By arrays, a stack of arrays, files, a folder, and Light."""
    lights, pictures, normal, inside = sphere
    surface = merlin.stereo(list(pictures), lights, mask=inside)
    assert surface.method == "robust" and error_degrees(surface, normal, inside) < 2
    assert surface.albedo.shape == surface.depth.shape == surface.mask.shape == (64, 64)
    assert surface.normal.shape == (64, 64, 3) and surface.lights is None and surface.camera.focal == 0
    by_light = merlin.stereo(pictures, [merlin.Light(direction=d) for d in lights], mask=inside, method="ls")
    assert by_light.method == "ls" and error_degrees(by_light, normal, inside) < 2


def test_files_and_folders_are_read(sphere, tmp_path):
    """16 bits would be linear; 8-bit ones are sRGB."""
    lights, pictures, normal, inside = sphere
    paths = [tmp_path / f"{i}.png" for i in range(len(lights))]
    for path, picture in zip(paths, pictures):
        merlin.write_image(path, np.repeat(picture[:, :, None], 3, axis=2))
    assert error_degrees(merlin.stereo(paths, lights, mask=inside), normal, inside) < 3
    np.savetxt(tmp_path / "lights.txt", lights)
    told = []
    surface = merlin.stereo(tmp_path, progress=lambda stage, share: told.append(stage))
    assert error_degrees(surface, normal, inside) < 3 and {"reading", "solving", "integrating"} <= set(told)


def write_linear(path, values):
    """A grey PNG of 16 bits, which says nothing of its values."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    height, width = values.shape
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in np.round(values * 65535))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def test_files_are_read_as_those_of_a_folder_are(sphere, tmp_path):
    """Of 16 bits values are linear, of 8 where that is said."""
    lights, pictures, normal, inside = sphere
    paths = [tmp_path / f"{i}.png" for i in range(len(lights))]
    for path, picture in zip(paths, pictures):
        write_linear(path, picture)
    assert error_degrees(merlin.stereo(paths, lights, mask=inside, method="ls"), normal, inside) < 2
    with pytest.raises(merlin.WrongUseError, match="linear is of arrays"):
        merlin.find_object(paths[0], linear=True)


def test_unknown_lights_are_found(sphere):
    """One a picture."""
    lights, pictures, _normal, inside = sphere
    surface = merlin.stereo(list(pictures), None, mask=inside)
    assert surface.method == "uncalibrated" and len(surface.lights) == len(lights)
    found = np.array([light.direction for light in surface.lights])
    assert found.shape == lights.shape and np.isfinite(found).all()


def test_near_lights_have_positions(sphere):
    """And a camera."""
    lights, pictures, _normal, inside = sphere
    surface = merlin.stereo(list(pictures), positions=lights * [1, 1, -1], mask=inside, field_of_view=30, distance=1,
                            iterations=1, check_result=False)
    assert surface.method == "near" and surface.camera.focal > 0


def test_near_lights_by_a_network(sphere):
    """Alone, and as what the fits begin with."""
    lights, pictures, _normal, inside = sphere
    near = {"positions": lights * [1, 1, -1], "mask": inside, "field_of_view": 30, "distance": 1, "check_result": False}
    alone = merlin.stereo(list(pictures), method="nfps", **near)
    assert alone.method == "nfps" and alone.by_network
    assert (alone.normal[inside & (alone.mask > 0)][:, 2] > 0).all()
    assert merlin.stereo(list(pictures), **near).by_network
    with pytest.raises(merlin.WrongUseError, match="takes no weights"):
        merlin.stereo(list(pictures), lights, mask=inside, method="ls", weights="merlin-nfps")


def test_intensities_are_used(sphere):
    """A number or three a picture, or found."""
    lights, pictures, normal, inside = sphere
    strength = np.linspace(0.5, 1, len(lights)).astype(np.float32)
    dimmed = list(pictures * strength[:, None, None])
    known = merlin.stereo(dimmed, lights, intensities=strength, mask=inside)
    assert error_degrees(known, normal, inside) < 2
    found = merlin.stereo(dimmed, lights, intensities="unknown", mask=inside)
    assert found.method == "semi" and len(found.lights) == len(lights)


def test_a_surface_is_a_mesh_file(sphere, tmp_path):
    """By its ending."""
    lights, pictures, _normal, inside = sphere
    surface = merlin.stereo(list(pictures), lights, mask=inside)
    mesh = surface.mesh()
    assert mesh.save(tmp_path / "ball.ply") == [str(tmp_path / "ball.ply")]
    assert (tmp_path / "ball.ply").read_bytes().startswith(b"ply")
    assert abs(len(mesh.vertices) - inside.sum()) < 0.1 * inside.sum() and mesh.faces.max() < len(mesh.vertices)
    with pytest.raises(merlin.WrongUseError):
        mesh.save(tmp_path / "ball.xyz")


def test_a_surface_is_saved_and_becomes_maps(sphere, model, tmp_path):
    """To be relit."""
    lights, pictures, _normal, inside = sphere
    surface = merlin.stereo(list(pictures), lights, mask=inside)
    surface.save(tmp_path / "ball", name="a ball")
    assert (tmp_path / "ball" / "report.json").exists() and surface.report("a ball")["method"] == "robust"
    assert len(surface.picture_names) == len(lights) and surface.normal_error is None and surface.relit is None
    assert surface.seconds["solve"] > 0 and surface.skipped == []
    maps = surface.maps(model)
    lit = maps.relight((-0.7, 0, -0.5), by="direct")
    assert lit[:, :32].sum() > 1.5 * lit[:, 32:].sum()
    loaded = merlin.Maps.load(tmp_path / "ball", model=model)
    np.testing.assert_allclose(loaded.relight((-0.7, 0, -0.5), by="direct"), lit, atol=0.02)
    for alone in (surface.maps(), merlin.Maps.load(tmp_path / "ball")):  # by the weights that the command takes
        np.testing.assert_allclose(alone.relight((-0.7, 0, -0.5), by="direct"), lit, atol=0.02)
    with pytest.raises(merlin.WrongUseError, match="captured surface, which is what is written"):
        loaded.save(tmp_path / "never")
    with pytest.raises(merlin.StoppedError):
        surface.save(tmp_path / "never", stop=lambda: True)
    surface.normal[30, 30] = np.nan
    with pytest.raises(merlin.WrongUseError, match="normal has values that are not finite"):
        surface.save(tmp_path / "never")
    assert not (tmp_path / "never").exists()


def test_a_photograph_becomes_a_surface(kept_maps):
    """By relit pictures."""
    told = []
    def stop():
        return len(told) > 3
    with pytest.raises(merlin.StoppedError):
        kept_maps.stereo(progress=lambda *step: told.append(step), stop=stop)
    assert told[0][0] == "solving"


WRONG = {
    "no pictures": ([], None, "no pictures"), "too few": (2, None, "."), "lights of another number": (8, 5, "of shape"),
    "no folder": ("/nowhere/at/all", None, "no folder"), "sizes": ("sizes", None, "."),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_capture_is_refused(name, sphere):
    """In the library's words."""
    lights, pictures, _normal, _inside = sphere
    images, known, words = WRONG[name]
    if images == "sizes":
        images = [pictures[0], pictures[1][1:], pictures[2]]
    elif isinstance(images, int):
        images = list(pictures[:images])
    with pytest.raises(ValueError, match=words):
        merlin.stereo(images, None if known is None else lights[:known])


def test_wrong_words_are_refused(sphere):
    """What may stand where is told."""
    lights, pictures, _normal, _inside = sphere
    for wrong in ({"method": "magic"}, {"intensities": "strong"}, {"positions": lights}, {"intensities": [1, 2]},
                  {"method": "near"}, {"field_of_view": np.nan}):
        with pytest.raises(ValueError):
            merlin.stereo(list(pictures), lights, **wrong)
    with pytest.raises(ValueError, match="'distant', 'near', 'unknown'"):
        merlin.Capture("bright")


def test_a_capture_makes_maps(sphere, model):
    """Whose normals are photometric stereo's, though nothing is known of the lights."""
    _lights, pictures, normal, inside = sphere
    capture = merlin.Capture("unknown", mask=inside)
    for picture in pictures:
        capture.add(picture.astype(np.float32), linear=True)
    stages = []
    maps = capture.maps(model, views=1, progress=lambda stage, _share: stages.append(stage))
    assert np.linalg.norm(maps.further_light) == pytest.approx(1, abs=1e-3)
    assert maps.photographs == len(pictures) and maps.refined and "estimating" in stages
    assert maps.spread is not None and 0 < maps.spread[inside].mean() < 30
    assert (maps.normal * normal)[inside].sum(axis=1).mean() > np.cos(np.radians(11))
    with pytest.warns(merlin.MerlinWarning, match="fewer than 7 pictures"):
        few = merlin.Capture("unknown", mask=inside)
        few.add(pictures[0].astype(np.float32), linear=True)
        few.add(pictures[1].astype(np.float32), linear=True)
        assert not few.maps(model, views=1).refined


def test_listed_pictures_are_a_capture(sphere, tmp_path, model):
    """In any folders, without a list of lights."""
    _lights, pictures, _normal, inside = sphere
    paths = [tmp_path / f"{i}.png" for i in range(2)]
    for path, picture in zip(paths, pictures):
        merlin.write_image(path, np.repeat(picture[:, :, None], 3, axis=2))
    merlin.write_image(tmp_path / "mask.png", inside.astype(np.float32))
    capture = merlin.Capture.read(paths, mask=tmp_path / "mask.png")
    with pytest.warns(merlin.MerlinWarning):
        assert capture.maps(model, views=1).photographs == 2
    with pytest.raises(merlin.BadInputError, match="absent.png"):
        merlin.Capture.read([paths[0], tmp_path / "absent.png"])
    with pytest.raises(TypeError):
        merlin.Capture.read([paths[0], 1])
    with pytest.raises(merlin.WrongUseError, match="frames"):
        merlin.Capture.read(tmp_path, unknown=True, frames=65)


def chrome(light, size=128, radius=50):
    """A mirror ball with the light's highlight."""
    half = light / np.linalg.norm(light) + [0, 0, 1]
    half /= np.linalg.norm(half)
    y, x = np.mgrid[:size, :size] + 0.5
    spot = np.hypot(x - size / 2 - radius * half[0], y - size / 2 + radius * half[1]) < 3
    ball = np.hypot(x - size / 2, y - size / 2) < radius
    return np.where(spot, 1.0, 0.02 * ball)


def test_lights_are_calibrated_by_a_ball(sphere, tmp_path):
    """Within three degrees, by its mask."""
    lights = sphere[0]
    for i, light in enumerate(lights):
        merlin.write_image(tmp_path / f"{i}.png", chrome(light))
    y, x = np.mgrid[:128, :128] + 0.5
    merlin.write_image(tmp_path / "mask.png", (np.hypot(x - 64, y - 64) < 50).astype(np.float32))
    found = merlin.calibrate(tmp_path)
    assert (found.directions * lights).sum(axis=1).min() > np.cos(np.radians(3))
    assert found.names == [f"{i}.png" for i in range(8)] and found.from_mask and found.mask_file.endswith("mask.png")
    assert found.circle.radius == pytest.approx(50, abs=1) and len(found.highlights) == 8 and found.residuals is None
    assert found.brightest.shape == (128, 128, 3) and found.ball == "chrome"
    written = found.save(tmp_path / "out")
    assert sorted(path.rsplit("/", 1)[1] for path in written) == ["calibration.png", "lights.txt"]
    with pytest.raises(ValueError, match="'chrome', 'matte'"):
        merlin.calibrate(tmp_path, "glass")
    with pytest.raises(merlin.MissingFileError):
        merlin.calibrate(tmp_path / "nowhere")
