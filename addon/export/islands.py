"""Random numbers of the connected parts of a mesh, as the Random Per Island output of Cycles' Geometry node."""

import numpy as np

from ..bindings.enums import Domain
from ..bindings.snapshot import MeshAttribute
from .edges import edge_ends
from .hashes import hash_of, unit

_POLL_EVERY = 1 << 16


def island_attribute(mesh, name, triangles, poll):
    """Return the attribute with one number for each triangle."""
    roots = _roots(edge_ends(mesh), len(mesh.vertices), poll)
    return MeshAttribute(name, unit(hash_of(roots[triangles[:, 0]])).reshape(-1, 1), Domain.FACE)


def _roots(ends, count, poll):
    """Return for each vertex the number of its part: the root of its tree. Edges join trees by rank, in their order."""
    parents, ranks = list(range(count)), [0] * count
    for number, (a, b) in enumerate(ends.tolist()):
        if number % _POLL_EVERY == 0:
            poll()
        while parents[a] != a:
            parents[a] = a = parents[parents[a]]
        while parents[b] != b:
            parents[b] = b = parents[parents[b]]
        if a == b:
            continue
        if ranks[a] < ranks[b]:
            a, b = b, a
        parents[b] = a
        ranks[a] += ranks[a] == ranks[b]
    roots = np.array(parents, np.int64).reshape(-1)
    while True:
        further = roots[roots]
        if (further == roots).all():
            return roots
        roots = further
