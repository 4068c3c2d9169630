# SPDX-License-Identifier: MIT
"""Arrays of every kind and layout are read as numpy reads them, or refused in a sentence."""
import gc
import random
import weakref

import numpy as np
import pytest

import merlin
from merlin import pictures
from merlin._call import view


def read(array, linear=None):
    """What the library got."""
    color, alpha = pictures.from_array(array, linear)
    return view(color, color.struct), view(alpha, alpha.struct)


def decoded(codes, linear):
    """sRGB to linear, in double."""
    x = codes.astype(np.float64)
    return x if linear else np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def expected(array, linear=None):
    """As the documentation says."""
    a = np.asarray(array)
    whole = a.dtype.kind != "f"
    values = a / (2.0 ** (8 * a.itemsize) - 1) if whole else a
    values = values if values.ndim == 3 else values[:, :, None]
    color = decoded(values[:, :, :3], not whole if linear is None else linear)
    return np.broadcast_to(color, color.shape[:2] + (3,))


DTYPES = [np.uint8, np.uint16, np.dtype(">u2"), np.float16, np.float32, np.float64, np.dtype(">f4")]


def random_array(rng, shape, dtype):
    """Values of all of its range."""
    dtype = np.dtype(dtype)
    if dtype.kind == "f":
        return rng.random(shape).astype(dtype)
    return rng.integers(0, 2 ** (8 * dtype.itemsize), shape).astype(dtype)


@pytest.mark.parametrize("dtype", DTYPES, ids=str)
@pytest.mark.parametrize("shape", [(5, 7), (5, 7, 1), (5, 7, 3), (5, 7, 4), (1, 1, 3), (1, 9, 3), (9, 1, 4)], ids=str)
def test_every_type_and_shape_is_read(dtype, shape):
    """Colours within rounding of float32."""
    array = random_array(np.random.default_rng(1), shape, dtype)
    color, alpha = read(array)
    np.testing.assert_allclose(color, expected(array), atol=2e-6)
    assert (alpha is not None) == (len(shape) == 3 and shape[2] == 4)


def odd_layouts(rng):
    """The same kind of values in memory of every sort."""
    base = random_array(rng, (12, 14, 3), np.uint8)
    yield "upside down", base[::-1]
    yield "mirrored", base[:, ::-1]
    yield "blue first", base[:, :, ::-1]
    yield "every other row", base[::2]
    yield "every other column", base[:, ::2]
    yield "a window", base[2:9, 3:11]
    yield "Fortran's order", np.asfortranarray(base)
    yield "rows and columns swapped", base.transpose(1, 0, 2)
    yield "channels first", np.ascontiguousarray(base.transpose(2, 0, 1)).transpose(1, 2, 0)
    yield "one row repeated", np.broadcast_to(base[:1], base.shape)
    yield "one value everywhere", np.broadcast_to(np.uint8(77), (6, 5, 3))
    yield "colours of four", random_array(rng, (5, 6, 4), np.uint8)[:, :, :3]
    yield "not aligned", np.frombuffer(base.tobytes() + b"123", np.uint16, 9 * 3 * 4, 1).reshape(9, 4, 3)
    yield "overlapping rows", np.lib.stride_tricks.as_strided(base, (6, 4, 3), (3, 3, 1))
    yield "one column", base[:, 3:4]
    yield "read only", np.frombuffer(base.tobytes(), np.uint8).reshape(base.shape)


@pytest.mark.parametrize("name, array", odd_layouts(np.random.default_rng(2)), ids=lambda v: v if isinstance(v, str) else "")
def test_every_layout_is_read(name, array):
    """Also those that the library cannot take as they are."""
    np.testing.assert_allclose(read(array)[0], expected(array), atol=2e-6, err_msg=name)


def test_linear_says_how_values_are_encoded():
    """Against the usual."""
    codes = np.arange(48, dtype=np.uint8).reshape(4, 4, 3)
    np.testing.assert_allclose(read(codes, linear=True)[0], codes / 255.0, atol=1e-6)
    floats = codes.astype(np.float32) / 48
    np.testing.assert_allclose(read(floats, linear=False)[0], decoded(floats, False), atol=2e-6)


