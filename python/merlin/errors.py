# SPDX-License-Identifier: MIT
"""What goes wrong, in the library's own words: one class for each of its statuses."""
from __future__ import annotations


class MerlinError(Exception):
    """What the library refused or could not do; str() of it is the library's sentence."""


class WrongUseError(MerlinError, ValueError):
    """The call makes no sense: shapes that do not fit, values out of range."""


class WrongTypeError(WrongUseError, TypeError):
    """An argument is of another kind: a word in the place of a number, bytes in that of floats."""


class ForkedError(MerlinError, RuntimeError):
    """The process was forked after the library's first call, whose threads it lacks."""


class BadInputError(MerlinError, ValueError):
    """A file or its content is missing, damaged or of another kind."""


class MissingFileError(BadInputError, FileNotFoundError):
    """There is no file or folder of this name."""


class CannotWriteError(MerlinError, OSError):
    """A file could not be written; nothing half-written is left."""


class NoMemoryError(MerlinError, MemoryError):
    """There was not enough memory; what was begun was freed."""


class DeviceError(MerlinError, RuntimeError):
    """The processor's neural-network library failed."""


class StoppedError(MerlinError):
    """`stop` said so."""


class MerlinWarning(UserWarning):
    """Something that should be known of a result before it is trusted; the results list them, too."""


# By merlin_status, from 1.
BY_STATUS = (WrongUseError, BadInputError, CannotWriteError, NoMemoryError, DeviceError, StoppedError)
