"""Flat parts of all objects in world space, and the pairs of them that lie in one plane."""

from dataclasses import dataclass

import numpy as np

from ..bindings.enums import InstanceKind
from .facets import facets_of, shape_facets
from .overlap import box_pairs
from .subject import step

# Each of the two surfaces has an error of half a step along each axis, and another half from its transform.
_STEPS = 2.0
# Cells of directions per unit, wider than any error by rounding, and the margin at their borders in cells.
_CELLS = 64.0
_EDGE = 0.02
# A direction to which modelled faces are hardly ever parallel: the sign of its dot product distinguishes opposite normals.
_AWRY = np.array([0.5432, 0.7531, 0.3711])
# Extent of infinite planes in boxes.
_FAR = 1e30


@dataclass(frozen=True)
class World:
    """All flat parts in world space."""

    rows: np.ndarray  # of instances
    parts: np.ndarray  # of their facets
    materials: np.ndarray
    normals: np.ndarray
    points: np.ndarray
    low: np.ndarray
    high: np.ndarray
    steps: np.ndarray  # of single precision at the part's place

    def __len__(self):
        return len(self.rows)


def gather(subject, duplicates, most):
    """Return ({(kind, mesh): Facets}, World of all parts); the World is None if there are no parts, or more than most."""
    table = subject.instances
    facets, rows_of = {}, {}
    # Skip instances scaled to 0 along an axis, and those whose volume is NaN.
    visible = np.abs(subject.volumes) > 0.0
    if duplicates:
        visible[list(duplicates)] = False
    for number, mesh, _ in subject.shown_meshes():
        found = facets_of(subject, number, mesh)
        if len(found):
            key = InstanceKind.MESH, number
            facets[key] = found
            rows_of[key] = _only(subject.rows_of(number), visible)
    for kind in (InstanceKind.PLANE, InstanceKind.CYLINDER, InstanceKind.CONE):
        rows = np.flatnonzero((table.kinds == kind) & visible)
        if len(rows):
            facets[kind, 0] = shape_facets(kind)
            rows_of[kind, 0] = rows
    if _count(facets, rows_of) > most:
        facets = {key: found.large() for key, found in facets.items()}
    if not 0 < _count(facets, rows_of) <= most:
        return facets, None
    columns = [_place(subject, facets[key], rows_of[key]) for key in facets]
    return facets, World(*(np.concatenate(column) for column in zip(*columns, strict=True)))


def _count(facets, rows_of):
    return sum(len(found) * len(rows_of[key]) for key, found in facets.items())


def _only(rows, mask):
    return rows[mask[rows]]


def _place(subject, facets, rows):
    """Return the columns of World for all instances of one mesh or shape."""
    matrices = subject.instances.matrices[rows]
    linear, offset = matrices[:, :, :3], matrices[:, :, 3]
    # Transform normals by the cofactor matrix, which needs no inverse; mirroring flips them.
    x, y, z = linear[:, :, 0], linear[:, :, 1], linear[:, :, 2]
    cofactors = (
        np.stack((np.cross(y, z), np.cross(z, x), np.cross(x, y)), axis=2) * np.sign(subject.volumes[rows])[:, None, None]
    )
    normals = np.einsum("rij,fj->rfi", cofactors, facets.normals)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    points = np.einsum("rij,fj->rfi", linear, facets.points) + offset[:, None]
    boxes = np.clip(facets.boxes, -_FAR, _FAR)
    middle, half = boxes.mean(axis=1), 0.5 * (boxes[:, 1] - boxes[:, 0])
    centers = np.einsum("rij,fj->rfi", linear, middle) + offset[:, None]
    halves = np.einsum("rij,fj->rfi", np.abs(linear), half)
    finite = (half < 0.5 * _FAR).all(axis=1)
    # Positions are rounded in world space and in object space.
    inner = np.abs(boxes).max(axis=1) * np.where(finite, 1.0, 0.0)[:, None]
    reach = np.maximum(np.abs(points).max(axis=2), np.einsum("rij,fj->rfi", np.abs(linear), inner).max(axis=2))
    reach = np.maximum(reach, np.abs(offset).max(axis=1)[:, None])
    steps = step(reach)
    count = len(facets)
    materials = np.array([[subject.material(row, slot) for slot in facets.slots] for row in _first_of_slots(subject, rows)])
    _, which = np.unique(subject.instances.first_slots[rows], return_inverse=True)
    margin = _STEPS * steps[:, :, None]
    return (
        np.repeat(rows, count),
        np.tile(np.arange(count), len(rows)),
        materials[which.reshape(-1)].reshape(-1),
        normals.reshape(-1, 3),
        points.reshape(-1, 3),
        (centers - halves - margin).reshape(-1, 3),
        (centers + halves + margin).reshape(-1, 3),
        steps.reshape(-1),
    )


def _first_of_slots(subject, rows):
    """Return one row for each list of slots, in the order of the lists' starts."""
    _, first = np.unique(subject.instances.first_slots[rows], return_index=True)
    return rows[first].tolist()


def pairs_of(subject, world, most):
    """Return (i, j) of parts with parallel normals and overlapping boxes; empty if there are more than most candidates."""
    # Group by cells of directions, in which opposite directions are equal; near a border a part is in both cells.
    sign = np.where(world.normals @ _AWRY < 0.0, -1.0, 1.0)
    scaled = world.normals * sign[:, None] * _CELLS + 0.5
    entries, cells = np.arange(len(world)), np.floor(scaled).astype(np.int64)
    for column in range(3):
        for shift in (-_EDGE, _EDGE):
            moved = np.floor(scaled[entries, column] + shift).astype(np.int64)
            over = np.flatnonzero(moved != cells[:, column])
            copies = cells[over].copy()
            copies[:, column] = moved[over]
            entries, cells = np.append(entries, entries[over]), np.concatenate((cells, copies))
    key = (cells[:, 0] * 1024 + cells[:, 1]) * 1024 + cells[:, 2]
    _, group, sizes = np.unique(key, return_inverse=True, return_counts=True)
    group = group.reshape(-1)
    several = np.flatnonzero(sizes[group] > 1)
    entries, group = entries[several], group[several]
    subject.poll()
    pairs = box_pairs(world.low[entries], world.high[entries], most, group)
    if pairs is None:
        return np.empty(0, int), np.empty(0, int)
    i, j = np.sort(entries[np.stack(pairs)], axis=0)
    return np.divmod(np.unique(i * len(world) + j), len(world))


def in_one_plane(world, i, j):
    """Return (n,) bool: whether two parts lie in one plane, up to rounding, over an intersection of boxes that is no line."""
    low, high = np.maximum(world.low[i], world.low[j]), np.minimum(world.high[i], world.high[j])
    margin = _STEPS * np.maximum(world.steps[i], world.steps[j])
    extent = np.sort(high - low, axis=1)
    middle, radius = 0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1)
    one = np.einsum("ij,ij->i", world.normals[i], middle - world.points[i])
    other = np.einsum("ij,ij->i", world.normals[j], middle - world.points[j])
    cosine = np.einsum("ij,ij->i", world.normals[i], world.normals[j])
    apart = np.abs(one - np.sign(cosine) * other)
    turned = np.linalg.norm(np.cross(world.normals[i], world.normals[j]), axis=1)
    # Boxes include the margin on both sides.
    return (extent[:, 1] > 8.0 * margin) & (apart <= margin) & (turned * np.minimum(radius, _FAR) <= 2.0 * margin)
