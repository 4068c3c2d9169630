# SPDX-License-Identifier: MIT
"""Photometric stereo: the surface of an object from pictures of it under many lights."""
from __future__ import annotations

import ctypes
import json
import os
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _headers as h
from . import mesh, pictures
from ._call import Owner, ProgressCallback, StopCallback, Watch, by_channel, call, check, choice, floats, is_path
from ._call import optional_path, path_bytes, real, taken_text, vector3, view, whole
from ._library import shipped_weights, weights_path
from .errors import WrongUseError
from .mesh import Mesh
from .pictures import PathLike, Picture
from .results import Camera, Notice, SkippedFile, notices, skipped, warn

if TYPE_CHECKING:
    from .maps import Maps
    from .model import Model

METHODS = {"auto": h.STEREO_AUTO, "ls": h.STEREO_LS, "robust": h.STEREO_ROBUST, "near": h.STEREO_NEAR,
           "semi": h.STEREO_SEMI, "uncalibrated": h.STEREO_UNCALIBRATED, "nfps": h.STEREO_NFPS}
LIGHTING = {"distant": h.DISTANT_LIGHTS, "near": h.NEAR_LIGHTS, "unknown": h.UNKNOWN_LIGHTS}
NOWHERE = (0.0, 0.0, 0.0)


def _near_network(method: str, weights: Optional[PathLike]) -> Optional[Owner]:
    """As the command has it: with what ships, where it is there, unless the method has no use for it."""
    if method not in ("auto", "near", "nfps"):
        if weights is not None:
            raise WrongUseError(f"the method {method} takes no weights")
        return None
    if weights is None and method != "nfps" and shipped_weights("merlin-nfps") is None:
        return None
    network = Owner(ctypes.c_void_p(), "near_network_close")
    path = weights_path("merlin-nfps" if weights is None else weights)
    check("near_network_open", path, network.at, path=os.fsdecode(path))
    return network


class Light(NamedTuple):
    """A light of a capture. A diffuse white surface appears with intensity * cos, or near ones' intensity * cos /
    distance^2."""

    direction: Any = NOWHERE  #: distant: from the object to the light; near: where an LED points (zeros: nowhere)
    position: Any = NOWHERE  #: near: in the camera's space, any unit
    intensity: Any = NOWHERE  #: by channel, the first alone for grey pictures; zeros: 1
    lobe: float = 0.0  #: near: exponent of an LED's fall-off with the cosine of the angle to its direction

    def _struct(self) -> Any:
        return h.Light(vector3(self.direction, "a light's direction"), vector3(self.position, "a light's position"),
                       by_channel(self.intensity, "a light's intensity"), real(self.lobe, "a light's lobe"))


def light_of(struct: Any) -> Light:
    """The structure as a tuple of arrays."""
    direction, position, intensity = (
        np.array(one, dtype=np.float32) for one in (struct.direction, struct.position, struct.intensity))
    return Light(direction, position, intensity, struct.lobe)


