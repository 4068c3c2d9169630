# SPDX-License-Identifier: MIT
"""A folder of merlin's results as what a scene is made of: maps, the camera and the light that was found.

    found = read_result("photo.merlin")
    found.camera.focal, found.lamps, found.surroundings

Space is merlin's: the camera at the origin, x right, y up, the object about (0, 0, -1). Everything here is from maps.exr,
as `merlin relight` has it too; the pictures beside it become textures.
"""

import math
import os
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from .exr import Exr, Unreadable

LIGHT_POWER = 5.95  # of a lamp of strength 1: it sends that radiant intensity
ASSUMED_FOV = 60.0  # degrees, of the crop, where nothing tells how wide the lens saw
EXPOSURE_WHITE = 1.568  # the least white of photographs that have values above 1
BEYOND_WHITE = 1.01
FARTHER_THAN_ANY = 0.9  # sines of the slant, squared and added up


@dataclass
class Camera:
    """The camera that took the photograph."""

    width: int
    height: int
    focal: float  # pixels; 0: seen from afar, without perspective
    center: tuple[float, float]  # where the lens's axis meets the picture, pixels from the upper left corner
    axes: np.ndarray  # 3 x 3: the columns are the picture's right and up, and what is behind the camera


@dataclass
class Lamp:
    """A lamp at a place, or the direction toward one far away."""

    name: str
    at: tuple[float, float, float]
    distant: bool
    strength: np.ndarray  # by channel: radiant intensity, or irradiance of a distant one, in the photograph's values


@dataclass
class Result:
    """What one folder holds."""

    folder: str
    camera: Camera
    depth: np.ndarray
    mask: np.ndarray
    photo: Optional[np.ndarray]  # height x width x 3, linear, black beside the object
    pitch: float  # size of a pixel seen from afar
    unit: float  # how much of the result's own unit of length one of the scene's is
    glossy: bool
    rounded: bool  # depth stands in the file as halves
    lamps: list[Lamp] = field(default_factory=list)
    surroundings: Optional[np.ndarray] = None  # 9 x 3 coefficients of radiance, in the photograph's values

    @property
    def name(self) -> str:
        base = os.path.basename(os.path.normpath(self.folder))
        return base[: -len(".merlin")] if base.endswith(".merlin") else base

    def picture(self, name: str) -> str:
        """Returns the path of a picture beside maps.exr."""
        path = os.path.join(self.folder, name)
        if not os.path.isfile(path):
            raise Unreadable(f"{self.folder} has no {name}: make its maps again with merlin")
        return path


def read_result(folder: str) -> Result:
    """Reads a folder that `merlin estimate` or `merlin stereo` has written."""
    path = os.path.join(folder, "maps.exr")
    if not os.path.isfile(path):
        raise Unreadable(f"no maps.exr in {folder}: choose a folder that merlin estimate or merlin stereo has written")
    file = Exr(path)
    if "merlinCrop" in file.attributes:
        return _of_photograph(folder, file)
    if "merlinFocal" in file.attributes:
        return _of_capture(folder, file)
    raise Unreadable(f"{path} was written by neither merlin estimate nor merlin stereo")


# ---- merlin estimate ----


def _numbers(file: Exr, name: str, count: int, otherwise: Optional[tuple] = None) -> tuple:
    values = file.attributes.get(name, otherwise)
    if isinstance(values, float):
        values = (values,)
    if not isinstance(values, tuple) or len(values) != count or not all(math.isfinite(x) for x in values):
        raise Unreadable(f"{file.path}: its attribute {name} should be {count} finite numbers")
    return values


def _plane(right: float, up: float) -> np.ndarray:
    """The lens's axes as seen by a camera that looks at the middle of the crop; the slant is given by its sines."""
    share = 1 / (1 + math.sqrt(1 - right * right - up * up))
    x = np.array([1 - right * right * share, -right * up * share, -right])
    y = np.array([-right * up * share, 1 - up * up * share, -up])
    return np.stack([x, y, np.cross(x, y)], axis=1)


