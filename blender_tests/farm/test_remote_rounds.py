"""Rounds of a picture of many workers: their ends, their order, and the size of their tasks."""

import numpy as np
import pytest
from given_pool import GivenPool
from part_reader import ReadPart
from picture_parts import different, finish, joiner, opened, told
from remote_pictures import PICTURES, picture, rendered_by

from addon.bindings.parts import RANGE
from addon.bindings.session import Pass
from addon.farm.remote_session import RemoteSession
from addon.farm.still import render_still, set_rounds
from addon.measure.schedule import CANCELLED, TIME, Schedule


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
