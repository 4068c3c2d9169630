# SPDX-License-Identifier: MIT
"""merlin: one photograph of an object, taken apart into its material and lit again from elsewhere.

    import merlin

    maps = merlin.Model().estimate("cup.jpg")
    maps.albedo, maps.normal, maps.roughness, maps.depth     # numpy, float32, of the photograph's size
    relit = maps.relight((0.7, 0.3, -0.4))                    # a lamp to the right: H x W x 3, linear
    merlin.write_image("relit.png", relit)

    surface = merlin.stereo(["a.png", "b.png", "c.png", ...], directions)
    surface.mesh().save("surface.glb")

Images are linear sRGB float32, rows from the top. Space: the camera is at the origin and looks along -z, x right, y up;
the object stands near (0, 0, -1). What goes wrong is a MerlinError with the library's sentence. Several threads may
call; a process that is forked after the first call may not.
"""
from . import _call
from .calibration import Calibration, calibrate
from .capture import Capture, Light, RelitPhoto, Statistics, Surface, stereo
from .errors import (BadInputError, CannotWriteError, DeviceError, ForkedError, MerlinError, MerlinWarning,
                     MissingFileError, NoMemoryError, StoppedError, WrongTypeError, WrongUseError)
from .exporting import Exported
from .lights import Environment, Lamp, dome, dome_directions, orbit, read_lamps, temperature_color
from .maps import Maps, Mended
from .mesh import Mesh
from .model import FoundObject, Model, estimate, find_object, read_shot
from .photos import PhotoFile, Photos, find_mask, find_masks, is_mask_name, list_photos
from .pictures import encode_image, read_image, read_mask, resize_image, to_pixels, write_animation, write_image
from .pictures import write_mask, write_sheet
from .relighting import Relighter
from .results import Camera, Circle, Crop, FoundLight, Notice, Shot, SkippedFile
from .rti import write_rti
from .weights import Tensor, Weights

__version__: str = _call.library.merlin_version().decode()


def set_threads(count: int) -> None:
    """How many threads work for each that calls the library, from its next call on: 1 to 1024, or as many of them as
    can be had. Without it OMP_NUM_THREADS, else one a processor."""
    _call.check("set_threads", _call.whole(count, "the number of threads"))


def version() -> str:
    """Of the library that runs, "0.1.0"."""
    return _call.call("version").decode()


__all__ = [
    "BadInputError", "Calibration", "Camera", "CannotWriteError", "Capture", "Circle", "Crop", "DeviceError",
    "Environment", "Exported", "ForkedError", "FoundLight", "FoundObject", "Lamp", "Light", "Maps", "Mended", "MerlinError",
    "MerlinWarning", "Mesh", "MissingFileError", "Model", "NoMemoryError", "Notice", "PhotoFile", "Photos",
    "Relighter", "RelitPhoto", "Shot", "SkippedFile", "Statistics", "StoppedError", "Surface", "Tensor", "Weights",
    "WrongTypeError", "WrongUseError", "calibrate", "dome", "dome_directions", "encode_image", "estimate", "find_mask", "find_masks",
    "find_object", "is_mask_name", "list_photos", "orbit", "read_image", "read_lamps", "read_mask", "read_shot",
    "resize_image", "set_threads", "stereo", "temperature_color", "to_pixels", "version", "write_animation",
    "write_image", "write_mask", "write_rti", "write_sheet",
]
