# SPDX-License-Identifier: MIT
"""The photographs of a folder, and which of its pictures are their masks."""
from __future__ import annotations

import ctypes
import os
from typing import List, NamedTuple, Optional, Sequence

from . import _headers as h
from ._call import Owner, call, check, optional_path, path_bytes, taken_bytes
from .pictures import PathLike
from .results import SkippedFile, skipped


class PhotoFile(NamedTuple):
    """A photograph of a folder."""

    path: str
    mask: Optional[str]  #: None: none lies beside it


class Photos(NamedTuple):
    """What a folder holds."""

    photos: List[PhotoFile]  #: sorted by name
    skipped: List[SkippedFile]  #: what is no photograph


def list_photos(folder: PathLike, masks: Optional[PathLike] = None) -> Photos:
    """Lists a folder's photographs, known by their content, and the masks beside them, known by their names
    (docs/pictures.md). masks: a folder of masks, which is no skipped folder where it lies in this one."""
    name, owner = path_bytes(folder), Owner(h.Photos(), "photos_free")
    check("photos_list", name, optional_path(masks), owner.at, path=os.fsdecode(name))
    found = [owner.struct.at[i] for i in range(owner.struct.count)]
    return Photos([PhotoFile(os.fsdecode(one.path), None if one.mask is None else os.fsdecode(one.mask))
                   for one in found], skipped(owner.struct.skipped))


def find_mask(photo: PathLike) -> Optional[str]:
    """The mask beside a photograph; None: there is none."""
    found = ctypes.c_void_p()
    check("mask_find", path_bytes(photo), ctypes.byref(found))
    return os.fsdecode(taken_bytes(found)) if found else None


def find_masks(folder: PathLike, photos: Sequence[PathLike]) -> List[str]:
    """The masks of photographs in a folder of masks; BadInputError if one has none."""
    names = (ctypes.c_char_p * max(len(photos), 1))(*(path_bytes(photo) for photo in photos))
    found = (ctypes.c_void_p * max(len(photos), 1))()
    check("masks_find", path_bytes(folder), names, len(photos), found)
    return [os.fsdecode(taken_bytes(ctypes.c_void_p(one))) for one in found[:len(photos)]]


def is_mask_name(name: PathLike) -> bool:
    """Whether a file's name, without folders, may be a mask's by its words."""
    return bool(call("mask_is_name", path_bytes(name)))
