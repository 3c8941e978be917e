"""A Session that renders its ranges in short steps, between which its samples can be exported. The bits are the same."""

import dataclasses
import time

import numpy as np

from ..bindings.session import Session
from ..farm.cut import whole_range

# Seconds of a step: Esc waits for its end, and threads may wait while a picture is shown.
_STEP_SECONDS = 0.5
# Tiles of a step for each thread, so that all threads end it at about the same time.
_TILES_EACH = 8
# Ranges too long for a step are rendered in this many pieces: shorter ones would make the film larger.
_PIECES = 8
# Seconds after which a cancelled step is not waited for.
_PATIENCE = 2.0
# The core decides the numbers of lights and paths of a sample for pictures of at least so many samples. More samples may follow
# a picture of fewer, so that all decide alike.
_DECIDED = 16


class SteppedSession(Session):
    """between() is called before each step; after a cancel, is_whole tells whether the last step has ended."""

    def __init__(self, scene, camera, settings):
        super().__init__(scene, camera, settings.replaced(in_parts=True, samples=max(settings.samples, _DECIDED)))
        self.settings = settings.replaced(in_parts=True)
        self.between = None
        self.seconds_before = 0.0  # of the samples that were added
        self.is_whole = True
        self._pixels = self.tiles()
        self._least = _TILES_EACH * self.statistics().threads
        self._queue = []  # arrays of RANGE, none of which has a tile twice
        self._rate = 0.0  # pixel samples a second
        self._begun, self._samples = 0.0, 0
        self._ends = False
        self._cancelled = None  # the time of the cancel

    def render(self, first, count):
        self.render_in_steps(whole_range(first, count, len(self._pixels)))

    def refine(self, target=0.0, confidence=0.95):
        ranges = self.plan(target, confidence)
        if len(ranges):
            self.render_in_steps(ranges)
        return len(ranges) > 0

    def render_in_steps(self, ranges):
        """Start an array of RANGE, as render_ranges() does."""
        self._ends = False
        self._queue = self._pieces(ranges)
        self._begin()

    @property
    def rest(self):
        """The ranges that no step has begun, as an array of RANGE that has each tile once."""
        left = np.concatenate([whole_range(0, 0, 0), *self._queue])
        tiles, first, numbers = np.unique(left["tile"], return_index=True, return_inverse=True)
        # Pieces of a tile follow each other.
        rest = left[first]
        rest["count"] = np.bincount(numbers, left["count"], len(tiles))
        return rest

    def wait(self, seconds):
        progress = super().wait(seconds)
        finished, cancelled = progress.finished, progress.cancelled
        if cancelled:
            self.is_whole = False
        elif finished:
            took = time.monotonic() - self._begun
            if progress.samples > self._samples and took > 0.0:
                self._rate = (progress.samples - self._samples) / took
            if self._queue and not self._ends:
                self._begin()
                finished = False
            cancelled = finished and self._cancelled is not None
        # Rates count the samples that were added.
        return dataclasses.replace(
            progress, seconds=progress.seconds + self.seconds_before, finished=finished, cancelled=cancelled
        )

    def stop(self):
        """End the range after the running step."""
        self._ends = True

    def cancel(self):
        """End the range after the running step, or at once where that takes long."""
        self._ends = True
        self._cancelled = self._cancelled or time.monotonic()
        if time.monotonic() - self._cancelled > _PATIENCE:
            super().cancel()

    def statistics(self):
        statistics = super().statistics()
        return dataclasses.replace(statistics, render_seconds=statistics.render_seconds + self.seconds_before)

    def _pieces(self, ranges):
        least = ranges[: self._least]
        work = int((least["count"].astype(np.int64) * self._pixels[least["tile"]]).sum())
        if self._rate == 0.0 or work < 2.0 * self._rate * _STEP_SECONDS:
            return [ranges]
        edges = [ranges["count"].astype(np.int64) * i // _PIECES for i in range(_PIECES + 1)]
        pieces = []
        for begin, end in zip(edges, edges[1:], strict=False):
            piece = ranges.copy()
            piece["first"] += begin.astype(np.uint32)
            piece["count"] = end - begin
            pieces.append(piece[piece["count"] > 0])
        return [piece for piece in pieces if len(piece)]

    def _begin(self):
        if self.between is not None:
            self.between()
        ranges = self._queue.pop(0)
        work = np.cumsum(ranges["count"].astype(np.int64) * self._pixels[ranges["tile"]])
        end = max(self._least, int(np.searchsorted(work, self._rate * _STEP_SECONDS)) + 1)
        if end < len(ranges):
            self._queue.insert(0, ranges[end:])
        self._begun, self._samples = time.monotonic(), super().statistics().samples
        self.render_ranges(ranges[:end])
