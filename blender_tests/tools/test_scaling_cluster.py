"""The simulated time, scheduler, workers and client of `make scaling`."""

import dataclasses
from concurrent.futures import CancelledError

import pytest
from round_costs import DEAR, EQUAL

from addon.farm import dask_tasks
from addon.farm.cut import whole_range
from tools.scaling.client import Client, Ledger
from tools.scaling.clock import Clock, Queues, Server, Stalled
from tools.scaling.cluster import Cluster
from tools.scaling.film import Plane
from tools.scaling.renderer import Picture, Renderer


def test_events_happen_in_order_of_time_and_equal_ones_in_that_of_their_call():
    clock, seen = Clock(), []
    for number, seconds in enumerate((2.0, 1.0, 2.0, 0.0)):
        clock.after(seconds, lambda number=number: seen.append((number, clock.elapsed)))
    clock.after(1.0, lambda: clock.after(0.5, lambda: seen.append(("later", clock.elapsed))))
    clock.advance(1.9)
    assert seen == [(3, 0.0), (1, 1.0), ("later", 1.5)] and clock.elapsed == pytest.approx(1.9)
    clock.advance(1.0)
    assert seen[3:] == [(0, 2.0), (2, 2.0)] and clock.elapsed == pytest.approx(2.9)


def test_waiting_ends_with_the_event_with_its_time_or_with_an_error():
    clock, seen = Clock(), []
    clock.after(3.0, lambda: seen.append(True))
    assert not clock.wait(lambda: seen, 2.0) and clock.elapsed == 2.0
    assert clock.wait(lambda: seen, 2.0) and clock.elapsed == 3.0
    with pytest.raises(Stalled):
        clock.wait(lambda: False)
    queue = Queues(clock).Queue()
    clock.after(1.0, lambda: queue.put("part"))
    with pytest.raises(Queues.Empty):
        queue.get_nowait()
    assert queue.get(timeout=9.0) == "part" and clock.elapsed == 4.0
    with pytest.raises(Queues.Empty):
        queue.get(timeout=2.0)
    assert clock.elapsed == 6.0


def test_a_server_does_one_thing_at_a_time():
    clock, ends = Clock(), []
    server = Server(clock)
    for seconds in (2.0, 3.0):
        server.serve(seconds, lambda: ends.append(clock.elapsed))
    clock.advance(10.0)
    server.serve(1.0, lambda: ends.append(clock.elapsed))
    clock.advance(1.0)
    assert ends == [2.0, 5.0, 11.0] and server.busy == 6.0


def machines(count, costs=DEAR, assumed=EQUAL):
    """Return a simulated cluster, and its client."""
    clock = Clock()
    cluster = Cluster(clock, costs, assumed, 1)
    picture = Picture(Plane(64, 64, [[1.0]], [[1.0]]), "combined", 4096.0, costs, assumed)
    for number in range(count):
        cluster.add(Renderer(number, 1.0, picture, clock, cluster))
    return cluster, Client(cluster, Ledger(clock), 0)


def test_parts_that_are_fetched_at_once_share_the_waiting():
    """All ways bring the same; one after another, each part waits for the scheduler and its worker."""
    seconds = []
    for at_once, in_turn in ((False, True), (True, True), (False, False)):
        cluster, client = machines(1, assumed=dataclasses.replace(EQUAL, in_turn=in_turn))
        futures = [client.scatter(None, list(cluster.machines)) for _ in range(10)]
        for number, future in enumerate(futures):
            future.work.result, future.work.is_told = number, True
        before = cluster.clock.now
        found = client.gather(futures) if at_once else [future.result() for future in futures]
        seconds.append(cluster.clock.now - before)
        assert found == list(range(10))
    assert seconds[0] == pytest.approx(10 * 3.5e-3)
    assert seconds[1] == pytest.approx(10 * 2.5e-4 + 2e-4)
    # A client that need not wait spends its own time only.
    assert seconds[2] == pytest.approx(10 * 2e-3)


def rendered(client, count, seconds=1):
    """Return futures of that many tasks, each of all tiles for some samples: of a second each."""
    ranges = [whole_range(i * seconds, seconds, 32) for i in range(count)]
    return [client.submit(dask_tasks.render, "scene", None, (1, 1), some, pure=False) for some in ranges]


def test_an_idle_worker_takes_what_waits_at_another():
    """A second worker comes while the first one has a task in work and one in reserve, each of 10 s."""
    cluster, client = machines(1)
    futures = rendered(client, 2, 10)
    cluster.clock.advance(1.5)
    (first,) = cluster.machines.values()
    cluster.add(Renderer(1, 1.0, first.picture, cluster.clock, cluster))
    cluster.clock.advance(14.0)
    assert len({one.result().by for one in futures}) == 2 and cluster.moved == 1


def test_cancelled_parts_are_skipped_or_refused():
    """As by distributed's Client.gather."""
    cluster, client = machines(2)
    futures = rendered(client, 3)
    client.cancel(futures[1:2])
    with pytest.raises(CancelledError):
        client.gather(futures)
    with pytest.raises(CancelledError):
        futures[1].result()
    parts = client.gather(futures, errors="skip", direct=True)
    assert [one.part.ranges["first"][0] for one in parts] == [0, 2] and futures[1].status == "cancelled"


def test_others_do_the_work_of_a_lost_worker():
    """The lost one has a part that nobody has fetched, a task in work, and one in reserve."""
    cluster, client = machines(3)
    futures = rendered(client, 9)
    cluster.clock.advance(2.5)
    lost = next(machine for machine in cluster.machines.values() if machine.has and machine.running)
    assert len(lost.assigned) == 2
    cluster.lose(lost)
    made = client.gather(futures)
    assert sorted(one.part.ranges["first"][0] for one in made) == list(range(9))
    assert lost.address not in {maker for one in made for maker in one.by} and len(cluster.machines) == 2


def test_the_machines_tell_their_threads():
    _, client = machines(2, assumed=dataclasses.replace(EQUAL, threads=12))
    assert set(client.nthreads().values()) == {12}
    assert client.submit(dask_tasks.decide, "scene", None, pure=False).result().figures["threads"] == 12
