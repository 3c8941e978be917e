"""Surfaces that can be evaluated anywhere: each corner of each face of a cage is a patch with coordinates u and v, 0 to 1.

u runs from the corner's vertex along the edge to the next corner, v along the edge to the corner before; both are 1 at the
centre of the face. The limit surface of Catmull-Clark is bicubic away from vertices with other than four edges: there, Bézier
patches show it exactly. Near such vertices they are those of Loop and Schaefer (2008), made after several refinements.
"""

import numpy as np

from .catmull_clark import Edges, Joints, refine, sums

# The refinements beyond which no cage is refined, and the number of quads that one may have for the sake of accuracy.
_MOST_LEVELS = 5
_MOST_QUADS = 1 << 16
_AT_ONCE = 1 << 16
# The sine of the angle between u and v below which they tell no normal, and the step to a place where they do.
_LEAST_SINE = 1e-6
_BESIDE = 1e-3
# The child of a quad that holds a point, by the halves of v and u.
_CHILDREN = np.array(((0, 1), (3, 2)))


class LimitPatches:
    """The limit surface of a cage, as a grid of Bézier patches for each corner."""

    def __init__(self, cage, poll):
        level, depth = refine(cage, turned=False), 0
        poll()
        while depth < _MOST_LEVELS - 1 and len(level.corners) <= _MOST_QUADS:
            level, depth = refine(level, turned=True), depth + 1
            poll()
        self._points = _bezier(level)
        poll()
        self._side = 1 << depth
        grid = np.zeros((1, 1), np.int64)
        for _ in range(depth):
            grid = np.kron(4 * grid, np.ones((2, 2), np.int64)) + np.tile(_CHILDREN, grid.shape)
        self._grid = grid

    def at(self, patches, uvs, poll):
        """Return the points of patches at uvs, (n, channels)."""
        return self._evaluate(patches, uvs, poll, lambda points, u, v: _sum(points, _weights(v), _weights(u)))

    def normals(self, patches, uvs, poll):
        """Return the normals of length 1 at the points; along z where the surface has none, as in Cycles."""
        return self._evaluate(patches, uvs, poll, _normals)

    def _evaluate(self, patches, uvs, poll, function):
        result = np.empty((len(patches), self._points.shape[2]))
        for first in range(0, len(patches), _AT_ONCE):
            poll()
            part = slice(first, first + _AT_ONCE)
            scaled = uvs[part] * self._side
            cells = np.clip(scaled.astype(np.int64), 0, self._side - 1)
            rows = patches[part] * self._side**2 + self._grid[cells[:, 1], cells[:, 0]]
            u, v = (scaled - cells).T
            result[part] = function(self._points[rows], u, v)
        return result


class LinearPatches:
    """Values of the corners of faces, interpolated over the faces as Cycles does: bilinear, towards the mean at the centre."""

    def __init__(self, values, cage, normals=None):
        """values: of each corner, (corners, channels); normals: of each corner, for normals()."""
        self._points = _corner_quads(values, cage)
        self._normals = None if normals is None else _corner_quads(normals, cage)

    def at(self, patches, uvs, poll):
        poll()
        return _bilinear(self._points, patches, uvs)

    def normals(self, patches, uvs, poll):
        poll()
        return unit(_bilinear(self._normals, patches, uvs))


class FacePatches:
    """A surface with further patches: patch corners + f is the whole of face f, a quad whose first corner is at (0, 0)."""

    def __init__(self, surface, cage):
        self._surface, self._starts, self._corners = surface, cage.starts, len(cage.corners)

    def is_corner(self, patches):
        return patches < self._corners

    def at(self, patches, uvs, poll):
        return self._surface.at(*self.of_corners(patches, uvs), poll)

    def of_corners(self, patches, uvs):
        """Return the points as patches of corners and their coordinates."""
        whole = np.flatnonzero(patches >= self._corners)
        patches, uvs = patches.copy(), uvs.copy()
        u, v = uvs[whole].T
        corner = _CHILDREN[(v > 0.5).astype(int), (u > 0.5).astype(int)]
        patches[whole] = self._starts[patches[whole] - self._corners] + corner
        # From each corner, the directions to the next one and to the one before.
        ways = np.stack([u, v, 1.0 - u, 1.0 - v], axis=1)
        rows = np.arange(len(whole))
        uvs[whole, 0], uvs[whole, 1] = 2.0 * ways[rows, corner], 2.0 * ways[rows, (corner + 1) % 4]
        return patches, uvs