class Capture:
    """Pictures of one still object by one camera, one light at a time.

    lighting: "distant" (directions are known), "near" (positions are) or "unknown". unknown_intensities: how strong the
    lights are is not known. mask: the object, as of Model.estimate; None: what is brighter than black and than a dark
    edge of the pictures. field_of_view: horizontal, degrees; 0: the camera is far away (60 with near lights). distance:
    of the object from the camera, in the unit of the positions; 0: not known."""

    def __init__(self, lighting: str = "distant", *, mask: Optional[Picture] = None, unknown_intensities: bool = False,
                 field_of_view: float = 0.0, distance: float = 0.0) -> None:
        params = h.CaptureParams(choice(lighting, LIGHTING, "lighting"), int(unknown_intensities),
                                 real(field_of_view, "field_of_view"), real(distance, "distance"))
        cover = None if mask is None else pictures.mask(mask)
        self._owner = Owner(ctypes.c_void_p(), "capture_free")
        check("capture_new", ctypes.byref(params), None if cover is None else cover.at, self._owner.at)

    @classmethod
    def read(cls, source: Union[PathLike, Sequence[PathLike]], *, lights: Optional[PathLike] = None,
             mask: Optional[PathLike] = None, ambient: Optional[PathLike] = None, near: bool = False,
             unknown: bool = False, linear: bool = False, frames: int = 0, field_of_view: float = 0.0,
             distance: float = 0.0, progress: Optional[ProgressCallback] = None,
             stop: Optional[StopCallback] = None) -> "Capture":
        """Reads a folder of pictures and the lights they were taken under (docs/captures.md), or a list of pictures or a
        video under lights that are not known (a video wants unknown=True).

        lights: lights.txt or an .lp file; None: the folder's. mask, ambient: pictures; None: the folder's, if any.
        near: the list holds positions. unknown: wherever lights are said to be, they are not known. linear: 8-bit
        pictures are linear. frames: of a video so many are taken at most, those whose light differs most; 0: 16.
        field_of_view: horizontal, degrees; 0: by EXIF where lights are near (60 if it says nothing), and for maps, else
        far away. Progress and stop: as of Model.estimate."""
        files = h.CaptureFiles(optional_path(lights), optional_path(mask), optional_path(ambient), int(near),
                               int(unknown), 0, whole(frames, "frames"), int(linear),
                               real(field_of_view, "field_of_view"), real(distance, "distance"))
        watch = Watch(progress, stop)
        watch.put(files)
        made = cls.__new__(cls)
        made._owner = Owner(ctypes.c_void_p(), "capture_free")
        if isinstance(source, (str, bytes, os.PathLike)):
            name = path_bytes(source)
            watch.check("capture_read", name, ctypes.byref(files), made._owner.at, path=os.fsdecode(name))
        else:
            names = [path_bytes(one) for one in source]
            listed = (ctypes.c_char_p * len(names))(*names)
            watch.check("capture_read_pictures", listed, len(names), ctypes.byref(files), made._owner.at)
        return made

    def add(self, picture: Any, light: Optional[Light] = None, *, linear: Optional[bool] = None) -> None:
        """Adds a picture, a file or an array of H x W or H x W x 3, all alike and of the mask's size; linear values in
        [0, 1], from 0.98 on they count as saturated. light: None: nothing is known of it. linear: of an array as of
        Model.estimate; True: 8-bit values of a file are linear, which otherwise is read as those of a folder are."""
        known = None if light is None else ctypes.byref(light._struct())
        if is_path(picture):
            name = path_bytes(picture)
            check("capture_add_file", self._owner.struct, name, int(bool(linear)), known, path=os.fsdecode(name))
            return
        color, _alpha = pictures.from_array(picture, linear, "a picture of a capture")
        image, kept = color.struct, None
        if np.ndim(picture) == 2 or np.shape(picture)[2] == 1:
            image, kept = pictures.image_for(view(color, color.struct)[:, :, 0])
        check("capture_add", self._owner.struct, ctypes.byref(image), known)
        del kept

    def stereo(self, method: str = "auto", *, keep_edges: bool = False, integrate: bool = False, iterations: int = 0,
               check_result: bool = True, weights: Optional[PathLike] = None,
               progress: Optional[ProgressCallback] = None, stop: Optional[StopCallback] = None) -> "Surface":
        """Solves for the surface, from 3 pictures on (7 if the lights are unknown).

        method: "auto" (by what is known of the lights), "ls", "robust", "near", "nfps" (near lights by a network),
        "semi" or "uncalibrated". keep_edges: depth may jump where the normals say so. integrate: depth that is solved
        with the normals is integrated from them once more. iterations: at most, of "near" and "semi"; 0: the method's
        own. check_result: hold the result against other lights, lenses and tones, for warnings. weights: of the
        network of near lights, with which "nfps" solves and "near" begins; None: those that ship. Progress and stop:
        as of Model.estimate."""
        params = h.StereoParams(choice(method, METHODS, "method"), int(keep_edges), int(integrate),
                                whole(iterations, "iterations"), int(not check_result))
        watch = Watch(progress, stop)
        watch.put(params)
        owner = Owner(h.Surface(), "surface_free")
        network = _near_network(method, weights)
        watch.check("stereo_by_network", None if network is None else network.struct, self._owner.struct,
                    ctypes.byref(params), owner.at)
        surface = Surface(owner)
        warn(surface.warnings)
        return surface

    def maps(self, model: "Optional[Model]" = None, *, views: int = 4, fov: Optional[float] = None,
             points: Any = None, box: Any = None, progress: Optional[ProgressCallback] = None,
             stop: Optional[StopCallback] = None) -> "Maps":
        """The maps of the object in these pictures, of one or more, whatever their lights are, which are ignored: a
        network's and, from 7 pictures on, photometric stereo's where that finds the lights. model: one of any light;
        None: the one that ships. The capture's mask is the object; without one it is searched for. views, fov, points,
        box, progress and stop: as of Model.estimate."""
        from .maps import Maps
        from .model import Model, fov_of, hint_of
        model = Model() if model is None else model
        params = call("params_default")
        params.views, params.fov = whole(views, "views"), fov_of(fov)
        params.hint = hint_of(points, box)
        network = _near_network("auto", None)
        if network is not None:
            params.near_network = network.struct
        watch = Watch(progress, stop)
        watch.put(params)
        owner = Owner(h.Maps(), "maps_free")
        watch.check("maps_from_capture", model._handle.struct, self._owner.struct, ctypes.byref(params), owner.at)
        made = Maps(owner, model)
        warn(made.doubts)
        return made


class Statistics(NamedTuple):
    """Of the values of pixels."""

    mean: float
    median: float
    pixels: int


