"""The limit surface of a cage, which can be evaluated anywhere: a Bézier patch for each regular face, grids for the others.

The limit surface of Catmull-Clark is bicubic away from vertices with other than four edges: there, Bézier patches show it
exactly. Near such vertices they are those of Loop and Schaefer (2008), made after several refinements.
"""

import numpy as np

from .catmull_clark import Cage, Joints, refine, sums

# The number of quads that a refined cage may have for the sake of accuracy.
_MOST_QUADS = 1 << 16
_AT_ONCE = 1 << 14
# The sine of the angle between u and v below which they tell no normal, and the step to a place where they do.
_LEAST_SINE = 1e-6
_BESIDE = 1e-3
# The child of a quad that holds a point, by the halves of v and u.
CHILDREN = np.array(((0, 1), (3, 2)))
# Coordinates u and v of a quad by those of its corner k, as numbers among u / 2, v / 2, 1 - u / 2, 1 - v / 2.
_OF_CORNER = np.array(((0, 3, 2, 1), (1, 0, 3, 2)))


class LimitPatches:
    """The patches of a cage: each corner of each face is one, with the coordinates of patches.py."""

    def __init__(self, cage, poll, levels=5):
        """levels: the refinements beyond which no cage is refined, at least 1."""
        faces = cage.neighbours()[2]
        regular = _regular_faces(cage, cage.edges, faces)
        poll()
        of_rest = ~regular[faces]
        part, own = _with_ring(cage, faces, ~regular)
        level, depth = _refined(part, levels, poll)
        self._side = 1 << depth
        cells, count = self._side**2, int(regular.sum())
        self._points = np.empty((count + cells * int(of_rest.sum()), 16, cage.values.shape[1]))
        self._points[count:] = _bezier(level, np.repeat(own, cells))
        poll()
        # Faces beside regular ones are quads.
        part, own = _with_ring(cage, faces, regular)
        self._points[:count] = _bezier(part, own[::4])
        poll()
        # The first row of points of each corner, and which corner of a patch of the whole face it is; -1 for none.
        self._first = np.empty(len(faces), np.int64)
        self._first[~of_rest] = np.repeat(np.arange(count), 4)
        self._first[of_rest] = count + cells * np.arange(int(of_rest.sum()))
        self._place = np.full(len(faces), -1, np.int8)
        self._place[~of_rest] = np.tile(np.arange(4), count)
        grid = np.zeros((1, 1), np.int64)
        while len(grid) < self._side:
            grid = np.kron(4 * grid, np.ones((2, 2), np.int64)) + np.tile(CHILDREN, grid.shape)
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
            rows, u, v = self._located(patches[part], uvs[part])
            result[part] = function(self._points[rows], u, v)
        return result

    def _located(self, patches, uvs):
        """Return the rows of points, and the coordinates in their patches."""
        rows, place = self._first[patches], self._place[patches]
        scaled = uvs * self._side
        cells = np.clip(scaled.astype(np.int64), 0, self._side - 1)
        whole = place >= 0
        half = 0.5 * uvs
        ways = np.concatenate([half, 1.0 - half], axis=1)
        numbers = np.arange(len(rows))
        u, v = (np.where(whole, ways[numbers, _OF_CORNER[axis][place]], (scaled - cells)[:, axis]) for axis in (0, 1))
        rows += np.where(whole, 0, self._grid[cells[:, 1], cells[:, 0]])
        return rows, u, v


def _regular_faces(cage, edges, faces):
    """Return whether each face is a quad among quads, whose vertices have four edges without creases."""
    count = len(cage.values)
    quads = np.diff(cage.starts) == 4
    number, of_quads = np.bincount(cage.corners, minlength=count), np.bincount(cage.corners, quads[faces], count)
    good = (number == 4) & (of_quads == 4.0) & (np.bincount(edges.ends.reshape(-1), minlength=count) == 4)
    good &= cage.vertex_sharpness == 0.0
    good[edges.ends[(edges.faces != 2) | edges.is_odd | (edges.sharpness > 0.0)]] = False
    regular = quads.copy()
    regular[faces[~good[cage.corners]]] = False
    return regular


