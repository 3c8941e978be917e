"""The edges between pieces of patches: how many segments each has, and the halves of those that are split."""

from dataclasses import dataclass

import numpy as np

# The number of segments of an edge that must be split, and the limits of Cycles.
SPLIT = -1
MOST_SEGMENTS = 8
_DEEPEST = 13
_DEEPEST_SUM = 20


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
        """Return the lengths between points of points(): as they are, and in units of the rate; 0 if they are no numbers."""
        with np.errstate(invalid="ignore", over="ignore"):
            lengths = np.nan_to_num(np.linalg.norm(end - start, axis=1), nan=0.0, posinf=0.0)
            if self.matrix is None:
                return lengths, lengths / self.rate
            wanted = lengths / np.maximum(self.rate * self.size(0.5 * (start + end)), 1e-30)
        return lengths, np.nan_to_num(wanted, nan=0.0, posinf=0.0)


# The edges that are measured at once.
_AT_ONCE = 1 << 14
# The columns of the table. Numbers of edges and vertices are below 2^31, or there is no memory for them.
_COLUMNS = {
    "ends": (np.int32, (2,)),
    "segments": (np.int32, ()),
    "inner": (np.int32, ()),  # the first vertex after the start; the others follow
    "length": (np.float64, ()),
    "depth": (np.int32, ()),
    "middle": (np.int32, ()),  # the vertex between the halves; -1 for none
    "halves": (np.int32, (2,)),
    "patch": (np.int32, ()),
    "uvs": (np.float64, (2, 2)),
}


