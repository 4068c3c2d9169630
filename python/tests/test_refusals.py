# SPDX-License-Identifier: MIT
"""What is wrong is said in the library's words, by the exception that its kind asks for."""
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
    "stop": ({"stop": True}, "cannot be"),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_a_wrong_option_is_refused(name, quick):
    """TypeError or ValueError."""
    options, words = OPTIONS[name]
    mask = None if "box" in options or "points" in options else DISC
    with pytest.raises((TypeError, ValueError), match=words):
        quick(GREY, mask, **options)


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
                        (merlin.NoMemoryError, MemoryError), (merlin.DeviceError, RuntimeError)):
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
