"""Two workers of Dask with one thread each against one process with one thread: the same picture, by turns.

Two plain processes that render half of the samples each, without any road between them, show what this machine allows.
"""

import hashlib
import threading
import time

from tools.harness import workers
from tools.harness.turns import by_turns, middle, ratio

from . import jobs


def measure(rounds, quick):
    """Return the times in seconds, their ratios, the bytes of all parts, and whether the bits are equal."""
    path = str(jobs.OUTPUT / "scenes" / "balls-machines.npz")
    size = {"width": 320, "height": 240, "samples": 16} if quick else {"width": 640, "height": 480, "samples": 64}
    jobs.in_blender("snapshot", path=path, name="balls", threads=1, **size)
    samples = size["samples"]

    def seconds_of(competitor, _):
        if competitor == "halves":
            return _at_once(path, samples // 2)
        return workers.ask("bench.many_machines", competitor, path=path, samples=samples)

    answers = by_turns(rounds, ("one", "two", "halves"), seconds_of)
    seconds = {name: [answer["seconds"] for answer in told] for name, told in answers.items()}
    return {
        "seconds": {name: middle(values) for name, values in seconds.items()},
        "times_faster": ratio(seconds["one"], seconds["two"]),
        "times_faster_without_a_road": ratio(seconds["one"], seconds["halves"]),
        "megabytes": middle(answer["megabytes"] for answer in answers["two"]),
        "equal": len({answer["hash"] for name in ("one", "two") for answer in answers[name]}) == 1,
    }


def _at_once(path, samples):
    """Return the longer time of two processes that run at once."""
    answers = []
    both = [
        threading.Thread(target=lambda: answers.append(workers.ask("bench.many_machines", "one", path=path, samples=samples)))
        for _ in range(2)
    ]
    for thread in both:
        thread.start()
    for thread in both:
        thread.join()
    if len(answers) < 2:
        raise workers.Failed("one of two processes has failed")
    return {"seconds": max(answer["seconds"] for answer in answers)}


def _snapshot(path, samples):
    from addon.bindings.snapshot import SceneSnapshot

    snapshot = SceneSnapshot.load(path)
    changes = {"samples": samples, "threads": 1, "target_error": 0.0, "time_limit": 0.0, "split_lights": 0, "split_paths": 0}
    snapshot.set("settings", snapshot.settings.replaced(**changes))
    return snapshot


def _timed(opened, started):
    """Render and return the seconds since the start, with a hash of the picture."""
    from addon.farm.still import render_still

    with opened as session:
        render_still(session)
        seconds = time.perf_counter() - started
        told = {"seconds": seconds, "hash": hashlib.sha256(session.read(0).tobytes()).hexdigest()}
        return {**told, "megabytes": getattr(session, "bytes", 0) / 1e6}


def one(path, samples):
    """Render by a session of one thread, from the snapshot to the last sample."""
    from addon.bindings.session import Session

    snapshot = _snapshot(path, samples)
    started = time.perf_counter()
    return _timed(Session.upload(snapshot), started)


def two(path, samples):
    """Render by two workers of one thread that are there, from the snapshot to the last sample."""
    from addon.farm.dask_pool import DaskPool
    from addon.farm.dask_worker import local_cluster
    from addon.farm.remote_session import RemoteSession

    snapshot = _snapshot(path, samples)
    with local_cluster(2, 1) as cluster:
        pool = DaskPool(cluster)
        started = time.perf_counter()
        told = _timed(RemoteSession(snapshot, pool), started)
        pool.close()
    return told


if __name__ == "__main__":
    workers.answer(one, two)
