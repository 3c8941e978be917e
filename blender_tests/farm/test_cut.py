"""Rounds cut into tasks: every sample once, in tasks of about equal work that shrink towards the end."""

import math
import random

import numpy as np
import pytest

from addon.bindings.parts import RANGE
from addon.farm.cut import Round, whole_range


def ranges_of(rows):
    return np.array(rows, RANGE)


def drained(whole, workers, **limits):
    """Return all tasks of a round."""
    tasks = []
    while (task := whole.take(workers, **limits)) is not None:
        tasks.append(task)
    return tasks


def samples_of(ranges):
    """Return the samples of ranges as a sorted list of (tile, number)."""
    return sorted((tile, number) for tile, first, count in ranges.tolist() for number in range(first, first + count))


def random_round(chance):
    """Return ranges of some tiles, each at its own place, in random order, and the pixels of all tiles."""
    tiles = chance.randrange(1, 60)
    pixels = np.array([chance.choice((0, 1, 64, 127, 128, 128)) for _ in range(tiles)], np.uint32)
    chosen = chance.sample(range(tiles), chance.randrange(tiles + 1))
    return ranges_of([(tile, chance.choice((0, 1, 16, 96)), chance.choice((1, 2, 16, 37))) for tile in chosen]), pixels


@pytest.mark.parametrize("seed", range(40))
def test_every_sample_is_handed_out_once(seed):
    chance = random.Random(seed)
    ranges, pixels = random_round(chance)
    whole = Round(ranges, pixels, first_number=seed)
    with_pixels = ranges[pixels[ranges["tile"]] > 0]
    work = int((pixels[with_pixels["tile"]].astype(int) * with_pixels["count"]).sum())
    assert whole.samples == whole.left == work
    least = chance.choice((1, 500, 10**6))
    tasks = []
    while (task := whole.take(chance.randrange(9), least, chance.choice((math.inf, 2000)))) is not None:
        work -= task.samples
        assert whole.left == work and task.samples > 0
        tasks.append(task)
    assert whole.take(1) is None and whole.left == 0
    assert [task.number for task in tasks] == list(range(seed, seed + len(tasks))) and whole.number == seed + len(tasks)
    # The ranges keep their order, which is that of their gain.
    assert [row for task in tasks for row in task.ranges.tolist()] == with_pixels.tolist()
    for task in tasks:
        pieces = [task.piece(index) for index in range(task.pieces)]
        # Each piece has something to do, at most one range of a tile, and samples of its own.
        assert all(len(piece) and len(set(piece["tile"].tolist())) == len(piece) for piece in pieces)
        assert samples_of(np.concatenate(pieces)) == samples_of(task.ranges)
        assert task.samples == sum(int(pixels[tile]) * count for tile, _, count in task.ranges.tolist())


@pytest.mark.parametrize("workers", [1, 2, 7, 40])
def test_tasks_shrink_towards_the_end(workers):
    """A task is a third of a worker's share of what is left, and at last a single tile."""
    pixels = np.full(5000, 128, np.uint32)
    whole = Round(whole_range(4, 4, 5000), pixels)
    sizes, left = [], whole.left
    for task in drained(whole, workers):
        share = left / (3 * workers)
        assert task.samples <= max(share, 512) and task.samples > share - 512
        sizes.append(task.samples)
        left -= task.samples
    assert sizes == sorted(sizes, reverse=True) and sizes[-1] == 512
    # All workers have something to do from the first tasks to the last ones.
    assert sum(sizes[:workers]) < whole.samples / 2 and max(sizes[-workers:]) <= 2 * 512


def test_tasks_follow_the_number_of_workers():
    pixels = np.full(1000, 128, np.uint32)
    whole = Round(whole_range(0, 1, 1000), pixels)
    few, many = whole.take(1), whole.take(100)
    assert (few.samples, many.samples) == (333 * 128, 2 * 128)
    # Without any worker, the next one is waited for.
    assert whole.take(0).samples == (1000 - 333 - 2) // 3 * 128


@pytest.mark.parametrize("least, most", [(1, 1000), (3000, 1e9), (3000, 5000), (1, 1)])
def test_least_and_most_are_obeyed(least, most):
    """A task does not exceed most unless it is one tile, and falls below least by less than a tile, unless it is the last."""
    chance = random.Random(7)
    pixels = np.array([chance.randrange(1, 129) for _ in range(800)], np.uint32)
    whole = Round(whole_range(16, 4, 800), pixels)
    tasks = drained(whole, 3, least=least, most=most)
    assert all(task.samples <= most or len(task.ranges) == 1 for task in tasks)
    assert all(task.samples > least - 4 * 128 for task in tasks[:-1])
    assert sum(task.samples for task in tasks) == whole.samples and len(tasks) > 10


