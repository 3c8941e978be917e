"""The simulated film: what the client's session knows of a picture without its colours, and what its work costs."""

import math
from types import SimpleNamespace

import numpy as np

from addon.bindings.parts import RANGE
from addon.bindings.session import PictureError

from .parts import with_span

_SQUARE = 16
_BISECTIONS = 60


class Plane:
    """The tiles of a picture: two for each square, the colours of a chessboard.

    pixels: of each tile; costs: of a sample, relative to the mean over the pixels; noise: relative variance of a sample.
    """

    def __init__(self, width, height, cost_map, noise_map):
        self.width, self.height = width, height
        sizes = [np.minimum(_SQUARE, length - np.arange(0, length, _SQUARE)) for length in (width, height)]
        area = np.outer(sizes[1], sizes[0]).reshape(-1)
        self.pixels = np.stack([area - area // 2, area // 2], axis=1).reshape(-1).astype(np.uint32)
        rows, columns = len(sizes[1]), len(sizes[0])
        self.costs, self.noise = (_stretched(one, rows, columns) for one in (cost_map, noise_map))
        self.costs = self.costs / np.average(self.costs, weights=self.pixels)

    def work(self, ranges):
        """Return the work of each range, in pixel samples of mean cost."""
        return ranges["count"] * (self.pixels[ranges["tile"]] * self.costs[ranges["tile"]])

    def error(self, counts):
        return math.sqrt(np.average(self.noise / counts, weights=self.pixels))


def _stretched(rows_of_squares, rows, columns):
    """Return the value of each tile, from a map of fewer squares."""
    told = np.asarray(rows_of_squares, float)
    at = np.ix_(np.arange(rows) * told.shape[0] // rows, np.arange(columns) * told.shape[1] // columns)
    return np.repeat(told[at].reshape(-1), 2)


class Film:
    """As Session.joiner. spend(seconds, kind): takes the client's time."""

    def __init__(self, plane, costs, spend):
        self.plane, self.costs, self._spend = plane, costs, spend
        self.counts = np.zeros(len(plane.pixels), np.int64)  # samples of each tile
        self._apart = {}  # spans of the tiles that lack samples before their last one
        self._is_apart = np.zeros(len(plane.pixels), bool)
        self._samples = 0
        self._picture = plane.width * plane.height
        self.library = None

    def tiles(self):
        return self.plane.pixels

    def describe(self, part, library=None):
        """As describe_part of bindings.parts."""
        first, count = part.ranges["first"].astype(np.int64), part.ranges["count"].astype(np.int64)
        samples = int(np.sum(count * self.plane.pixels[part.ranges["tile"]]))
        tiles = len(np.unique(part.ranges["tile"]))
        return SimpleNamespace(tiles=tiles, samples=samples, first=int(first.min()), end=int((first + count).max()))

    def add(self, part):
        """Add the samples of a part, in any order; raise LancerError and change nothing if the film has some of them."""
        self._spend(part.nbytes * self.costs.join_seconds_per_byte, "join")
        ranges, tiles = part.ranges, part.ranges["tile"]
        # A tile with two ranges lacks samples between them.
        is_one = len(np.unique(tiles)) == len(tiles)
        follows = (self.counts[tiles] == ranges["first"]) & ~self._is_apart[tiles] & is_one
        changed = {}
        for tile, first, count in ranges[~follows].tolist():
            spans = changed.get(tile) or self._apart.get(tile) or [(0, int(self.counts[tile]))]
            changed[tile] = with_span(spans, first, first + count)
        for tile, spans in changed.items():
            self._apart.pop(tile, None)
            self._is_apart[tile] = len(spans) > 1
            if len(spans) > 1:
                self._apart[tile] = spans
        np.add.at(self.counts, tiles, ranges["count"])
        self._samples += int(np.sum(ranges["count"].astype(np.int64) * self.plane.pixels[tiles]))

    @property
    def mean(self):
        """Samples of a pixel, on average."""
        return self._samples / self._picture

    def statistics(self):
        self._spend(len(self.counts) * self.costs.statistics_seconds_per_tile, "judge")
        return SimpleNamespace(samples=self._samples, rays=self._samples)

    def error(self, confidence=0.95):
        self._spend(self._picture * self.costs.error_seconds_per_pixel, "judge")
        least, most = int(self.counts.min()), int(self.counts.max())
        # As in the library, a picture that lacks samples in between has no error yet.
        error = self.plane.error(self.counts) if least > 1 and not self._apart else math.inf
        return PictureError(error, error, error, *[0.0] * 11, least, most)

    def plan(self, target, confidence=0.95):
        """Return the ranges that bring the error below the target with the fewest samples, in order of gain."""
        self._spend(self._picture * self.costs.plan_seconds_per_pixel, "judge")
        chosen = self._chosen(target)
        ranges = np.empty(len(chosen), RANGE)
        ranges["tile"] = chosen
        ranges["first"] = ranges["count"] = self.counts[chosen]
        return ranges

    def read(self, which):
        self._spend(self._picture * self.costs.read_seconds_per_pixel, "judge")

    def close(self):
        pass

    def _chosen(self, target):
        """Return the tiles whose samples are doubled: those of the largest decrease of the error for each sample."""
        gains = self.plane.noise / (2.0 * self.counts.astype(float) ** 2)
        low, high = 1e-30, max(float(gains.max()), 1e-30) * 2.0

        def doublings(least):
            # Each doubling leaves a quarter of the gain.
            return np.maximum(0.0, np.floor(np.log(np.maximum(gains, 1e-300) / least) / math.log(4.0)) + 1.0)

        for _ in range(_BISECTIONS):
            middle = math.sqrt(low * high)
            if self.plane.error(self.counts * 2.0 ** doublings(middle)) <= target:
                low = middle
            else:
                high = middle
        chosen = np.flatnonzero(doublings(low) > 0)
        return chosen[np.argsort(-gains[chosen], kind="stable")]
