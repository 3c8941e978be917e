"""A simulated worker's process: it brings the scene, renders, joins, and takes its own time for each."""

import heapq
from statistics import NormalDist

import numpy as np

from addon.farm import worker
from addon.farm.dask_tasks import Parcel

from .clock import Server
from .parts import joined, part_of

# Machines that a worker sends results to at once, and seconds until one that was turned away asks again, as in distributed.
_RECEIVERS, _RETRY = 50, 0.15
# Names of the functions of dask_tasks; the one that prepares does nothing else than bring the scene.
DECIDE, RENDER, JOIN, COPY = "decide", "render", "join", "copy"


def speeds(count, assumed):
    """Return the speeds of workers, of mean 1: a log-normal distribution by its quantiles, and some slow ones."""
    places = (np.arange(count) + 0.5) / count
    made = np.exp(assumed.spread * np.array([NormalDist().inv_cdf(place) for place in places]))
    slow = round(assumed.slow_share * count)
    made[:slow] = 1.0 / assumed.slowness
    return (made / made.mean()).tolist()


def makespan(times, threads):
    """Return the time until threads that take pieces of work in order have done all."""
    if threads == 1:
        return float(np.sum(times))
    ends = [0.0] * min(threads, len(times))
    for one in times.tolist():
        heapq.heapreplace(ends, ends[0] + one)
    return max(ends)


class Picture:
    """What all workers know about the picture. rate: pixel samples per second of a worker of speed 1."""

    def __init__(self, plane, kind, rate, costs, assumed):
        self.plane, self.rate = plane, rate
        self.all, self.costs, self.assumed = costs, costs.parts[kind], assumed

    def part_of(self, ranges):
        return part_of(ranges, self.plane.pixels, self.costs)

    def join(self, pieces):
        """Return the Made of several, and the seconds of joining them."""
        part = self.part_of(joined([one.part.ranges for one in pieces]))
        seconds = sum(one.part.nbytes for one in pieces) * self.costs.worker_join_seconds_per_byte
        makers = tuple(dict.fromkeys(maker for one in pieces for maker in one.by))
        return worker.Made(part, seconds + sum(one.seconds for one in pieces), makers, "simulated"), seconds

    def seconds_of(self, ranges, part):
        threads = self.assumed.threads
        rendering = makespan(self.plane.work(ranges) * (threads / self.rate), threads)
        return self.costs.start_seconds + rendering + part.nbytes * self.costs.export_seconds_per_byte


class Renderer:
    """has: results that lie here; assigned: what the scheduler thinks to be here."""

    def __init__(self, number, speed, picture, clock, cluster):
        self.address = f"tcp://machine-{number}:1"
        self.speed, self.picture, self.cluster, self.clock = speed, picture, cluster, clock
        self.is_alive, self.has_scene = True, False
        self.link = Server(clock)  # out of this machine
        self.receivers = 0  # machines that wait for bytes from here
        self.assigned = {}
        self.has = {}  # in order, so that equal simulations are equal
        self.busy = 0.0  # seconds of rendering
        self._waiting = []
        self.running = None

    def take(self, work):
        heapq.heappush(self._waiting, (work.priority, work.number, work))
        self._next()

    def gives_up(self, work):
        """Return whether work has not begun, and forget it."""
        found = [item for item in self._waiting if item[2] is work]
        for item in found:
            self._waiting.remove(item)
            heapq.heapify(self._waiting)
        return bool(found)

    def send(self, nbytes, act, to):
        """Call act() when that many bytes from here have come to another machine."""
        if to is self:
            self.clock.after(0.0, act)
            return
        assumed = self.picture.assumed
        self.receivers += 1

        def sent():
            self.receivers -= 1
            self.clock.after(assumed.latency, act)

        self.link.serve(nbytes / assumed.bytes_per_second, sent)

    def _next(self):
        while self.running is None and self._waiting and self.is_alive:
            work = heapq.heappop(self._waiting)[2]
            if work.is_wanted:
                self.running = work
                self._fetch(work, [one for one in work.needs if one not in self.has])

    def _fetch(self, work, missing):
        """Bring what the work needs, one after another; then do it."""
        if not missing:
            self._bring_scene(work)
            return
        source = self.cluster.holder(missing[0])
        if source is None or source.receivers >= _RECEIVERS:
            # It is being made again, or its machines are busy.
            self.clock.after(_RETRY, lambda: self._fetch(work, missing))
            return

        def arrived():
            self.has[missing[0]] = True
            self.cluster.has_copy(missing[0], self)
            self._fetch(work, missing[1:])

        source.send(missing[0].nbytes, arrived, self)

    def _bring_scene(self, work):
        if self.has_scene or work.kind == JOIN:
            self._do(work)
            return

        costs = self.picture.all

        def build():
            self.has_scene = True
            self.cluster.scene_came = self.clock.elapsed
            seconds = costs.scene.worker + costs.prepare_seconds / self.speed
            self.clock.after(seconds, lambda: self._do(work))

        parcels = [one for one in work.arguments if isinstance(one, Parcel)]
        if parcels:
            self.cluster.fetch_parcel(parcels[0], self, build)
        else:
            build()

    def _do(self, work):
        costs = self.picture.all
        seconds, made, nbytes = costs.submit.worker, None, 0
        if work.kind == DECIDE:
            seconds += costs.pilot_samples / self.picture.rate / self.speed
            figures = {"instruction_set": "simulated", "threads": self.picture.assumed.threads}
            made = worker.Decision(1, 1, (), figures)
        elif work.kind == RENDER:
            ranges = work.arguments[-1]
            part = self.picture.part_of(ranges)
            taken = self.picture.seconds_of(ranges, part) / self.speed
            seconds, nbytes = seconds + taken, part.nbytes
            made = worker.Made(part, taken, (self.address,), "simulated")
            self.busy += taken
        elif work.kind == COPY:
            nbytes = self.picture.all.scene_bytes
        elif work.kind == JOIN:
            made, taken = self.picture.join([one.result for one in work.needs])
            seconds, nbytes = seconds + taken, made.part.nbytes

        def done():
            self.running = None
            if self.is_alive:
                self.has[work] = True
                self.cluster.done(self, work, made, nbytes)
                self._next()

        self.clock.after(seconds, done)