REFUSED = {
    "a number": 3, "nothing": None, "a row": np.zeros(8, np.uint8), "four dimensions": np.zeros((2, 2, 2, 3), np.uint8),
    "two channels": np.zeros((8, 8, 2), np.uint8), "channels first": np.zeros((3, 8, 8), np.uint8),
    "no rows": np.zeros((0, 8, 3), np.uint8), "no columns": np.zeros((8, 0, 3), np.float32),
    "no channels": np.zeros((8, 8, 0), np.uint8), "int64": np.zeros((8, 8, 3), np.int64),
    "complex": np.zeros((8, 8, 3), complex), "words": np.full((8, 8, 3), "x"), "objects": np.full((8, 8, 3), None),
    "bool": np.zeros((8, 8, 3), bool), "huge": np.broadcast_to(np.uint8(0), (100_000, 100_000, 3)),
    "beyond int": np.broadcast_to(np.float64(0), (2**33, 1, 3)), "ragged": [[1.0, 2.0], [3.0]],
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_picture_is_refused(name):
    """With a TypeError or a ValueError that says what."""
    with pytest.raises((TypeError, ValueError)) as error:
        read(REFUSED[name])
    assert len(str(error.value)) > 20 and "\n" not in str(error.value)[:-1]


def test_an_alpha_that_shows_nothing_is_refused():
    """By the library."""
    with pytest.raises(merlin.BadInputError, match="transparent everywhere"):
        read(np.zeros((8, 8, 4), np.uint8))


MASKS = {"bool": bool, "0 and 1": np.uint8, "0 and 1 of int64": np.int64, "floats": np.float32, "doubles": np.float64}


@pytest.mark.parametrize("name", MASKS)
def test_a_mask_of_ones_is_full_coverage(name):
    """Whatever its type."""
    wanted = np.zeros((6, 7), MASKS[name])
    wanted[2:4, 1:5] = 1
    made = pictures.mask(wanted)
    np.testing.assert_array_equal(view(made, made.struct), wanted.astype(np.float32))


def test_a_mask_of_bytes_is_coverage():
    """128 of 255."""
    made = pictures.mask(np.full((4, 4, 1), 128, np.uint8))
    np.testing.assert_allclose(view(made, made.struct), 128 / 255, atol=1e-6)
    with pytest.raises(ValueError, match="1 channel, not 3"):
        pictures.mask(np.zeros((4, 4, 3), np.uint8))


def test_random_views_of_random_arrays_are_read_as_numpy_reads_them():
    """Slices, steps, turns and types by chance."""
    chance = random.Random(7)
    rng = np.random.default_rng(7)
    for _ in range(300):
        shape = (chance.randint(1, 9), chance.randint(1, 9), chance.choice([1, 3, 4]))
        array = random_array(rng, shape, chance.choice(DTYPES))
        for axis in range(2):
            if chance.random() < 0.5:
                step = chance.choice([-3, -2, -1, 1, 2, 3])
                array = array[(slice(None),) * axis + (slice(None, None, step),)]
        if chance.random() < 0.3:
            array = array.transpose(1, 0, 2)
        if chance.random() < 0.3:
            array = np.asfortranarray(array)
        if array.shape[2] == 4:
            array = array.copy()
            array[0, 0, 3] = 1 if array.dtype.kind == "f" else np.iinfo(array.dtype).max
        np.testing.assert_allclose(read(array)[0], expected(array), atol=2e-6)


def test_pixels_come_back_as_they_went_in():
    """Through linear floats, in every type."""
    codes = np.arange(256, dtype=np.uint8).reshape(16, 16)
    linear = read(codes)[0]
    np.testing.assert_array_equal(merlin.to_pixels(linear)[:, :, 0], codes)
    wide = np.linspace(0, 65535, 300).astype(np.uint16).reshape(10, 10, 3)
    np.testing.assert_array_equal(merlin.to_pixels(read(wide)[0], np.uint16), wide)
    with_alpha = merlin.to_pixels(linear, alpha=np.full((16, 16), 0.5), linear=True)
    assert with_alpha.shape == (16, 16, 4) and (with_alpha[:, :, 3] == 128).all()
    with pytest.raises(TypeError, match="uint8, uint16 or float32"):
        merlin.to_pixels(linear, np.int32)
    with pytest.raises(merlin.WrongUseError):
        merlin.to_pixels(linear, alpha=np.ones((3, 3)))


def test_a_picture_is_written_and_read(tmp_path):
    """Of one channel and of three."""
    image = np.linspace(0, 1, 48).reshape(4, 4, 3)
    merlin.write_image(tmp_path / "a.png", image)
    color, alpha = merlin.read_image(tmp_path / "a.png")
    np.testing.assert_allclose(color, image, atol=0.005)
    assert alpha is None
    with pytest.raises(merlin.MerlinError, match="png"):
        merlin.write_image(tmp_path / "a.gif", image)
    with pytest.raises(merlin.CannotWriteError):
        merlin.write_image(tmp_path / "missing" / "a.png", image)


def test_nan_is_no_picture(tmp_path):
    """Neither in a file nor in its bytes; pixels to show are black there."""
    image = np.ones((4, 6, 3))
    image[2, 5, 1] = np.nan
    for wrong in (lambda: merlin.write_image(tmp_path / "a.png", image), lambda: merlin.encode_image(image),
                  lambda: merlin.write_animation(tmp_path / "a.gif", [image]),
                  lambda: merlin.write_sheet(tmp_path / "s.png", {"a": image}),
                  lambda: merlin.write_mask(tmp_path / "m.png", image[:, :, 1])):
        with pytest.raises(merlin.BadInputError, match="NaN.* 5,2"):
            wrong()
    assert not list(tmp_path.iterdir())
    assert merlin.to_pixels(image)[2, 5, 1] == 0


def test_pictures_for_people_are_written(tmp_path):
    """Sheets, animations, bytes, masks."""
    image = np.random.default_rng(3).random((20, 30, 3))
    assert merlin.encode_image(image).startswith(b"\x89PNG") and merlin.encode_image(image, "jpeg")[:2] == b"\xff\xd8"
    assert merlin.resize_image(image, 15, 10).shape == (10, 15, 3)
    merlin.write_sheet(tmp_path / "sheet.png", {"left": image, "grey": image[:, :, 0]}, side=64)
    assert merlin.read_image(tmp_path / "sheet.png")[0].shape[1] > 2 * 64
    merlin.write_animation(tmp_path / "a.webp", [image, image[::-1]])
    assert (tmp_path / "a.webp").read_bytes()[8:12] == b"WEBP"
    merlin.write_mask(tmp_path / "mask.png", image[:, :, 0] > 0.5)
    np.testing.assert_array_equal(merlin.read_mask(tmp_path / "mask.png"), image[:, :, 0] > 0.5)
    for wrong in (lambda: merlin.write_animation(tmp_path / "b.gif", []), lambda: merlin.encode_image(image, "bmp"),
                  lambda: merlin.write_animation(tmp_path / "b.gif", [image, image[1:]]),
                  lambda: merlin.write_sheet(tmp_path / "s.png", {}), lambda: merlin.resize_image(image, 0, 4)):
        with pytest.raises(ValueError):
            wrong()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.webp", "mask.png", "sheet.png"]


def test_photographs_and_masks_of_a_folder_are_listed(tmp_path):
    """By content and by name."""
    image = np.random.default_rng(3).random((20, 30, 3))
    for name in ("cup.png", "cup.mask.png", "jug.png"):
        merlin.write_image(tmp_path / name, image)
    (tmp_path / "words.txt").write_text("words")
    listed = merlin.list_photos(tmp_path)
    cup, jug = str(tmp_path / "cup.png"), str(tmp_path / "jug.png")
    assert listed.photos == [(cup, str(tmp_path / "cup.mask.png")), (jug, None)]
    assert "words.txt" in [one.name for one in listed.skipped]
    assert merlin.find_mask(cup) == str(tmp_path / "cup.mask.png") and merlin.find_mask(jug) is None
    assert merlin.find_masks(tmp_path, [cup]) == [str(tmp_path / "cup.mask.png")]
    assert merlin.is_mask_name("cup_mask.png") and not merlin.is_mask_name("cup.png")
    (tmp_path / "empty").mkdir()
    for wrong in (lambda: merlin.list_photos(tmp_path / "empty"), lambda: merlin.list_photos(tmp_path / "none"),
                  lambda: merlin.find_masks(tmp_path / "empty", [cup, jug])):
        with pytest.raises(ValueError):
            wrong()


def test_an_array_keeps_the_librarys_memory_alive(demo):
    """It is a view, and frees what it shows when it goes."""
    color, _alpha = pictures.from_file(demo)
    array = view(color, color.struct)
    freed = weakref.ref(color)
    assert not array.flags.owndata and array.flags.writeable
    before = array.copy()
    del color, _alpha
    gc.collect()
    assert freed() is not None
    part = array[3:5, ::-1]
    del array
    np.testing.assert_array_equal(part, before[3:5, ::-1])
    del part
    gc.collect()
    assert freed() is None
