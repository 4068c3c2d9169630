# SPDX-License-Identifier: MIT
"""Finds libmerlin.so and the weights, and loads the library.

In a wheel both are in the package. In a checkout the library of the build tree is taken, or the file that the
environment variable MERLIN_LIBRARY names, which goes before all others.
"""
from __future__ import annotations

import ctypes
import os
import re
from typing import Any, Dict, List, Optional, Tuple

from . import _headers
from .errors import MissingFileError, WrongTypeError

HERE = os.path.dirname(os.path.abspath(__file__))
CHECKOUT = os.path.dirname(os.path.dirname(HERE))
_SONAME = "libmerlin.so.0.1"
# The best level of x86-64 first, and what it wants of the processor (System V ABI), as /proc/cpuinfo calls it.
_LEVEL_3 = {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe", "xsave"}
_LEVELS = {"x86-64-v4": _LEVEL_3 | {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}, "x86-64-v3": _LEVEL_3}


def _processor_flags() -> set:
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            for line in file:
                if line.startswith("flags"):
                    return set(line.split(":", 1)[1].split())
    except OSError:
        pass
    return set()


def _candidates() -> List[str]:
    """The paths of libraries, the best first; a bare name is for the system's loader."""
    named = os.environ.get("MERLIN_LIBRARY")
    if named:
        return [named]
    flags = _processor_flags()
    found = [os.path.join(HERE, "lib", level, "libmerlin.so") for level, wanted in _LEVELS.items() if wanted <= flags]
    found.append(os.path.join(HERE, "lib", "libmerlin.so"))
    if os.path.exists(os.path.join(CHECKOUT, "CMakePresets.json")):
        found += [os.path.join(CHECKOUT, "build", name, "libmerlin.so") for name in ("release", "product")]
    return [path for path in found if os.path.exists(path)] + [_SONAME]


def _loads(name: str) -> bool:
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


def _missing_packages() -> List[str]:
    """The packages of libraries that the wheel's library needs and that are not there, by the list made with it."""
    needs: Dict[str, str] = {}
    try:
        with open(os.path.join(HERE, "lib", "needs.txt"), encoding="utf-8") as file:
            needs = dict(line.split() for line in file if len(line.split()) == 2)
    except OSError:
        pass
    return sorted({package for soname, package in needs.items() if not _loads(soname)})


def _explain(path: str, error: OSError) -> ImportError:
    missing = re.match(r"(lib[^:/ ]+\.so[^: ]*): cannot open shared object file", str(error))
    packages = _missing_packages()
    if packages:
        return ImportError(f"merlin needs libraries that are not there: sudo apt-get install {' '.join(packages)}")
    if path == _SONAME:
        return ImportError("there is no libmerlin.so: install the wheel (pip install ./python), build the library "
                           "(make build and cmake --build --preset release --target libmerlin), or name one by "
                           "MERLIN_LIBRARY")
    if missing and missing.group(1) != os.path.basename(path):
        return ImportError(f"{path} needs {missing.group(1)}, which is not there: install the packages of "
                           "packages.txt (sudo apt-get install ...)")
    return ImportError(f"{path} cannot be loaded: {error}")


def _declare(library: ctypes.CDLL, path: str) -> None:
    for name, (returned, taken) in _headers.FUNCTIONS.items():
        try:
            function = getattr(library, "merlin_" + name)
        except AttributeError:
            raise ImportError(f"{path} is another version of the library: it has no merlin_{name}") from None
        function.restype, function.argtypes = returned, taken


def load() -> Tuple[ctypes.CDLL, str]:
    """Loads the library and declares its functions; returns its path, too. ImportError, one line, says what is missing."""
    path = _candidates()[0]
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise _explain(path, error) from None
    _declare(library, path)
    return library, path


def shipped_weights(name: str) -> Optional[str]:
    """The file of weights that come with merlin, "merlin-any" or another; None: there are none of that name."""
    library = os.environ.get("MERLIN_LIBRARY")
    folders = [os.path.join(HERE, "models"), os.path.join(CHECKOUT, "models")]
    if library:
        folders.append(os.path.join(os.path.dirname(library), "..", "share", "merlin", "models"))
    folders += ["/usr/local/share/merlin/models", "/usr/share/merlin/models"]
    for folder in folders:
        path = os.path.join(folder, name + ".safetensors")
        if os.path.exists(path):
            return path
    return None


def weights_path(name: Any, why: str = "") -> bytes:
    """The path of weights, by a shipped name or a path, as the command takes --model; why: what the error begins with."""
    if not isinstance(name, (str, bytes, os.PathLike)):
        raise WrongTypeError(f"weights are a name or a path, not a {type(name).__name__}")
    asked = os.fsdecode(name)
    if "/" in asked or "." in asked or (os.path.exists(asked) and not os.path.isdir(asked)):
        return os.fsencode(asked)
    found = shipped_weights(asked)
    if found is None:
        raise MissingFileError(f"{why}there is no weights file {asked}, nor are weights of that name with merlin")
    return os.fsencode(found)
