"""A picture that a pool of workers renders, behind the methods of bindings.session.Session.

Rounds of samples are cut into tasks; the parts that come back are joined here, in any order, to the bits that one session
would give. A Schedule drives it like any other session.
"""

import math
import time
from collections import Counter

import numpy as np

from ..bindings.abi import LancerError, Status
from ..bindings.digest import scene_digest
from ..bindings.parts import describe_part
from ..bindings.session import Cancelled, Progress, Session, Statistics
from . import worker
from .cut import Round, whole_range
from .pool import PoolError

# Pieces of tasks on their way for each worker: one in work, and one that waits beside it.
_AHEAD = 2
# Seconds of work below which a task is not worth its way, and those of the longest one. A scheduler needs some thousandth of a
# second for each task: with many workers, tasks are longer.
_LEAST_SECONDS, _SECONDS_EACH, _MOST_SECONDS = 0.2, 0.001, 10.0
# Least seconds of a pixel sample: numbers of workers are not to be trusted.
_LEAST_COST = 1e-12
# Failures of one task after which the picture ends.
_MOST_FAILURES = 4


class RemoteSession:
    """snapshot: a SceneSnapshot, whose meshes and images may be freed afterwards; pool: as pool.LocalPool.

    overlaps: whether a range of render() ends when all of it is handed out, if settings.samples asks for more: the workers
    begin the next one before the last parts of this one come. Set it where nothing is decided by the samples in between.
    """

    def __init__(self, snapshot, pool, poll=None, library=None):
        self.pool = pool
        self.camera, self.settings = snapshot.camera, snapshot.settings
        digest = scene_digest(snapshot)
        pool.open(*worker.encoded(snapshot), poll)
        decision = pool.decide(poll)
        if decision is None:
            raise Cancelled
        self._decision = decision
        self.splits = decision.split_lights, decision.split_paths
        settings = self.settings.replaced(in_parts=True, split_lights=self.splits[0], split_paths=self.splits[1])
        self._film = Session.joiner(digest, self.camera, settings, library)
        self.library = self._film.library
        self._pixels = self._film.tiles()
        self._round = Round(whole_range(0, 0, 0), self._pixels)
        self._waiting = {}  # tasks by number
        self._failures = Counter()
        self._number = 0
        self._before = 0  # pixel samples before the round
        self._threads = max(1, decision.figures["threads"])  # of a worker
        self._seconds, self._started = 0.0, None
        self._costs = np.zeros(len(self._pixels))  # seconds of a pixel sample of each tile; 0: unknown
        self._ended = self._cancelled = self._runs_on = False
        self.overlaps = False
        self.instruction_sets = {decision.figures["instruction_set"]}
        self.makers = Counter()  # pixel samples by worker
        self.refused = []  # sentences about parts that were wrong
        self.bytes = 0  # of all parts that came

    def render(self, first, count):
        self._start(whole_range(first, count, len(self._pixels)))
        self._runs_on = self.overlaps and first + count < self.settings.samples

    def refine(self, target=0.0, confidence=0.95):
        ranges = self._film.plan(target, confidence)
        if not len(ranges):
            return False
        self._start(ranges)
        return True

    def wait(self, seconds):
        """Join the parts that come within that time; return the Progress of the round."""
        self._hand_out()
        for done in self.pool.ended(seconds) if self._waiting else ():
            self._take(done)
        self._hand_out()
        finished = self._ended or self._round.left == 0 and (self._runs_on or not self._waiting)
        if finished and self._started is not None:
            self._seconds += time.monotonic() - self._started
            self._started = None
        statistics = self._film.statistics()
        share = (statistics.samples - self._before) / max(1, self._round.samples)
        return Progress(
            min(1.0, max(0.0, share)), self.seconds, statistics.samples, statistics.rays, finished, finished and self._cancelled
        )

    def stop(self):
        """End the round; the picture keeps the parts that have come."""
        self.pool.cancel()
        self._waiting.clear()
        self._ended = True

    def cancel(self):
        self.stop()
        self._cancelled = True

    @property
    def seconds(self):
        return self._seconds + (time.monotonic() - self._started if self._started is not None else 0.0)

    def error(self, confidence=0.95):
        return self._film.error(confidence)

    def read(self, which):
        return self._film.read(which)

    def export(self):
        """Return the picture so far as one part."""
        return self._film.export()

    def statistics(self):
        joined = self._film.statistics()
        values = {name: getattr(joined, name) for name in Statistics.__dataclass_fields__}
        values |= self._decision.figures
        values["render_seconds"] = self.seconds
        values["threads"] = self._threads * max(1, len(self.makers))
        values["instruction_set"] = ", ".join(sorted(self.instruction_sets))
        return Statistics(**values)

    def messages(self):
        return list(self._decision.messages)

    def close(self):
        self.pool.cancel()
        self._film.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _start(self, ranges):
        self._round = Round(ranges, self._pixels, self._number)
        self._before = self._film.statistics().samples + sum(task.samples for task in self._waiting.values())
        self._ended = self._runs_on = False
        self._started = time.monotonic()
        self._hand_out()

    def _hand_out(self):
        """Give the pool as many tasks as its workers can have in work and in reserve."""
        workers = self.pool.workers
        if self._costs.any() and not self._round.is_timed:
            self._round.time(self._expected())
        least, most = (max(_LEAST_SECONDS, _SECONDS_EACH * workers), _MOST_SECONDS) if self._round.is_timed else (0.0, math.inf)
        room = _AHEAD * max(1, workers) - sum(task.pieces for task in self._waiting.values())
        while not self._ended and room > 0:
            task = self._round.take(workers, least, most, self._threads)
            if task is None:
                break
            self._number = self._round.number
            self._waiting[task.number] = task
            room -= task.pieces
            self.pool.submit(task, self.splits)

    def _take(self, done):
        """Join a part; hand its task out again if it is wrong. A task that has ended before is ignored."""
        number = done.task.number
        if number not in self._waiting:
            return
        failure, by = done.failure, done.by
        if not failure:
            made = done.made
            self.bytes += made.part.nbytes
            try:
                self._require_samples(done.task, made.part)
                self._film.add(made.part)
            except LancerError as error:
                if error.status is Status.ERROR_MEMORY:
                    raise
                failure, by = str(error), made.by
        if failure:
            self._again(done.task, failure, by)
            return
        del self._waiting[number]
        self.instruction_sets.add(made.instruction_set)
        for maker in made.by:
            self.makers[maker] += done.task.samples // len(made.by)
        if made.seconds > 0.0 and math.isfinite(made.seconds):
            self._learn(done.task, made.seconds)

    def _learn(self, task, seconds):
        """Scale the costs of a task's tiles so that the task would take that long: earlier tasks tell how its tiles differ."""
        tiles = task.ranges["tile"]
        costs = self._expected()[tiles]
        samples = task.ranges["count"].astype(float) * self._pixels[tiles]
        self._costs[tiles] = np.maximum(costs * (seconds / float(samples @ costs)), _LEAST_COST)

    def _expected(self):
        """Return the seconds of a pixel sample of each tile; those of unknown tiles are the mean of the others, or 1."""
        known = self._costs > 0.0
        return np.where(known, self._costs, self._costs[known].mean() if known.any() else 1.0)

    def _require_samples(self, task, part):
        """Raise LancerError for a part of other samples than its task's: they would be missing without a word."""
        about, first, end = describe_part(part, self.library), task.ranges["first"], task.ranges["first"] + task.ranges["count"]
        if (about.tiles, about.samples, about.first, about.end) != (len(first), task.samples, first.min(), end.max()):
            raise LancerError("part: it has other samples than its task")

    def _again(self, task, failure, by):
        self._failures[task.number] += 1
        self.refused.append(f"{', '.join(by) or 'a worker'}: {failure}")
        if self._failures[task.number] == _MOST_FAILURES:
            self.stop()
            raise PoolError(f"{_MOST_FAILURES} workers failed at the same samples; the last one, {self.refused[-1]}")
        self.pool.refuse(by, failure)
        self.pool.submit(task, self.splits)
