# SPDX-License-Identifier: MIT
"""Meshes: the visible surface of an object as triangles."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, List, Optional

import numpy as np

from . import _headers as h
from ._call import Owner, check, path_bytes, view, view_of, whole, written_paths
from .errors import WrongUseError
from .pictures import PathLike

if TYPE_CHECKING:
    from .capture import Surface
    from .maps import Maps


class Mesh:
    """Triangles of the front that the camera saw; N vertices, M faces. The arrays show the library's memory: nothing is
    copied, an array keeps its mesh alive, and what is written into one is what `save` writes."""

    def __init__(self, owner: Owner) -> None:
        self._owner = owner
        m = owner.struct
        n = m.vertex_count
        #: N x 3, camera space: x right, y up, -z away from the camera; in depth's unit
        self.vertices: np.ndarray = view_of(owner, m.positions, (n, 3))
        #: M x 3 uint32, counter-clockwise as the camera sees it
        self.faces: np.ndarray = view_of(owner, m.triangles, (m.triangle_count, 3), "<u4")
        self.normals: np.ndarray = view_of(owner, m.normals, (n, 3))  #: N x 3, unit: the maps'
        #: N x 3, unit: the mean of the faces' around a vertex; None: as normals
        self.face_normals: Optional[np.ndarray] = view_of(owner, m.face_normals, (n, 3))
        self.colors: Optional[np.ndarray] = view_of(owner, m.colors, (n, 3))  #: N x 3, albedo, linear, in [0, 1]
        self.uvs: np.ndarray = view_of(owner, m.uvs, (n, 2))  #: N x 2, (0, 0) is a texture's upper left corner
        #: N uint32, row * width + column in the maps that `shape` is the height and width of
        self.pixels: Optional[np.ndarray] = view_of(owner, m.pixels, (n,), "<u4")
        self.shape = (m.height, m.width)
        self.albedo: Optional[np.ndarray] = view(owner, m.albedo)  #: H x W x 3, the texture, linear, in [0, 1]
        self.roughness: Optional[np.ndarray] = view(owner, m.roughness)  #: H x W, the texture; None: 1

    def __repr__(self) -> str:
        return f"<merlin.Mesh of {len(self.vertices)} vertices and {len(self.faces)} faces>"

    def _check(self) -> None:
        """That arrays, which may have been changed, are a mesh still."""
        if len(self.faces) and self.faces.max() >= len(self.vertices):
            raise WrongUseError(f"a face names vertex {self.faces.max()}, but there are {len(self.vertices)}")
        for name in ("vertices", "normals", "uvs", "colors", "face_normals", "albedo", "roughness"):
            array = getattr(self, name)
            if array is not None and not np.isfinite(array).all():
                raise WrongUseError(f"this mesh's {name} has values that are not finite")

    def save(self, path: PathLike) -> List[str]:
        """Writes the mesh by the path's ending: .ply with colours of vertices, .obj with .mtl and .png beside it, .glb
        with albedo, roughness and normals as textures, .usda with these beside it. Returns the paths of the files."""
        self._check()
        written = Owner(h.Files(), "files_free")
        check("mesh_write", self._owner.at, path_bytes(path), written.at)
        return written_paths(written)


def of_maps(maps: "Maps", side: int, texture_side: int) -> Mesh:
    """As Maps.mesh."""
    params = h.MeshParams(whole(side, "side"), whole(texture_side, "texture_side"))
    owner = Owner(h.Mesh(), "mesh_free")
    check("mesh_from_maps", maps._sound(), ctypes.byref(params), owner.at)
    return Mesh(owner)


def of_surface(surface: "Surface") -> Mesh:
    """As Surface.mesh."""
    owner = Owner(h.Mesh(), "mesh_free")
    check("mesh_from_surface", surface._owner.at, owner.at)
    return Mesh(owner)
