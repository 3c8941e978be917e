"""MikkTSpace tangents of triangles, as in Cycles: Blender's own fail on faces of more than four corners.

The tangent of a triangle points to increasing u. A corner has the mean over the triangles that share its position, normal and
texture coordinate: each triangle's tangent is projected onto the plane of the normal and weighted by the angle at its corner.
Mirrored triangles are averaged separately. Where mirrored and plain triangles alternate around a vertex, MikkTSpace has one
tangent for each run of equal ones; here there is one for each handedness.
"""

import numpy as np

_AT_ONCE = 1 << 15
_SMALLEST = np.finfo(np.float32).tiny


def corner_tangents(positions, triangles, normals, uvs, poll):
    """Return (3 triangles, 4): x, y, z and handedness, 1 or -1.

    normals: None (flat), per vertex or per corner. uvs: per vertex, (vertices, 2), or per corner, (triangles, 3, 2).
    """
    if normals is None:
        normals = _flat_normals(positions[triangles])
    shared = _shared(positions, triangles, normals, uvs)
    poll()
    # Sum the triangles' tangents over shared corners, those of mirrored triangles in a second row.
    count = int(shared.max()) + 1
    rows = 2 * shared
    across = np.empty((*triangles.shape, 3), np.float32)
    usable = np.empty(len(triangles), bool)
    for first in range(0, len(triangles), _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        numbers = triangles[part]
        places = positions[numbers]
        of_normals = normals[numbers] if normals.ndim == 2 else normals[part]
        tangents, area, usable[part] = _along_u(places, uvs[numbers] if uvs.ndim == 2 else uvs[part])
        rows[part] += (area <= 0.0)[:, None]
        weights = np.where(usable[part, None], _angles(places, of_normals), 0.0)
        across[part] = _across(tangents[:, None], of_normals) * weights[..., None]
        poll()
    sums = np.stack([np.bincount(rows.ravel(), across[..., axis].ravel(), 2 * count) for axis in range(3)], axis=1)
    known = np.zeros(2 * count, bool)
    known[rows[usable]] = True
    poll()
    # A triangle without a tangent uses its neighbours' tangent, or x without such neighbours.
    rows ^= (~usable[:, None] & ~known[rows]).astype(rows.dtype)
    rows = rows.reshape(-1)
    found = np.where(known[:, None], _unit(sums), (1.0, 0.0, 0.0)).astype(np.float32)
    result = np.empty((len(rows), 4), np.float32)
    result[:, :3] = found[rows]
    result[:, 3] = np.where((rows & 1).astype(bool) | ~known[rows], -1.0, 1.0)
    return result


def _flat_normals(places):
    flat = _unit(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]))
    return np.repeat(flat[:, None], 3, axis=1)


def _along_u(places, uvs):
    """Return for each triangle: the unit vector of increasing u, twice the signed area in UV space, whether both exist."""
    e1, e2 = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
    d1, d2 = uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]
    area = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
    along = e1 * d2[:, 1:] - e2 * d1[:, 1:]
    usable = (np.abs(area) > _SMALLEST) & (_dot(along, along) > 0.0)
    return _unit(along) * np.where(area > 0.0, 1.0, -1.0)[:, None], area, usable


def _shared(positions, triangles, normals, uvs):
    """Return (triangles, 3): equal numbers for corners of equal position, normal and texture coordinate."""
    at_vertices = normals.ndim == 2
    if at_vertices and uvs.ndim == 2:
        keys = _hashes(np.zeros(len(positions), np.uint64), positions, normals, uvs)
        return np.unique(keys, return_inverse=True)[1].reshape(-1)[triangles]
    uvs = uvs[triangles] if uvs.ndim == 2 else uvs
    keys = _hashes(np.zeros(len(positions), np.uint64), positions, *([normals] if at_vertices else []))[triangles]
    keys = _hashes(keys, uvs, *([] if at_vertices else [normals]))
    _, numbers = np.unique(keys, return_inverse=True)
    return numbers.reshape(keys.shape)


def _hashes(keys, *values):
    """Return 64-bit hashes of rows; among ten million different rows two collide with probability 3e-6."""
    for array in values:
        # Adding 0 turns -0 into 0.
        bits = (array.astype(np.float32) + np.float32(0.0)).view(np.uint32)
        for axis in range(array.shape[-1]):
            keys = (keys ^ bits[..., axis]) * np.uint64(0x9E3779B97F4A7C15)
            keys ^= keys >> np.uint64(29)
    return keys


def _angles(places, normals):
    """Return the angle at each corner between its two edges, projected along its normal."""
    onward = _across(np.roll(places, -1, axis=1) - places, normals)
    back = _across(np.roll(places, 1, axis=1) - places, normals)
    return np.arccos(np.clip(_dot(onward, back), -1.0, 1.0))


def _across(vectors, normals):
    return _unit(vectors - normals * _dot(vectors, normals)[..., None])


def _unit(vectors):
    lengths = np.sqrt(_dot(vectors, vectors))
    return vectors / np.where(lengths > 0.0, lengths, 1.0)[..., None]


def _dot(a, b):
    return np.einsum("...i,...i->...", a, b)