class RelitPhoto(NamedTuple):
    """How a surface was made of one photograph."""

    lights: int  #: relit pictures
    subsets: int  #: random ones of them, which were solved by themselves
    lights_a_subset: int
    model: str
    pixels: int  #: the object's
    pixels_left: int  #: those with the photograph's normals, as the subsets contradict each other
    spread: float  #: mean of the residual, degrees
    angle: float  #: mean angle between the solved normals and the photograph's, degrees


def _relit(struct: Any) -> Optional[RelitPhoto]:
    if not struct.lights:
        return None
    return RelitPhoto(struct.lights, struct.subsets, struct.lights_a_subset, struct.model.decode("utf-8", "replace"),
                      struct.pixels, struct.pixels_left, struct.spread, struct.angle)


def _text(words: Optional[str]) -> Optional[bytes]:
    return None if words is None else words.encode()


def of_maps(model: "Model", maps: "Maps", method: str, keep_edges: bool, progress: Optional[ProgressCallback],
            stop: Optional[StopCallback]) -> "Surface":
    """As Maps.stereo."""
    params = h.StereoParams(choice(method, METHODS, "method"), int(keep_edges))
    watch = Watch(progress, stop)
    watch.put(params)
    owner = Owner(h.Surface(), "surface_free")
    watch.check("stereo_from_maps", model._handle.struct, maps._sound(), ctypes.byref(params), owner.at)
    surface = Surface(owner)
    warn(surface.warnings)
    return surface


class Surface:
    """What photometric stereo found: arrays of float32 of the pictures' height and width, zero where the mask is. They
    show the library's memory: nothing is copied, and an array keeps its surface alive."""

    def __init__(self, owner: Owner) -> None:
        self._owner = owner
        struct = owner.struct
        self.normal: np.ndarray = view(owner, struct.normal)  #: H x W x 3, unit, z > 0 toward the camera
        self.albedo: np.ndarray = view(owner, struct.albedo)  #: H x W or x 3; relative unless intensities are known
        #: H x W, along -z: in the unit of the distance (1 if not known), in pixels for a camera far away
        self.depth: np.ndarray = view(owner, struct.depth)
        self.residual: np.ndarray = view(owner, struct.residual)  #: H x W, root mean square left by the fit, a share
        #: H x W, degrees: standard error of the normals, by leaving out single pictures; None with "ls"
        self.spread: Optional[np.ndarray] = view(owner, struct.spread)
        self.mask: np.ndarray = view(owner, struct.mask)  #: H x W, 0 or 1
        self.camera = Camera(struct.camera.focal, struct.camera.x, struct.camera.y, struct.camera.distance)
        self.method: str = next(name for name, number in METHODS.items() if number == struct.method)  #: the one used
        self.lights_near: bool = bool(struct.lights_near)  #: the found lights have positions, too
        self.strengths_unsure: bool = bool(struct.strengths_unsure)
        self.distance_unsure: bool = bool(struct.distance_unsure)
        #: whether "near" began with a network's surface, or "nfps" has it
        self.by_network: bool = bool(struct.by_network)
        self.lights_unsure: bool = bool(struct.lights_unsure)
        #: what speaks against the pictures, their lights and the result, the gravest first
        self.warnings: Tuple[Notice, ...] = notices(struct.warnings)
        #: one a picture, as "semi" and "uncalibrated" found them; else None
        self.lights: Optional[List[Light]] = (
            [light_of(struct.lights[i]) for i in range(struct.light_count)] if struct.lights else None)

        self.keep_edges: bool = bool(struct.keep_edges)
        self.picture_names: List[str] = [os.fsdecode(struct.picture_names[i]) for i in range(struct.picture_count)]
        self.lights_in_order: bool = bool(struct.lights_in_order)  #: the list of lights names no pictures
        self.skipped: List[SkippedFile] = skipped(struct.skipped)  #: files of the capture's folder that were left aside
        #: angles to the true normals, degrees, where these lie beside the pictures; else None
        self.normal_error: Optional[Statistics] = (
            Statistics(struct.normal_error.mean, struct.normal_error.median, struct.normal_error.count)
            if struct.normal_error.count else None)
        self.seconds: Dict[str, float] = {name: getattr(struct.seconds, name)
                                          for name in ("read", "solve", "integrate", "total")}
        #: of a surface from one photograph; else None
        self.relit: Optional[RelitPhoto] = _relit(struct.relit)

    def __repr__(self) -> str:
        return f"<merlin.Surface {self.mask.shape[0]} x {self.mask.shape[1]} by {self.method}>"

    def save(self, folder: PathLike, *, name: Optional[str] = None, progress: Optional[ProgressCallback] = None,
             stop: Optional[StopCallback] = None) -> None:
        """Writes maps.exr, the PNGs, overview.png and report.json into a folder, which is made if need be: all of them
        or, after a failure, none. name: of what it was made from, for the report. Maps.load reads it."""
        for which in ("normal", "albedo", "depth", "mask"):
            if not np.isfinite(getattr(self, which)).all():
                raise WrongUseError(f"this surface's {which} has values that are not finite")
        params, watch = h.WriteParams(), Watch(progress, stop)
        watch.put(params)
        watch.check("surface_write", self._owner.at, _text(name), ctypes.byref(params), path_bytes(folder))

    def report(self, name: Optional[str] = None) -> Dict[str, Any]:
        """What report.json has (docs/json.md)."""
        text = ctypes.c_void_p()
        check("surface_report", self._owner.at, _text(name), ctypes.byref(text))
        return json.loads(taken_text(text))

    def maps(self, model: "Optional[Model]" = None) -> "Maps":
        """Maps of the surface, to be relit and viewed: matte, moved in front of a photograph's camera. model: to relight
        them by; None: the default one, opened when it is first needed."""
        from .maps import Maps
        owner = Owner(h.Maps(), "maps_free")
        check("maps_from_surface", self._owner.at, owner.at)
        return Maps(owner, model)

    def mesh(self) -> Mesh:
        """The front as triangles, a vertex for each pixel of the mask; albedo is scaled so that its brightest are 0.9.
        `.save("surface.glb")` writes it."""
        return mesh.of_surface(self)


