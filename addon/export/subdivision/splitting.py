"""Division of patches into pieces with a number of segments on each edge: DiagSplit (Fisher and others, 2009), as in Cycles.

An edge belongs to all pieces beside it and has one number of segments, so that no cracks arise. An edge is split if its halves
differ much in length or if it has many segments. All pieces of a generation are split together.
"""

from dataclasses import dataclass

import numpy as np

from .catmull_clark import Edges

# The number of segments of an edge that must be split, and the limits of Cycles.
_SPLIT = -1
_MOST_SEGMENTS = 8
_DEEPEST = 13
# Of edges of equal length, the first ones of a piece count as longer, whatever the rounding.
_BIAS = 1.00012345


class TooManyTrianglesError(Exception):
    """The pieces have more triangles than allowed."""


@dataclass(frozen=True)
class Rate:
    """How long segments may be: rate times size(points) of the world, or rate in object space if matrix is None."""

    rate: float
    most_levels: int
    matrix: np.ndarray | None = None  # from the object to the world
    size: object = None  # a pixel_size()

    def points(self, points):
        return points if self.matrix is None else points @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    def lengths(self, start, end):
        """Return the lengths between points of points(): as they are, and in units of the rate."""
        lengths = np.linalg.norm(end - start, axis=1)
        if self.matrix is None:
            return lengths, lengths / self.rate
        return lengths, lengths / np.maximum(self.rate * self.size(0.5 * (start + end)), 1e-30)


@dataclass(frozen=True)
class Pieces:
    """Quads or triangles of patches: corner k has the coordinates uvs[:, k], and edge k runs from it to the next corner."""

    patches: np.ndarray  # (n,)
    uvs: np.ndarray  # (n, sides, 2)
    edges: np.ndarray  # (n, sides)
    reverse: np.ndarray  # (n, sides): whether the piece has the other direction than the edge

    def take(self, which):
        return Pieces(self.patches[which], self.uvs[which], self.edges[which], self.reverse[which])

    def turned(self, steps):
        """Return the pieces with steps, (n,), places as the first corner."""
        sides = self.edges.shape[1]
        order = (np.arange(sides) + np.asarray(steps)[:, None]) % sides
        uvs = np.take_along_axis(self.uvs, order[..., None], axis=1)
        return Pieces(self.patches, uvs, *(np.take_along_axis(a, order, axis=1) for a in (self.edges, self.reverse)))


def joined(pieces, sides):
    if not pieces:
        return Pieces(
            np.zeros(0, np.int64), np.zeros((0, sides, 2)), np.zeros((0, sides), np.int64), np.zeros((0, sides), bool)
        )
    return Pieces(*(np.concatenate(part) for part in zip(*(tuple(vars(piece).values()) for piece in pieces), strict=True)))


