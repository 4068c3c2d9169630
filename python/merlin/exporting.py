# SPDX-License-Identifier: MIT
"""Maps as other programs read them: engines of games, 3-D programs, machines that mill and print."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Iterable, List, NamedTuple, Optional

import numpy as np

from . import _headers as h
from ._call import Owner, Watch, check, choice, path_bytes, view, whole, written_paths
from .pictures import PathLike, new_image

if TYPE_CHECKING:
    from .maps import Maps

# The command's names.
NAMES = {"OCCLUSION": "ao", "HEIGHT_FLOAT": "height32"}
BITS = {NAMES.get(name, name.lower()): 1 << bit for bit, name in enumerate(h.EXPORT_NAMES)}
BITS["all"] = h.EXPORT_ALL


class Exported(NamedTuple):
    """What was written, and what a program needs to know of it."""

    files: List[str]
    side: int  #: of all pictures, in pixels
    relief: float  #: from the lowest point to the highest, in widths of the square
    width: float  #: of the square at the object's mean distance, in the maps' unit


def export(maps: "Maps", folder: PathLike, which: Optional[Iterable[str]], normal_y: str, side: int,
           watch: Watch) -> Exported:
    """As Maps.export."""
    bits = 0
    for name in [which] if isinstance(which, str) else which or ():
        bits |= choice(name, BITS, "a map")
    params = h.ExportParams(bits, choice(normal_y, {"up": 0, "down": 1}, "normal_y"), whole(side, "side"))
    facts, written = h.ExportFacts(), Owner(h.Files(), "files_free")
    watch.put(params)
    watch.check("maps_export", maps._sound(), ctypes.byref(params), path_bytes(folder), ctypes.byref(facts), written.at)
    return Exported(written_paths(written), facts.side, facts.relief, facts.width)


def occlusion(maps: "Maps", side: int) -> Any:
    """As Maps.occlusion."""
    out = new_image()
    check("maps_occlusion", maps._sound(), whole(side, "side"), out.at)
    made: np.ndarray = view(out, out.struct)
    return made
