"""The simulated film and its parts beside the library's: equal tiles, sizes, refusals and planned ranges."""

import dataclasses
import random
from types import SimpleNamespace

import numpy as np
import picture_parts
import pytest
from part_reader import ReadPart, xxh64

from addon.bindings.abi import LancerError, Pass
from addon.bindings.parts import RANGE, describe_part
from addon.denoise import view_layer
from tools.scaling.costs import PartCosts
from tools.scaling.film import Film, Plane
from tools.scaling.measure_core import sizes
from tools.scaling.parts import joined, part_of, sums_of

# A picture of 2 x 2 squares, of which only the first is whole, and the last has an odd number of pixels.
WIDTH, HEIGHT = 21, 17
PLANE = Plane(WIDTH, HEIGHT, [[1.0]], [[1.0]])
FREE = PartCosts(0, 40, 0, 0, *[0.0] * 8)


def ranges_of(*rows):
    return np.array(list(rows), RANGE)


def film_of(plane, costs=FREE):
    return Film(plane, costs, lambda seconds, kind: None)


def part(*rows):
    return part_of(ranges_of(*rows), PLANE.pixels, FREE)


@pytest.fixture(scope="module")
def measured():
    """Return by passes: (a session, the PartCosts that its parts tell)."""
    made = {}
    for passes in ((Pass.COMBINED,), (Pass.COMBINED, *view_layer.PASSES)):
        plain = {"mattes": 0, "light_groups": 0, "aov_colors": 0, "aov_values": 0}
        snapshot = picture_parts.room(size=(WIDTH, HEIGHT), passes=passes, **plain)
        with picture_parts.opened(snapshot) as session:

            def size(first, count, session=session):
                return picture_parts.rendered(session, [(0, first, count)]).nbytes

            head = session.export().nbytes
            told = sizes(head, int(session.tiles()[0]), size)
            renders = [(0, 0, 5), (1, 3, 13), (3, 4, 4), (5, 1, 2), (7, 0, 1)], [(2, 6, 10)], [(4, 0, 8), (6, 8, 8)]
            parts = [picture_parts.rendered(session, rows) for rows in renders]
            made[len(passes)] = SimpleNamespace(
                tiles=session.tiles(),
                costs=dataclasses.replace(FREE, head_bytes=head, **told),
                parts=[(ranges_of(*rows), one) for rows, one in zip(renders, parts, strict=True)],
            )
    return made


def test_tiles_are_those_of_the_library(measured):
    for one in measured.values():
        assert one.tiles.tolist() == PLANE.pixels.tolist()


def test_parts_have_the_bytes_of_real_ones(measured):
    """The costs are read from parts of one whole tile; all others follow from lancer.h."""
    assert measured[1].costs.sum_bytes == 36 and measured[1].costs.tile_bytes == 4
    for one in measured.values():
        for ranges, real in one.parts:
            assert part_of(ranges, PLANE.pixels, one.costs).nbytes == real.nbytes


def test_parts_are_described_as_real_ones(measured):
    film = film_of(PLANE)
    for ranges, real in measured[1].parts:
        told, about = film.describe(part_of(ranges, PLANE.pixels, FREE)), describe_part(real)
        assert vars(told) == {name: getattr(about, name) for name in vars(told)}


@pytest.mark.parametrize(("first", "count", "sums"), [
    (0, 1, 1), (0, 8, 1), (8, 8, 1), (3, 5, 2), (5, 12, 4), (16, 21, 3), (0, 2**31 - 1, 31), (2**30, 2**30, 1),
])  # fmt: skip
def test_samples_are_in_aligned_sums(first, count, sums):
    """5 ... 16: one of sample 5, two of 6 and 7 ... the sums of a binary counter from either end."""
    assert sums_of(ranges_of((0, first, count)))[0] == sums


def test_joined_pieces_are_one_range_and_others_stay_apart():
    one = joined([ranges_of((0, 2, 2), (4, 0, 3)), ranges_of((0, 0, 2), (4, 8, 8)), ranges_of((0, 4, 1))])
    assert one.tolist() == [(0, 0, 5), (4, 0, 3), (4, 8, 8)]


