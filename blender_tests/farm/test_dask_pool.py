"""The road over Dask without Dask: a scheduler that is lost at a chosen moment."""

import pytest

from addon.farm import dask_pool
from addon.farm.cut import Task, whole_range


class Future:
    """Finished from the start."""

    status = "finished"

    def __init__(self, key):
        self.key = key

    def add_done_callback(self, act):
        act(self)


class Scheduler:
    """Lost while the first result comes, until reconnect()."""

    scene = "scene", None

    def __init__(self, *_):
        self.client, self.is_running, self.reconnects = self, True, 0

    def submit(self, function, *arguments, key, **options):
        return Future(key)

    def results(self, futures):
        if self.reconnects == 0:
            self.is_running = False
            raise ConnectionError("the scheduler is lost")
        return ["part" for _ in futures]

    def reconnect(self, poll):
        self.is_running = True
        self.reconnects += 1

    def workers(self):
        return ["one worker"]

    def choice(self):
        return None


@pytest.mark.parametrize("tasks", [1, 3])
def test_a_task_whose_result_is_lost_with_the_scheduler_begins_again(monkeypatch, tasks):
    monkeypatch.setattr(dask_pool, "Scheduler", Scheduler)
    pool = dask_pool.DaskPool("tcp://nowhere:1")
    for number in range(tasks):
        pool.submit(Task(number, whole_range(0, 1, 1), 1, 1), (1, 1))
    # Each look takes what has arrived; the first one loses the scheduler.
    found = [done for _ in range(1 + tasks) for done in pool.ended(0.01)]
    assert sorted(done.task.number for done in found) == list(range(tasks))
    assert {done.made for done in found} == {"part"} and pool.waiting == 0
