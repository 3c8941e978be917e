"""Division of patches into pieces with a number of segments on each edge: DiagSplit (Fisher and others, 2009), as in Cycles.

An edge belongs to all pieces beside it and has one number of segments, so that no cracks arise. An edge is split if its halves
differ much in length or if it has many segments. All pieces of a generation are split together.
"""

from dataclasses import dataclass

import numpy as np

from .edge_table import MOST_SEGMENTS, SPLIT, EdgeTable
from .patches import FacePatches

_SQUARE = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
# Factor by which the first edges of a piece count as longer, so that no rounding decides between edges of equal length.
_BIAS = 1.00012345


class TooManyTrianglesError(Exception):
    """The pieces have more triangles than allowed."""


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


def split_patches(surface, cage, rate, most_triangles, poll):
    """Return (EdgeTable, quads, triangles), the Pieces of a cage's patches; raise TooManyTrianglesError beyond the most."""
    return _Splitter(surface, cage, rate, most_triangles, poll).run()


class _Splitter:
    def __init__(self, surface, cage, rate, most_triangles, poll):
        self._table = EdgeTable(FacePatches(surface, cage), rate, poll)
        self._poll, self._most = poll, most_triangles
        self._start = self._whole_patches(cage)
        self._done = {3: [], 4: []}
        self._count = 0

    def run(self):
        quads, triangles = self._start, joined([], 3)
        self._start = None
        while len(quads.patches) or len(triangles.patches):
            self._poll()
            quads, diagonal = self._split_quads(quads)
            triangles = self._split_triangles(joined([triangles, diagonal], 3))
            # Each piece has two triangles or more, or is one.
            if self._count + 2 * len(quads.patches) + len(triangles.patches) > self._most:
                raise TooManyTrianglesError
        return self._table, *(joined(self._done[sides], sides) for sides in (4, 3))

    def _whole_patches(self, cage):
        """Return the Pieces at the start: quads as a whole, and a piece for each corner of the other faces."""
        after, before, faces = cage.neighbours()
        edges, corners, here = cage.edges, cage.corners, np.arange(len(cage.corners))
        vertices, count = len(cage.values), len(edges.ends)
        middles, centres = vertices + np.arange(count), vertices + count + np.arange(len(cage.starts) - 1)
        self._table.vertices = vertices + count + len(centres)
        quad = np.diff(cage.starts) == 4
        on_quad = quad[faces]
        forward = edges.ends[edges.of_corner, 0] == corners
        self._add_halves(cage, edges, middles, forward, on_quad)
        table, none = self._table, np.zeros(count, np.int64)
        # Quads first split whole edges, which other faces know by their halves alone.
        split = {"segments": none + SPLIT, "inner": none, "length": np.zeros(count)}
        whole = table.add(edges.ends, none, np.zeros((count, 2, 2)), none - 1, **split)
        table.join(whole, middles, 2 * np.arange(count)[:, None] + (0, 1))
        round_quads = whole[edges.of_corner[on_quad]].reshape(-1, 4)
        turned = ~forward[on_quad].reshape(-1, 4)
        patches = len(corners) + np.flatnonzero(quad)
        quads = Pieces(patches, np.broadcast_to(_SQUARE, (len(patches), 4, 2)), round_quads, turned)
        # Spokes from the middles of edges to the centre.
        own = here[~on_quad]
        inward = np.broadcast_to(_SQUARE[1:3], (len(own), 2, 2))
        segments, length = table.summed(own, inward)
        ends, none = np.stack([middles[edges.of_corner[own]], centres[faces[own]]], axis=1), np.zeros(len(own), np.int64)
        spokes = np.zeros(len(corners), np.int64)
        spokes[own] = table.add(ends, own, inward, none, segments=segments, length=length)
        ahead, behind = edges.of_corner[own], edges.of_corner[before[own]]
        towards = forward[before[own]]
        sides = np.stack([2 * ahead + ~forward[own], spokes[own], spokes[before[own]], 2 * behind + towards], axis=1)
        yes = np.ones(len(own), bool)
        reverse = np.stack([~forward[own], ~yes, yes, ~towards], axis=1)
        return joined([quads, Pieces(own, np.broadcast_to(_SQUARE, (len(own), 4, 2)), sides, reverse)], 4)

    def _add_halves(self, cage, edges, middles, forward, on_quad):
        """Add the edges 2 e from the start of edge e to its middle and 2 e + 1 from there to its end.

        As in Cycles, the first face beside an edge measures it: a quad splits uneven halves, other faces sum their parts.
        """
        here = np.arange(len(cage.corners))
        first = np.zeros(len(middles), np.int64)
        first[edges.of_corner[::-1]] = here[::-1]
        by_quad, forward = on_quad[first], forward[first]
        faces = np.repeat(np.arange(len(cage.starts) - 1), np.diff(cage.starts))[first]
        corner = first - cage.starts[faces]
        start, end = _SQUARE[corner % 4], _SQUARE[(corner + 1) % 4]
        start, end = np.where(forward[:, None], start, end), np.where(forward[:, None], end, start)
        middle = 0.5 * (start + end)
        uvs = np.stack([start, middle, middle, end], axis=1).reshape(-1, 2, 2)
        patch = np.repeat(len(here) + faces, 2)
        # The half at the corner is the lower side of its patch; the other half is the left side of the next corner's patch.
        after = cage.neighbours()[0][first]
        low, left = _SQUARE[[0, 1]], _SQUARE[[3, 0]]
        for half in (0, 1):
            near = forward == (half == 0)
            rows = np.flatnonzero(~by_quad)
            patch[2 * rows + half] = np.where(near, first, after)[rows]
            side = np.where(near[:, None, None], low, left)
            # The half at the start of an edge ends at the middle, and the other one starts there.
            outward = near if half == 0 else ~near
            uvs[2 * rows + half] = np.where(outward[:, None, None], side, side[:, ::-1])[rows]
        table, depth = self._table, np.zeros(2 * len(middles), np.int64)
        ends = np.stack([edges.ends[:, 0], middles, middles, edges.ends[:, 1]], axis=1).reshape(-1, 2)
        summed = np.repeat(~by_quad, 2)
        segments, length = table.measured(patch, uvs, depth)
        segments[summed], length[summed] = table.summed(patch[summed], uvs[summed])
        table.add(ends, patch, uvs, depth, segments=segments, length=length)

    def _keep(self, pieces):
        self._done[pieces.edges.shape[1]].append(pieces)
        self._count += int(triangle_counts(self._table.segments[pieces.edges]).sum())

    def _split_quads(self, quads):
        """Keep the quads that are fine enough; return the quads and the triangles of the others."""
        t, length = self._table.segments[quads.edges], self._table.length[quads.edges]
        low, high = np.minimum(t[:, :2], t[:, 2:]), np.maximum(t[:, :2], t[:, 2:])
        uneven = (low[:, ::-1] >= 2) & (low > MOST_SEGMENTS) & (high // np.maximum(low, 1) >= 2)
        ways = (low == SPLIT) | uneven[:, ::-1]
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
        depth = table.depth[quads.edges[:, (1, 3)]].max(axis=1)
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
        diagonal = table.add(ends, quads.patches, uv[:, (0, 2)], table.depth[e].max(axis=1))
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
        must = table.segments[triangles.edges] == SPLIT
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
