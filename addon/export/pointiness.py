"""How pointed a mesh is at its vertices, as the Pointiness output of Cycles' Geometry node: 0.5 is flat, more is convex."""

import numpy as np

from ..bindings.enums import Domain
from ..bindings.snapshot import MeshAttribute
from .arrays import read
from .edges import edge_ends

# Vertices count as one if their coordinates' sums and their places are as near as this (single precision's 1 + epsilon).
_EPSILON = np.float32(2.0**-23)


def pointiness_attribute(mesh, name, positions, poll):
    """Return the attribute with one number for each vertex."""
    first = _first_of_equals(positions, poll)
    normals = _unit(_summed(first, read(mesh.vertices, "normal", np.float32, 3)))
    ends = _distinct(first[edge_ends(mesh)])
    poll()
    # Compare the normal with the mean direction of the edges at the vertex.
    along = _unit(positions[ends[:, 1]].astype(float) - positions[ends[:, 0]])
    count = len(positions)
    edges = np.bincount(ends.ravel(), minlength=count)
    both, ways = ends.T.ravel(), np.concatenate([along, -along])
    mean = np.stack([np.bincount(both, axis, count) for axis in ways.T], axis=1) / np.maximum(edges, 1)[:, None]
    cosine = (normals * mean).sum(axis=1)
    angles = np.where(edges > 0, np.arccos(np.clip(cosine, -1.0, 1.0)) / np.pi, 0.0)
    poll()
    # Blur over the neighbours.
    around = np.bincount(both, angles[ends[:, ::-1].T.ravel()], count)
    values = (angles + around) / (edges + 1.0)
    return MeshAttribute(name, values[first].astype(np.float32).reshape(-1, 1), Domain.VERTEX)


def _first_of_equals(positions, poll):
    """Return for each vertex the one that stands for all vertices at its place."""
    sums = positions[:, 0] + positions[:, 1] + positions[:, 2]
    order = np.argsort(sums, kind="stable")
    sums, places = sums[order], positions[order]
    following = np.arange(len(order))
    waiting, step = np.arange(len(order)), 0
    # Look for an equal vertex among the next ones, until their sums are too far away.
    while True:
        poll()
        step += 1
        waiting = waiting[waiting < len(order) - step]
        other = waiting + step
        is_near = sums[other] - sums[waiting] <= np.float32(3.0) * _EPSILON
        waiting, other = waiting[is_near], other[is_near]
        if len(waiting) == 0:
            break
        is_equal = ((places[other] - places[waiting]) ** 2).sum(axis=1) < _EPSILON
        following[waiting[is_equal]] = other[is_equal]
        waiting = waiting[~is_equal]
    # Follow each chain to its end.
    while True:
        further = following[following]
        if (further == following).all():
            break
        following = further
    first = np.empty(len(order), np.int64)
    first[order] = order[following]
    return first


def _summed(first, values):
    sums = [np.bincount(first, axis, len(first)) for axis in values.T.astype(float)]
    return np.stack(sums, axis=1)[first]


def _distinct(ends):
    """Return each edge once, in one of its directions."""
    low, high = ends.min(axis=1), ends.max(axis=1)
    return np.unique(np.stack([low, high], axis=1), axis=0) if len(ends) else ends


def _unit(vectors):
    length = np.sqrt((vectors**2).sum(axis=1, keepdims=True))
    return vectors / np.where(length > 0.0, length, 1.0)
