"""One simulated render: the farm's own session, pool and schedule, with simulated machines, time and film."""

import contextlib
import queue
import sys
import time
from dataclasses import dataclass
from types import SimpleNamespace
from unittest import mock

import distributed
import numpy as np

from addon.bindings.parts import describe_part
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, SceneSnapshot, Settings
from addon.farm import dask_pool, dask_scheduler, remote_session, still
from addon.measure import schedule

from .client import Client, Ledger, Variables, gathered
from .clock import Clock, Queues
from .cluster import Cluster
from .film import Film, Plane
from .renderer import Picture, Renderer, speeds

HOUR = 3600.0
# The rooms whose code runs in simulated time.
_FARM = ("addon.farm.", "addon.measure.")
# Largest number of samples of a pixel of a picture with a target.
_MOST_SAMPLES = 1 << 20


@dataclass(frozen=True)
class Case:
    """A still that takes one machine an hour, without its scene and pilot.

    samples: of each pixel; with_target: of which the error is the target, so that the picture needs fewer.
    """

    width: int
    height: int
    samples: int
    passes: str  # a kind of PartCosts
    with_target: bool = False
    work: float = HOUR

    def plane(self, costs):
        return Plane(self.width, self.height, costs.cost_map, costs.noise_map)

    def snapshot(self, plane):
        ends = {"samples": self.samples}
        if self.with_target:
            counts = np.full(len(plane.pixels), self.samples)
            ends = {"samples": _MOST_SAMPLES, "target_error": plane.error(counts)}
        return SceneSnapshot(camera=Camera(width=self.width, height=self.height), settings=Settings(**ends))

    def pixel_samples(self, plane, snapshot, costs):
        """Return the picture's work in pixel samples of mean cost."""
        film = Film(plane, costs.parts[self.passes], lambda seconds, kind: None)
        progress = schedule.Schedule(_Alone(film, snapshot))
        while progress.start():
            progress.wait(0.0)
        return float(np.sum(film.counts * (plane.pixels * plane.costs)))


@dataclass(frozen=True)
class Outcome:
    seconds: float
    prepared: float  # seconds before the first round
    speedup: float  # against one machine without a farm
    fetched: int  # bytes that came to the client
    parts: int  # that came to the client
    fetches: int  # requests of the client for them
    tasks: int  # of the scheduler
    messages: int
    rounds: tuple  # (seconds at the start, mean samples of a pixel then, tasks on their way then) of each
    client: dict  # seconds of the client by what it does
    scheduler_busy: float  # share of the time
    workers_busy: float  # share of the time, of all workers
    scene_came: float  # seconds until the last worker had the scene
    refused: int  # parts
    lost: int
    moved: int
    samples: float  # of a pixel, on average


def simulate(case, workers, costs, assumed, seed=1):
    """Return the Outcome of a picture by that number of workers."""
    plane = case.plane(costs)
    snapshot = case.snapshot(plane)
    rate = case.pixel_samples(plane, snapshot, costs) / case.work
    clock = Clock()
    cluster = Cluster(clock, costs, assumed, seed)
    picture = Picture(plane, case.passes, rate, costs, assumed)
    given = speeds(workers, assumed)
    cluster.random.shuffle(given)
    machines = [Renderer(number, speed, picture, clock, cluster) for number, speed in enumerate(given)]
    for machine in machines:
        cluster.add(machine)
        if assumed.lost_per_second > 0.0:
            clock.after(cluster.random.expovariate(assumed.lost_per_second), lambda one=machine: cluster.lose(one))
    ledger = Ledger(clock)
    film = Film(plane, costs.parts[case.passes], ledger.spend)
    with _simulated(clock, cluster, ledger, film, costs) as client:
        ledger.spend(costs.encode_seconds, "scene")
        pool = _Pool(ledger, costs)
        with _Watched(snapshot, pool, clock) as session:
            prepared = clock.elapsed
            still.render_still(session, lambda fraction, text: None)
            session.error()
            session.read(0)
        pool.close()
    alone = costs.prepare_seconds + costs.pilot_samples / rate + case.work
    busy = sum(machine.busy for machine in machines) / (clock.elapsed * workers)
    return Outcome(
        seconds=clock.elapsed,
        prepared=prepared,
        speedup=alone / clock.elapsed,
        fetched=client[0].fetched,
        parts=client[0].parts,
        fetches=client[0].fetches,
        tasks=cluster.works,
        messages=cluster.messages,
        rounds=tuple(session.rounds),
        client=dict(ledger.seconds),
        scheduler_busy=cluster.server.busy / clock.elapsed,
        workers_busy=busy,
        scene_came=cluster.scene_came,
        refused=len(session.refused),
        lost=cluster.lost,
        moved=cluster.moved,
        samples=film.mean,
    )


@contextlib.contextmanager
def _simulated(clock, cluster, ledger, film, costs):
    """Context in which the farm's code runs in simulated time; yields the list of its clients.

    Replaced is each name of the farm's modules that is bound to real time, Dask or a film.
    """
    clients = []

    def client(*_, **__):
        clients.append(Client(cluster, ledger, costs.scene_bytes))
        return clients[-1]

    replaced = [
        (time, clock),
        (queue, Queues(clock)),
        (distributed.Client, client),
        (distributed.Variable, Variables(cluster.parcels)),
        (dask_scheduler.gathered, gathered),
        (Session, SimpleNamespace(joiner=lambda *_: film)),
        (describe_part, film.describe),
    ]
    by_id = {id(real): simulated for real, simulated in replaced}
    with contextlib.ExitStack() as stack:
        for name, module in list(sys.modules.items()):
            if name.startswith(_FARM):
                names = {name: by_id[id(value)] for name, value in vars(module).items() if id(value) in by_id}
                stack.enter_context(mock.patch.multiple(module, **names) if names else contextlib.nullcontext())
        yield clients


class _Pool(dask_pool.DaskPool):
    """A pool whose looks at its list of workers take the client's time."""

    def __init__(self, ledger, costs):
        self._ledger, self._look_seconds = ledger, costs.list_seconds_per_worker
        super().__init__("simulated")

    @property
    def workers(self):
        found = super().workers
        self._ledger.spend(found * self._look_seconds, "look")
        return found


class _Watched(remote_session.RemoteSession):
    """rounds: (seconds at the start, mean samples of a pixel then, tasks on their way then)."""

    def __init__(self, snapshot, pool, clock):
        super().__init__(snapshot, pool)
        self._clock, self.rounds = clock, []

    def render(self, first, count):
        self._note()
        super().render(first, count)

    def refine(self, target=0.0, confidence=0.95):
        self._note()
        return super().refine(target, confidence)

    def _note(self):
        self.rounds.append((self._clock.elapsed, self._film.mean, self.pool.waiting))


class _Alone:
    """A session that renders at once: it tells how many samples a picture takes."""

    def __init__(self, film, snapshot):
        self.film, self.camera, self.settings = film, snapshot.camera, snapshot.settings

    def render(self, first, count):
        self.film.counts += count

    def refine(self, target=0.0, confidence=0.95):
        ranges = self.film.plan(target)
        self.film.counts[ranges["tile"]] *= 2
        return len(ranges) > 0

    def wait(self, seconds):
        samples = int(np.sum(self.film.counts * self.film.plane.pixels))
        return SimpleNamespace(samples=samples, seconds=1.0, finished=True, cancelled=False)

    def error(self, confidence=0.95):
        return self.film.error(confidence)