@pytest.mark.parametrize("seed", range(5))
def test_parts_come_in_any_order(seed):
    """The library's film and this one take the same parts in the same random order, and refuse the same ones."""
    chance = random.Random(seed)
    snapshot = picture_parts.room(size=(WIDTH, HEIGHT), passes=(Pass.COMBINED,))
    rows = [(tile, first, count) for tile in range(8) for first, count in ((0, 1), (1, 1), (2, 2), (4, 3), (7, 2))]
    rows += [(chance.randrange(8), 3, 2) for _ in range(3)]
    chance.shuffle(rows)
    film, refused = film_of(PLANE), 0
    with picture_parts.opened(snapshot) as session, picture_parts.joiner(snapshot) as real:
        for row in rows:
            answers = []
            for one, made in ((film, part(row)), (real, picture_parts.rendered(session, [row]))):
                try:
                    one.add(made)
                    answers.append(True)
                except LancerError:
                    answers.append(False)
            assert answers[0] == answers[1]
            refused += not answers[0]
            assert film.statistics().samples == real.statistics().samples
            ours, theirs = film.error(), real.error()
            assert (ours.known, ours.least_samples, ours.most_samples) == (
                theirs.known,
                theirs.least_samples,
                theirs.most_samples,
            )
    assert refused >= 3


def test_a_refused_part_changes_nothing():
    film = film_of(PLANE)
    film.add(part((0, 0, 4), (1, 8, 8)))
    with pytest.raises(LancerError, match="samples that the session has already"):
        film.add(part((0, 4, 4), (1, 4, 8)))
    assert film.counts[:2].tolist() == [4, 8]
    film.add(part((0, 4, 4), (1, 0, 8)))
    assert film.counts[:2].tolist() == [8, 16]


# Squares of an even noise that is small beside the differences of brightness of neighbours, also of diagonal ones: so the
# library shares no noise between squares.
ROWS, COLUMNS = 3, 5
NOISE = 0.01 * np.array([0.31, 0.02, 0.11, 0.72, 0.0057, 0.043, 0.9, 0.23, 0.017, 0.066, 0.5, 0.0033, 0.15, 0.0081, 0.4])
LEVEL = 3.0 ** (np.arange(ROWS * COLUMNS) % 7)
# Samples of the even and the odd half of each square; the last row and column are of narrower squares.
COUNTS = (2, 4)
NOISY = Plane(16 * COLUMNS - 11, 16 * ROWS - 6, [[1.0]], NOISE.reshape(ROWS, COLUMNS))


def noisy_part():
    """Return a snapshot, and a part of its picture whose sums have the LEVEL and NOISE of their squares."""
    snapshot = picture_parts.room(samples=1 << 20, size=(NOISY.width, NOISY.height), passes=(Pass.COMBINED,))
    snapshot = dataclasses.replace(snapshot, camera=dataclasses.replace(snapshot.camera, x=0, y=0, width=96, height=54))
    with picture_parts.opened(snapshot) as session:
        rows = [(tile, 0, COUNTS[tile % 2]) for tile in range(len(session.tiles()))]
        read = ReadPart(picture_parts.rendered(session, rows))
    data = np.frombuffer(read._data, np.uint8)
    made, start = data.copy(), data.__array_interface__["data"][0]

    def put(array, values):
        at = array.__array_interface__["data"][0] - start
        made[at : at + array.nbytes].view(array.dtype).reshape(array.shape)[:] = values

    # The level to which noise is relative: with a hundredth of the mean of the picture.
    level = LEVEL + 0.01 * np.average(np.repeat(LEVEL, 2), weights=NOISY.pixels)
    for tile in read.tiles:
        (sums,), square = tile.sums, tile.number // 2
        put(sums.channels, LEVEL[square] * tile.count)
        # A pixel's variance is a quarter of the squared difference, for all its samples.
        put(sums.difference, 2.0 * level[square] * np.sqrt(NOISE[square] / tile.count))
        put(tile.brightest, LEVEL[square])
    made[-8:] = np.frombuffer(xxh64(made[:-8].tobytes()).to_bytes(8, "little"), np.uint8)
    return snapshot, made


def test_planned_ranges_are_those_of_the_library():
    snapshot, data = noisy_part()
    film = film_of(NOISY)
    film.add(part_of(ranges_of(*((tile, 0, COUNTS[tile % 2]) for tile in range(len(NOISY.pixels)))), NOISY.pixels, FREE))
    numbers = set()
    with picture_parts.joiner(snapshot) as real:
        real.add(data)
        told = real.error()
        assert told.error == pytest.approx(film.error().error, rel=1e-5)
        # An even half doubled once gains as much as its odd half at the start: these shares do not end between the two.
        for share in (0.885, 0.718, 0.455, 0.1):
            # The library's target is for the bound of the error, the film's for the error itself.
            planned = real.plan(share * told.bound)
            assert film.plan(share * told.error).tolist() == planned.tolist()
            numbers.add(len(planned))
    assert len(numbers) == 4 and max(numbers) == len(NOISY.pixels)
