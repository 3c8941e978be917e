"""How faces meet along edges, by the places of their vertices: a seam in the data that is none in space does not count."""

from dataclasses import dataclass

import numpy as np

_M1, _M2, _M3 = (np.uint64(m) for m in (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB))


def mixed(values):
    """64 bits that look random, the same for the same number."""
    values = (values ^ (values >> np.uint64(30))) * _M2
    values = (values ^ (values >> np.uint64(27))) * _M3
    return values ^ (values >> np.uint64(31))


def vertex_keys(positions):
    """A number for each place: equal places have equal ones, others differ but for one chance in 2^64."""
    # Adding zero turns -0 into 0.
    bits = (positions + np.float32(0.0)).view(np.uint32).astype(np.uint64)
    return mixed(mixed(mixed(bits[:, 0] + _M1) + bits[:, 1]) + bits[:, 2])


def corner_keys(mesh):
    """(triangles, 3)"""
    return vertex_keys(mesh.positions)[mesh.triangles]


def _edges(keys):
    """(key, direction) of the edges of triangles: one key for both directions, which are 1 and -1; 0 for a single point."""
    ends = keys[:, (1, 2, 0)]
    return mixed(keys + ends), (keys < ends).astype(np.int8) - (keys > ends).astype(np.int8)


def is_balanced(keys):
    """Whether each edge is passed as often one way as the other: a closed surface whose faces agree on the outside.

    The sum of one random number for each pass, with its direction as sign, is 0 for these, and else but once in 2^64.
    """
    edge, direction = _edges(keys)
    return int((edge * direction.astype(np.int64).view(np.uint64)).sum(dtype=np.uint64)) == 0


@dataclass(frozen=True)
class Faults:
    """Numbers of triangles, one for each edge at fault."""

    open: np.ndarray  # no other face
    flipped: np.ndarray  # two faces that look opposite ways
    shared: np.ndarray  # three or more faces that enclose nothing


def edge_faults(keys):
    edge, direction = _edges(keys)
    edge, direction = edge.reshape(-1), direction.reshape(-1)
    real = np.flatnonzero(direction)
    order = real[np.argsort(edge[real])]
    edge, direction = edge[order], direction[order]
    first = np.flatnonzero(np.append(True, edge[1:] != edge[:-1])) if len(edge) else np.empty(0, int)
    uses = np.diff(np.append(first, len(edge)))
    balance = np.add.reduceat(direction.astype(np.int64), first) if len(first) else np.empty(0, int)
    faces = order[first] // 3
    odd = balance != 0
    return Faults(faces[odd & (uses == 1)], faces[odd & (uses == 2)], faces[odd & (uses > 2)])


def shells(keys):
    """The number of the connected part that each triangle belongs to, by edges and corners that they share."""
    _, vertices = np.unique(keys, return_inverse=True)
    triangles = vertices.reshape(-1, 3)
    label = np.arange(int(triangles.max()) + 1)
    while True:
        # Give all corners of a triangle the least label among them, then follow labels to their own.
        least = label[triangles].min(axis=1)
        before = label.copy()
        for corner in range(3):
            np.minimum.at(label, triangles[:, corner], least)
        label = label[label]
        if np.array_equal(label, before):
            return label[triangles[:, 0]]
