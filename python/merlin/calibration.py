# SPDX-License-Identifier: MIT
"""The directions of lights from pictures of a ball, one picture a light."""
from __future__ import annotations

import ctypes
import os
from typing import List, Optional, Tuple

import numpy as np

from . import _headers as h
from ._call import Owner, ProgressCallback, StopCallback, Watch, check, choice, optional_path, path_bytes, real, view
from ._call import written_paths
from .capture import Light, light_of
from .pictures import PathLike
from .results import Circle, Notice, SkippedFile, notices, skipped, warn

BALLS = {"chrome": h.CHROME_BALL, "matte": h.MATTE_BALL}


def _circle(struct: h.Struct) -> Circle:
    return Circle(struct.x, struct.y, struct.radius)


class Calibration:
    """Lights, in the order of the pictures' names. They count as distant: one direction for the whole scene."""

    def __init__(self, owner: Owner) -> None:
        self._owner = owner
        c = owner.struct
        count = range(c.count)
        self.ball: str = next(name for name, number in BALLS.items() if number == c.ball)
        self.circle: Circle = _circle(c.circle)  #: the ball's outline
        self.from_mask: bool = bool(c.from_mask)  #: the circle was fitted to a mask's edge
        self.mask_file: Optional[str] = None if c.mask_file is None else os.fsdecode(c.mask_file)
        self.names: List[str] = [os.fsdecode(c.names[i]) for i in count]  #: of the pictures
        self.lights: List[Light] = [light_of(c.lights[i]) for i in count]
        #: N x 3, unit, from the ball to each light: what stereo takes as lights
        self.directions: np.ndarray = np.array([light.direction for light in self.lights], np.float32).reshape(-1, 3)
        #: of a mirror ball: each highlight's centre, and the radius of a disc of its area
        self.highlights: Optional[List[Circle]] = [_circle(c.highlights[i]) for i in count] if c.highlights else None
        #: N, of a matte ball: root mean square of what its shading leaves unexplained, a share of the light
        self.residuals: Optional[np.ndarray] = (
            np.array([c.residuals[i] for i in count], np.float32) if c.residuals else None)
        self.warnings: Tuple[Notice, ...] = notices(c.warnings)
        self.skipped: List[SkippedFile] = skipped(c.skipped)  #: files of the folder that were left aside
        self.brightest: np.ndarray = view(owner, c.brightest)  #: H x W x 3, linear: the brightest of each pixel

    def __repr__(self) -> str:
        return f"<merlin.Calibration, {len(self.names)} lights by a {self.ball} ball>"

    def save(self, folder: PathLike) -> List[str]:
        """Writes lights.txt (x y z a line) and calibration.png into a folder, which is made if need be: both or, after
        a failure, none. Returns their paths."""
        written = Owner(h.Files(), "files_free")
        check("calibration_write", self._owner.at, path_bytes(folder), written.at)
        return written_paths(written)


def calibrate(folder: PathLike, ball: str = "chrome", *, mask: Optional[PathLike] = None, linear: bool = False,
              field_of_view: float = 0.0, progress: Optional[ProgressCallback] = None,
              stop: Optional[StopCallback] = None) -> Calibration:
    """Finds the lights by the highlight on a mirror ball ("chrome") or by the shading of a matte one ("matte").

    mask: a picture, white on the ball; None: the folder's mask.png or the like, else the ball is searched for. linear:
    8-bit pictures are linear. field_of_view: of the camera, horizontal, degrees, at most 170; 0: by EXIF, else it is far
    away. Progress and stop: as of Model.estimate."""
    name = path_bytes(folder)
    params = h.CalibrateParams(choice(ball, BALLS, "ball"), optional_path(mask), int(linear),
                               real(field_of_view, "field_of_view"))
    watch = Watch(progress, stop)
    watch.put(params)
    owner = Owner(h.Calibration(), "calibration_free")
    watch.check("calibrate", name, ctypes.byref(params), owner.at, path=os.fsdecode(name))
    found = Calibration(owner)
    warn(found.warnings)
    return found
