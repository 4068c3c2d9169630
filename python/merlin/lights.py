# SPDX-License-Identifier: MIT
"""What objects are lit by: lamps, alone and on domes and orbits; surroundings; the light found in a photograph."""
from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any, List, NamedTuple, Optional, Tuple

import numpy as np

from . import _headers as h
from ._call import Owner, by_channel, call, check, path_bytes, real, vector3, whole
from .errors import WrongTypeError, WrongUseError
from .pictures import PathLike
from .results import notices, warn

if TYPE_CHECKING:
    from .maps import Maps

_MOST = 1_000_000


class Lamp(NamedTuple):
    """A lamp in the maps' space: the object is about (0, 0, -1), the flash at the lens, (0, 0, 0)."""

    at: Any  #: its place; of a distant lamp the direction toward it, of any length
    distant: bool = False  #: far away: its light is parallel, everywhere as bright as a near one's at distance 1
    power: Any = (1.0, 1.0, 1.0)  #: by channel, linear: 1 is the flash's (5.95)

    def _struct(self) -> Any:
        return h.Lamp(vector3(self.at, "a lamp's place"), int(self.distant), by_channel(self.power, "a lamp's power"))


def _lamp(struct: Any) -> Lamp:
    return Lamp(np.array(struct.at, dtype=np.float32), bool(struct.distant), np.array(struct.power, dtype=np.float32))


def _count(count: Any) -> int:
    if not 1 <= whole(count, "the number of lamps") <= _MOST:
        raise WrongUseError(f"there are 1 to {_MOST} lamps, not {count}")
    return count


def dome(count: int, near: float = 0.0) -> List[Lamp]:
    """Lamps that are spread evenly over the hemisphere in front of the object: far away, or `near` from (0, 0, -1)."""
    return [_lamp(call("dome_lamp", i, count, real(near, "near"))) for i in range(_count(count))]


def dome_directions(count: int) -> np.ndarray:
    """count x 3: the unit directions from the object toward a dome's lamps, as `stereo` takes lights."""
    one = h.floats3()
    rows = np.empty((_count(count), 3), np.float32)
    for i in range(count):
        call("dome_direction", i, count, one)
        rows[i] = one
    return rows


def orbit(count: int) -> List[Lamp]:
    """Lamps at equal steps on a circle in front of the object, at distance 1 and 50 degrees aside, the first to the
    right."""
    return [_lamp(call("orbit_lamp", i, count)) for i in range(_count(count))]


def temperature_color(kelvin: float) -> np.ndarray:
    """3, linear, the largest 1: the colour of a black body of 1000 to 40000 kelvin, a Lamp's power."""
    color = h.floats3()
    check("temperature_color", real(kelvin, "kelvin"), color)
    return np.array(color, dtype=np.float32)


def read_lamps(path: PathLike, near: float = 0.0) -> List[Lamp]:
    """Reads a list of lights (docs/light_lists.md): places, x y z a line; or directions, of an .lp file or as angles,
    whose lamps are far away, or `near` from (0, 0, -1)."""
    name, owner = path_bytes(path), Owner(h.Lamps(), "lamps_free")
    check("lamps_read", name, real(near, "near"), owner.at, path=os.fsdecode(name))
    warn(notices(owner.struct.warnings))
    return [_lamp(owner.struct.at[i]) for i in range(owner.struct.count)]


def lamps_of(light: Any) -> Tuple[Any, int]:
    """An array of the library's lamps, and how many: of None, a place (x, y, z), a Lamp, or several of either."""
    if light is None:
        return None, 0
    if isinstance(light, Lamp):
        several = [light]
    else:
        try:
            several = list(light)
        except TypeError:
            raise WrongTypeError(f"light is a place (x, y, z), a Lamp or several of them, not {light!r}") from None
        if len(several) == 3 and not any(isinstance(one, Lamp) or np.ndim(one) for one in several):
            several = [Lamp(several)]
    structs = [(one if isinstance(one, Lamp) else Lamp(one))._struct() for one in several]
    return ((h.Lamp * len(structs))(*structs) if structs else None), len(structs)


class Environment:
    """Surroundings: a latitude-longitude picture, Radiance HDR or EXR, twice as wide as high; up is its top row,
    straight ahead of the camera its middle column, right of that the camera's right.

    turn: degrees about the vertical. exposure: EV; at 0 a white object is about as bright as under the flash."""

    def __init__(self, path: PathLike, turn: float = 0.0, exposure: float = 0.0) -> None:
        name = path_bytes(path)
        self._owner = Owner(ctypes.c_void_p(), "environment_free")
        check("environment_read", name, real(turn, "turn"), real(exposure, "exposure"), self._owner.at,
              path=os.fsdecode(name))

    def turn(self, degrees: float) -> None:
        """Turns it further about the vertical: by 90 what was straight ahead comes to the camera's right."""
        call("environment_turn", self._owner.struct, real(degrees, "degrees"))

    @property
    def negative(self) -> float:
        """The share of the file's values, in [0, 1], that were negative and count as black."""
        return call("environment_negative", self._owner.struct)


def environment_of(source: Any, turn: float = 0.0, exposure: float = 0.0) -> Optional[Environment]:
    """An Environment as it is, or a path's; None for None."""
    if source is None or isinstance(source, Environment):
        if source is not None and (turn or exposure):
            raise WrongUseError("an Environment has its turn and exposure already")
        return source
    return Environment(source, turn, exposure)


def found_lights(maps: "Maps", turn: float) -> Tuple[List[Lamp], Optional[Environment]]:
    """As Maps.found_lights."""
    owner = Owner(h.FoundLights(), "found_lights_free")
    check("found_lights_new", ctypes.byref(maps._struct.light), real(turn, "turn"), owner.at)
    lamps = [_lamp(owner.struct.lamps[i]) for i in range(owner.struct.count)]
    if not owner.struct.rest:
        return lamps, None
    rest = Environment.__new__(Environment)
    rest._owner = Owner(ctypes.c_void_p(owner.struct.rest), "environment_free")
    owner.struct.rest = None  # is the environment's now
    return lamps, rest
