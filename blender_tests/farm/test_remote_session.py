"""A picture of many workers has the bits of one session, whatever comes back, when, and how often."""

import dataclasses
import functools
import random
import threading
from collections import Counter

import numpy as np
import pytest
from given_pool import GivenPool
from part_reader import ReadPart
from picture_parts import different, finish, joiner, opened, rendered, room, told

from addon.bindings.abi import Status
from addon.bindings.parts import RANGE
from addon.bindings.session import Cancelled, LancerError, Pass, Session
from addon.bindings.snapshot import World
from addon.farm import worker
from addon.farm.pool import LocalPool, PoolError
from addon.farm.remote_session import RemoteSession
from addon.farm.still import render_still, set_rounds
from addon.measure.schedule import CANCELLED, SAMPLES, TARGET, TIME, Schedule

PASSES = (Pass.COMBINED, Pass.DEPTH, Pass.OBJECT_INDEX, Pass.DIFFUSE_DIRECT, Pass.HALVES, Pass.ERROR)


def picture(samples=12, **settings):
    """Return a snapshot of 12 tiles, without parts: only its RemoteSession is about those."""
    given = {"in_parts": False, "passes": PASSES, "max_bounces": 3, "split_lights": 0, "split_paths": 0, **settings}
    return room(samples, (36, 20), **given)


# Numbers of samples that are no power of two, one that ends a refinement, and a target.
PICTURES = {
    "samples": (picture(), SAMPLES),
    "splits": (picture(23), SAMPLES),
    "target": (picture(1024, target_error=0.9), TARGET),
    "unreached target": (picture(24, target_error=0.01), SAMPLES),
}


@functools.cache
def expected(name="samples"):
    """Return what one session tells of a picture, and why it ended."""
    with Session.upload(PICTURES[name][0]) as session:
        schedule = render_still(session)
        return told(session), schedule.reason


def rendered_by(pool, name="samples"):
    """Render a picture by a pool, and require the bits of one session."""
    with RemoteSession(PICTURES[name][0], pool) as session:
        schedule = render_still(session)
        assert different(told(session), expected(name)[0]) == []
        assert schedule.reason == expected(name)[1] == PICTURES[name][1]
        assert session.bytes == pool.bytes
        return session


@pytest.mark.parametrize("name", PICTURES)
def test_it_is_the_picture_of_one_session(name):
    pool = GivenPool()
    session = rendered_by(pool, name)
    assert set(pool.submitted.values()) == {1} and len(pool.tasks) > 20
    assert session.refused == pool.refusals == []
    facts = expected(name)[0]
    assert (facts["least_samples"] < facts["most_samples"]) == (name == "target")
    assert facts["split_lights"] == (1 if name == "samples" else 2)
    # Tiles of many samples were cut along them.
    assert (max(task.pieces for task in pool.tasks.values()) > 4) == (name == "target")


class Mixed:
    """Random deliveries: late, out of order, twice, wrong up to three times; and a number of workers that changes."""

    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.pool = GivenPool(3, self.render, self.deliver)
        self.late = 0
        self.right = set()  # numbers of tasks whose parts are

    def render(self, task, made, attempt):
        if attempt > 3 or self.chance.random() < 0.6:
            self.right.add(task.number)
            return made
        return self.chance.choice((damaged, truncated, lambda made: "MemoryError: none left"))(made)

    def deliver(self, waiting):
        self.pool.workers = self.chance.choice((0, 1, 2, 3, 8))
        self.chance.shuffle(waiting)
        found, kept = [], []
        for done in waiting:
            fate = self.chance.random()
            # Only of a joined part it is clear that it came before: a failure says that its task is to be done again.
            twice = fate < 0.3 and done.task.number in self.right
            found += [done] * (fate < 0.5) * (1 + twice)
            kept += [done] * (fate >= 0.5 or fate < 0.15 and twice)
        self.late += len(kept)
        waiting[:] = kept
        return found


@pytest.mark.parametrize("seed", range(4))
def test_nothing_that_workers_do_changes_the_picture(seed):
    mixed = Mixed(seed)
    session = rendered_by(mixed.pool, ("samples", "unreached target")[seed % 2])
    assert len(session.refused) == len(mixed.pool.refusals) > 10 and mixed.late > 10
    assert sum(mixed.pool.submitted.values()) == len(mixed.pool.tasks) + len(session.refused)


