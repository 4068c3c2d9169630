# SPDX-License-Identifier: MIT
"""Models: trained weights, and what they make of a photograph."""
from __future__ import annotations

import ctypes
import os
import threading
from typing import Any, Iterable, Optional, Tuple, Union

import numpy as np

from . import _headers as h
from . import pictures
from ._call import Owner, ProgressCallback, StopCallback, Watch, call, check, is_path, path_bytes, real, view, whole
from .errors import WrongTypeError, WrongUseError
from ._library import shipped_weights, weights_path
from .maps import Maps
from .pictures import PathLike, Picture
from .results import Shot, warn

Points = Iterable[Tuple[int, int]]
Box = Tuple[int, int, int, int]


def _shipped(name: str) -> Optional[bytes]:
    path = shipped_weights(name)
    return None if path is None else os.fsencode(path)


def _default_weights() -> Tuple[bytes, Optional[bytes], Optional[bytes]]:
    """As the command's: $MERLIN_MODEL, else merlin-any and, for flashes, merlin-point; several photographs by merlin-several."""
    named = os.environ.get("MERLIN_MODEL")
    if named:
        return weights_path(named, "MERLIN_MODEL: "), None, None
    return weights_path("merlin-any"), _shipped("merlin-point"), _shipped("merlin-several")


def hint_of(points: Optional[Points], box: Optional[Box]) -> Any:
    """Where the object is, as the library takes it."""
    hint = h.Hint()
    try:
        pairs = [(x, y) for x, y in points or ()]
        numbers = None if box is None else tuple(box)
    except (TypeError, ValueError):
        raise WrongTypeError("points are pairs (x, y), and a box is x, y, width, height") from None
    for x, y in pairs:
        if hint.point_count == h.MOST_POINTS:
            raise WrongUseError(f"there are at most {h.MOST_POINTS} points")
        hint.point[hint.point_count] = h.Point(whole(x, "a point's x"), whole(y, "a point's y"))
        hint.point_count += 1
    if numbers is not None:
        if len(numbers) != 4:
            raise WrongUseError("a box is x, y, width, height")
        hint.box = h.Box(*(whole(number, "a box's numbers") for number in numbers))
        if hint.box.width < 1 or hint.box.height < 1:
            raise WrongUseError("a box is one pixel wide and high at least")
    return hint


def fov_of(fov: Optional[float]) -> float:
    """A field of view as the library takes it, for which 0 is an unknown one."""
    if fov is None:
        return 0
    degrees = real(fov, "fov")
    if degrees == 0:
        raise WrongUseError("fov is 1 to 150 degrees, or None")
    return degrees


def read_shot(path: PathLike) -> Shot:
    """Reads how a photograph was taken from its EXIF; unknown without."""
    shot = _shot(path)
    flash = {h.FLASH_NONE: False, h.FLASH_FIRED: True}.get(shot.flash)
    return Shot(flash, shot.focal_35mm, shot.reduced, shot.frames)


def _shot(path: PathLike) -> Any:
    name, shot = path_bytes(path), h.Shot()
    check("shot_read", name, ctypes.byref(shot), path=os.fsdecode(name))
    return shot


def _reduction(photo: Any) -> int:
    """Returns the number of a file's pixels a side that became one, which points and boxes count."""
    return int(_shot(photo).reduced) if is_path(photo) else 1


class FoundObject:
    """Which part of a photograph is the object, as `find_object` found it; `Model.estimate` takes it as a mask."""

    def __init__(self, owner: Owner) -> None:
        self._owner = owner
        self.mask: np.ndarray = view(owner, owner.struct.mask)  #: H x W, coverage in [0, 1]
        self.source: str = "given" if owner.struct.source == h.MASK_GIVEN else "found"
        self.confidence: float = owner.struct.confidence  #: how likely it is right, in [0, 1]
        self.seconds: float = owner.struct.seconds  #: that it took

    def __repr__(self) -> str:
        return f"<merlin.FoundObject {self.source}, confidence {self.confidence:.2f}>"


def _find(photo: Owner, mask: Any, hint: Any) -> Owner:
    found = Owner(h.Object(), "object_free")
    check("object_find", photo.at, None if mask is None else mask.at, ctypes.byref(hint), found.at)
    return found


def _taken(photo: Picture, mask: Any, linear: Optional[bool]) -> Tuple[Owner, Optional[Owner]]:
    """The photograph and its mask: the given one, else its alpha, else None."""
    color, alpha = pictures.picture(photo, linear)
    if mask is not None:
        return color, pictures.mask(mask)
    return color, alpha if alpha.struct.data else None


def find_object(photo: Picture, mask: Optional[Picture] = None, *, points: Optional[Points] = None,
                box: Optional[Box] = None, linear: Optional[bool] = None) -> FoundObject:
    """Finds which part of a photograph is the object: by the mask or the photograph's alpha, else by a search.

    points: up to 16 (x, y), pixels of the object; box: (x, y, width, height), which holds all of it. Both help the
    search, and are refused where there is a mask."""
    hint = hint_of(points, box)
    hint.reduced = _reduction(photo)
    return FoundObject(_find(*_taken(photo, mask, linear), hint))


class _Ahead(threading.Thread):
    """Reads a photograph and finds its object while the model is made ready by the thread that waits for it."""

    def __init__(self, work: Any) -> None:
        super().__init__(daemon=True)
        self._work, self._result = work, None
        self._error: Optional[BaseException] = None
        self.start()

    def run(self) -> None:
        """Does the work."""
        try:
            self._result = self._work()
        except BaseException as error:  # noqa: B902 - it is raised by the other thread
            self._error = error

    def finish(self) -> Any:
        """Waits for the result; raises what the work raised."""
        self.join()
        if self._error is not None:
            raise self._error
        return self._result


