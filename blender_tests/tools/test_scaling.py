"""`make scaling`: laws that the simulation of many machines obeys. Its costs here are round numbers."""

import dataclasses

import numpy as np
import pytest
from round_costs import DEAR, EQUAL, FREE

from addon.farm import remote_session
from tools.scaling import costs as terms
from tools.scaling.costs import Assumed, Spent, without
from tools.scaling.renderer import makespan, speeds
from tools.scaling.simulate import Case, simulate

# 240 tiles.
SMALL = Case(192, 160, 64, "combined", work=100.0)
TILES = 240


def test_one_worker_takes_the_sum_of_the_work():
    found = simulate(SMALL, 1, FREE, EQUAL)
    assert found.seconds == pytest.approx(100.0) and found.workers_busy == pytest.approx(1.0)
    assert found.samples == 64 and found.rounds[0][1:] == (0, 0)


@pytest.mark.parametrize("workers", [2, 8, 30])
def test_equal_workers_share_the_time(workers):
    """Before a worker has nothing to do, all have: that is at most a workers-th of the time. Each of the others then has a
    task in work and one in reserve. They are among the last tasks of a round, which last _LEAST_SECONDS or are one tile.
    """
    case = dataclasses.replace(SMALL, work=300.0)
    found = simulate(case, workers, FREE, EQUAL)
    last = 2.0 * (len(found.rounds) * remote_session._LEAST_SECONDS + case.work / TILES)
    # One worker takes as long as the work does: test_one_worker_takes_the_sum_of_the_work.
    assert case.work / workers <= found.seconds <= case.work / workers + last
    assert found.workers_busy * found.seconds * workers == pytest.approx(case.work)


@pytest.mark.parametrize("with_target", [False, True])
def test_no_sample_is_lost_or_comes_twice(with_target):
    """Workers are lost every second, some are slow, and pieces of tiles are joined by workers; the film refuses what it has."""
    case = dataclasses.replace(SMALL, width=64, height=48, with_target=with_target)
    rough = Assumed(threads=4, slow_share=0.2, lost_per_second=0.02, bytes_per_second=1e7)
    found = simulate(case, 30, DEAR, rough)
    assert found.lost > 5 and found.refused == 0
    # Joins, second attempts and repeated work come beside the parts.
    assert found.tasks > found.parts
    if with_target:
        assert 16 < found.samples < 64
    else:
        assert found.samples == 64


def test_equal_seeds_give_equal_figures():
    given = Case(96, 80, 16, "combined", work=50.0), 12, DEAR, Assumed(lost_per_second=0.01)
    once = simulate(*given, seed=3)
    assert once == simulate(*given, seed=3) and once != simulate(*given, seed=4)


@pytest.mark.parametrize(("term", "changes", "assumed"), [
    (terms.SCENE, {"prepare_seconds": 5.0, "pilot_samples": 1e5}, {}),
    (terms.NETWORK, {}, {"bytes_per_second": 2e5}),
    (terms.CLIENT, {"submit": Spent(0.05, 0.0, 0.0)}, {}),
    (terms.SCHEDULER, {"submit": Spent(0.0, 0.05, 0.0)}, {}),
    (terms.THREADS, {}, {"threads": 48}),
    (terms.WORKERS, {}, {"lost_per_second": 0.1}),
])  # fmt: skip
def test_a_term_takes_time_and_no_other_one_does(term, changes, assumed):
    """Without the term of what is changed, the time is that before the change; without all other terms, it stays long."""
    case = Case(96, 80, 16, "combined", work=50.0)
    costs, given = dataclasses.replace(FREE, **changes), dataclasses.replace(EQUAL, **assumed)
    plain, found = simulate(case, 8, FREE, EQUAL).seconds, simulate(case, 8, costs, given).seconds
    assert found > 1.1 * plain
    assert simulate(case, 8, *without(term, costs, given)).seconds == pytest.approx(plain)
    for other in terms.TERMS:
        if other != term:
            costs, given = without(other, costs, given)
    assert simulate(case, 8, costs, given).seconds > 0.9 * found


def test_other_terms_are_refused():
    with pytest.raises(ValueError):
        without("weather", FREE, EQUAL)


def test_the_simulation_follows_the_policy_of_the_farm(monkeypatch):
    before = simulate(SMALL, 8, FREE, EQUAL)
    monkeypatch.setattr(remote_session, "_LEAST_SECONDS", 2.0)
    after = simulate(SMALL, 8, FREE, EQUAL)
    assert after.parts < 0.7 * before.parts and after.workers_busy < before.workers_busy


def test_a_stuck_worker_does_not_keep_the_picture():
    """A worker is a thousand times slower: others get its tasks, too, after three times the time that tasks take."""
    stuck = Assumed(threads=1, spread=0.0, slow_share=0.125, slowness=1000.0, lost_per_second=0.0)
    found = simulate(SMALL, 8, FREE, stuck)
    # A task of 0.2 s would take it 200 s.
    assert found.seconds < 60.0


def test_a_slow_scheduler_or_client_limits_the_parts_of_a_second():
    costs = dataclasses.replace(FREE, submit=Spent(0.0, 0.05, 0.0))
    slow = simulate(SMALL, 32, costs, EQUAL)
    assert slow.scheduler_busy > 0.9 and slow.parts / slow.seconds < 1.0 / 0.05
    costs = dataclasses.replace(FREE, fetch=Spent(0.05, 0.0, 0.0), gather=Spent(0.05, 0.0, 0.0))
    slow = simulate(SMALL, 32, costs, EQUAL)
    assert slow.client["fetch"] > 0.7 * slow.seconds and slow.parts / slow.seconds < 1.0 / 0.05


def test_bytes_take_the_time_of_the_network():
    narrow = dataclasses.replace(EQUAL, bytes_per_second=1e5)
    found = simulate(SMALL, 8, FREE, narrow)
    # At least a sum of each pixel in each round, of 40 bytes, and 24 bytes of each tile; the client's link brings them one
    # after another.
    assert found.fetched >= len(found.rounds) * (192 * 160 * 40 + TILES * 24)
    assert found.seconds > found.fetched / 1e5


@pytest.mark.parametrize("threads", [1, 3, 16])
def test_equal_tiles_take_as_many_turns_as_they_need(threads):
    for tiles in (1, 15, 16, 17, 48):
        assert makespan(np.full(tiles, 2.0), threads) == 2.0 * -(-tiles // threads)


def test_tiles_are_taken_in_order_by_the_thread_that_ends_first():
    """List scheduling: the same tiles take 3 or 2 by their order, and never more than twice the best (Graham, 1966)."""
    assert makespan(np.array([1.0, 1.0, 2.0]), 2) == 3.0 and makespan(np.array([2.0, 1.0, 1.0]), 2) == 2.0
    assert makespan(np.array([3.0, 1.0, 1.0, 1.0]), 2) == 3.0 and makespan(np.array([5.0, 1.0, 3.0]), 1) == 9.0


def test_speeds_have_the_mean_1_and_some_are_slow():
    made = np.array(speeds(1000, Assumed()))
    assert made.mean() == pytest.approx(1.0)
    assert np.sum(made < 0.3) == 10
    # The standard deviation of a log-normal distribution's logarithm, without its slowest hundredth.
    assert np.std(np.log(made[10:])) == pytest.approx(0.2, rel=0.05)
