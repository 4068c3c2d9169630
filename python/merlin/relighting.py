# SPDX-License-Identifier: MIT
"""Maps under other light."""
from __future__ import annotations

import ctypes
import threading
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _headers as h
from ._call import Owner, call, check, choice, real, view, whole
from .errors import WrongUseError
from .lights import Environment, environment_of, lamps_of
from .pictures import PathLike, image_for, new_image
from .results import notices, warn

if TYPE_CHECKING:
    from .maps import Maps
    from .model import Model

WAYS = {"brdf": h.BY_BRDF, "network": h.BY_NETWORK, "unshadowed": h.BY_BRDF_UNSHADOWED, "direct": h.BY_BRDF_DIRECT}


def warn_of_model(model: "Model", maps: "Maps", how: int) -> None:
    """Where other weights than the maps' estimate their bounces, or relight them by a decoder."""
    found = h.Warnings()
    call("relighting_warnings", model._handle.struct, maps._owner.at, how, ctypes.byref(found))
    warn(notices(found))


def relight(model: "Model", maps: "Maps", light: Any, environment: Any, turn: float, exposure: float,
            by: str) -> np.ndarray:
    """As Maps.relight."""
    how = choice(by, WAYS, "by")
    if light is not None:
        warn_of_model(model, maps, how)
    if isinstance(light, str):
        if light != "found" or environment is not None or exposure:
            raise WrongUseError('light is a place, lamps or "found", and the latter stands alone, or with turn')
        out = new_image()
        check("relight_found", model._handle.struct, maps._sound(), real(turn, "turn"), how, out.at)
        return view(out, out.struct)
    if environment is None and (turn or exposure):
        raise WrongUseError('turn and exposure are of an environment, or turn of light="found"')
    around = environment_of(environment, turn, exposure)
    lamps, count = lamps_of(light)
    if not count and around is None:
        raise WrongUseError('there is no light: give light=(x, y, z), lamps, light="found" or an environment')
    if count == 0 or (count == 1 and not lamps[0].distant and list(lamps[0].power) == [1, 1, 1]):
        return _relight_one(model, maps, lamps[0].at if count else None, around, how)
    for i in range(count):
        check("relighting_check", how, ctypes.byref(lamps[i]), int(around is not None))
    with Relighter(maps, by=by, model=model) as relighter:
        return relighter.place(relighter.render(light, around))


def _relight_one(model: "Model", maps: "Maps", place: Any, around: Optional[Environment], how: int) -> np.ndarray:
    """Under one lamp of the flash's power, in surroundings, or both: in less memory than a relighter takes."""
    out = new_image()
    if around is None:
        check("relight", model._handle.struct, maps._sound(), place, how, out.at)
    else:
        check("relight_environment", model._handle.struct, maps._sound(), around._owner.struct, place, how, out.at)
    return view(out, out.struct)


class Relighter:
    """Maps made ready once for many lights; later changes of the maps are not seen. Threads take turns."""

    def __init__(self, maps: "Maps", side: int = 0, *, by: str = "brdf", model: "Optional[Model]" = None) -> None:
        how = choice(by, WAYS, "by")
        lighting = maps._lighting_model(model)
        warn_of_model(lighting, maps, how)
        handle = lighting._handle
        self._owner: Optional[Owner] = Owner(ctypes.c_void_p(), "relighter_free", keeps=handle)
        self._lock = threading.Lock()
        check("relighter_new", handle.struct, maps._sound(), whole(side, "side"), how, self._owner.at)

    @property
    def _handle(self) -> Any:
        if self._owner is None:
            raise WrongUseError("this relighter is closed")
        return self._owner.struct

    def render(self, light: Any = None, environment: Union[Environment, PathLike, None] = None) -> np.ndarray:
        """The square `crop` under light: side x side x 3 float32, linear, in [0, 1], zero beside the object.

        light: a lamp's place (x, y, z), a Lamp, several of either together, or None. environment: surroundings, with
        them or alone."""
        around = environment_of(environment)
        (lamps, count), out = lamps_of(light), new_image()
        with self._lock:
            check("relighter_render_lamps", self._handle, lamps, count,
                  None if around is None else around._owner.struct, out.at)
        return view(out, out.struct)

    __call__ = render

    @property
    def mask(self) -> np.ndarray:
        """The object in its pictures: side x side, coverage in [0, 1]; a copy."""
        with self._lock:
            image = call("relighter_mask", self._handle).contents
            return view(self._owner, image).copy()

    @property
    def white(self) -> float:
        """The radiance that is white in its pictures, at first as the photograph was exposed; may be set."""
        with self._lock:
            return call("relighter_white", self._handle)

    @white.setter
    def white(self, radiance: float) -> None:
        with self._lock:
            check("relighter_set_white", self._handle, real(radiance, "white"))

    def meter(self, light: Any = None, environment: Union[Environment, PathLike, None] = None) -> float:
        """The white that leaves all but a thousandth of the object's values below it under each of these lamps; without
        lamps, in these surroundings."""
        around, white = environment_of(environment), ctypes.c_float()
        lamps, count = lamps_of(light)
        with self._lock:
            check("relighter_meter", self._handle, lamps, count, None if around is None else around._owner.struct,
                  ctypes.byref(white))
        return white.value

    def make_matte(self) -> None:
        """Takes the gloss away from all pictures that follow."""
        with self._lock:
            check("relighter_make_matte", self._handle)

    def place(self, square: np.ndarray) -> np.ndarray:
        """Puts a picture of the photograph's resolution into its frame: H x W x 3, black beside the object."""
        struct, _kept = image_for(square)
        out = new_image()
        with self._lock:
            check("relighter_place", self._handle, ctypes.byref(struct), out.at)
        return view(out, out.struct)

    def close(self) -> None:
        """Frees it, when a picture that is being made is done."""
        with self._lock:
            self._owner = None

    def __enter__(self) -> "Relighter":
        return self

    def __exit__(self, *_error: Any) -> None:
        self.close()