def test_most_counts_more_than_least():
    whole = Round(whole_range(0, 1, 100), np.full(100, 100, np.uint32))
    assert {task.samples for task in drained(whole, 2, least=5000, most=1000)} == {1000}


@pytest.mark.parametrize("tiles, workers", [(1, 1), (2, 8), (3, 40)])
def test_few_tiles_are_cut_along_their_samples(tiles, workers):
    """Pieces of a tile are as large as tasks would be, so that all workers have some."""
    whole = Round(whole_range(1024, 1024, tiles), np.full(tiles, 128, np.uint32))
    left, pieces = whole.left, 0
    for task in drained(whole, workers):
        share = left / (3 * workers)
        assert len(task.ranges) == 1 and task.pieces & (task.pieces - 1) == 0
        assert task.pieces == 64 or 1 <= task.pieces / (1024 * 128 / share) < 2
        counts = [int(task.piece(index)["count"][0]) for index in range(task.pieces)]
        assert max(counts) - min(counts) <= 1
        pieces += task.pieces
        left -= task.samples
    assert pieces >= min(3 * workers, 64)


@pytest.mark.parametrize("threads", [1, 4, 16])
def test_every_thread_of_a_worker_has_a_tile(threads):
    """Tasks have no fewer tiles than a worker has threads, but for the last one; pieces are as large as tasks would be."""
    whole = Round(whole_range(64, 64, 200), np.full(200, 128, np.uint32))
    tasks, left = [], whole.left
    while (task := whole.take(50, 1000, threads=threads)) is not None:
        share = max(1000, left / 150)
        assert len(task.ranges) >= threads or len(task.ranges) == len(whole.ranges) - sum(len(one.ranges) for one in tasks)
        assert task.pieces in (64, 1) or task.samples / task.pieces <= share < 2 * task.samples / task.pieces
        tasks.append(task)
        left -= task.samples
    assert len(tasks) > 10 and (threads == 1 or tasks[0].pieces > 1)
    assert samples_of(np.concatenate([one.ranges for one in tasks])) == samples_of(whole.ranges)


def test_tasks_have_equal_work_where_samples_take_unequal_times():
    seconds = np.where(np.arange(900) < 300, 1.0, 0.01)
    whole = Round(whole_range(8, 8, 900), np.full(900, 100, np.uint32))
    whole.time(seconds)
    assert whole.is_timed and whole.samples == whole.left == 900 * 800
    tasks, left = [], float(seconds.sum()) * 800.0
    while (task := whole.take(4, least=900.0, most=20000.0)) is not None:
        work = float(seconds[task.ranges["tile"]].sum()) * 800.0
        share = min(max(900.0, left / 12.0), 20000.0)
        assert share - 800.0 < work <= share + 1e-6 or whole.left == 0
        tasks.append(task)
        left -= work
    assert samples_of(np.concatenate([task.ranges for task in tasks])) == samples_of(whole.ranges)
    # The tasks before the last one are worth their way: many cheap tiles, where the first ones have few dear ones.
    assert len(tasks[-2].ranges) > 100 and len(tasks[2].ranges) < 50


def test_pieces_have_at_least_a_sample():
    (task,) = drained(Round(ranges_of([(0, 5, 3)]), np.array([128])), 50)
    assert task.pieces == 3 and [task.piece(index).tolist() for index in range(3)] == [[(0, 5 + i, 1)] for i in range(3)]


def test_a_task_of_several_tiles_is_in_one_piece():
    task = Round(whole_range(0, 64, 10), np.full(10, 128, np.uint32)).take(1)
    assert len(task.ranges) == 3 and task.pieces == 1


def test_the_last_samples_of_the_numbers_do_not_overflow():
    """Numbers of samples have 32 bits, products of them more."""
    whole = Round(whole_range(2**30, 2**30, 3), np.full(3, 65536, np.uint32))
    assert whole.samples == 3 * 2**46
    *_, task = drained(whole, 7)
    assert task.pieces > 20
    pieces = [task.piece(index) for index in range(task.pieces)]
    ends = [int(piece["first"][0]) + int(piece["count"][0]) for piece in pieces]
    assert ends == [int(piece["first"][0]) for piece in pieces[1:]] + [2**31]


def test_a_round_of_nothing_has_no_task():
    for rows in ([], [(1, 0, 5)]):
        whole = Round(ranges_of(rows), np.array([128, 0], np.uint32))
        assert (whole.take(3), whole.samples, whole.left) == (None, 0, 0)


def test_a_whole_range_has_every_tile():
    assert whole_range(3, 5, 3).tolist() == [(0, 3, 5), (1, 3, 5), (2, 3, 5)]
    assert whole_range(3, 5, 3).dtype == RANGE and len(whole_range(3, 5, 0)) == 0
