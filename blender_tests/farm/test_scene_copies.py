"""Copies of a scene on a scheduler's workers: which worker makes one, and from which other copy."""

import random
from types import SimpleNamespace

import pytest

from addon.farm import dask_scheduler, dask_tasks
from addon.farm.dask_tasks import Parcel


class Variable:
    def __init__(self, name, client):
        self.name = name

    def set(self, future):
        self.future = future


class Client:
    """Every call is noted; futures keep the status that the test gives them."""

    status = "running"

    def __init__(self, *_, **__):
        self.workers = {}
        self.sent = []  # addresses that got the bytes from this machine
        self.made = {}  # (address, parcel) of tasks, by their future's number

    def nthreads(self):
        return self.workers or {"first": 1}

    def scatter(self, data, workers, **_):
        self.sent += workers
        return SimpleNamespace(status="finished")

    def submit(self, function, parcel, workers, **_):
        future = SimpleNamespace(status="pending")
        self.made[id(future)] = workers[0], parcel
        return future


@pytest.fixture
def scheduler(monkeypatch):
    monkeypatch.setattr(dask_scheduler, "Client", Client)
    monkeypatch.setattr(dask_scheduler, "Variable", Variable)
    return dask_scheduler.Scheduler("tcp://nowhere:1", None, 0.0)


def look(scheduler, workers):
    scheduler.client.workers = dict.fromkeys(workers, 1)
    scheduler._looked = float("-inf")
    scheduler.workers()


def names(scheduler):
    return [copy.variable.name for copy in scheduler._copies]


def source(scheduler, copy):
    _, parcel = scheduler.client.made[id(copy.future)]
    return parcel.choose()


def test_new_copies_are_a_tree(scheduler):
    look(scheduler, many := [f"worker-{number}" for number in range(96)])
    scheduler.send("scene", b"bytes")
    look(scheduler, many)
    assert scheduler.client.sent == [many[0]] and len(scheduler._copies) == 2 + 96 // 16
    assert len({copy.address for copy in scheduler._copies}) == len(scheduler._copies)
    parents = [names(scheduler).index(source(scheduler, copy)) for copy in scheduler._copies[1:]]
    assert parents == [0, 0, 1, 1, 2, 2, 3]


def test_readers_take_leaves():
    drawn = {Parcel([f"copy {number}" for number in range(7)]).choose() for _ in range(200)}
    assert drawn == {f"copy {number}" for number in (3, 4, 5, 6)}
    assert Parcel(["copy"]).choose() == "copy"
    first, second = (Parcel(range(8)).choose(random.Random(3)) for _ in range(2))
    assert first == second


def test_a_lost_copy_comes_from_one_that_is_there(scheduler):
    look(scheduler, many := [f"worker-{number}" for number in range(32)])
    scheduler.send("scene", b"bytes")
    look(scheduler, many)
    bytes_here, one, two, three = scheduler._copies
    one.future.status = two.future.status = "finished"
    # The first copy and the source of the last one go with their workers; the last one is still being made.
    bytes_here.future.status = one.future.status = "lost"
    gone = {bytes_here.address, one.address}
    look(scheduler, [address for address in many if address not in gone])
    assert scheduler.client.sent == [many[0]], "the bytes went from this machine again"
    assert {source(scheduler, copy) for copy in (bytes_here, one)} == {two.variable.name}
    assert len({copy.address for copy in scheduler._copies} - gone) == 4 and three.future.status == "pending"


def test_the_bytes_are_sent_again_when_no_copy_is_there(scheduler):
    look(scheduler, ["a", "b"])
    scheduler.send("scene", b"bytes")
    look(scheduler, ["a", "b"])
    kept, made = scheduler._copies
    kept.future.status = "cancelled"
    look(scheduler, ["b", "c"])
    # The other copy is being made from the lost one.
    assert made.future.status == "pending" and scheduler.client.sent[1:] == ["b"] and kept.is_there


def test_a_reader_turns_to_another_copy_than_one_that_does_not_come(monkeypatch):
    """The copy may wait for the reader's own thread."""
    copies = {
        "there": SimpleNamespace(status="finished", result=lambda: b"bytes"),
        "pending": SimpleNamespace(status="pending"),
    }
    monkeypatch.setattr(dask_tasks, "Variable", lambda name, client: SimpleNamespace(get=lambda timeout: copies[name]))
    monkeypatch.setattr(dask_tasks, "get_client", lambda: None)
    monkeypatch.setattr(dask_tasks, "_LOYALTY", 0.0)
    monkeypatch.setattr(dask_tasks, "_LONGEST", 10.0)
    monkeypatch.setattr(dask_tasks, "_STEP", 0.001)
    assert Parcel(["there", "pending"])() == b"bytes"


def test_a_new_worker_makes_no_copy_while_others_can(scheduler):
    look(scheduler, ["a", "b", "c"])
    scheduler.send("scene", b"bytes")
    look(scheduler, ["a", "b", "c"])
    scheduler._prepared.update("abc")
    first, second = scheduler._copies
    second.future.status = "lost"
    rest = sorted({"a", "b", "c"} - {second.address})
    look(scheduler, ["0 new", *rest])
    assert second.address in rest
