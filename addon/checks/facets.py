"""Flat parts of meshes and exact shapes: a plane, a material slot and its triangles. Large meshes have only large parts."""

from dataclasses import dataclass

import numpy as np

from ..bindings.enums import InstanceKind
from .edges import mixed
from .sides import corners, crossed, dots, lengths

# Least share of the mesh's area for a part of a mesh with more than _FEW triangles. Curved surfaces have no such parts, so that
# their triangles cost no further time.
_FEW, _SHARE = 2048, 0.01
# Tolerance within a part of directions, and of heights relative to the mesh's size.
_TURN = 2.0**-11
_DISK = 32


@dataclass(frozen=True)
class Facets:
    """The flat parts of a mesh or a unit shape, in object space."""

    normals: np.ndarray  # (n, 3), unit
    points: np.ndarray  # (n, 3), one on each part
    boxes: np.ndarray  # (n, 2, 3)
    slots: np.ndarray  # (n,)
    faces: tuple  # for each part, numbers of its triangles; for a shape the corners themselves
    shares: np.ndarray  # (n,) of the mesh's area

    def __len__(self):
        return len(self.normals)

    def large(self):
        """Return the parts with at least _SHARE of the area."""
        kept = np.flatnonzero(self.shares >= _SHARE)
        faces = tuple(self.faces[part] for part in kept)
        return Facets(self.normals[kept], self.points[kept], self.boxes[kept], self.slots[kept], faces, self.shares[kept])


_NONE = Facets(np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 2, 3)), np.empty(0, int), (), np.empty(0))


def facets_of(subject, number, mesh):
    """Return the Facets of a mesh by its number: all parts of a small mesh, the large parts of others."""

    def make():
        whole = len(mesh.triangles) <= (_FEW if subject.thorough else min(_FEW, subject.parts_left))
        if whole:
            subject.parts_left -= len(mesh.triangles)
        return mesh_facets(mesh, np.nextafter(0.0, 1.0) if whole else _SHARE)

    return subject.cached("facets", number, make)


def mesh_facets(mesh, share=_SHARE):
    """Return the Facets with at least that share of the mesh's area."""
    a, b, c = corners(mesh)
    areas, key = _cells(mesh, a, b, c)
    total = areas.sum(dtype=float)
    if not (np.isfinite(total) and total > 0.0):
        return _NONE
    # Sum the area of each cell. Cells share buckets: a bucket with too little area excludes all its cells.
    least = share * total
    bits = 16 if len(key) > 1 << 14 else 10
    bucket = (mixed(key.view(np.uint64)) >> np.uint64(64 - bits)).astype(np.int64)
    some = np.flatnonzero((np.bincount(bucket, areas, 1 << bits) >= least)[bucket])
    _, group = np.unique(key[some], return_inverse=True)
    group = group.reshape(-1)
    large = np.bincount(group, areas[some]) >= least
    kept = np.flatnonzero(large[group] & (areas[some] > 0.0))
    if len(kept) == 0:
        return _NONE
    # Sort by plane, the largest triangle first: it determines the plane best.
    kept = kept[np.lexsort((-areas[some[kept]], group[kept]))]
    faces = some[kept]
    starts = np.flatnonzero(np.diff(group[kept], prepend=-1))
    places = mesh.positions[mesh.triangles[faces]].astype(float)
    best = places[starts]
    normals = crossed(*best.transpose(1, 0, 2))
    boxes = np.stack((np.minimum.reduceat(places.min(axis=1), starts), np.maximum.reduceat(places.max(axis=1), starts)), axis=1)
    slots = np.zeros(len(starts), int) if mesh.material_slots is None else mesh.material_slots[faces[starts]].astype(int)
    shares = np.add.reduceat(areas[faces].astype(float), starts) / total
    parts = tuple(np.split(faces, starts[1:]))
    return Facets(normals / lengths(normals)[:, None], best.mean(axis=1), boxes, slots, parts, shares)


def _cells(mesh, a, b, c):
    """Return (twice the areas, cell numbers): triangles of equal direction, height and slot have equal cell numbers."""
    normals = crossed(a, b, c)
    areas = lengths(normals)
    low, high = (np.array([pick(a[:, axis]) for axis in range(3)]) for pick in (np.min, np.max))
    size = float(lengths((high - low)[None])[0]) or 1.0
    normals /= areas[:, None]
    heights = dots(normals, a - np.float32(0.5) * (low + high)) / np.float32(size)
    key = np.zeros(len(a), np.int64) if mesh.material_slots is None else mesh.material_slots.astype(np.int64)
    # 13 bits hold each column: the values lie within +-2048.
    for column in (normals[:, 0], normals[:, 1], normals[:, 2], heights):
        cell = np.floor(column * np.float32(1.0 / _TURN) + np.float32(0.5))
        key = (key << 13) + (np.where(np.isfinite(cell), cell, 0.0).astype(np.int64) & 8191)
    return areas, key


def shape_facets(kind):
    """Return the Facets of an exact shape; that of a plane is infinite."""
    if kind == InstanceKind.PLANE:
        far = np.inf
        corner = np.array([[-far, -far, 0.0], [far, -far, 0.0], [far, far, 0.0], [-far, far, 0.0]])
        triangles = corner[[[0, 1, 2], [0, 2, 3]]]
        box = np.array([[[-np.inf, -np.inf, 0.0], [np.inf, np.inf, 0.0]]])
        return Facets(np.array([[0.0, 0.0, 1.0]]), np.zeros((1, 3)), box, np.zeros(1, int), (triangles,), np.ones(1))
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
    return Facets(np.sign(axes), axes, np.array(boxes), np.zeros(len(heights), int), tuple(parts), np.ones(len(heights)))
