"""All costs of a still on many machines, as this machine has them."""

import statistics
import time

from . import measure_core, measure_dask
from .costs import Costs, PartCosts, Spent
from .machines import started, wait_for_workers

COMBINED, DENOISED = "combined", "denoised"
# Rounds of tasks, tasks of a round, workers for what may grow with their number, and looks at them.
_FULL, _QUICK = (5, 400, 32, 400), (2, 150, 16, 100)


def measure(threads, quick, say):
    """Return (Costs, further figures for the page)."""
    rounds, tasks, many, looks = _QUICK if quick else _FULL
    snapshot = measure_core.with_settings(measure_core.load(), threads=threads)
    scene, (name, splits) = measure_core.of_scene(snapshot, threads)
    say(f"scene: {scene['scene_bytes'] / 1e6:.1f} MB, built in {scene['prepare_seconds']:.2f} s")
    fixed = measure_core.with_settings(snapshot, split_lights=splits[0], split_paths=splits[1])
    sample = statistics.median(measure_core.of_samples(fixed, threads) for _ in range(rounds))
    say(f"a sample of a pixel: {1e6 * sample:.2f} microseconds with {threads} threads")
    parts = {}
    for kind, passes in ((COMBINED, snapshot.settings.passes), (DENOISED, measure_core.DENOISED)):
        # Other passes make another snapshot, which is prepared anew.
        given = measure_core.with_settings(snapshot, passes=passes)
        _, (name, splits) = measure_core.of_scene(given, threads)
        parts[kind] = PartCosts(**measure_core.of_parts(given, name, splits, threads))
        say(f"{kind}: {parts[kind].sum_bytes} bytes for a sum of a pixel, joined at {_rate(parts[kind].join_seconds_per_byte)}")
    maps = measure_core.maps(fixed)
    dask = measure_dask.of_tasks(rounds, tasks)
    say("a task, of client, scheduler and worker: " + ", ".join(f"{1e3 * one:.2f} ms" for one in dask["submit"]))
    say("its part, fetched alone: " + ", ".join(f"{1e3 * one:.2f} ms" for one in dask["fetch"]))
    grown = measure_dask.of_workers(tasks, many, looks)
    costs = Costs(
        connect_seconds=connect_seconds(),
        **{name: Spent(*dask[name]) for name in ("submit", "fetch", "gather", "release")},
        ask=Spent(*grown["ask"]),
        # A worker asks for the scene in a task, whose own cost is counted apart.
        scene=Spent(*(max(0.0, a - b) for a, b in zip(grown["prepare"], grown["submit"], strict=True))),
        list_seconds_per_worker=grown["list_seconds_per_worker"],
        fetch_seconds_per_byte=dask["seconds_per_byte"],
        scene_bytes=scene["scene_bytes"],
        encode_seconds=scene["encode_seconds"],
        prepare_seconds=scene["prepare_seconds"],
        pilot_samples=scene["pilot_seconds"] / sample,
        parts=parts,
        cost_map=maps["costs"],
        noise_map=maps["noise"],
    )
    told = {"sample_seconds": sample, "threads": threads, "many_workers": many, "submit_of_many": grown["submit"]}
    return costs, told | {"scene": measure_core.SCENE, "pilot_seconds": scene["pilot_seconds"]}


def connect_seconds():
    """Return the seconds to connect to a scheduler that is there."""
    with started() as machines:
        machines.add_no_op()
        pool = measure_dask.DaskPool(machines.address, patience=60.0)
        wait_for_workers(pool, 1)
        pool.close()
        before = time.perf_counter()
        pool = measure_dask.DaskPool(machines.address)
        seconds = time.perf_counter() - before
        pool.close()
    return seconds


def _rate(seconds_per_byte):
    return f"{1e-6 / seconds_per_byte:.0f} MB/s"
