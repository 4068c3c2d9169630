# SPDX-License-Identifier: MIT
"""Reads the OpenEXR files that merlin writes: scan lines of halves and floats, as they are or in ZIP.

    file = Exr("photo.merlin/maps.exr")
    file.attributes["merlinCrop"]             (0.0, 0.0, 512.0)
    file.read(["depth.Z", "mask.A"])          a dictionary of arrays, height x width, of halves or floats

Blender shows such files but does not give their layers to scripts.
"""

import struct
import zlib
from typing import Any

import numpy as np

MAGIC = 20000630
TILED, DEEP, SEVERAL_PARTS = 0x200, 0x800, 0x1000
LINES_PER_CHUNK = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIP of single lines, ZIP
SAMPLE_TYPES = {1: np.dtype("<f2"), 2: np.dtype("<f4")}
MOST_PIXELS = 1 << 26  # merlin reads no larger photographs


class Unreadable(Exception):
    """Says in one line what is wrong with which file."""


class Odd(ValueError):
    """Says what is wrong, without the file's name."""


# Errors that reading raises where bytes are missing or mean nothing.
DAMAGE = (ValueError, IndexError, KeyError, TypeError, struct.error, zlib.error)


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8", "replace"), end + 1


def _value(kind: str, data: bytes) -> Any:
    """Takes an attribute of the kinds that matter here; others stay bytes."""
    if kind == "float":
        return struct.unpack("<f", data)[0]
    if kind == "floatvector":
        return struct.unpack(f"<{len(data) // 4}f", data)
    if kind == "string":
        return data.decode("utf-8", "replace")
    if kind == "box2i":
        return struct.unpack("<4i", data)
    if kind == "compression":
        return data[0]
    return data


def _channels(data: bytes) -> list[tuple[str, np.dtype]]:
    """Lists names and sample types, in the order of the samples in a line."""
    found, at = [], 0
    while data[at]:
        name, at = _text(data, at)
        kind, _, across, down = struct.unpack_from("<iIii", data, at)
        if kind not in SAMPLE_TYPES or across != 1 or down != 1:
            raise Odd(f"its channel {name} is of a kind that merlin does not write")
        found.append((name, SAMPLE_TYPES[kind]))
        at += 16
    return found


def _unzip(packed: bytes, size: int) -> np.ndarray:
    """Undoes the format's ZIP: differences of bytes, the even ones before the odd ones."""
    if len(packed) == size:
        return np.frombuffer(packed, np.uint8)
    changes = np.frombuffer(zlib.decompressobj().decompress(packed, size + 1), np.uint8).copy()
    if len(changes) != size:
        raise Odd("a part of it has the wrong length")
    changes[1:] -= 128
    halves = np.add.accumulate(changes, dtype=np.uint8)
    whole = np.empty(size, np.uint8)
    middle = (size + 1) // 2
    whole[0::2], whole[1::2] = halves[:middle], halves[middle:]
    return whole


class Exr:
    """An open file: its attributes, the size of its picture, and its channels when they are asked for."""

    def __init__(self, path: str) -> None:
        self.path = path
        try:
            with open(path, "rb") as file:
                self._data = file.read()
            self._read_head()
        except OSError as error:
            raise Unreadable(f"{path}: {error.strerror}") from error
        except DAMAGE as error:
            why = error if isinstance(error, Odd) else "it is cut short, or none at all"
            raise Unreadable(f"{path} cannot be read as one of merlin's EXR files: {why}") from error

    def _read_head(self) -> None:
        magic, version = struct.unpack_from("<iI", self._data)
        if magic != MAGIC or version & (TILED | DEEP | SEVERAL_PARTS):
            raise Odd("it is no EXR file of scan lines and one part")
        self.attributes: dict[str, Any] = {}
        at = 8
        while self._data[at]:
            name, at = _text(self._data, at)
            kind, at = _text(self._data, at)
            (size,) = struct.unpack_from("<I", self._data, at)
            self.attributes[name] = _value(kind, self._data[at + 4 : at + 4 + size])
            at += 4 + size
        self._table = at + 1
        left, top, right, bottom = self.attributes["dataWindow"]
        self._top = top
        self.width, self.height = right - left + 1, bottom - top + 1
        if self.attributes["dataWindow"] != self.attributes["displayWindow"]:
            raise Odd("another program has cut it to a part of the picture")
        if self.width < 1 or self.height < 1 or self.width * self.height > MOST_PIXELS:
            raise Odd("its size is out of range")
        if self.attributes["compression"] not in LINES_PER_CHUNK:
            raise Odd("another program has saved it with a compression that merlin does not write")
        self.channels = _channels(self.attributes["channels"])

    def read(self, names: list[str]) -> dict[str, np.ndarray]:
        """Reads these channels, height x width each, of the type that they have in the file."""
        kinds = dict(self.channels)
        missing = [name for name in names if name not in kinds]
        if missing:
            raise Unreadable(f"{self.path} has no channel {missing[0]}")
        planes = {name: np.empty((self.height, self.width), kinds[name]) for name in names}
        try:
            self._read_chunks(planes)
        except DAMAGE as error:
            why = f": {error}" if isinstance(error, Odd) else ""
            raise Unreadable(f"{self.path} is damaged or cut short{why}") from error
        return planes

    def _read_chunks(self, planes: dict[str, np.ndarray]) -> None:
        lines = LINES_PER_CHUNK[self.attributes["compression"]]
        count = -(-self.height // lines)
        line_bytes = self.width * sum(kind.itemsize for _, kind in self.channels)
        for offset in struct.unpack_from(f"<{count}Q", self._data, self._table):
            if offset > len(self._data):
                raise Odd("it ends before a part of it begins")
            row, size = struct.unpack_from("<ii", self._data, offset)
            row -= self._top
            if not 0 <= row < self.height:
                raise Odd("a part of it lies outside the picture")
            here = min(lines, self.height - row)
            chunk = _unzip(self._data[offset + 8 : offset + 8 + size], here * line_bytes).reshape(here, line_bytes)
            at = 0
            for name, kind in self.channels:
                end = at + self.width * kind.itemsize
                if name in planes:
                    planes[name][row : row + here] = np.ascontiguousarray(chunk[:, at:end]).view(kind)
                at = end
