# SPDX-License-Identifier: MIT
"""Maps: what an object is made of, pixel by pixel."""
from __future__ import annotations

import ctypes
import json
import os
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _headers as h
from . import capture, exporting, mesh
from ._call import Owner, ProgressCallback, StopCallback, Watch, call, check, optional_path, path_bytes
from ._call import taken_text, vector3, view, whole
from ._library import shipped_weights
from .capture import Surface
from .errors import WrongUseError
from .mesh import Mesh
from .pictures import PathLike
from .results import Crop, FoundLight, Notice, found_light, notices, warn

if TYPE_CHECKING:
    from .model import Model
    from .lights import Environment, Lamp
    from .relighting import Relighter


class Mended(NamedTuple):
    """Shares of the object, in [0, 1], whose values were corrected when maps were read."""

    normal: float
    albedo: float
    roughness: float
    depth: float


def _map(name: str, words: str) -> Any:
    def get(self: "Maps") -> Any:
        return self._views.get(name)

    def put(self: "Maps", value: Any) -> None:
        if name not in self._views:
            raise WrongUseError(f"these maps have no {name}")
        try:
            self._views[name][...] = value
        except (TypeError, ValueError) as error:
            raise WrongUseError(f"these maps' {name} takes no such values: {error}") from None

    return property(get, put, doc=words)


