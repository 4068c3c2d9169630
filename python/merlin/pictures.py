# SPDX-License-Identifier: MIT
"""Pictures: from arrays and files to the library, and back.

Arrays are H x W, H x W x 1, x 3 (red, green, blue) or x 4 (these and alpha, which is not multiplied into them); uint8
and uint16 are encoded as sRGB, floats are linear, unless `linear` says otherwise.
"""
from __future__ import annotations

import ctypes
import os
from typing import Any, Iterable, Mapping, Optional, Tuple, Union

import numpy as np

from . import _headers as h
from ._call import Owner, check, choice, free, is_path, path_bytes, view, whole
from .errors import WrongTypeError, WrongUseError
from .results import Notice, warn

PathLike = Union[str, bytes, "os.PathLike[Any]"]
Picture = Union[np.ndarray, PathLike, Any]

_MOST_PIXELS = 64_000_000
_LEAST_CODE = 128  # white is 1: hardly any photograph is this bright, but its bytes as floats are
_TYPES = {np.dtype(np.uint8): h.PIXEL_8, np.dtype(np.uint16): h.PIXEL_16, np.dtype(np.float32): h.PIXEL_FLOAT}


def new_image() -> Owner:
    """An image without data, to be filled in."""
    return Owner(h.Image(), "image_free")


def _array(source: Any, what: str) -> np.ndarray:
    array = np.asarray(source)
    if array.ndim not in (2, 3):
        raise WrongUseError(f"{what} is an array of H x W or H x W x channels, not of shape {array.shape}")
    if array.ndim == 3 and array.shape[2] not in (1, 3, 4):
        raise WrongUseError(f"{what} has 1, 3 or 4 channels behind rows and columns, not {array.shape[2]}: "
                            f"its shape is {array.shape}")
    if 0 in array.shape:
        raise WrongUseError(f"{what} is empty: its shape is {array.shape}")
    height, width = array.shape[:2]
    if height * width > _MOST_PIXELS:
        raise WrongUseError(f"{what} has {width} x {height} pixels, more than 64 million; make it smaller first")
    return array


def _known_type(array: np.ndarray, what: str) -> np.ndarray:
    """uint8, uint16 or float32 in the machine's order of bytes."""
    if array.dtype.kind == "f":
        return array if array.dtype == np.float32 else array.astype(np.float32)
    native = array.dtype.newbyteorder("=")
    if native in _TYPES:
        return array.astype(native, copy=False)
    raise WrongTypeError(f"{what} is of uint8, uint16 or floats, not of {array.dtype}")


def _laid_out(array: np.ndarray, linear: Optional[bool]) -> Tuple[np.ndarray, Any]:
    """The array, copied only if its rows have gaps, and its layout."""
    channels = array.shape[2] if array.ndim == 3 else 1
    value = array.itemsize
    row = array.shape[1] * channels * value
    stride = 0
    if not array.flags.c_contiguous:
        packed = array.strides[1] == channels * value and (array.ndim == 2 or array.strides[2] == value)
        if packed and abs(array.strides[0]) >= row:
            stride = array.strides[0]
        else:
            array = np.array(array, order="C")
    layout = h.PixelLayout(width=array.shape[1], height=array.shape[0], channels=channels, type=_TYPES[array.dtype],
                           linear=int(array.dtype.kind == "f" if linear is None else bool(linear)), stride=stride)
    return array, layout


def _warn_of_codes(array: np.ndarray, linear: Optional[bool], what: str) -> None:
    """Of floats that look like the codes of bytes; whoever calls them linear means it."""
    most = float(array.max()) if array.dtype.kind == "f" and not linear else 0.0
    if _LEAST_CODE <= most < np.inf:
        warn([Notice("floats_like_bytes", f"{what} of floats reaches {most:g}, where white is 1: give 8-bit values as "
                     "uint8, or divide them by 255 and say linear=False where they are sRGB; linear=True says that "
                     "they are radiance")])


