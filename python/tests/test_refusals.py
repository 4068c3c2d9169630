# SPDX-License-Identifier: MIT
"""What is wrong is said in the library's words, by the exception that its kind asks for."""
import warnings

import numpy as np
import pytest

import merlin

GREY = np.full((32, 32, 3), 128, np.uint8)
DISC = np.hypot(*(np.mgrid[:32, :32] - 15.5)) < 10

PHOTOGRAPHS = {
    "not a number": (np.full((32, 32, 3), np.nan, np.float32), DISC, "not finite"),
    "infinite": (np.full((32, 32, 3), np.inf), DISC, "not finite"),
    "too small": (np.zeros((8, 8, 3), np.uint8), None, "at least 16×16 are needed"),
    "even": (GREY, None, "no object stands out"),
    "black": (np.zeros((32, 32, 3), np.uint8), DISC, "black in this photograph"),
    "a mask of another size": (GREY, DISC[1:], "must be equal"),
    "an empty mask": (GREY, DISC & False, "the mask selects nothing"),
    "a mask that is not a number": (GREY, np.full((32, 32), np.nan), "."),
}


@pytest.mark.parametrize("name", PHOTOGRAPHS)
def test_a_wrong_photograph_is_bad_input(name, quick):
    """ValueError, too."""
    photo, mask, words = PHOTOGRAPHS[name]
    with pytest.raises(merlin.BadInputError, match=words) as error:
        quick(photo, mask)
    assert isinstance(error.value, (merlin.MerlinError, ValueError))


OPTIONS = {
    "size": ({"size": 100}, "multiple of 32"), "size of a float": ({"size": 64.0}, "whole number"),
    "a huge size": ({"size": 2**40}, "out of range"), "views": ({"views": 9}, "1 to 8 views"),
    "fov": ({"fov": 170}, "field of view"), "no fov": ({"fov": "wide"}, "is a number"),
    "exposure": ({"exposure": np.nan}, "within 20 EV"), "a box": ({"box": (1, 2)}, "a box is"),
    "a point outside": ({"points": [(500, 3)]}, "."), "progress": ({"progress": 3}, "cannot be"),
    "stop": ({"stop": True}, "cannot be"), "points": ({"points": 3}, "pairs"), "a box of one": ({"box": 3}, "a box is"),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_a_wrong_option_is_refused(name, quick):
    """By a MerlinError that is a TypeError or a ValueError, too."""
    options, words = OPTIONS[name]
    mask = None if "box" in options or "points" in options else DISC
    with pytest.raises(merlin.MerlinError, match=words) as error:
        quick(GREY, mask, **options)
    assert isinstance(error.value, (TypeError, ValueError))


def test_arguments_of_another_kind_are_merlin_errors(tmp_path):
    """And usual ones."""
    for call in (lambda: merlin.Model(3), lambda: merlin.read_image(None), lambda: merlin.Lamp("left")._struct(),
                 lambda: merlin.Lamp((0, 0, 0), power="much")._struct(), lambda: merlin.set_threads(1.5),
                 lambda: merlin.to_pixels(GREY), lambda: merlin.write_image(tmp_path / "a.png", GREY),
                 lambda: merlin.find_object(GREY.astype(np.int64)), lambda: merlin.Environment(7),
                 lambda: merlin.write_rti(tmp_path, [DISC * 1.0], "up"), lambda: merlin.calibrate(1)):
        with pytest.raises(merlin.WrongTypeError) as error:
            call()
        assert isinstance(error.value, TypeError) and isinstance(error.value, ValueError)
    for call in (lambda: merlin.dome(0), lambda: merlin.Lamp((0, 0))._struct(), lambda: merlin.encode_image(GREY / 255.0, "gif"),
                 lambda: merlin.read_image("a\0b")):
        with pytest.raises(merlin.WrongUseError):
            call()


def test_floats_that_are_bytes_get_a_word(quick, model):
    """Unless they are said to be linear."""
    shade = 40 + 180 * np.linspace(0, 1, 32)[None, :, None] * np.ones((32, 1, 3))
    with pytest.warns(UserWarning, match="a photograph of floats reaches 220, where white is 1: .*uint8"):
        model.estimate(shade, DISC, size=64, views=1)
    capture = merlin.Capture()
    with pytest.warns(merlin.MerlinWarning, match="floats_like_bytes"):
        capture.add(shade, merlin.Light(direction=(0, 0, 1)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        merlin.find_object(shade / 255, DISC)
        merlin.find_object(shade.astype(np.uint8), DISC)
        merlin.find_object(shade, DISC, linear=True)


def test_files_that_are_none_are_refused(quick, tmp_path):
    """Missing, a folder, other content, a name that cannot be."""
    with pytest.raises(FileNotFoundError, match="nowhere.png: No such file"):
        quick(tmp_path / "nowhere.png")
    with pytest.raises(merlin.BadInputError, match="it is a folder"):
        quick(tmp_path)
    (tmp_path / "words.png").write_text("these are words")
    with pytest.raises(merlin.BadInputError, match="not a picture"):
        quick(str(tmp_path / "words.png"))
    with pytest.raises(ValueError, match="null character"):
        quick("a\0b.png")
    with pytest.raises(FileNotFoundError):
        quick("\udcff.png")


def test_wrong_weights_are_refused(source, tmp_path):
    """Other files, damaged ones, none."""
    with pytest.raises(merlin.MissingFileError, match="nor are weights of that name"):
        merlin.Model("merlin-none")
    with pytest.raises(merlin.MissingFileError):
        merlin.Model(tmp_path / "none.safetensors")
    with pytest.raises(merlin.BadInputError):
        merlin.Model(source + "/README.md")
    whole = open(source + "/models/merlin-any.safetensors", "rb").read()
    (tmp_path / "half.safetensors").write_bytes(whole[:len(whole) // 2])
    with pytest.raises(merlin.BadInputError, match="half.safetensors"):
        merlin.Model(tmp_path / "half.safetensors")
    with pytest.raises(merlin.WrongUseError, match="tells no flash from other light"):
        merlin.Model("merlin-point", flash="merlin-any")


def test_every_exception_is_a_merlin_error_and_a_usual_one():
    """So that either can be caught."""
    for kind, usual in ((merlin.WrongUseError, ValueError), (merlin.BadInputError, ValueError),
                        (merlin.MissingFileError, FileNotFoundError), (merlin.CannotWriteError, OSError),
                        (merlin.NoMemoryError, MemoryError), (merlin.DeviceError, RuntimeError),
                        (merlin.WrongTypeError, TypeError), (merlin.WrongTypeError, ValueError),
                        (merlin.ForkedError, RuntimeError)):
        assert issubclass(kind, merlin.MerlinError) and issubclass(kind, usual)
        assert str(kind("words")) == "words"


def test_threads_are_set_within_bounds():
    """And as whole numbers."""
    for wrong in (0, 5000, 2**40):
        with pytest.raises(ValueError):
            merlin.set_threads(wrong)
    with pytest.raises(TypeError):
        merlin.set_threads("two")
    merlin.set_threads(1)
    merlin.set_threads(2)
    assert merlin.version() == merlin.__version__