def changed(made, change):
    part = made.part.copy()
    change(part)
    return made._replace(part=part)


def damaged(made):
    return changed(made, lambda part: part.__setitem__(len(part) // 2, part[len(part) // 2] ^ 16))


def truncated(made):
    return made._replace(part=made.part[: len(made.part) // 2].copy())


@functools.cache
def decided():
    with Session.upload(PICTURES["samples"][0]) as session:
        session.decide()
        finish(session)
        return session.statistics().split_lights, session.statistics().split_paths


def other(change=lambda snapshot: snapshot, ranges=lambda ranges: ranges, **settings):
    """Return a function that replaces a part by one of another snapshot, of other settings, or of other ranges."""
    snapshot = change(PICTURES["samples"][0])

    def render(task, made):
        lights, paths = decided()
        given = {"in_parts": True, "split_lights": lights, "split_paths": paths, "threads": 1, **settings}
        with opened(snapshot, **given) as session:
            return made._replace(part=rendered(session, ranges(task.ranges.copy())))

    return render


def darker(snapshot):
    return dataclasses.replace(snapshot, world=World(radiance=0.0))


def moved(snapshot):
    return dataclasses.replace(snapshot, camera=dataclasses.replace(snapshot.camera, x=snapshot.camera.x + 1))


def shifted(ranges):
    ranges["first"] += 100
    return ranges


def shortened(ranges):
    ranges["count"][-1] -= 1
    return ranges


def lengthened(ranges):
    ranges["count"] += 1
    return ranges


def of_neighbours(ranges):
    """Return the ranges of the other halves of squares, which have as many pixels."""
    ranges["tile"] ^= 1
    return ranges


# What a worker may send, and the words of the refusal.
WRONG = {
    "damaged": (lambda task, made: damaged(made), "it is damaged"),
    "truncated": (lambda task, made: truncated(made), "it is incomplete"),
    "no bytes": (lambda task, made: made._replace(part=np.zeros(0, np.uint8)), "no part of a picture"),
    "another scene": (other(darker), "of another scene"),
    "another camera": (other(moved), "of another camera"),
    "another seed": (other(seed=4), "seed is 4, the session's 0"),
    "other splits": (other(split_paths=7), "and 7 paths"),
    "no samples": (other(ranges=lambda ranges: ranges[:0]), "other samples than its task"),
    "fewer samples": (other(ranges=shortened), "other samples than its task"),
    "more samples": (other(ranges=lengthened), "other samples than its task"),
    "fewer tiles": (other(ranges=lambda ranges: ranges[1:]), "other samples than its task"),
    "later samples": (other(ranges=shifted), "other samples than its task"),
    "a failure": (lambda task, made: "MemoryError: none left", "MemoryError: none left"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_part_is_refused_with_its_maker_and_done_again(name):
    wrong, words = WRONG[name]
    makers = {}

    def render(task, made, attempt):
        if attempt > 1 or task.number % 5 != 3:
            return made
        makers[task.number] = made.by
        return wrong(task, made)

    pool = GivenPool(render=render)
    session = rendered_by(pool)
    assert len(makers) > 4 and pool.submitted == {number: 1 + (number in makers) for number in pool.tasks}
    assert len(session.refused) == len(pool.refusals) == len(makers)
    for (by, why), told_, maker in zip(pool.refusals, session.refused, makers.values(), strict=True):
        assert words in why and told_ == f"{', '.join(by)}: {why}"
        # A failure is one worker's, a part that of all who made it.
        assert by == maker[: 1 if name == "a failure" else None]


def test_samples_of_another_task_end_the_picture():
    """They pass for those of their task, but then the other task's own part does not fit."""
    wrong = other(ranges=of_neighbours)
    pool = GivenPool(1, lambda task, made, attempt: made if task.number else wrong(task, made))
    with RemoteSession(PICTURES["samples"][0], pool) as session, pytest.raises(PoolError, match="the session has them already"):
        render_still(session)
    assert [row.tolist() for row in pool.tasks[0].ranges] == [(0, 0, 1)] and pool.submitted[1] == 4


def failing(attempts, texts=("ValueError: first", "KeyError: second", "OSError: third", "TypeError: fourth")):
    """Return a render that fails for the sixth task that many times."""
    return lambda task, made, attempt: made if task.number != 5 or attempt > attempts else texts[attempt - 1]


def test_three_failures_of_a_task_end_nothing():
    pool = GivenPool(render=failing(3))
    session = rendered_by(pool)
    assert pool.submitted[5] == 4 and [text.split(": ", 1)[1] for text in session.refused] == list(
        ("ValueError: first", "KeyError: second", "OSError: third")
    )


def test_four_failures_of_a_task_end_the_picture():
    pool = GivenPool(1, failing(4))
    with RemoteSession(PICTURES["samples"][0], pool) as session:
        with pytest.raises(PoolError) as raised:
            render_still(session)
        assert str(raised.value) == "4 workers failed at the same samples; the last one, worker 0: TypeError: fourth"
        assert pool.waiting == 0 and pool.submitted[5] == 4
        # What had come is there.
        assert session.statistics().samples > 0 and session.read(Pass.COMBINED).any() and session.wait(0.0).finished


def test_single_failures_of_many_tasks_end_nothing():
    pool = GivenPool(render=lambda task, made, attempt: made if attempt > 1 else "OSError: the way is lost")
    assert len(rendered_by(pool).refused) == len(pool.tasks) > 20


def test_missing_memory_is_no_workers_fault(monkeypatch):
    pool = GivenPool()
    with RemoteSession(PICTURES["samples"][0], pool) as session:

        def add(part):
            raise LancerError("out of memory", Status.ERROR_MEMORY)

        monkeypatch.setattr(session._film, "add", add)
        with pytest.raises(LancerError, match="^out of memory$"):
            render_still(session)
    assert session.refused == pool.refusals == []


def test_the_pools_own_end_ends_the_picture():
    pool = GivenPool(render=failing(1))

    def refuse(by, why):
        raise PoolError(f"no worker is left, {by[0]} failed because {why}")

    pool.refuse = refuse
    with RemoteSession(PICTURES["samples"][0], pool) as session, pytest.raises(PoolError, match="no worker is left, worker"):
        render_still(session)


# ---- the end of a picture before its last sample ----


def ended_early(pool, snapshot, end):
    """Render until a round after the first 16 samples has some parts, call end(schedule), and return the schedule."""
    session = RemoteSession(snapshot, pool)
    schedule = Schedule(session)
    set_rounds(schedule)
    while schedule.start():
        pool.deliver = one_by_one
        while not (progress := schedule.wait(0.0)).finished:
            if schedule.samples >= 16 and progress.fraction > 0.3:
                end(schedule)
    return schedule


def one_by_one(waiting):
    return [waiting.pop()]


def stop_for_time(schedule):
    schedule.reserve = 2.0 * schedule.settings.time_limit


@pytest.mark.parametrize("end, reason", [(stop_for_time, TIME), (Schedule.cancel, CANCELLED)])
def test_an_ended_picture_keeps_what_has_come(end, reason):
    snapshot = picture(64, time_limit=1e6)
    pool = GivenPool()
    schedule = ended_early(pool, snapshot, end)
    session = schedule.session
    assert (schedule.reason, pool.waiting, session.wait(0.0).finished) == (reason, 0, True)
    facts, error = told(session), session.error()
    # Some tiles have the samples of the last round, others have not.
    assert error.known and (error.least_samples, error.most_samples) == (16, 32)
    assert np.frombuffer(facts[Pass.COMBINED], np.float32).any()
    part = session.export()
    with joiner(snapshot, in_parts=True) as again:
        again.add(part)
        assert different(told(again), facts) == ["planned_samples"]
    # These are the bits of a session that renders the same samples of the same tiles.
    late = [(tile.number, 16, 16) for tile in ReadPart(part).tiles if tile.count == 32]
    with opened(snapshot, in_parts=True) as one:
        one.render_all(16)
        one.render_ranges(np.array(late, RANGE))
        finish(one)
        assert different(told(one), facts) == ["planned_samples"]
    session.close()


@pytest.mark.parametrize("name, overlaps", [("samples", True), ("target", False)])
def test_workers_wait_for_the_end_of_a_round_only_where_it_decides_the_next(name, overlaps):
    pool, begun = GivenPool(4), []

    def keep_the_first(waiting):
        found = [done for done in waiting if done.task.number != 0] or list(waiting)
        if any(done.task.number == 0 for done in found):
            begun.append(any(task.ranges["first"].max() > 0 for task in pool.tasks.values()))
        for done in found:
            waiting.remove(done)
        return found

    pool.deliver = keep_the_first
    rendered_by(pool, name)
    assert begun == [overlaps]


@pytest.mark.parametrize(
    "workers, samples, first", [(1, 64, 1), (2, 64, 2), (7, 64, 4), (60, 64, 8), (60, 4096, 32), (60, 3, 1)]
)
def test_the_first_round_has_a_sample_for_each_worker(workers, samples, first):
    for limits in ({}, {"time_limit": 100.0}):
        with RemoteSession(picture(samples, **limits), GivenPool(workers)) as session:
            schedule = Schedule(session)
            set_rounds(schedule)
            assert schedule.first == (min(first, 16) if limits else first)
            assert session.overlaps == (not limits)


def test_without_a_round_there_is_nothing_to_wait_for():
    with RemoteSession(PICTURES["samples"][0], GivenPool()) as session:
        progress = session.wait(0.0)
        assert progress.finished and not progress.cancelled and progress.samples == 0


def test_late_parts_of_an_ended_picture_are_ignored():
    pool = GivenPool()
    with RemoteSession(PICTURES["samples"][0], pool) as session:
        session.render(0, 4)
        stale = list(pool.parts)
        session.stop()
        assert pool.waiting == 0 and session.wait(0.0).finished and not session.wait(0.0).cancelled
        # The next round's tasks have other numbers.
        session.render(0, 2)
        pool.parts += stale
        finish(session)
        assert session.error().most_samples == session.error().least_samples == 2


def test_workers_may_vanish_and_come_back():
    asked = []

    def deliver(waiting):
        pool.workers = 0 if 3 < len(asked) < 30 else 4
        asked.append(pool.workers)
        return [] if pool.workers == 0 else [waiting.pop(0) for _ in list(waiting)]

    pool = GivenPool(4, deliver=deliver)
    session = rendered_by(pool)
    assert asked.count(0) == 26 and session.refused == []


def test_a_pool_without_workers_gets_few_tasks():
    """One that begins with the next worker, and one in reserve."""
    pool = GivenPool(0, deliver=lambda waiting: [])
    with RemoteSession(PICTURES["samples"][0], pool) as session:
        session.render(0, 4)
        for _ in range(9):
            assert not session.wait(0.0).finished
        assert pool.most_waiting == pool.waiting == 2


@pytest.mark.parametrize("workers", [1, 3])
def test_parts_in_memory_are_few(workers):
    """Two for each worker, and the one that was joined last; a picture has many times as many."""
    pool = GivenPool(workers)
    rendered_by(pool)
    assert len(pool.tasks) > 5 * 2 * workers
    assert pool.most_waiting == 2 * workers and pool.most_alive <= 2 * workers + 1


def test_tasks_follow_the_speed_of_workers():
    """A task takes at least a fifth of a second, and at most ten, but for single tiles."""
    sizes = {}
    for speed in (1.0, 10000.0):
        pool = GivenPool(1, speed=speed)
        rendered_by(pool)
        # How long a sample takes is known from the second round on.
        known = [task for task in pool.tasks.values() if task.ranges["first"].min() > 0]
        sizes[speed] = sorted({len(task.ranges) for task in known})
        assert all(task.samples <= 10.0 * speed or len(task.ranges) == 1 for task in known)
    # At 10000 samples a second 2000 samples are one task: the 720 pixels of a round, or most of four samples of each.
    assert sizes[1.0] == [1] and max(sizes[10000.0]) == 12


def test_tasks_take_equal_times_where_tiles_do_not():
    """Half of the tiles take a thousand times as long: once that is known, tasks of a round shrink in time, not in tiles."""

    def seconds_of(task):
        costs = np.where(task.ranges["tile"] < 6, 1.0, 0.001)
        return float((costs * task.ranges["count"]).sum())

    pool = GivenPool(2, lambda task, made, attempt: made._replace(seconds=seconds_of(task)))
    with RemoteSession(picture(64), pool) as session:
        render_still(session)
    last = [task for task in pool.tasks.values() if task.ranges["first"].min() >= 32]
    assert len(last) > 3
    # The cheap half is one task, as it takes less than a fifth of a second; equal samples would make several.
    assert sum(task.ranges["tile"].min() >= 6 for task in last) <= 1
    assert max(seconds_of(task) / task.pieces for task in last) <= 10.0


def test_a_time_that_no_task_takes_does_no_harm():
    for seconds in (0.0, -1.0, 1e-300, 1e300, float("inf"), float("nan")):
        pool = GivenPool(2, lambda task, made, attempt, seconds=seconds: made._replace(seconds=seconds))
        rendered_by(pool)


def test_makers_and_bytes_are_counted():
    counted = Counter()

    def render(task, made, attempt):
        if task.number == 4 and attempt == 1:
            return truncated(made)
        for name in made.by:
            counted[name] += task.samples // len(made.by)
        return made

    pool = GivenPool(3, render)
    session = rendered_by(pool, "splits")
    assert session.makers == counted and len(counted) == 3
    # Shares of a task of several makers are rounded down.
    assert 0 <= expected("splits")[0]["samples"] - sum(session.makers.values()) < len(pool.tasks) * 3
    assert session.bytes == pool.bytes > 100000


def test_what_the_first_worker_knows_is_told():
    pool = GivenPool()
    with RemoteSession(PICTURES["samples"][0], pool) as session, Session.upload(PICTURES["samples"][0]) as one:
        render_still(session)
        statistics, own = session.statistics(), one.statistics()
        assert session.messages() == one.messages()
        for name in ("triangles", "instances", "lights", "features", "geometry_bytes", "instruction_set"):
            assert getattr(statistics, name) == getattr(own, name)
        assert statistics.render_seconds == session.seconds > 0.0
        assert (session.camera, session.settings) == (one.camera, one.settings)


def test_the_snapshot_may_be_freed():
    pool, snapshot = GivenPool(), picture()
    with RemoteSession(snapshot, pool) as session:
        for name in ("meshes", "materials", "lights", "images"):
            snapshot.set(name, ())
        render_still(session)
        assert different(told(session), expected()[0]) == []


def test_cancelled_before_the_first_sample():
    with pytest.raises(Cancelled):
        RemoteSession(PICTURES["samples"][0], GivenPool(), poll=lambda: True)


# ---- the pool within this process ----


def test_the_local_pool_renders_the_same():
    pool = LocalPool(threads=1)
    with RemoteSession(PICTURES["unreached target"][0], pool) as session:
        render_still(session)
        assert different(told(session), expected("unreached target")[0]) == []
        assert set(session.makers) == {pool.address} and session.refused == [] and pool.waiting == 0
    pool.close()
    assert not pool._thread.is_alive()


def test_the_local_pool_forgets_cancelled_tasks(monkeypatch):
    begun, may_end = threading.Event(), threading.Event()
    render, ended = worker.render, LocalPool.ended

    def held(*arguments):
        begun.set()
        may_end.wait()
        return render(*arguments)

    def let_end(pool, seconds):
        may_end.set()
        return ended(pool, seconds)

    pool = LocalPool(threads=1)
    with RemoteSession(PICTURES["samples"][0], pool) as session, monkeypatch.context() as patched:
        patched.setattr(worker, "render", held)
        patched.setattr(LocalPool, "ended", let_end)
        try:
            session.render(0, 64)
            # One task is in work, and one waits.
            begun.wait()
            session.stop()
            assert pool.waiting == 0 and pool.ended(0.0) == [] and session.statistics().samples == 0
        finally:
            may_end.set()
        # It can go on.
        session.render(64, 1)
        finish(session)
        assert session.statistics().samples == 36 * 20
    pool.close()


def test_the_local_pools_failure_ends_the_picture(monkeypatch):
    def fail(*_):
        raise MemoryError("none left")

    pool = LocalPool(threads=1)
    with RemoteSession(PICTURES["samples"][0], pool) as session:
        monkeypatch.setattr(worker, "render", fail)
        with pytest.raises(PoolError, match="this machine .*MemoryError: none left"):
            render_still(session)
    pool.close()