def from_array(source: Any, linear: Optional[bool] = None, what: str = "a photograph") -> Tuple[Owner, Owner]:
    """Copies an array into an image of 3 linear channels and its alpha, which has no data where there is none."""
    known = _known_type(_array(source, what), what)
    _warn_of_codes(known, linear, what)
    array, layout = _laid_out(known, linear)
    color, alpha = new_image(), new_image()
    check("image_from_pixels", array.ctypes.data_as(ctypes.c_void_p), ctypes.byref(layout), color.at, alpha.at)
    return color, alpha


def from_file(path: PathLike) -> Tuple[Owner, Owner]:
    """Reads a file of any kind into the same."""
    name = path_bytes(path)
    color, alpha = new_image(), new_image()
    check("image_read", name, color.at, alpha.at, path=os.fsdecode(name))
    return color, alpha


def picture(source: Any, linear: Optional[bool] = None, what: str = "a photograph") -> Tuple[Owner, Owner]:
    """A file or an array, as an image and its alpha."""
    if not is_path(source):
        return from_array(source, linear, what)
    if linear is not None:
        raise WrongUseError("linear is of arrays: a picture's file says what its values are")
    return from_file(source)


def _coverage(source: Any, what: str) -> np.ndarray:
    array = _array(source, what)
    if array.ndim == 3:
        if array.shape[2] != 1:
            raise WrongUseError(f"{what} has 1 channel, not {array.shape[2]}: its shape is {array.shape}")
        array = array[:, :, 0]
    if array.dtype == np.bool_:
        return array.astype(np.uint8) * np.uint8(255)
    if array.dtype.kind in "iu" and array.min() >= 0 and array.max() <= 1:
        return array.astype(np.uint8) * np.uint8(255)
    return _known_type(array, what)


def mask(source: Picture, what: str = "a mask") -> Owner:
    """A mask's file, or an array (H x W; bool, whole numbers of 0 and 1, or coverage from black to white)."""
    made = new_image()
    if is_path(source):
        name = path_bytes(source)
        check("mask_read", name, made.at, path=os.fsdecode(name))
        return made
    array, layout = _laid_out(_coverage(source, what), True)
    check("mask_from_pixels", array.ctypes.data_as(ctypes.c_void_p), ctypes.byref(layout), made.at)
    return made


def image_for(array: Any, what: str = "a picture") -> Tuple[Any, np.ndarray]:
    """An image that shows an array of floats, without owning it; the array must live as long."""
    values = _array(array, what)
    if values.dtype.kind != "f" and values.dtype != np.bool_:
        raise WrongTypeError(f"{what} is of linear floats here, not of {values.dtype}: divide what is linear, and read what is "
                        "sRGB by merlin.read_image")
    floats = np.ascontiguousarray(values, dtype=np.float32)
    channels = floats.shape[2] if floats.ndim == 3 else 1
    image = h.Image(width=floats.shape[1], height=floats.shape[0], channels=channels,
                    data=floats.ctypes.data_as(ctypes.c_void_p))
    return image, floats


# ---- for users ----


def read_image(path: PathLike) -> Tuple[np.ndarray, Optional[np.ndarray]]:
    """Reads a picture of any kind that merlin knows (PNG, JPEG, TIFF, WebP, HEIC, EXR, HDR, raw ...).

    Returns its colours, H x W x 3 linear float32, and its alpha, H x W in [0, 1], or None where the file has none that
    is not opaque everywhere. More than 64 million pixels are read at a reduced size."""
    color, alpha = from_file(path)
    return view(color, color.struct), view(alpha, alpha.struct)


def read_mask(path: PathLike) -> np.ndarray:
    """Reads a mask: H x W float32, coverage in [0, 1], 1 on the object."""
    made = mask(os.fspath(path))
    return view(made, made.struct)


def write_image(path: PathLike, image: np.ndarray) -> None:
    """Writes linear floats, H x W or H x W x 3, clamped to [0, 1], as an 8-bit sRGB PNG; path ends in .png."""
    struct, _kept = image_for(image)
    check("image_write", path_bytes(path), ctypes.byref(struct))