class Model:
    """Trained weights, opened to work with. Several threads may use one model (they take turns), or each its own.

    weights: "merlin-any" (any light), "merlin-point" (a flash alone), "merlin-env" (a flash in a room), or a file.
    flash: weights of the same kinds for photographs that those of any light see lit by a flash alone; several:
    "merlin-several" or a file, which sees several photographs of an object together (`Capture.maps`).
    Without any of them: $MERLIN_MODEL, else merlin-any with merlin-point and merlin-several, as the command has it."""

    def __init__(self, weights: Optional[PathLike] = None, *, flash: Optional[PathLike] = None,
                 several: Optional[PathLike] = None) -> None:
        main, other, together = _default_weights() if weights is None else (weights_path(weights), None, None)
        if flash is not None:
            other = weights_path(flash)
        if several is not None:
            together = weights_path(several)
        self._owner: Optional[Owner] = Owner(ctypes.c_void_p(), "model_close")
        self._ready: Any = None
        check("model_open", main, self._owner.at, path=os.fsdecode(main))
        if other is not None:
            check("model_add_flash", self._handle.struct, other)
        if together is not None:
            check("model_add_several", self._handle.struct, together)

    @property
    def _handle(self) -> Owner:
        if self._owner is None:
            raise WrongUseError("this model is closed")
        return self._owner

    @property
    def name(self) -> str:
        """Of the weights."""
        return call("model_name", self._handle.struct).decode("utf-8", "replace")

    def close(self) -> None:
        """Lets go of the weights, when the calls and relighters that use them are done. Maps stay."""
        self._owner = None

    def __enter__(self) -> "Model":
        return self

    def __exit__(self, *_error: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return "<merlin.Model, closed>" if self._owner is None else f"<merlin.Model {self.name}>"

    def prepare(self, *, size: int = 512, views: int = 4, flash: bool = False) -> None:
        """Does now what the first photograph would begin with, some tenths of a second."""
        params = call("params_default")
        params.size, params.views, params.flash = whole(size, "size"), whole(views, "views"), int(flash)
        check("model_prepare", self._handle.struct, ctypes.byref(params))

    def estimate(self, photo: Picture, mask: Union[Picture, FoundObject, None] = None, *, size: int = 512,
                 views: int = 4, exposure: Optional[float] = None, flash: bool = False, fov: Optional[float] = None,
                 points: Optional[Points] = None, box: Optional[Box] = None, linear: Optional[bool] = None,
                 last: bool = False, progress: Optional[ProgressCallback] = None,
                 stop: Optional[StopCallback] = None) -> Maps:
        """Takes the object of a photograph apart into maps of its material and shape.

        photo: a file, or an array: H x W (grey), H x W x 3 or H x W x 4 (with alpha), from 16 pixels a side to 64
        million; uint8 and uint16 are sRGB, floats are linear, in any unit, unless `linear` says otherwise. mask: a
        file, an array of H x W (bool, or coverage from 0 to white), or a FoundObject; None: the photograph's alpha,
        else the object is searched for.

        size: side of the square that the network sees, a multiple of 32 from 64 to 512. views: the mean over 1 to 8 of
        the square's orientations. exposure: EV instead of the automatic one. flash: the light was a flash at the lens
        and nothing else. fov: degrees that the photograph is wide, 1 to 150; None: by its EXIF. points, box: as of
        find_object. last: no photograph follows, the model need keep nothing for one.

        progress(stage, share): told how far it is, the share in [0, 1]. stop(): asked between stages; a true answer
        ends the work with StoppedError. What either raises, and Ctrl-C, ends it, too. Doubts are told by Python's
        warnings, and are in Maps.doubts."""
        params = call("params_default")
        params.size, params.views = whole(size, "size"), whole(views, "views")
        if exposure is not None:
            params.auto_exposure, params.exposure = 0, real(exposure, "exposure")
        params.flash, params.last = int(flash), int(last)
        params.fov = fov_of(fov)
        hint = hint_of(points, box)
        watch = Watch(progress, stop)
        watch.put(params)
        handle = self._handle
        color, found = self._begin(photo, mask, linear, hint, params)
        owner = Owner(h.Maps(), "maps_free")
        watch.check("estimate_object", handle.struct, color.at, found.at, ctypes.byref(params), owner.at)
        maps = Maps(owner, self)
        warn(maps.doubts)
        return maps

    def _begin(self, photo: Any, mask: Any, linear: Optional[bool], hint: Any, params: Any) -> Tuple[Owner, Owner]:
        """The photograph and its object; the first time beside what the model begins with, as the command does it."""

        def take() -> Tuple[Owner, Owner]:
            if is_path(photo):
                params.shot = _shot(photo)
                hint.reduced = params.shot.reduced
            if isinstance(mask, FoundObject):
                color, cover = _taken(photo, mask.mask, linear)
                found = _find(color, cover, hint)
                found.struct.source, found.struct.confidence = mask._owner.struct.source, mask.confidence
                return color, found
            color, cover = _taken(photo, mask, linear)
            return color, _find(color, cover, hint)

        wanted = (params.size, params.views, params.flash)
        if self._ready == wanted:
            return take()
        ahead = _Ahead(take)
        try:
            check("model_prepare", self._handle.struct, ctypes.byref(params))
            self._ready = wanted
        finally:
            taken = ahead.finish()
        return taken


def estimate(photo: Picture, mask: Union[Picture, FoundObject, None] = None, **options: Any) -> Maps:
    """Model().estimate(...): for one photograph; for several keep a Model."""
    return Model().estimate(photo, mask, **options)
