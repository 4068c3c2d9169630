# SPDX-License-Identifier: MIT
"""Maps under other light."""
from __future__ import annotations

import ctypes
import os
import threading
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _headers as h
from ._call import Owner, check, choice, path_bytes, real, vector3, view, whole
from .pictures import PathLike, new_image

if TYPE_CHECKING:
    from .maps import Maps
    from .model import Model

WAYS = {"brdf": h.BY_BRDF, "network": h.BY_NETWORK, "unshadowed": h.BY_BRDF_UNSHADOWED, "direct": h.BY_BRDF_DIRECT}


class Environment:
    """Surroundings: a latitude-longitude picture, Radiance HDR or EXR, twice as wide as high; up is its top row,
    straight ahead of the camera its middle column, right of that the camera's right.

    turn: degrees about the vertical. exposure: EV; at 0 a white object is about as bright as under the flash."""

    def __init__(self, path: PathLike, turn: float = 0.0, exposure: float = 0.0) -> None:
        name = path_bytes(path)
        self._owner = Owner(ctypes.c_void_p(), "environment_free")
        check("environment_read", name, real(turn, "turn"), real(exposure, "exposure"), self._owner.at,
              path=os.fsdecode(name))


def _environment(source: Any, turn: float, exposure: float) -> Optional[Environment]:
    if source is None or isinstance(source, Environment):
        if source is not None and (turn or exposure):
            raise ValueError("an Environment has its turn and exposure already")
        return source
    return Environment(source, turn, exposure)


def _lamp(light: Any) -> Any:
    return None if light is None else vector3(light, "a light's place")


def relight(model: "Model", maps: "Maps", light: Any, environment: Any, turn: float, exposure: float,
            by: str) -> np.ndarray:
    """As Maps.relight."""
    how = choice(by, WAYS, "by")
    handle, out = model._handle, new_image()
    if isinstance(light, str):
        if light != "found" or environment is not None:
            raise ValueError('light is (x, y, z) or "found", and the latter stands alone')
        check("relight_found", handle.struct, maps._sound(), real(turn, "turn"), how, out.at)
        return view(out, out.struct)
    if environment is None and (turn or exposure):
        raise ValueError('turn and exposure are of an environment, or turn of light="found"')
    around = _environment(environment, turn, exposure)
    if light is None and around is None:
        raise ValueError("there is no light: give light=(x, y, z), light=\"found\" or an environment")
    if around is None:
        check("relight", handle.struct, maps._sound(), _lamp(light), how, out.at)
    else:
        check("relight_environment", handle.struct, maps._sound(), around._owner.struct, _lamp(light), how, out.at)
    return view(out, out.struct)


class Relighter:
    """Maps made ready once for many lights; later changes of the maps are not seen. Threads take turns."""

    def __init__(self, maps: "Maps", side: int = 0, *, by: str = "brdf", model: "Optional[Model]" = None) -> None:
        how = choice(by, WAYS, "by")
        handle = maps._lighting_model(model)._handle
        self._owner: Optional[Owner] = Owner(ctypes.c_void_p(), "relighter_free", keeps=handle)
        self._lock = threading.Lock()
        check("relighter_new", handle.struct, maps._sound(), whole(side, "side"), how, self._owner.at)

    def render(self, light: Any = None, environment: Union[Environment, PathLike, None] = None) -> np.ndarray:
        """The square `crop` under a lamp at (x, y, z), in surroundings, or both: side x side x 3 float32, linear, in
        [0, 1], zero beside the object."""
        around = _environment(environment, 0.0, 0.0)
        lamp, out = _lamp(light), new_image()
        with self._lock:
            if self._owner is None:
                raise ValueError("this relighter is closed")
            check("relighter_render", self._owner.struct, lamp, None if around is None else around._owner.struct,
                  out.at)
        return view(out, out.struct)

    __call__ = render

    def close(self) -> None:
        """Frees it, when a picture that is being made is done."""
        with self._lock:
            self._owner = None

    def __enter__(self) -> "Relighter":
        return self

    def __exit__(self, *_error: Any) -> None:
        self.close()