def _with_ring(cage, faces, chosen):
    """Return the Cage of the chosen faces and those beside them, on which their limit depends, and which corners are chosen."""
    near = np.zeros(len(cage.values), bool)
    near[cage.corners[chosen[faces]]] = True
    kept = np.zeros(len(chosen), bool)
    kept[faces[near[cage.corners]]] = True
    if kept.all():
        return cage, chosen[faces]
    corners = kept[faces]
    used = np.zeros(len(cage.values), bool)
    used[cage.corners[corners]] = True
    numbers = np.cumsum(used) - 1
    creases = used[cage.creases].all(axis=1)
    part = Cage(
        values=cage.values[used],
        corners=numbers[cage.corners[corners]],
        starts=np.concatenate([[0], np.cumsum(np.diff(cage.starts)[kept])]),
        creases=numbers[cage.creases[creases]],
        crease_sharpness=cage.crease_sharpness[creases],
        vertex_sharpness=cage.vertex_sharpness[used],
    )
    return part, chosen[faces[corners]]


def _refined(cage, levels, poll):
    """Return the cage after several refinements, and how many there are after the first, which makes quads of corners."""
    level, depth = refine(cage, turned=False), 0
    poll()
    while depth < levels - 1 and len(level.corners) <= _MOST_QUADS:
        level, depth = refine(level, turned=True), depth + 1
        poll()
    return level, depth


def unit(vectors):
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.where(lengths > 0.0, vectors / np.where(lengths > 0.0, lengths, 1.0), (0.0, 0.0, 1.0))


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


def _bezier(level, chosen):
    """Return (quads, 16, channels), the control points of the chosen quads of a cage, along u and then along v."""
    values, count = level.values, len(level.values)
    after, before, _ = level.neighbours()
    edges = level.edges
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
    # As OpenSubdiv does, keep the edges at a sharp vertex straight.
    straight = np.repeat(edges.sharpness > 0.0, 2) & ~smooth[here] | joints.corner[here]
    on_edges[straight] = (2.0 * values[here] + values[there])[straight] / 3.0
    inner = _beside_sharp(level, joints, limits, on_edges, inner, ahead, behind)
    rows = 4 * np.flatnonzero(chosen)
    points = np.empty((len(rows), 16, values.shape[1]))
    # The places of corner, the point towards the next corner, the inner point, and the point towards the corner before.
    places = ((0, 1, 5, 4), (3, 7, 6, 2), (15, 14, 10, 11), (12, 8, 9, 13))
    for corner, (own, forward, middle, backward) in enumerate(places):
        points[:, own] = limits[corners[rows + corner]]
        points[:, forward] = on_edges[ahead[rows + corner]]
        points[:, middle] = inner[rows + corner]
        points[:, backward] = on_edges[behind[rows + corner]]
    return points


def _beside_sharp(level, joints, limits, on_edges, inner, ahead, behind):
    """Return the inner points, those of quads with a sharp vertex that no sharp edge meets as the means of OpenSubdiv's two.

    OpenSubdiv has a Gregory patch there, which has two inner points at each corner, one for each edge. ahead, behind: the end
    of the edge at each corner among on_edges.
    """
    edges, corners, values = level.edges, level.corners, level.values
    sharp = joints.corner.copy()
    sharp[edges.ends[edges.sharpness > 0.0]] = False
    quads = np.flatnonzero(sharp[corners].reshape(-1, 4).any(axis=1))
    if len(quads) == 0:
        return inner
    rows = (4 * quads[:, None] + np.arange(4)).reshape(-1)
    after, before, _ = level.neighbours()
    ends = np.concatenate([ahead, behind])
    opposite = corners.reshape(-1, 4)[:, [2, 3, 0, 1]].reshape(-1)
    turned = 2.0 * np.pi / np.maximum(np.bincount(corners, minlength=len(values)), 1)
    cosines = np.where(sharp, np.cos(turned), 0.0)[:, None]
    inner, total = inner.copy(), 0.0
    for end, beside, far in ((ahead, before, after), (behind, after, before)):
        # The difference of the two faces at the edge.
        sides = sums(ends, np.concatenate([values[corners[before]], values[corners[after]]]), 2 * len(edges.ends))
        across = sums(ends, np.concatenate([values[opposite]] * 2), 2 * len(edges.ends))
        end = end[rows]
        apart = (2.0 * values[corners[beside[rows]]] - sides[end]) / 9.0 + (2.0 * values[opposite[rows]] - across[end]) / 18.0
        near, other = cosines[corners[rows]], cosines[corners[far[rows]]]
        total = (
            total
            + apart
            + (other * limits[corners[rows]] + (3.0 - 2.0 * near - other) * on_edges[end] + 2.0 * near * on_edges[end ^ 1])
            / 3.0
        )
    inner[rows] = 0.5 * total
    return inner
