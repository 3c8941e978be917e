"""Division of a round of a picture into tasks of about equal work."""

import math
from typing import NamedTuple

import numpy as np

from ..bindings.parts import RANGE

# Tasks for each worker that a share of the remaining work would make. Tasks become smaller as the work does, so that the last
# ones of all workers end at about the same time (Polychronopoulos, Kuck, "Guided self-scheduling", 1987).
_TASKS_EACH = 3
# A range of a tile is rendered in at most this many pieces.
_MOST_PIECES = 64


class Task(NamedTuple):
    """Some ranges of a round.

    pieces: number of pieces in which the samples of each range are rendered, apart from each other; a worker joins them.
    """

    number: int
    ranges: np.ndarray  # of RANGE
    pieces: int
    samples: int  # pixel samples

    def piece(self, index):
        """Return the ranges of one piece."""
        counts = self.ranges["count"].astype(np.int64)
        begin, end = counts * index // self.pieces, counts * (index + 1) // self.pieces
        cut = self.ranges.copy()
        cut["first"] += begin.astype(np.uint32)
        cut["count"] = end - begin
        return cut[cut["count"] > 0]


class Round:
    """The ranges of one round, handed out as tasks.

    ranges: array of RANGE; pixels: pixels of each tile; first_number: the number of the first task. The work of a pixel sample
    is 1, until time() tells better.
    """

    def __init__(self, ranges, pixels, first_number=0):
        self.ranges = ranges[pixels[ranges["tile"]] > 0]
        self._each = self.ranges["count"].astype(np.int64) * pixels[self.ranges["tile"]]
        # Samples and work before each range, and those of all.
        self._samples = self._work = _sums(self._each)
        self.is_timed = False
        self._next = 0
        self.number = first_number  # of the next task
        self.samples = int(self._samples[-1])

    def time(self, seconds):
        """Set the work of a pixel sample: the seconds that a worker takes for it, of each tile."""
        self._work = _sums(self._each * seconds[self.ranges["tile"]])
        self.is_timed = True

    @property
    def left(self):
        """The pixel samples that have not been handed out."""
        return self.samples - int(self._samples[self._next])

    def take(self, workers, least=0, most=math.inf, threads=1):
        """Return the next Task, or None if nothing is left.

        workers: their number; least: work below which a task is not worth its way; most: work above which the picture would
        wait for it too long; threads: those of a worker, each of which renders one tile at a time.
        """
        if self._next == len(self.ranges):
            return None
        done, all_work = self._work[self._next], self._work[-1]
        share = min(max(least, (all_work - done) / (_TASKS_EACH * max(1, workers))), most)
        end = int(np.searchsorted(self._work[1:], done + share, side="right"))
        # A task gives each thread a tile; where that is too much work, it is cut along the samples.
        is_small = end < self._next + threads
        end = min(self._next + threads, len(self.ranges)) if is_small else end
        ranges = self.ranges[self._next : end]
        samples, work = int(self._samples[end] - self._samples[self._next]), self._work[end] - done
        # By a power of two, pieces are whole subtrees of the film's sums, so that their parts are small.
        pieces = 1 << (math.ceil(work / share) - 1).bit_length() if is_small else 1
        pieces = min(pieces, int(ranges["count"].max()), _MOST_PIECES)
        task = Task(self.number, ranges, pieces, samples)
        self.number += 1
        self._next = end
        return task


def _sums(values):
    """Return the sum of the values before each, and that of all."""
    return np.concatenate([np.zeros(1, values.dtype), np.cumsum(values)])


def whole_range(first, count, tiles):
    """Return the ranges of the same samples of all tiles."""
    ranges = np.empty(tiles, RANGE)
    ranges["tile"] = np.arange(tiles)
    ranges["first"], ranges["count"] = first, count
    return ranges