def unit(vectors):
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.where(lengths > 0.0, vectors / np.where(lengths > 0.0, lengths, 1.0), (0.0, 0.0, 1.0))


def _corner_quads(values, cage):
    """Return (4, corners, channels): at the corner, half way to the next, at the centre, half way to the one before."""
    after, before, faces = cage.neighbours()
    sizes = np.maximum(np.diff(cage.starts), 1)
    centres = sums(faces, values.astype(float), len(sizes)) / sizes[:, None]
    return np.stack([values, 0.5 * (values + values[after]), centres[faces], 0.5 * (values + values[before])])


def _bilinear(points, patches, uvs):
    u, v = uvs.T[..., None]
    a, b, c, d = points
    return (1.0 - v) * ((1.0 - u) * a[patches] + u * b[patches]) + v * ((1.0 - u) * d[patches] + u * c[patches])


def _weights(t):
    s = 1.0 - t
    return np.stack([s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t], axis=1)


def _slopes(t):
    s = 1.0 - t
    return 3.0 * np.stack([-s * s, s * s - 2.0 * s * t, 2.0 * s * t - t * t, t * t], axis=1)


def _normals(points, u, v):
    along_u, along_v = _sum(points, _weights(v), _slopes(u)), _sum(points, _slopes(v), _weights(u))
    across = np.cross(along_u, along_v)
    areas = np.linalg.norm(along_u, axis=1) * np.linalg.norm(along_v, axis=1)
    flat = np.linalg.norm(across, axis=1) <= _LEAST_SINE * areas
    if flat.any():
        # At a round corner of a boundary both directions are the boundary's: take the normal beside.
        u, v = (t[flat] + _BESIDE * (0.5 - t[flat]) for t in (u, v))
        points = points[flat]
        across[flat] = np.cross(_sum(points, _weights(v), _slopes(u)), _sum(points, _slopes(v), _weights(u)))
    return unit(across)


def _sum(points, rows, columns):
    weights = (rows[:, :, None] * columns[:, None, :]).reshape(-1, 16)
    return np.einsum("np,npc->nc", weights, points)


def _bezier(level):
    """Return (quads, 16, channels), the control points of the quads of a cage, along u and then along v."""
    values, count = level.values, len(level.values)
    after, before, _ = level.neighbours()
    edges = Edges(level, after)
    joints = Joints(edges, level.vertex_sharpness, 0.0)
    smooth = ~(joints.corner | joints.crease)
    corners = level.corners
    opposite = corners.reshape(-1, 4)[:, [2, 3, 0, 1]].reshape(-1)
    valence = np.bincount(edges.ends.reshape(-1), minlength=count)
    # A vertex on a crease has the rule of four edges: its neighbours beyond the crease do not count.
    n = np.where(smooth, valence, 4)[corners][:, None]
    inner = n * values[corners] + 2.0 * (values[corners[after]] + values[corners[before]]) + values[opposite]
    inner /= n + 5.0
    number = np.maximum(np.bincount(corners, minlength=count), 1)[:, None]
    limits = sums(corners, inner, count) / number
    limits[joints.corner] = values[joints.corner]
    crease = joints.crease
    limits[crease] = (4.0 * values[crease] + joints.across(values)[crease]) / 6.0
    # The two ends of each edge are 2 e and 2 e + 1.
    ahead, behind = edges.of_corner, edges.of_corner[before]
    ahead = 2 * ahead + (edges.ends[ahead, 1] == corners)
    behind = 2 * behind + (edges.ends[behind, 1] == corners)
    ends = np.concatenate([ahead, behind])
    on_edges = sums(ends, np.concatenate([inner, inner]), 2 * len(edges.ends))
    on_edges /= np.bincount(ends, minlength=2 * len(edges.ends))[:, None]
    here, there = edges.ends.reshape(-1), edges.ends[:, ::-1].reshape(-1)
    straight = np.repeat(edges.sharpness > 0.0, 2) & ~smooth[here]
    on_edges[straight] = (2.0 * values[here] + values[there])[straight] / 3.0
    points = np.empty((len(corners) // 4, 16, values.shape[1]))
    # The places of corner, the point towards the next corner, the inner point, and the point towards the corner before.
    places = ((0, 1, 5, 4), (3, 7, 6, 2), (15, 14, 10, 11), (12, 8, 9, 13))
    for corner, (own, forward, middle, backward) in enumerate(places):
        points[:, own] = limits[corners[corner::4]]
        points[:, forward] = on_edges[ahead[corner::4]]
        points[:, middle] = inner[corner::4]
        points[:, backward] = on_edges[behind[corner::4]]
    return points
