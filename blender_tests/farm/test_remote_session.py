"""A picture of many workers has the bits of one session, whatever comes back, when, and how often."""

import dataclasses
import functools
import random
from collections import Counter

import numpy as np
import pytest
from given_pool import GivenPool
from picture_parts import different, finish, opened, rendered, told
from remote_pictures import PICTURES, expected, picture, rendered_by

from addon.bindings.abi import Status
from addon.bindings.session import Cancelled, LancerError, Pass, Session
from addon.bindings.snapshot import World
from addon.farm.pool import PoolError
from addon.farm.remote_session import RemoteSession
from addon.farm.still import render_still


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


# Wrong parts of workers, and the words of the refusal.
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
        # The picture keeps the parts that had come.
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
