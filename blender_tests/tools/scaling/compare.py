"""A real render by one and by two workers of this machine, beside the simulation of the same render.

Other programs slow this machine down at times. So the simulation gets the seconds that the parts took in the real render, and
predicts all others: preparation, rounds, hand-outs, fetching, joining, waiting.
"""

import dataclasses
import statistics
import time

from addon.farm.dask_pool import DaskPool
from addon.farm.remote_session import RemoteSession
from addon.farm.still import render_still

from . import measure_core
from .costs import Assumed
from .machines import started, wait_for_workers
from .measure import COMBINED
from .simulate import Case, simulate

WORKERS = (1, 2)
# Workers of one thread. On one machine they are equal, none is lost, and a network costs no more than what is measured.
_ALONE = Assumed(threads=1, spread=0.0, slow_share=0.0, lost_per_second=0.0, bytes_per_second=1e12, latency=0.0)


class Watched(DaskPool):
    """made: seconds that the parts took; tasks: their number."""

    def __init__(self, *arguments, **options):
        self.made, self.tasks = 0.0, 0
        super().__init__(*arguments, **options)

    def ended(self, seconds):
        found = super().ended(seconds)
        self.made += sum(done.made.seconds for done in found)
        self.tasks += len(found)
        return found


def compare(costs, samples, rounds, say):
    """Return rows of what was measured, the median of several renders, and what the simulation says."""
    snapshot = measure_core.with_settings(measure_core.load(), samples=samples, threads=1)
    camera = snapshot.camera
    case = Case(camera.region_width, camera.region_height, samples, COMBINED)
    rows = []
    for count in WORKERS:
        runs = [_run(snapshot, case, count, costs) for _ in range(rounds)]
        rows.append({"workers": count} | {name: statistics.median(run[name] for run in runs) for name in runs[0]})
        say(
            "{workers} workers: {seconds:.1f} s in {tasks} tasks; simulated {predicted:.1f} s in {predicted_tasks}".format(
                **rows[-1]
            )
        )
    return rows


def _run(snapshot, case, count, costs):
    seconds, pool = _render(snapshot, count)
    predicted = simulate(dataclasses.replace(case, work=pool.made), count, costs, _ALONE)
    return {
        "seconds": seconds,
        "of_parts": pool.made,
        "tasks": pool.tasks,
        "predicted": predicted.seconds,
        "predicted_tasks": predicted.parts,
    }


def _render(snapshot, count):
    """Return the seconds of a render by that many workers, and its pool."""
    with started() as machines:
        for _ in range(count):
            machines.add_renderer(1)
        wait_for_workers(first := DaskPool(machines.address, patience=60.0), count)
        first.close()
        before = time.perf_counter()
        pool = Watched(machines.address)
        with RemoteSession(snapshot, pool) as session:
            render_still(session, lambda fraction, text: None)
            session.error()
            session.read(0)
        seconds = time.perf_counter() - before
        pool.close()
    return seconds, pool
