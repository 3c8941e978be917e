"""What Dask costs: processor times of client, scheduler and workers, by workers that render nothing.

A processor's time is the same if others wait for the processor, too; so it is measured, and not how long things took.
"""

import contextlib
import statistics
import time
import uuid

import numpy as np
from distributed import Client, Variable

from addon.farm import dask_tasks
from addon.farm.cut import whole_range
from addon.farm.dask_pool import DaskPool

from .machines import started

# Tiles of a task, which the scheduler passes on.
_TILES = 64
# Bytes of small and large parts.
_SMALL, _LARGE = 64, 8_000_000
_PICTURE = b"no scene"
_PAUSE = 0.005
# Seconds in which the scheduler gets the messages of released results, and in which it has nothing to do.
_RELEASE, _IDLE = 0.5, 3.0


class Probe:
    """A client, the scheduler and workers, and the processor's seconds of each."""

    def __init__(self, machines, count):
        self.machines = machines
        # As DaskPool connects, and brings a scene.
        self.client = Client(machines.address, timeout=60, direct_to_workers=True, set_as_default=False)
        self.client.wait_for_workers(count, timeout=60)
        self._variable = Variable("no-scene", client=self.client)
        self._variable.set(self.client.scatter(np.frombuffer(_PICTURE, np.uint8), hash=False, direct=True))
        self.parcel = dask_tasks.Parcel(["no-scene"])

    def spent(self, work):
        """Return work()'s result, and the seconds of client, scheduler and workers."""
        before = [time.process_time(), *self.machines.cpu_seconds()]
        made = work()
        after = [time.process_time(), *self.machines.cpu_seconds()]
        client, scheduler, *others = (b - a for a, b in zip(before, after, strict=True))
        return made, np.array([client, scheduler, sum(others)])

    def submit(self, count, part_bytes=_SMALL):
        """Return futures of that many tasks, as DaskPool submits them, once all have ended."""
        ranges = whole_range(0, 1, _TILES)
        made = [
            self.client.submit(
                dask_tasks.render,
                "no-scene",
                self.parcel,
                (part_bytes, 1),
                ranges,
                key=f"lancer-{number}-{uuid.uuid4().hex[:8]}-0",
                priority=-number,
                pure=False,
                workers=None,
            )  # fmt: skip
            for number in range(count)
        ]
        self.wait(made)
        return made

    def wait(self, futures):
        while not all(one.done() for one in futures):
            time.sleep(_PAUSE)


@contextlib.contextmanager
def probing(processes, each=1):
    with started() as machines:
        for _ in range(processes):
            machines.add_no_op(each)
        probe = Probe(machines, processes * each)
        try:
            probe.submit(4 * processes * each)
            yield probe
        finally:
            probe.client.close()


def of_tasks(rounds, tasks):
    """Return the seconds of client, scheduler and workers for a task, by what happens to it; and those of many bytes."""
    found = {"submit": [], "fetch": [], "gather": [], "release": []}
    with probing(2) as probe:
        idle = probe.spent(lambda: time.sleep(_IDLE))[1] / _IDLE
        for _ in range(rounds):
            made, spent = probe.spent(lambda: probe.submit(tasks))
            found["submit"].append(spent / tasks)
            found["fetch"].append(probe.spent(lambda made=made: [one.result() for one in made])[1] / tasks)
            made.clear()
            time.sleep(_RELEASE)
            made = probe.submit(tasks)
            found["gather"].append(probe.spent(lambda made=made: probe.client.gather(made))[1] / tasks)

            def release(made=made):
                made.clear()
                time.sleep(_RELEASE)

            found["release"].append((probe.spent(release)[1] - idle * _RELEASE) / tasks)
        seconds = {size: statistics.median(_fetched(probe, size) for _ in range(8 * rounds)) for size in (_SMALL, _LARGE)}
    result = {name: np.maximum(0.0, np.median(several, axis=0)).tolist() for name, several in found.items()}
    return result | {"seconds_per_byte": max(0.0, seconds[_LARGE] - seconds[_SMALL]) / _LARGE}


def _fetched(probe, size):
    """Return the seconds to fetch one part."""
    made = probe.submit(1, size)
    before = time.perf_counter()
    made[0].result()
    return time.perf_counter() - before


def of_workers(tasks, count, looks):
    """Return what may grow with the number of workers: seconds of client and scheduler with that many in one process."""
    with probing(1, count) as probe:
        client = probe.client
        addresses = list(client.nthreads())

        def prepare():
            options = {"pure": False}
            made = [client.submit(dask_tasks.prepare, "x", probe.parcel, workers=[one], **options) for one in addresses]
            probe.wait(made)

        preparing = probe.spent(prepare)[1] / count
        submit = probe.spent(lambda: probe.submit(tasks))[1] / tasks
        ask = probe.spent(lambda: [client.nthreads() for _ in range(looks)])[1] / looks
        processing = probe.spent(lambda: [client.processing() for _ in range(looks)])[1] / looks
        looked = _look(probe.machines.address, looks)
    return {
        "workers": count,
        "submit": submit.tolist(),
        "prepare": preparing.tolist(),
        "ask": ask.tolist(),
        "processing": processing.tolist(),
        "list_seconds_per_worker": looked / count,
    }


def _look(address, looks):
    """Return the least seconds of a look at the list of workers: most looks do not ask the scheduler."""
    pool, found = DaskPool(address), []
    for _ in range(looks):
        before = time.perf_counter()
        _ = pool.workers
        found.append(time.perf_counter() - before)
    pool.close()
    return min(found)
