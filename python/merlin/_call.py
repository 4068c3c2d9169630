# SPDX-License-Identifier: MIT
"""How the library is called: errors become exceptions, what it made is freed with what shows it, Ctrl-C stops it.

ctypes lets go of the interpreter's lock for the time of a call, so that other Python threads go on.
"""
from __future__ import annotations

import ctypes
import os
import signal
import threading
from typing import Any, Callable, List, Optional

import numpy as np

from . import _headers, _library
from .errors import BY_STATUS, BadInputError, ForkedError, MerlinError, MissingFileError, WrongTypeError, WrongUseError

library, library_path = _library.load()
free = ctypes.CDLL(None).free  # of the C library, for what a caller gives back to it
free.argtypes, free.restype = [ctypes.c_void_p], None

ProgressCallback = Callable[[str, float], Any]
StopCallback = Callable[[], Any]

_process = {"called": False, "lost": False}


def _after_fork() -> None:
    _process["lost"] = _process["called"]


os.register_at_fork(after_in_child=_after_fork)


def call(name: str, *arguments: Any) -> Any:
    """Calls merlin_NAME and returns what it returns."""
    if _process["lost"]:
        raise ForkedError("merlin was used before this process was forked, and its threads are not in the child: "
                           "start processes by multiprocessing's \"spawn\", or fork before the first call")
    _process["called"] = True
    return getattr(library, "merlin_" + name)(*arguments)


def error_of(status: int, words: str, path: Optional[str] = None) -> MerlinError:
    """The exception of a status and the library's words; path: what was to be read."""
    kind = BY_STATUS[status - 1] if 1 <= status <= len(BY_STATUS) else MerlinError
    if kind is BadInputError and path is not None and not os.path.exists(path):
        kind = MissingFileError
    return kind(words)


def check(name: str, *arguments: Any, path: Optional[str] = None) -> None:
    """Calls merlin_NAME; raises what it says went wrong."""
    status = call(name, *arguments)
    if status != _headers.OK:
        raise error_of(status, library.merlin_error().decode("utf-8", "replace"), path)


class Watch:
    """Carries progress, stop and Ctrl-C into a call, and what they raise out of it.

    An exception must not be raised through the library: a callback that fails asks it to stop, and the exception is
    raised when it has returned. For the same reason the handler of Ctrl-C waits until then."""

    def __init__(self, progress: Optional[ProgressCallback], stop: Optional[StopCallback]) -> None:
        for name, value in (("progress", progress), ("stop", stop)):
            if value is not None and not callable(value):
                raise WrongTypeError(f"{name} is called, and a {type(value).__name__} cannot be")
        self._told, self._asked = progress, stop
        self._raised: Optional[BaseException] = None
        self._handler: Any = None
        self._signal: Any = None
        self._callbacks: Any = (_headers.Stop(self._stop), _headers.Progress(self._progress))

    def put(self, params: Any) -> None:
        """Sets the three fields of params; the watch must live as long as they are used."""
        params.stop, params.progress = self._callbacks

    def _stop(self) -> int:
        if self._raised is not None or self._signal is not None:
            return 1
        try:
            return 1 if self._asked is not None and self._asked() else 0
        except BaseException as error:  # noqa: B902 - it is raised again by check
            self._raised = error
            return 1

    def _progress(self, _context: Any, stage: bytes, share: float) -> None:
        if self._told is None or self._raised is not None:
            return
        try:
            self._told(stage.decode("utf-8", "replace"), share)
        except BaseException as error:  # noqa: B902
            self._raised = error

    def _interrupt(self, number: int, frame: Any) -> None:
        self._signal = (number, frame)

    def _catch(self) -> None:
        if threading.current_thread() is not threading.main_thread():
            return
        handler = signal.getsignal(signal.SIGINT)
        if callable(handler):
            self._handler = handler
            signal.signal(signal.SIGINT, self._interrupt)

    def _release(self) -> None:
        if self._handler is not None:
            signal.signal(signal.SIGINT, self._handler)
        if self._signal is not None:
            handler, self._handler = self._handler, None
            handler(*self._signal)
        if self._raised is not None:
            raise self._raised

    def check(self, name: str, *arguments: Any, path: Optional[str] = None) -> None:
        """As the function of this name, with Ctrl-C, and with whatever the callbacks raised."""
        self._catch()
        words = ""
        status = _headers.OK
        try:
            status = call(name, *arguments)
            if status != _headers.OK:
                words = library.merlin_error().decode("utf-8", "replace")
        finally:
            self._callbacks = None  # which point back here
            self._release()
        if status != _headers.OK:
            raise error_of(status, words, path)