# ---- the short way ----


def _rows(values: Any, count: int, what: str) -> np.ndarray:
    array = floats(values, what)
    if array.shape != (count, 3):
        raise WrongUseError(f"{count} pictures want {what} of shape ({count}, 3), not {array.shape}")
    return array


def _strengths(intensities: Any, count: int) -> np.ndarray:
    if intensities is None or isinstance(intensities, str):
        return np.zeros((count, 3), np.float32)
    array = floats(intensities, "intensities")
    return _rows(array[:, None] * np.ones(3, np.float32) if array.shape == (count,) else array, count, "intensities")


def _lights(lights: Any, positions: Any, intensities: Any, count: int) -> Tuple[str, List[Optional[Light]]]:
    """What is known of the lights, and each."""
    if lights is not None and positions is not None:
        raise WrongUseError("lights are known by their directions (lights) or by their positions, not by both")
    if isinstance(intensities, str) and intensities != "unknown":
        raise WrongUseError(f'intensities are numbers or "unknown", not {intensities!r}')
    strength = _strengths(intensities, count)
    if positions is not None:
        return "near", [Light(position=p, intensity=s) for p, s in zip(_rows(positions, count, "positions"), strength)]
    if lights is None:
        known = strength.any()
        return "unknown", [Light(intensity=s) if known else None for s in strength]
    lights = list(lights)
    if lights and all(isinstance(light, Light) for light in lights):
        if len(lights) != count:
            raise WrongUseError(f"{count} pictures want as many lights, not {len(lights)}")
        return "near" if any(np.any(light.position) for light in lights) else "distant", lights
    return "distant", [Light(direction=d, intensity=s) for d, s in zip(_rows(lights, count, "lights"), strength)]


def stereo(images: Union[Capture, PathLike, Sequence[Picture], np.ndarray], lights: Any = None, *,
           positions: Any = None, intensities: Any = None, mask: Any = None, method: str = "auto",
           field_of_view: float = 0.0, distance: float = 0.0, linear: Optional[bool] = None, **options: Any) -> Surface:
    """The surface of an object from pictures of it under many lights.

    images: a Capture, a folder (lights: its list, or None: by the folder), or a sequence of files or arrays (H x W or
    H x W x 3, all alike). Of a sequence lights is N x 3, directions from the object to each light, or N Light, or None:
    unknown. positions: N x 3, instead, of near lights in the camera's space. intensities: N, N x 3, "unknown", or None:
    all 1. mask, field_of_view, distance: as of Capture; linear: as of Model.estimate; other options: of
    Capture.stereo."""
    if isinstance(images, Capture):
        return images.stereo(method, **options)
    many: Any = images
    if is_path(many):
        if positions is not None or intensities is not None:
            raise WrongUseError("positions and intensities of a folder are in its files; Capture.read has near=True")
        capture = Capture.read(many, lights=lights, mask=mask, linear=bool(linear), field_of_view=field_of_view,
                               distance=distance, progress=options.get("progress"), stop=options.get("stop"))
        return capture.stereo(method, **options)
    many = list(many)
    lighting, known = _lights(lights, positions, intensities, len(many))
    capture = Capture(lighting, mask=mask, unknown_intensities=isinstance(intensities, str),
                      field_of_view=field_of_view, distance=distance)
    for picture, light in zip(many, known):
        capture.add(picture, light, linear=linear)
    return capture.stereo(method, **options)