def to_pixels(image: np.ndarray, dtype: Any = np.uint8, *, linear: bool = False,
              alpha: Optional[np.ndarray] = None) -> np.ndarray:
    """Encodes linear floats, H x W or H x W x 3, as pixels of uint8, uint16 or float32 of the same shape.

    linear: True leaves them linear, else they are sRGB. alpha: H x W in [0, 1], which becomes a fourth channel. Whole
    numbers are clamped and rounded."""
    kind = np.dtype(dtype)
    if kind not in _TYPES:
        raise WrongTypeError(f"pixels are uint8, uint16 or float32, not {kind}")
    struct, kept = image_for(image)
    cover = None if alpha is None else image_for(alpha, "an alpha")
    shape = kept.shape if cover is None else kept.shape[:2] + (4,)
    out = np.empty(shape, dtype=kind)
    _same, layout = _laid_out(out, linear)
    check("image_to_pixels", ctypes.byref(struct), None if cover is None else ctypes.byref(cover[0]),
          ctypes.byref(layout), out.ctypes.data_as(ctypes.c_void_p))
    return out


def resize_image(image: np.ndarray, width: int, height: int) -> np.ndarray:
    """Resizes linear floats, H x W or H x W x 3, by Lanczos where it enlarges, by area where it shrinks."""
    struct, _kept = image_for(image)
    out = new_image()
    check("image_resize", ctypes.byref(struct), whole(width, "width"), whole(height, "height"), out.at)
    return view(out, out.struct)


def encode_image(image: np.ndarray, kind: str = "png") -> bytes:
    """The bytes of a "png" or a "jpeg" file of 8-bit sRGB, of linear floats, H x W x 3, clamped to [0, 1]."""
    struct, _kept = image_for(image)
    made, size = ctypes.c_void_p(), ctypes.c_size_t()
    check("image_encode", ctypes.byref(struct), choice(kind, {"png": h.PNG, "jpeg": h.JPEG}, "kind"),
          ctypes.byref(made), ctypes.byref(size))
    try:
        return ctypes.string_at(made, size.value)
    finally:
        free(made)


def write_mask(path: PathLike, mask: np.ndarray) -> None:
    """Writes a mask, or other numbers in [0, 1], H x W or H x W x 3, as 8-bit values without the curve of sRGB; path
    ends in .png or .webp."""
    struct, _kept = image_for(np.asarray(mask, dtype=np.float32), "a mask")
    check("mask_write", ctypes.byref(struct), path_bytes(path))


def write_sheet(path: PathLike, pictures: Mapping[str, np.ndarray], *, columns: int = 4, side: int = 256) -> None:
    """Writes pictures, linear floats by their labels, in rows on dark grey, each side x side pixels, as a PNG."""
    images = [image_for(picture) for picture in pictures.values()]
    tiles = (h.Tile * max(len(images), 1))(*(
        h.Tile(label.encode(), ctypes.pointer(image)) for label, (image, _kept) in zip(pictures, images)))
    check("sheet_write", tiles, len(images), min(whole(columns, "columns"), max(len(images), 1)), whole(side, "side"),
          path_bytes(path))


def write_animation(path: PathLike, frames: Iterable[np.ndarray], *, milliseconds: int = 125) -> None:
    """Writes frames, linear floats, H x W x 3, all alike, as an animation that repeats for ever, each shown for so many
    milliseconds; path ends in .webp or .gif."""
    images = [image_for(frame, "a frame") for frame in frames]
    if not images:
        raise WrongUseError("an animation has one frame at least")
    made = Owner(ctypes.c_void_p(), "animation_free")
    check("animation_new", images[0][0].width, images[0][0].height, len(images), made.at)
    for image, _kept in images:
        check("animation_add", made.struct, ctypes.byref(image))
    check("animation_write", made.struct, path_bytes(path), whole(milliseconds, "milliseconds"))
