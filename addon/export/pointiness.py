"""How pointed a mesh is at its vertices, as the Pointiness output of Cycles' Geometry node: 0.5 is flat, more is convex."""

import itertools

import numpy as np

from ..bindings.enums import Domain
from ..bindings.snapshot import MeshAttribute
from .arrays import read
from .edges import edge_ends

# Vertices count as one if the square of their distance is less, and the sums of their coordinates are not farther apart.
_EPSILON = np.float32(2.0**-23)
_FARTHEST = np.float32(3.0) * _EPSILON
# Cells of a grid per unit, half of which is longer than the root of _EPSILON.
_CELLS = 1024.0
# Mixes a cell's three numbers into one; where two cells get the same, their vertices are compared in vain.
_MIXED = 2.0**0.5 * 1e4, 3.0**0.5 * 1e8
_SPREAD = np.uint64(0x9E3779B97F4A7C15)  # the odd number nearest to 2^64 over the golden ratio


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
    # Most vertices have no other with nearly the same sum.
    beside = np.concatenate([[False], sums[1:] - sums[:-1] <= _FARTHEST, [False]])
    some = np.flatnonzero(beside[1:] | beside[:-1])
    nearest = np.full(len(some), len(some))
    # Two places less than half a cell apart share a cell of one of eight grids, each shifted by half a cell along some axes.
    for shift in itertools.product((0.0, 0.5), repeat=3):
        poll()
        for one, other in _find_pairs(sums[some], places[some], np.array(shift), poll):
            nearest[one] = np.minimum(nearest[one], other)
    following = np.arange(len(order))
    found = nearest < len(some)
    following[some[found]] = some[nearest[found]]
    # Follow each chain to its end.
    while True:
        further = following[following]
        if (further == following).all():
            break
        following = further
    first = np.empty(len(order), np.int64)
    first[order] = order[following]
    return first


def _find_pairs(sums, places, shift, poll):
    """Yield (vertices, the next equal vertex of each in its cell). The vertices are in the order of their sums."""
    x, y, z = np.floor(places.astype(float) * _CELLS + shift).T
    keys = x + y * _MIXED[0] + z * _MIXED[1]
    grouped = _companions(keys)
    grouped = grouped[np.argsort(keys[grouped], kind="stable")]
    keys, waiting, step = keys[grouped], np.arange(len(grouped)), 0
    # Look for an equal vertex among the next ones, until the cell ends or their sums are too far away.
    while len(waiting):
        poll()
        step += 1
        waiting = waiting[waiting < len(grouped) - step]
        waiting = waiting[keys[waiting + step] == keys[waiting]]
        one, other = grouped[waiting], grouped[waiting + step]
        is_near = sums[other] - sums[one] <= _FARTHEST
        waiting, one, other = waiting[is_near], one[is_near], other[is_near]
        is_equal = ((places[other] - places[one]) ** 2).sum(axis=1) < _EPSILON
        yield one[is_equal], other[is_equal]
        waiting = waiting[~is_equal]


def _companions(keys):
    """Return the places of all keys that are not alone, and of few others, without sorting."""
    bits = (4 * len(keys)).bit_length()
    hashes = (keys.view(np.uint64) * _SPREAD >> np.uint64(64 - bits)).astype(np.int64)
    return np.flatnonzero(np.bincount(hashes)[hashes] > 1)


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