class Maps:
    """The maps of a photograph: arrays of float32, of the photograph's height and width, zero where the mask is.

    They show the library's memory: nothing is copied, an array keeps its maps alive, and what is written into one
    (`maps.albedo *= 0.5`) is what `relight` and `view` see. Space: the camera is at the origin and looks along -z, x
    right, y up; the object stands near (0, 0, -1)."""

    albedo: np.ndarray = _map("albedo", "H x W x 3, linear sRGB, in [0, 1]: the diffuse colour.")
    normal: np.ndarray = _map("normal", "H x W x 3, unit vectors, z > 0 toward the camera.")
    roughness: np.ndarray = _map("roughness", "H x W, in [0.03, 1].")
    depth: np.ndarray = _map("depth", "H x W, distance along -z in scene units (the object is about 1 away).")
    mask: np.ndarray = _map("mask", "H x W, coverage in [0, 1].")
    photo: np.ndarray = _map("photo", "H x W x 3, linear: the photograph times the mask.")
    reconstruction: Optional[np.ndarray] = _map("reconstruction", """H x W x 3, linear: the maps under the photograph's
        own light, exposed as by relight. None in maps of several photographs, and in those that were loaded.""")
    spread: Optional[np.ndarray] = _map("spread", """H x W, degrees, in [0, 90]: by how much the normals differ with other
        photographs, near 0 where they are sure. None for maps of one photograph.""")

    def __init__(self, owner: Owner, model: "Optional[Model]") -> None:
        self._owner, self._model = owner, model
        self._views: Dict[str, Any] = {name: view(owner, getattr(owner.struct, name)) for name in h.MAP_NAMES
                       if getattr(owner.struct, name).data}

    @property
    def _struct(self) -> Any:
        return self._owner.struct

    @property
    def height(self) -> int:
        """Rows of the photograph."""
        return self._struct.albedo.height

    @property
    def width(self) -> int:
        """Columns of the photograph."""
        return self._struct.albedo.width

    @property
    def crop(self) -> Crop:
        """The square around the object, in pixels of the photograph."""
        return Crop(self._struct.crop.x, self._struct.crop.y, self._struct.crop.side)

    @property
    def size(self) -> int:
        """What the square was resized to for the network, at most 256: for all but fine normals."""
        return self._struct.size

    @property
    def fov(self) -> Optional[float]:
        """How wide the crop is, degrees; None: the lens is not known, and the maps take it for 60."""
        return self._struct.fov or None

    @property
    def slant(self) -> Tuple[float, float]:
        """Where the crop's middle is as seen from the lens: sines to the right and upwards."""
        return self._struct.slant[0], self._struct.slant[1]

    @property
    def gain(self) -> float:
        """The photograph times this is radiance under a flash of power 5.95."""
        return self._struct.gain

    @property
    def burnt_out(self) -> float:
        """Share of the object's values at the photograph's white, in [0, 1]; from 0.1 on the maps are poor."""
        return self._struct.burnt_out

    @property
    def mask_source(self) -> str:
        """"given" or "found"."""
        return "given" if self._struct.mask_source == h.MASK_GIVEN else "found"

    @property
    def mask_confidence(self) -> float:
        """1 for a given mask; how likely a found one is right, in [0, 1] (below 0.5: check it)."""
        return self._struct.mask_confidence

    @property
    def light(self) -> Optional[FoundLight]:
        """The photograph's light, as models of any light see it; None: this model knows one light alone."""
        return found_light(self._struct.light)

    @property
    def light_elsewhere(self) -> float:
        """How likely the photograph was lit from elsewhere than the lens, in [0, 1]."""
        return self._struct.light_elsewhere

    @property
    def environment(self) -> Optional[np.ndarray]:
        """9 x 3, spherical harmonics of the surroundings' radiance, of models that know a flash in a room; or None."""
        return np.array(self._struct.environment, dtype=np.float32) if self._struct.has_environment else None

    @property
    def model_name(self) -> str:
        """Of the weights the maps are by."""
        return self._struct.model.decode("utf-8", "replace")

    @property
    def photographs(self) -> int:
        """So many were seen together (Capture.maps); 0 or 1 for most."""
        return self._struct.photographs

    @property
    def refined(self) -> bool:
        """Whether the normals are photometric stereo's from several photographs."""
        return bool(self._struct.refined)

    @property
    def further_light(self) -> Optional[Tuple[float, float, float]]:
        """Of several photographs: toward the lamp under which a further one would tell most; else None."""
        x, y, z = self._struct.further_light
        return (x, y, z) if x or y or z else None

    @property
    def reduced(self) -> int:
        """So many of the file's pixels a side became one: 0 or 1 for most."""
        return self._struct.reduced

    @property
    def frames(self) -> int:
        """Of an animation, whose first picture alone was read: 0 or 1 for most."""
        return self._struct.frames

    @property
    def timing(self) -> Dict[str, float]:
        """Seconds of each stage."""
        return {name: getattr(self._struct.timing, name) for name, _type in h.Timing._fields_}

    @property
    def mended(self) -> Mended:
        """What was corrected of maps that were loaded; zeros of others."""
        return Mended(*(getattr(self._struct.mended, name) for name in Mended._fields))

    @property
    def doubts(self) -> Tuple[Notice, ...]:
        """Why the maps may be wrong, the gravest first."""
        found = h.Warnings()
        call("maps_warnings", self._owner.at, ctypes.byref(found))
        return notices(found)

    @property
    def light_words(self) -> str:
        """The photograph's light for a person, "a lamp from the upper left, 40 degrees aside"; "": not known."""
        text = ctypes.create_string_buffer(h.LIGHT_WORDS)
        call("light_words", ctypes.byref(self._struct.light), text, h.LIGHT_WORDS)
        return text.value.decode("utf-8", "replace")

    def report(self) -> Dict[str, Any]:
        """What report.json has (docs/json.md): what was done, the doubts, the maps' statistics."""
        text = ctypes.c_void_p()
        check("maps_report", self._sound(), ctypes.byref(text))
        return json.loads(taken_text(text))

    def __repr__(self) -> str:
        return f"<merlin.Maps {self.height} x {self.width} by {self.model_name}>"

    # ---- light ----

    def _sound(self) -> Any:
        """The structure's address, for a call that takes maps which may have been changed."""
        for name in ("albedo", "normal", "roughness", "depth", "mask"):
            if not np.isfinite(self._views[name]).all():
                raise WrongUseError(f"these maps' {name} has values that are not finite")
        return self._owner.at

    def _lighting_model(self, model: "Optional[Model]") -> "Model":
        from .model import Model
        if model is not None:
            return model
        if self._model is None:
            own = not self._struct.captured and shipped_weights(self.model_name) is not None
            self._model = Model(self.model_name if own else None)
        return self._model

    def relight(self, light: Any = None, *, environment: "Union[Environment, PathLike, None]" = None,
                turn: float = 0.0, exposure: float = 0.0, by: str = "brdf",
                model: "Optional[Model]" = None) -> np.ndarray:
        """The object under other light: H x W x 3 float32, linear, in [0, 1], of the photograph's exposure.

        light: a lamp's place (x, y, z) in scene units, of the flash's power, (0, 0, 0) being the lens; a Lamp; several
        of either together; "found": the light that was found in the photograph; or None. environment: surroundings, an Environment or a
        latitude-longitude picture's path, with the lamp or alone. turn: degrees by which the found light or the
        picture is turned about the vertical, at 90 what was ahead of the camera is to its right. exposure: EV, of a
        picture's path. by: "brdf" (with cast shadows and the network's global illumination), "direct" (without the
        latter), "unshadowed" (as in the paper) or "network" (the decoder of models that have one). model: another than
        the maps', which are relit by the weights of their name, or, if these are not known or the maps are of a
        captured surface, by the default ones."""
        from .relighting import relight
        return relight(self._lighting_model(model), self, light, environment, turn, exposure, by)

    def relighter(self, side: int = 0, *, by: str = "brdf", model: "Optional[Model]" = None) -> "Relighter":
        """The maps made ready for many lights, of which each takes a fraction of the time then. side: pixels a side of
        the pictures, which show the square `crop`; 0: as many as it has; at most 8000."""
        from .relighting import Relighter
        return Relighter(self, side, by=by, model=model)

    def stereo(self, method: str = "auto", *, keep_edges: bool = False, model: "Optional[Model]" = None,
               progress: Optional[ProgressCallback] = None, stop: Optional[StopCallback] = None) -> Surface:
        """The surface by photometric stereo of the photograph, relit under 50 lamps: the square around the object, of at
        most 512 pixels a side. method: "auto", "near" or "uncalibrated". keep_edges, progress, stop: as of
        Capture.stereo."""
        return capture.of_maps(self._lighting_model(model), self, method, keep_edges, progress, stop)

    def found_lights(self, turn: float = 0.0) -> "Tuple[List[Lamp], Optional[Environment]]":
        """The light that was found in the photograph, turned about the vertical by so many degrees: its lamps and, unless
        that is dark, what is around. BadInputError where nothing is known."""
        from .lights import found_lights
        return found_lights(self, turn)

    @property
    def field_of_view(self) -> float:
        """How wide the whole photograph is, in degrees: by its lens, else as if the square `crop` were 60 degrees wide."""
        return call("maps_field_of_view", self._owner.at)

    def lens_place(self, place: Any) -> np.ndarray:
        """Takes a place (x, y, z) from the maps' space to that of the lens, whose axis is the middle of the photograph:
        as positions of near lights are for `stereo`."""
        out = h.floats3()
        call("maps_lens_place", self._owner.at, vector3(place, "a place"), out)
        return np.array(out, dtype=np.float32)

    def mesh(self, side: int = 0, texture_side: int = 0) -> Mesh:
        """The object's front as triangles, about (0, 0, -1). side: of the square around the object, in vertices; 0:
        512. texture_side: of the textures, in pixels; 0: 2048. Neither is larger than the square in the photograph."""
        return mesh.of_maps(self, side, texture_side)

    # ---- files ----

    def save(self, folder: PathLike, *, model: "Optional[Model]" = None, last: bool = False,
             progress: Optional[ProgressCallback] = None, stop: Optional[StopCallback] = None) -> None:
        """Writes maps.exr, the PNGs, overview.png and report.json into a folder, which is made if need be: all of them
        or, after a failure, none. Loaded maps get a reconstruction, too; a captured surface's are refused, whose
        Surface.save writes them. BadInputError for values that load would refuse. last, progress and stop: as of
        Model.estimate."""
        params = h.WriteParams(last=int(last))
        watch = Watch(progress, stop)
        watch.put(params)
        watch.check("maps_write", self._lighting_model(model)._handle.struct, self._sound(), ctypes.byref(params),
                    path_bytes(folder))

    def export(self, folder: PathLike, maps: Optional[Iterable[str]] = None, *, normal_y: str = "up",
               side: int = 0, progress: Optional[ProgressCallback] = None,
               stop: Optional[StopCallback] = None) -> exporting.Exported:
        """Writes the square around the object as other programs read it, and export.json, into a folder.

        maps: any of "albedo", "normal", "roughness", "smoothness", "ao", "orm", "height", "height32", "alpha",
        "materialx" and "all" (with "down" all but materialx); None: albedo, normal, roughness, ao, height and alpha. normal_y: "up"
        (OpenGL, Unity, Blender) or "down" (DirectX, Unreal). side: pixels a side, 64 to 8192; 0: the square's in the
        photograph, at most 2048. progress, stop: as of Model.estimate."""
        return exporting.export(self, folder, maps, normal_y, side, Watch(progress, stop))

    def occlusion(self, side: int) -> np.ndarray:
        """Ambient occlusion of the square around the object: side x side in [0, 1], 1 beside the object; the share,
        weighted by the cosine, of the directions about a point's normal that the object leaves open."""
        return exporting.occlusion(self, side)

    @classmethod
    def load(cls, folder: PathLike, *, model: "Optional[Model]" = None) -> "Maps":
        """Reads maps.exr of a folder of maps, edited or not. model: to relight them by; None: the weights of the name
        they tell, or the default ones (as of relight), opened when they are first needed. Warns of what had to be corrected."""
        name = path_bytes(folder)
        owner = Owner(h.Maps(), "maps_free")
        check("maps_read", name, owner.at, path=os.fsdecode(name))
        made = cls(owner, model)
        warn(made.doubts)
        return made

    def view(self, path: PathLike, *, name: Optional[str] = None, folder: Optional[PathLike] = None, side: int = 0) -> None:
        """Writes one HTML page that any browser opens, offline, and in which the maps are lit.

        name: what the page is called. folder: of the maps, for the commands that the page tells. side: pixels a side,
        64 to 4096 (0: at most 2048)."""
        params = h.ViewParams(None if name is None else name.encode(), optional_path(folder), whole(side, "side"))
        check("view_write", self._sound(), ctypes.byref(params), path_bytes(path))
