# SPDX-License-Identifier: MIT
"""What the tests share: a model of the weights that ship, small photographs, maps of one."""
import os
import sys
import warnings

import numpy as np
import pytest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
if not os.environ.get("MERLIN_TEST_INSTALLED"):
    sys.path.insert(0, os.path.join(SOURCE, "python"))

import merlin  # noqa: E402

QUICK = {"size": 64, "views": 1}


@pytest.fixture(scope="session")
def source():
    """The checkout."""
    return SOURCE


@pytest.fixture(scope="session")
def demo(source):
    """A photograph's file, with alpha."""
    return os.path.join(source, "examples", "demo.png")


@pytest.fixture(scope="session")
def photo(demo):
    """A small photograph, 128 x 128 x 3 bytes, and its mask."""
    color, alpha = merlin.read_image(demo)
    return merlin.to_pixels(color[::4, ::4]), alpha[::4, ::4] > 0.5


@pytest.fixture(scope="session")
def model():
    """Of any light."""
    return merlin.Model("merlin-any")


@pytest.fixture(scope="session")
def quick(model):
    """estimate, as quick as can be, without warnings."""
    def run(*arguments, **options):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", merlin.MerlinWarning)
            return model.estimate(*arguments, **{**QUICK, **options})
    return run


@pytest.fixture(scope="session")
def kept_maps(quick, photo):
    """Maps that no test changes."""
    return quick(*photo)


@pytest.fixture
def maps(quick, photo):
    """Maps to change."""
    return quick(*photo)


@pytest.fixture(scope="session")
def sphere():
    """Lights of a matte ball, N x 3, and its pictures under them, N x 64 x 64."""
    y, x = (np.mgrid[:64, :64] + 0.5 - 32) / 28
    inside = x * x + y * y < 1
    normal = np.stack([x, -y, np.sqrt(np.clip(1 - x * x - y * y, 0, 1))], axis=-1)
    angle = np.arange(8) * np.pi / 4
    lights = np.stack([0.5 * np.cos(angle), 0.5 * np.sin(angle), np.full(8, 0.75 ** 0.5)], axis=-1).astype(np.float32)
    pictures = np.clip(np.einsum("hwc,nc->nhw", normal, lights), 0, 1) * inside * 0.8
    return lights, pictures.astype(np.float32), normal, inside
