# SPDX-License-Identifier: MIT
"""Small things that results consist of."""
from __future__ import annotations

import os
import sys
import warnings
from typing import Any, Iterable, List, NamedTuple, Optional, Tuple

import numpy as np

from .errors import MerlinWarning

_HERE = os.path.dirname(__file__)


class Notice(NamedTuple):
    """What should be known of a result before it is trusted."""

    code: str  #: a name for programs, as in docs/json.md
    message: str  #: a sentence for a person


class Crop(NamedTuple):
    """The square of the photograph that the network saw, in pixels; it may hang over the edges."""

    x: int
    y: int
    side: int


class Circle(NamedTuple):
    """Pixels from the upper left corner; a pixel's centre is at one half."""

    x: float
    y: float
    radius: float


class Camera(NamedTuple):
    """A camera by its calibration."""

    focal: float  #: focal length in pixels; 0: the camera is far away, its lines of sight are parallel
    x: float  #: principal point, pixels from the upper left corner
    y: float
    distance: float  #: of the object, its mean, in the unit of the lights' positions; 0: not known


class SkippedFile(NamedTuple):
    """A file of a folder that was left aside."""

    name: str
    why: str


class FoundLight(NamedTuple):
    """What lights a photograph, as a model of any light sees it. Strengths are in the photograph's radiance (its values
    times Maps.gain): 1 is a lamp of power 5.95 at distance 1."""

    flash: float  #: strength of a flash at the lens; 0: none
    lamp: Optional[np.ndarray]  #: 3, unit, from the object's middle toward the strongest lamp; None: no lamp
    lamp_sure: float  #: how sure the model is that there is one, in [0, 1]
    lamp_distance: float  #: from the object's middle, scene units; 0: far away
    lamp_strength: np.ndarray  #: 3, in the object's middle, by channel
    rest: np.ndarray  #: 9 x 3, everything else: spherical harmonics of radiance, bands 0 to 2


class Shot(NamedTuple):
    """Facts of how a photograph was taken, by its EXIF."""

    flash: Optional[bool]  #: whether it fired; None: unknown
    focal_35mm: float  #: focal length in mm whose picture on 36 x 24 mm has as wide a diagonal; 0: unknown
    reduced: int  #: so many of the file's pixels a side became one
    frames: int  #: of an animation, whose first alone is read


def found_light(struct: Any) -> Optional[FoundLight]:
    """The structure as a tuple; None where the model does not tell."""
    if not struct.known:
        return None
    lamp = np.array(struct.lamp, dtype=np.float32)
    return FoundLight(struct.flash, lamp if lamp.any() else None, struct.lamp_sure, struct.lamp_distance,
                      np.array(struct.lamp_strength, dtype=np.float32), np.array(struct.rest, dtype=np.float32))


def notices(struct: Any) -> Tuple[Notice, ...]:
    """merlin_warnings as tuples."""
    return tuple(Notice(one.code.decode(), one.message.decode("utf-8", "replace"))
                 for one in struct.at[:struct.count])


def warn(found: Iterable[Notice]) -> None:
    """Tells notices by Python's warnings, of the line that called this package."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == _HERE:
        level, frame = level + 1, frame.f_back
    for notice in found:
        warnings.warn(f"{notice.message} ({notice.code})", MerlinWarning, stacklevel=level)


def skipped(struct: Any) -> List[SkippedFile]:
    """merlin_skipped_files as tuples."""
    return [SkippedFile(one.name.decode("utf-8", "replace"), one.why.decode("utf-8", "replace"))
            for one in struct.at[:struct.count]]