class EdgeTable:
    """All edges: their ends, their number of segments, their vertices between the ends, and their halves."""

    def __init__(self, surface, rate, poll):
        self._surface, self._rate, self._poll = surface, rate, poll
        self.vertices = 0
        self._count = 0
        self._columns = {name: np.empty((0, *shape), dtype) for name, (dtype, shape) in _COLUMNS.items()}
        self._show()

    def _show(self):
        """Give each column the rows that are in use."""
        used = {name: column[: self._count] for name, column in self._columns.items()}
        self.ends, self.segments, self.length, self.depth = (used[name] for name in ("ends", "segments", "length", "depth"))
        self.inner, self.middle, self.halves = (used[name] for name in ("inner", "middle", "halves"))
        self._patch, self._uvs = used["patch"], used["uvs"]

    def add(self, ends, patch, uvs, depth, **known):
        """Add edges and return their numbers. known: segments, inner and length of edges that need not be measured."""
        segments, length = known.get("segments"), known.get("length")
        if segments is None:
            segments, length = self.measured(patch, uvs, depth)
        inner = known.get("inner")
        if inner is None:
            own = np.maximum(segments - 1, 0)
            inner = self.vertices + np.cumsum(own) - own
            self.vertices += int(own.sum())
        first, self._count = self._count, self._count + len(ends)
        news = (ends, segments, inner, length, depth, -1, -1, patch, uvs)
        for name, new in zip(_COLUMNS, news, strict=True):
            column = self._columns[name]
            if len(column) < self._count:
                # Grow by more than is needed, so that few rows are copied often.
                grown = np.empty((self._count + self._count // 2, *column.shape[1:]), column.dtype)
                grown[:first] = column[:first]
                self._columns[name] = column = grown
            column[first : self._count] = new
        self._show()
        return np.arange(first, self._count)

    def measured(self, patch, uvs, depth):
        """Return the segments, or SPLIT, and the lengths of edges, from their ends and their middles."""
        segments, length, uneven = self._estimated(patch, uvs)
        segments[uneven | (segments > MOST_SEGMENTS)] = SPLIT
        segments = self._limited(segments, patch, uvs)
        segments[(segments == SPLIT) & (depth >= _DEEPEST)] = MOST_SEGMENTS
        # A whole face must have a middle.
        segments[(segments == 1) & (depth < 0)] = 2
        return segments, length

    def summed(self, patch, uvs, depth=0):
        """Return the segments and the lengths of edges that are not split: the sums of their halves where these differ."""
        segments, length, uneven = self._estimated(patch, uvs)
        if depth < _DEEPEST_SUM and uneven.any():
            ends, own = uvs[uneven], patch[uneven]
            middle = ends.mean(axis=1)
            halves = np.stack([ends[:, 0], middle], 1), np.stack([middle, ends[:, 1]], 1)
            (first, a), (second, b) = (self.summed(own, half, depth + 1) for half in halves)
            segments[uneven], length[uneven] = first + second, a + b
        return self._limited(segments, patch, uvs), length

    def _estimated(self, patch, uvs):
        """Return the segments and the lengths of edges, and whether their halves differ by more than a segment."""
        found = np.empty(len(patch), np.int64), np.empty(len(patch)), np.empty(len(patch), bool)
        for first in range(0, len(patch), _AT_ONCE):
            part = slice(first, first + _AT_ONCE)
            for column, values in zip(found, self._estimated_part(patch[part], uvs[part]), strict=True):
                column[part] = values
        return found

    def _estimated_part(self, patch, uvs):
        at = [
            self._rate.points(self._surface.at(patch, np.ascontiguousarray(place), self._poll))
            for place in (uvs[:, 0], 0.5 * (uvs[:, 0] + uvs[:, 1]), uvs[:, 1])
        ]
        (long_a, a), (long_b, b) = self._rate.lengths(at[0], at[1]), self._rate.lengths(at[1], at[2])
        most = float(1 << 24)
        least, wanted = np.ceil(np.minimum(a + b, most)), np.ceil(np.minimum(2.0 * np.maximum(a, b), most))
        return np.maximum(wanted, 1.0).astype(np.int64), long_a + long_b, wanted - least > 1.0

    def _limited(self, segments, patch, uvs):
        side = np.linalg.norm(uvs[:, 1] - uvs[:, 0], axis=1)
        limit = ((1 << self._rate.most_levels) * side).astype(np.int64)
        # The patch of a corner is half as wide as a face.
        limit = np.where(self._surface.is_corner(patch), limit >> 1, limit)
        return np.where(limit <= 1, 1, np.minimum(segments, limit))

    def split(self, numbers):
        """Give halves to the edges that have none."""
        numbers = np.unique(numbers)
        numbers = numbers[self.middle[numbers] < 0]
        must = self.segments[numbers] == SPLIT
        self._halve(numbers[must], self.vertices + np.arange(must.sum()), measured=True)
        rest = numbers[~must]
        self._halve(rest, self.inner[rest] + self.segments[rest] // 2 - 1, measured=False)

    def _halve(self, numbers, middles, measured):
        if measured:
            self.vertices += len(numbers)
        ends, uvs, patch, depth = self.ends[numbers], self._uvs[numbers], self._patch[numbers], self.depth[numbers] + 1
        fraction = self.fraction(numbers)
        between = uvs[:, 0] + fraction[:, None] * (uvs[:, 1] - uvs[:, 0])
        known = {}, {}
        if not measured:
            first, inner, length = self.segments[numbers] // 2, self.inner[numbers], self.length[numbers]
            known = (
                {"segments": first, "inner": inner, "length": fraction * length},
                {"segments": self.segments[numbers] - first, "inner": inner + first, "length": (1.0 - fraction) * length},
            )
        a = self.add(np.stack([ends[:, 0], middles], 1), patch, np.stack([uvs[:, 0], between], 1), depth, **known[0])
        b = self.add(np.stack([middles, ends[:, 1]], 1), patch, np.stack([between, uvs[:, 1]], 1), depth, **known[1])
        self.middle[numbers] = middles
        self.halves[numbers] = np.stack([a, b], axis=1)

    def join(self, numbers, middles, halves):
        """Make edges that must be split of known halves."""
        self.middle[numbers], self.halves[numbers] = middles, halves

    def fraction(self, numbers):
        """Return where the middle of the edges lies, from start to end."""
        segments = self.segments[numbers]
        return np.where(segments == SPLIT, 0.5, segments // 2 / np.maximum(segments, 1))
