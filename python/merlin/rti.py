# SPDX-License-Identifier: MIT
"""Pictures of an object under many lights as one file that viewers relight: reflectance transformation imaging."""
from __future__ import annotations

import ctypes
import os
from typing import Any, List, Sequence

import numpy as np

from . import _headers as h
from ._call import Owner, check, choice, floats, path_bytes, vector3, whole, written_paths
from .errors import WrongUseError
from .pictures import PathLike, image_for

BASES = {"ptm": h.RTI_PTM, "lrgb": h.RTI_LRGB, "hsh": h.RTI_HSH, "rbf": h.RTI_RBF}


def write_rti(path: PathLike, images: Sequence[np.ndarray], directions: Any, *, basis: str = "ptm", planes: int = 0,
              quality: int = 0) -> List[str]:
    """Writes a folder for OpenLIME and relight or, if the path ends in .ptm, a classic file; returns what was written.

    images: N of H x W x 3, linear, clamped to [0, 1], such as a Relighter's. directions: N x 3, from the object toward
    each light, z > 0 toward the camera (`dome_directions`). basis: "ptm" (polynomials by channel), "lrgb" (one for the
    brightness), "hsh" (hemispherical harmonics) or "rbf" (between the pictures; planes: a multiple of 3 up to 27, 0:
    18). quality: of the planes' JPEG files, 1 to 100; 0: 95. ptm and lrgb want 6 pictures, hsh 9, rbf 4."""
    images = list(images)
    rows = floats(directions, "directions")
    if not images or rows.shape != (len(images), 3):
        raise WrongUseError(f"{len(images)} pictures want directions of shape ({len(images)}, 3), not {rows.shape}")
    params = h.RtiParams(choice(basis, BASES, "basis"), whole(planes, "planes"), whole(quality, "quality"))
    first, _kept = image_for(images[0])
    made = Owner(ctypes.c_void_p(), "rti_free")
    check("rti_new", first.width, first.height, ctypes.byref(params), made.at)
    for picture, direction in zip(images, rows):
        image, _kept = image_for(picture)
        check("rti_add", made.struct, ctypes.byref(image), vector3(direction, "a direction"))
    name = path_bytes(path)
    if name.endswith(b".ptm"):
        check("rti_write_ptm", made.struct, name)
        return [os.fsdecode(name)]
    written = Owner(h.Files(), "files_free")
    check("rti_write", made.struct, name, written.at)
    return written_paths(written)
