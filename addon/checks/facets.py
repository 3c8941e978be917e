"""The flat parts of meshes and shapes that are large enough to be seen: a plane, a material slot, and the triangles in it."""

from dataclasses import dataclass

import numpy as np

from ..bindings.enums import InstanceKind
from .edges import mixed
from .sides import corners, crossed, dots, lengths

# A part of its mesh's area. What is curved has no flat part as large, so that its triangles cost nothing further.
_SHARE = 0.01
# How far directions, and heights in parts of the mesh's size, may differ within a part.
_TURN = 2.0**-11
_DISK = 32


@dataclass(frozen=True)
class Facets:
    """Those of a mesh or a unit shape, in its own space."""

    normals: np.ndarray  # (n, 3), unit
    points: np.ndarray  # (n, 3), one on each
    boxes: np.ndarray  # (n, 2, 3)
    slots: np.ndarray  # (n,)
    faces: tuple  # of each, numbers of its triangles; for a shape its corners themselves

    def __len__(self):
        return len(self.normals)


_NONE = Facets(np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 2, 3)), np.empty(0, int), ())


def mesh_facets(mesh):
    a, b, c = corners(mesh)
    areas, key = _cells(mesh, a, b, c)
    total = areas.sum(dtype=float)
    if not (np.isfinite(total) and total > 0.0):
        return _NONE
    # Sum up the area of the triangles of each cell. Cells share buckets: where all of a bucket is too little, so is each.
    least = _SHARE * total
    bits = 16 if len(key) > 1 << 14 else 10
    bucket = (mixed(key.view(np.uint64)) >> np.uint64(64 - bits)).astype(np.int64)
    some = np.flatnonzero((np.bincount(bucket, areas, 1 << bits) >= least)[bucket])
    _, group = np.unique(key[some], return_inverse=True)
    group = group.reshape(-1)
    large = np.flatnonzero(np.bincount(group, areas[some]) >= least)
    order = np.argsort(group, kind="stable")
    ends = np.searchsorted(group[order], np.stack((large, large + 1)))
    faces = [some[order[start:end]] for start, end in ends.T]
    faces = tuple(part[areas[part] > 0.0] for part in faces)
    if not faces:
        return _NONE
    places = [mesh.positions[mesh.triangles[part]].astype(float) for part in faces]
    # Of the triangles in a plane the largest tells best where it is.
    best = np.array([place[np.argmax(areas[part])] for part, place in zip(faces, places, strict=True)])
    normals = crossed(*best.transpose(1, 0, 2))
    slots = [0 if mesh.material_slots is None else mesh.material_slots[part[0]] for part in faces]
    return Facets(
        normals / lengths(normals)[:, None],
        best.mean(axis=1),
        np.array([(place.min(axis=(0, 1)), place.max(axis=(0, 1))) for place in places]),
        np.array(slots, int),
        faces,
    )


def _cells(mesh, a, b, c):
    """(areas, a number for each triangle: equal for those that look the same way from the same height in the same slot)"""
    normals = crossed(a, b, c)
    areas = lengths(normals)
    low, high = (np.array([pick(a[:, axis]) for axis in range(3)]) for pick in (np.min, np.max))
    size = float(lengths((high - low)[None])[0]) or 1.0
    normals /= areas[:, None]
    heights = dots(normals, a - np.float32(0.5) * (low + high)) / np.float32(size)
    key = np.zeros(len(a), np.int64) if mesh.material_slots is None else mesh.material_slots.astype(np.int64)
    # 13 bits hold each: they lie within +-2048.
    for column in (normals[:, 0], normals[:, 1], normals[:, 2], heights):
        cell = np.floor(column * np.float32(1.0 / _TURN) + np.float32(0.5))
        key = (key << 13) + (np.where(np.isfinite(cell), cell, 0.0).astype(np.int64) & 8191)
    return areas, key


def shape_facets(kind):
    """The flat parts of an exact shape; that of a plane has no end."""
    if kind == InstanceKind.PLANE:
        far = np.inf
        corner = np.array([[-far, -far, 0.0], [far, -far, 0.0], [far, far, 0.0], [-far, far, 0.0]])
        triangles = corner[[[0, 1, 2], [0, 2, 3]]]
        box = np.array([[[-np.inf, -np.inf, 0.0], [np.inf, np.inf, 0.0]]])
        return Facets(np.array([[0.0, 0.0, 1.0]]), np.zeros((1, 3)), box, np.zeros(1, int), (triangles,))
    heights = {InstanceKind.CYLINDER: (-1.0, 1.0), InstanceKind.CONE: (-1.0,)}.get(kind, ())
    if not heights:
        return _NONE
    angles = np.linspace(0.0, 2.0 * np.pi, _DISK, endpoint=False)
    parts, boxes = [], []
    for height in heights:
        ring = np.column_stack((np.cos(angles), np.sin(angles), np.full(_DISK, height)))
        middle = np.broadcast_to([0.0, 0.0, height], ring.shape)
        parts.append(np.stack((middle, ring, np.roll(ring, -1, axis=0)), axis=1))
        boxes.append(((-1.0, -1.0, height), (1.0, 1.0, height)))
    axes = np.array([(0.0, 0.0, height) for height in heights])
    return Facets(np.sign(axes), axes, np.array(boxes), np.zeros(len(heights), int), tuple(parts))
