"""Topology of faces by the positions of vertices: seams with duplicate vertices in the same place count as connected."""

from dataclasses import dataclass

import numpy as np

_M1, _M2, _M3 = (np.uint64(m) for m in (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB))


def mixed(values):
    """Return a 64-bit hash of each number."""
    values = (values ^ (values >> np.uint64(30))) * _M2
    values = (values ^ (values >> np.uint64(27))) * _M3
    return values ^ (values >> np.uint64(31))


def vertex_keys(positions):
    """Return a 64-bit hash of each position; different positions collide with probability 2^-64."""
    # Adding zero turns -0 into 0.
    bits = (positions + np.float32(0.0)).view(np.uint32).astype(np.uint64)
    return mixed(mixed(mixed(bits[:, 0] + _M1) + bits[:, 1]) + bits[:, 2])


def corner_keys(mesh):
    """Return the vertex keys of the triangles' corners, (triangles, 3)."""
    return vertex_keys(mesh.positions)[mesh.triangles]


def _edges(keys):
    """Return (key, direction) of the triangles' edges: one key for both directions, 1 and -1; 0 for an edge of length 0."""
    ends = keys[:, (1, 2, 0)]
    return mixed(keys + ends), (keys < ends).astype(np.int8) - (keys > ends).astype(np.int8)


def is_balanced(keys):
    """Whether each edge is used equally often in both directions: a closed surface with consistent orientation.

    The sum of the edges' hashes, signed by direction, is 0 for such surfaces, and for others with probability 2^-64.
    """
    edge, direction = _edges(keys)
    return int((edge * direction.astype(np.int64).view(np.uint64)).sum(dtype=np.uint64)) == 0


@dataclass(frozen=True)
class Faults:
    """Triangles at faulty edges, one for each edge."""

    open: np.ndarray  # edges of one face
    flipped: np.ndarray  # edges of two faces with opposite orientation
    shared: np.ndarray  # edges of three or more faces that do not bound a volume


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
    """Return the number of each triangle's connected part; triangles are connected by shared corners."""
    _, vertices = np.unique(keys, return_inverse=True)
    triangles = vertices.reshape(-1, 3)
    label = np.arange(int(triangles.max()) + 1)
    while True:
        # Give all corners of a triangle their least label, then replace each label by its own label.
        least = label[triangles].min(axis=1)
        before = label.copy()
        for corner in range(3):
            np.minimum.at(label, triangles[:, corner], least)
        label = label[label]
        if np.array_equal(label, before):
            return label[triangles[:, 0]]