def _camera_of_photograph(file: Exr) -> Camera:
    left, top, side = _numbers(file, "merlinCrop", 3)
    fov, right, up = _numbers(file, "merlinLens", 3, (0.0, 0.0, 0.0))
    if fov == 0:
        fov, right, up = ASSUMED_FOV, 0.0, 0.0
    if not (side >= 1 and 1 <= fov <= 150 and right * right + up * up < FARTHER_THAN_ANY):
        raise Unreadable(f"{file.path}: no camera is as its merlinCrop and merlinLens say")
    size = 2 * math.tan(math.radians(fov) / 2) / side  # of a pixel in the crop's middle, at distance 1
    focal = math.sqrt(1 - right * right - up * up) / size
    center = (left + side / 2 - right / size, top + side / 2 + up / size)
    return Camera(file.width, file.height, focal, center, _plane(right, up))


def _white(photo: np.ndarray, gain: float) -> float:
    """The radiance that the photograph shows as 1; one of values above 1 has no such white of its own."""
    return gain if gain >= EXPOSURE_WHITE or photo.max() <= BEYOND_WHITE else EXPOSURE_WHITE


def _light_lamps(result: Result, file: Exr, white: float) -> None:
    """Adds what the model saw, or the flash alone, which is all the light that other models know."""
    if "merlinLight" not in file.attributes:
        result.lamps.append(Lamp("flash", (0, 0, 0), False, np.full(3, LIGHT_POWER / white)))
        if "merlinEnvironment" in file.attributes:
            sh = _numbers(file, "merlinEnvironment", 27)
            result.surroundings = np.reshape(sh, (9, 3)) / white
        return
    values = np.array(_numbers(file, "merlinLight", 36))
    flash, toward, distance, strength = values[0], values[1:4], values[5], values[6:9]
    if flash > 0:
        result.lamps.append(Lamp("flash", (0, 0, 0), False, np.full(3, flash * LIGHT_POWER / white)))
    if np.any(toward):
        place = toward * distance - (0, 0, 1) if distance > 0 else toward
        power = strength * LIGHT_POWER / white * (distance * distance if distance > 0 else 1)
        result.lamps.append(Lamp("lamp", tuple(place), distance <= 0, power))
    result.surroundings = values[9:].reshape(9, 3) / white


def _of_photograph(folder: str, file: Exr) -> Result:
    planes = file.read(["depth.Z", "mask.A", "photo.R", "photo.G", "photo.B"])
    photo = np.stack([planes["photo.R"], planes["photo.G"], planes["photo.B"]], axis=2)
    camera = _camera_of_photograph(file)
    depth, mask = planes["depth.Z"].astype(np.float32), planes["mask.A"].astype(np.float32)
    found = Result(folder, camera, depth, mask, photo, pitch=0, unit=1, glossy=True, rounded=True)
    (gain,) = _numbers(file, "merlinGain", 1)
    if not gain > 0:
        raise Unreadable(f"{file.path}: merlinGain {gain:g} is out of range")
    _light_lamps(found, file, _white(photo, gain))
    return found


# ---- merlin stereo ----

# A capture's own lights are many and of unknown strength: a white matte surface that faces this one is white.
CAPTURE_LIGHT = Lamp("sun", (-1, 1, 1.5), True, np.full(3, math.pi))


def _of_capture(folder: str, file: Exr) -> Result:
    """A surface is brought to a mean depth of 1, or seen from afar to a picture of length 1 about (0, 0, -1)."""
    planes = file.read(["depth.Z", "mask.A"])
    depth, mask = planes["depth.Z"].astype(np.float32), planes["mask.A"].astype(np.float32)
    (focal,) = _numbers(file, "merlinFocal", 1)
    seen = depth[(mask > 0.5) & np.isfinite(depth)]
    if seen.size == 0:
        raise Unreadable(f"{file.path}: its mask is empty")
    mean = float(seen.mean(dtype=np.float64))
    if focal < 0 or (focal > 0 and not mean > 0):
        raise Unreadable(f"{file.path}: no camera with a focal length of {focal:g} pixels sees such depths")
    unit = mean if focal > 0 else float(max(file.width, file.height))
    placed = depth / unit if focal > 0 else 1 + (depth - mean) / unit
    camera = Camera(file.width, file.height, focal, (file.width / 2, file.height / 2), np.eye(3))
    found = Result(folder, camera, placed, mask, None, pitch=1 / unit, unit=unit, glossy=False, rounded=False)
    found.lamps.append(CAPTURE_LIGHT)
    return found