class EdgeTable:
    """All edges: their ends, their number of segments, their vertices between the ends, and their halves."""

    def __init__(self, surface, rate, poll):
        self._surface, self._rate, self._poll = surface, rate, poll
        self.vertices = 0
        self.ends = np.zeros((0, 2), np.int64)
        self.segments = np.zeros(0, np.int64)
        self.inner = np.zeros(0, np.int64)  # the first vertex after the start; the others follow
        self.length = np.zeros(0)
        self.depth = np.zeros(0, np.int64)
        self.middle = np.full(0, -1)  # the vertex between the halves
        self.halves = np.full((0, 2), -1)
        self._patch, self._uvs = np.zeros(0, np.int64), np.zeros((0, 2, 2))

    def add(self, ends, patch, uvs, depth, segments=None, inner=None, length=None):
        """Add edges and return their numbers. segments: of edges whose vertices are known; else the segments are measured."""
        if segments is None:
            segments, length = self._measured(patch, uvs, depth)
            own = np.maximum(segments - 1, 0)
            inner = self.vertices + np.cumsum(own) - own
            self.vertices += int(own.sum())
        first, count = len(self.ends), len(ends)
        none = np.full((count, 2), -1)
        news = (ends, segments, inner, length, depth, none[:, 0], none, patch, uvs)
        names = ("ends", "segments", "inner", "length", "depth", "middle", "halves", "_patch", "_uvs")
        for name, new in zip(names, news, strict=True):
            setattr(self, name, np.concatenate([getattr(self, name), new]))
        return np.arange(first, first + count)

    def _measured(self, patch, uvs, depth):
        """Return the segments, or _SPLIT, and the lengths of edges, from their ends and their middles."""
        at = [
            self._rate.points(self._surface.at(patch, np.ascontiguousarray(place), self._poll))
            for place in (uvs[:, 0], 0.5 * (uvs[:, 0] + uvs[:, 1]), uvs[:, 1])
        ]
        (long_a, a), (long_b, b) = self._rate.lengths(at[0], at[1]), self._rate.lengths(at[1], at[2])
        most = float(1 << 24)
        least, wanted = np.ceil(np.minimum(a + b, most)), np.ceil(np.minimum(2.0 * np.maximum(a, b), most))
        segments = np.maximum(wanted, 1.0).astype(np.int64)
        segments[(wanted - least > 1.0) | (segments > _MOST_SEGMENTS)] = _SPLIT
        # A patch is half as wide as the face of which it shows a corner.
        side = np.linalg.norm(uvs[:, 1] - uvs[:, 0], axis=1)
        limit = (0.5 * (1 << self._rate.most_levels) * side).astype(np.int64)
        segments = np.where(limit <= 1, 1, np.minimum(segments, limit))
        segments[(segments == _SPLIT) & (depth >= _DEEPEST)] = _MOST_SEGMENTS
        return segments, long_a + long_b

    def split(self, numbers):
        """Give halves to the edges that have none."""
        numbers = np.unique(numbers)
        numbers = numbers[self.middle[numbers] < 0]
        must = self.segments[numbers] == _SPLIT
        self._halve(numbers[must], self.vertices + np.arange(must.sum()), measured=True)
        rest = numbers[~must]
        self._halve(rest, self.inner[rest] + self.segments[rest] // 2 - 1, measured=False)

    def _halve(self, numbers, middles, measured):
        if measured:
            self.vertices += len(numbers)
        ends, uvs, patch, depth = self.ends[numbers], self._uvs[numbers], self._patch[numbers], self.depth[numbers] + 1
        fraction = self.fraction(numbers)
        between = uvs[:, 0] + fraction[:, None] * (uvs[:, 1] - uvs[:, 0])
        known = ({}, {})
        if not measured:
            first = self.segments[numbers] // 2
            inner, length = self.inner[numbers], self.length[numbers]
            known = (
                {"segments": first, "inner": inner, "length": fraction * length},
                {
                    "segments": self.segments[numbers] - first,
                    "inner": inner + first,
                    "length": (1.0 - fraction) * length,
                },
            )
        a = self.add(np.stack([ends[:, 0], middles], 1), patch, np.stack([uvs[:, 0], between], 1), depth, **known[0])
        b = self.add(np.stack([middles, ends[:, 1]], 1), patch, np.stack([between, uvs[:, 1]], 1), depth, **known[1])
        self.middle[numbers] = middles
        self.halves[numbers] = np.stack([a, b], axis=1)

    def fraction(self, numbers):
        """Return where the middle of the edges lies, from start to end."""
        segments = self.segments[numbers]
        return np.where(segments == _SPLIT, 0.5, segments // 2 / np.maximum(segments, 1))


def split_patches(surface, cage, rate, most_triangles, poll):
    """Return (EdgeTable, quads, triangles), the Pieces of a cage's patches; raise TooManyTrianglesError beyond the most."""
    return _Splitter(surface, cage, rate, most_triangles, poll).run()


class _Splitter:
    def __init__(self, surface, cage, rate, most_triangles, poll):
        self._table, self._poll, self._most = EdgeTable(surface, rate, poll), poll, most_triangles
        self._start = self._whole_patches(cage)
        self._done = {3: [], 4: []}
        self._count = 0

    def run(self):
        quads, triangles = self._start, joined([], 3)
        while len(quads.patches) or len(triangles.patches):
            self._poll()
            quads, diagonal = self._split_quads(quads)
            triangles = self._split_triangles(joined([triangles, diagonal], 3))
            # Each piece has two triangles or more, or is one.
            if self._count + 2 * len(quads.patches) + len(triangles.patches) > self._most:
                raise TooManyTrianglesError
        return self._table, *(joined(self._done[sides], sides) for sides in (4, 3))

    def _whole_patches(self, cage):
        after, before, faces = cage.neighbours()
        edges = Edges(cage, after)
        vertices, count, corners = len(cage.values), len(edges.ends), cage.corners
        middles = vertices + np.arange(count)
        centres = vertices + count + np.arange(len(cage.starts) - 1)
        self._table.vertices = vertices + count + len(centres)
        here = np.arange(len(corners))
        ahead, behind = edges.of_corner, edges.of_corner[before]
        ahead = 2 * ahead + (edges.ends[ahead, 1] == corners)
        behind = 2 * behind + (edges.ends[behind, 1] == corners)
        # From the ends of each edge to its middle, of any patch beside it; then from the middles to the centres.
        patch, uvs = np.zeros(2 * count, np.int64), np.zeros((2 * count, 2, 2))
        patch[behind], uvs[behind] = here, ((0.0, 0.0), (0.0, 1.0))
        patch[ahead], uvs[ahead] = here, ((0.0, 0.0), (1.0, 0.0))
        table = self._table
        table.add(np.stack([edges.ends.reshape(-1), np.repeat(middles, 2)], 1), patch, uvs, np.zeros(2 * count, np.int64))
        ends = np.stack([middles[edges.of_corner], centres[faces]], axis=1)
        inward = np.broadcast_to(np.array(((1.0, 0.0), (1.0, 1.0))), (len(here), 2, 2))
        table.add(ends, here, inward, np.zeros(len(here), np.int64))
        square = np.broadcast_to(np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))), (len(here), 4, 2))
        reverse = np.broadcast_to(np.array((False, False, True, True)), (len(here), 4))
        pieces = Pieces(here, square, np.stack([ahead, 2 * count + here, 2 * count + before, behind], axis=1), reverse)
        # The four pieces of a quad have the quad's own directions, on which the diagonals of their grids depend.
        corner = here - cage.starts[faces]
        return pieces.turned(np.where(np.diff(cage.starts)[faces] == 4, -corner, 0))

    def _keep(self, pieces):
        self._done[pieces.edges.shape[1]].append(pieces)
        self._count += int(triangle_counts(self._table.segments[pieces.edges]).sum())

    def _split_quads(self, quads):
        """Keep the quads that are fine enough; return the quads and the triangles of the others."""
        t, length = self._table.segments[quads.edges], self._table.length[quads.edges]
        low, high = np.minimum(t[:, :2], t[:, 2:]), np.maximum(t[:, :2], t[:, 2:])
        uneven = (low[:, ::-1] >= 2) & (low > _MOST_SEGMENTS) & (high // np.maximum(low, 1) >= 2)
        ways = (low == _SPLIT) | uneven[:, ::-1]
        along = np.where(length[:, 0] + length[:, 2] >= (length[:, 1] + length[:, 3]) / _BIAS, 0, 1)
        along = np.where(ways.all(axis=1), along, np.where(ways[:, 0], 0, 1))
        split = ways.any(axis=1)
        self._keep(quads.take(~split))
        along, t = along[split], t[split]
        quads = quads.take(split).turned(along)
        single = np.take_along_axis((t[:, :2] == 1) | (t[:, 2:] == 1), along[:, None], axis=1)[:, 0]
        halves = self._across(quads.take(~single)).turned(np.tile(-along[~single], 2))
        return halves, self._along_diagonal(quads.take(single))

    def _across(self, quads):
        """Split quads from the middle of edge 0 to the middle of edge 2."""
        table = self._table
        table.split(quads.edges[:, (0, 2)].reshape(-1))
        (first, second, near, start), (third, fourth, far, end) = (self._at_middle(quads, side) for side in (0, 2))
        depth = table.depth[quads.edges[:, (1, 3)]].max(axis=1, initial=0)
        cross = table.add(np.stack([start, end], 1), quads.patches, np.stack([near, far], 1), depth)
        e, r, uv = quads.edges, quads.reverse, quads.uvs
        no, yes = np.zeros(len(e), bool), np.ones(len(e), bool)
        return joined([
            Pieces(
                quads.patches,
                np.stack([uv[:, 0], near, far, uv[:, 3]], 1),
                np.stack([first, cross, fourth, e[:, 3]], 1),
                np.stack([r[:, 0], no, r[:, 2], r[:, 3]], 1),
            ),
            Pieces(
                quads.patches,
                np.stack([near, uv[:, 1], uv[:, 2], far], 1),
                np.stack([second, e[:, 1], third, cross], 1),
                np.stack([r[:, 0], r[:, 1], r[:, 2], yes], 1),
            ),
        ], 4)  # fmt: skip

    def _at_middle(self, pieces, side):
        """Return the halves of an edge in the direction of the pieces, and the coordinates and vertex between them."""
        table, numbers, reverse = self._table, pieces.edges[:, side], pieces.reverse[:, side]
        halves = np.where(reverse[:, None], table.halves[numbers][:, ::-1], table.halves[numbers])
        fraction = table.fraction(numbers)
        fraction = np.where(reverse, 1.0 - fraction, fraction)[:, None]
        start, end = pieces.uvs[:, side], pieces.uvs[:, (side + 1) % pieces.edges.shape[1]]
        return halves[:, 0], halves[:, 1], start + fraction * (end - start), table.middle[numbers]

    def _along_diagonal(self, quads):
        """Split quads, of which an edge must be split and the opposite has one segment, into triangles."""
        table, e, r, uv = self._table, quads.edges, quads.reverse, quads.uvs
        ends = np.stack([self._corners(quads, corner) for corner in (0, 2)], axis=1)
        diagonal = table.add(ends, quads.patches, uv[:, (0, 2)], table.depth[e].max(axis=1, initial=0))
        no, yes = np.zeros(len(e), bool), np.ones(len(e), bool)
        return joined([
            Pieces(quads.patches, uv[:, :3], np.stack([e[:, 0], e[:, 1], diagonal], 1), np.stack([r[:, 0], r[:, 1], yes], 1)),
            Pieces(
                quads.patches,
                uv[:, (0, 2, 3)],
                np.stack([diagonal, e[:, 2], e[:, 3]], 1),
                np.stack([no, r[:, 2], r[:, 3]], 1),
            ),
        ], 3)  # fmt: skip

    def _corners(self, pieces, corner):
        ends = self._table.ends[pieces.edges[:, corner]]
        return np.where(pieces.reverse[:, corner], ends[:, 1], ends[:, 0])

    def _split_triangles(self, triangles):
        """Keep the triangles that are fine enough; return the halves of the others, cut at the longest edge to be split."""
        table = self._table
        must = table.segments[triangles.edges] == _SPLIT
        split = must.any(axis=1)
        self._keep(triangles.take(~split))
        triangles, must = triangles.take(split), must[split]
        lengths = np.where(must, table.length[triangles.edges] * (_BIAS**2, _BIAS, 1.0), -1.0)
        triangles = triangles.turned(lengths.argmax(axis=1))
        table.split(triangles.edges[:, 0])
        first, second, near, middle = self._at_middle(triangles, 0)
        far = self._corners(triangles, 2)
        e, r, uv = triangles.edges, triangles.reverse, triangles.uvs
        depth = table.depth[e[:, 0]] + 1
        cross = table.add(np.stack([middle, far], 1), triangles.patches, np.stack([near, uv[:, 2]], 1), depth)
        no, yes = np.zeros(len(e), bool), np.ones(len(e), bool)
        return joined([
            Pieces(
                triangles.patches,
                np.stack([uv[:, 0], near, uv[:, 2]], 1),
                np.stack([first, cross, e[:, 2]], 1),
                np.stack([r[:, 0], no, r[:, 2]], 1),
            ),
            Pieces(
                triangles.patches,
                np.stack([near, uv[:, 1], uv[:, 2]], 1),
                np.stack([second, e[:, 1], cross], 1),
                np.stack([r[:, 0], r[:, 1], yes], 1),
            ),
        ], 3)  # fmt: skip


def triangle_counts(segments):
    """Return how many triangles pieces have, by the segments of their edges, (n, sides)."""
    if segments.shape[1] == 3:
        most, total = segments.max(axis=1, initial=0), segments.sum(axis=1)
        grid = (most - 2) ** 2 + total + 3 * (most - 2)
        return np.where(most == 1, 1, np.where(most == 2, total - 2, grid))
    u, v = np.maximum(segments[:, :2], segments[:, 2:]).T
    total = segments.sum(axis=1)
    grid = 2 * (u - 2) * (v - 2) + total + 2 * (u - 2) + 2 * (v - 2)
    return np.where(u == 1, segments[:, 1] + segments[:, 3], np.where(v == 1, segments[:, 0] + segments[:, 2], grid))