class Owner:
    """A structure that the library filled in, or a handle that it gave; it is freed with the last that uses it, and
    before what it keeps."""

    def __init__(self, struct: Any, free: str, keeps: Any = None) -> None:
        self.struct = struct
        self.keeps = keeps
        self._free = getattr(library, "merlin_" + free)

    def __del__(self, _process: Any = _process) -> None:
        if not _process["lost"]:
            self._free(self.struct if isinstance(self.struct, ctypes.c_void_p) else ctypes.byref(self.struct))

    @property
    def at(self) -> Any:
        """The structure's address, for a call."""
        return ctypes.byref(self.struct)


class _Memory:
    """Memory of the library as numpy takes it; numpy keeps this, and this keeps the owner."""

    def __init__(self, owner: Any, address: int, shape: tuple, typestr: str) -> None:
        self.owner = owner
        self.__array_interface__ = {"version": 3, "typestr": typestr, "shape": shape, "data": (address, False)}


def view(owner: Any, image: Any) -> Any:
    """An image as an array without a copy: H x W, or H x W x 3; None where it has no data."""
    if not image.data:
        return None
    shape = (image.height, image.width) + ((image.channels,) if image.channels != 1 else ())
    return np.asarray(_Memory(owner, image.data, shape, "<f4"))


def view_of(owner: Any, pointer: Any, shape: tuple, typestr: str = "<f4") -> Any:
    """What a pointer of the library points to, as an array without a copy; None where there is nothing."""
    if not pointer:
        return None
    address = ctypes.cast(pointer, ctypes.c_void_p).value
    return np.asarray(_Memory(owner, address or 0, shape, typestr))


def taken_bytes(text: ctypes.c_void_p) -> bytes:
    """Text that the library gave to a caller, who frees it."""
    try:
        return ctypes.string_at(text)
    finally:
        free(text)


def taken_text(text: ctypes.c_void_p) -> str:
    """The same as text."""
    return taken_bytes(text).decode("utf-8", "replace")


def written_paths(files: Owner) -> List[str]:
    """The paths of merlin_files."""
    return [os.fsdecode(files.struct.at[i]) for i in range(files.struct.count)]


def path_bytes(path: Any) -> bytes:
    """A path as the library takes it; WrongUseError for one with a null character in it."""
    if not is_path(path):
        raise WrongTypeError(f"a path is text, bytes or of pathlib, not a {type(path).__name__}")
    encoded = os.fsencode(path)
    if b"\0" in encoded:
        raise WrongUseError("a path holds no null character")
    return encoded


def optional_path(path: Any) -> Optional[bytes]:
    """None, or as path_bytes."""
    return None if path is None else path_bytes(path)


def is_path(value: Any) -> bool:
    """True for what names a file."""
    return isinstance(value, (str, bytes, os.PathLike))


def choice(value: Any, names: dict, what: str) -> int:
    """The number of a name in a table; WrongUseError lists the names."""
    if not isinstance(value, str) or value not in names:
        raise WrongUseError(f"{what} is one of {', '.join(map(repr, names))}, not {value!r}")
    return names[value]


def real(value: Any, what: str) -> float:
    """A number as the library takes it, which refuses those that are not finite itself."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise WrongTypeError(f"{what} is a number, not {value!r}") from None


def whole(value: Any, what: str) -> int:
    """A whole number that fits the library's int, which ctypes would cut down in silence."""
    try:
        number = value.__index__()
    except AttributeError:
        raise WrongTypeError(f"{what} is a whole number, not {value!r}") from None
    if not -2**31 <= number < 2**31:
        raise WrongUseError(f"{what} is out of range: {number}")
    return number


def floats(value: Any, what: str) -> np.ndarray:
    """An array of float32; WrongTypeError for what is none."""
    try:
        return np.asarray(value, dtype=np.float32)
    except (TypeError, ValueError):
        raise WrongTypeError(f"{what} is of numbers, not {value!r}") from None


def by_channel(value: Any, what: str) -> Any:
    """Three floats of one number or three."""
    array = floats(value, what)
    return vector3(np.repeat(array, 3) if array.size == 1 else array, what)


def vector3(value: Any, what: str) -> Any:
    """Three floats for the library."""
    array = floats(value, what)
    if array.shape != (3,):
        raise WrongUseError(f"{what} is three numbers, not of shape {array.shape}")
    return _headers.floats3(*array.tolist())
