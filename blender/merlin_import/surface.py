# SPDX-License-Identifier: MIT
"""A depth map as a mesh: a vertex at every so many pixels of the object, squares between them.

    mesh = surface_of(result)
    mesh.points, mesh.pixels, mesh.faces
"""

from dataclasses import dataclass

import numpy as np

from .result import Camera, Result

MOST_SIDE = 512  # vertices along the object's longer side: the network's shape has no more detail
JUMP = 10  # neighbours whose depths differ by more than so many pixel sizes (a slope of 84 degrees) are not joined


@dataclass
class Surface:
    """Vertices in merlin's space and where the photograph shows them; faces turn counter-clockwise to the camera."""

    points: np.ndarray  # n x 3
    pixels: np.ndarray  # n x 2, from the upper left corner
    faces: list[list[int]]  # of four vertices, and of three along the outline


def _place(camera: Camera, pitch: float, x: np.ndarray, y: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Places what is seen at (x, y) at its depth, -z."""
    if camera.focal == 0:
        return np.stack([(x - camera.center[0]) * pitch, (camera.center[1] - y) * pitch, -depth], axis=1)
    u, v = (x - camera.center[0]) / camera.focal, (camera.center[1] - y) / camera.focal
    rays = np.stack([u, v, np.full_like(u, -1)], axis=1) @ camera.axes.T
    return rays * (depth / -rays[:, 2])[:, None]


def _erode(inside: np.ndarray, by: int) -> np.ndarray:
    """Leaves pixels whose neighbours as far as that are inside too, so that no face between them shows the outside."""
    out = inside
    for axis in (0, 1):
        around = np.pad(out, [(by, by) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
        length = out.shape[axis]
        out = np.logical_and.reduce([around.take(range(i, i + length), axis) for i in range(2 * by + 1)])
    return out


def _object_box(inside: np.ndarray) -> tuple[int, int, int, int]:
    rows, columns = np.flatnonzero(inside.any(1)), np.flatnonzero(inside.any(0))
    return rows[0], rows[-1] + 1, columns[0], columns[-1] + 1


def _joined(depth: np.ndarray, a: np.ndarray, b: np.ndarray, reach: np.ndarray) -> np.ndarray:
    return np.abs(depth[a] - depth[b]) <= np.minimum(reach[a], reach[b])


def _faces(number: np.ndarray, depth: np.ndarray, reach: np.ndarray) -> list[list[int]]:
    """Joins neighbours of a grid; number is each one's vertex, -1 outside, whose depth and reach of a jump are flat."""
    corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]  # counter-clockwise from the upper left
    corners = np.stack([c.ravel() for c in corners], axis=1)
    corners = corners[(corners >= 0).sum(1) >= 3]
    pairs = [(i, j) for i in range(4) for j in range(i)]
    join = {pair: (corners[:, pair] >= 0).all(1) & _joined(depth, *corners[:, pair].T, reach) for pair in pairs}
    sides = join[1, 0] & join[2, 1] & join[3, 2] & join[3, 0]
    whole = sides & (join[2, 0] | join[3, 1])
    faces = corners[whole].tolist()
    left = ~whole
    for out in range(4):
        kept = [k for k in range(4) if k != out]
        fits = left & join[kept[1], kept[0]] & join[kept[2], kept[1]] & join[kept[2], kept[0]]
        faces += corners[fits][:, kept].tolist()
        left &= ~fits
    return faces


def surface_of(found: Result) -> Surface:
    """Makes the mesh of a result's depths; without any face where its mask is too thin."""
    inside = (found.mask > 0.5) & np.isfinite(found.depth)
    nothing = Surface(np.zeros((0, 3)), np.zeros((0, 2)), [])
    if not inside.any():
        return nothing
    top, bottom, left, right = _object_box(inside)
    step = -(-max(bottom - top, right - left) // MOST_SIDE)
    grid = (slice(top + step // 2, bottom, step), slice(left + step // 2, right, step))
    kept = (_erode(inside, step // 2) if step > 1 else inside)[grid]
    rows, columns = np.nonzero(kept)
    depth = found.depth[grid][kept].astype(np.float64)
    number = np.full(kept.shape, -1)
    number[kept] = np.arange(len(depth))
    pixel = found.pitch if found.camera.focal == 0 else depth / found.camera.focal
    faces = _faces(number, depth, np.broadcast_to(JUMP * step * pixel, depth.shape))
    if not faces:
        return nothing
    x, y = grid[1].start + step * columns + 0.5, grid[0].start + step * rows + 0.5
    points = _place(found.camera, found.pitch, x, y, depth)
    return _without_loose(Surface(points, np.stack([x, y], axis=1), faces))


def _without_loose(s: Surface) -> Surface:
    """Drops vertices that no face has."""
    used = np.zeros(len(s.points), bool)
    for face in s.faces:
        used[face] = True
    new = (np.cumsum(used) - 1).tolist()
    return Surface(s.points[used], s.pixels[used], [[new[v] for v in face] for face in s.faces])
