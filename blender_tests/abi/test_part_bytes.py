"""The bytes of a part, as a reader finds them that knows nothing but their description in lancer.h."""

import dataclasses

import numpy as np
import pytest
from part_reader import COMPONENTS, ReadPart, by_hand, color_of, xxh64
from picture_parts import OTHER_VALUES, all_of, joiner, opened, rendered, room
from tiny_scenes import overflowing

from addon.bindings import abi, marshal
from addon.bindings.enums import Integrator
from addon.bindings.session import Pass
from addon.bindings.structs import SETTINGS


@pytest.mark.parametrize("text, expected", [
    (b"", 0xEF46DB3751D8E999),
    (b"a", 0xD24EC4F1A98C6E5B),
    (b"abc", 0x44BC2CF5AD770999),
    (b"Nobody inspects the spammish repetition", 0xFBCEA83C8A378BF1),
])  # fmt: skip
def test_the_readers_checksum_is_xxh64(text, expected):
    """Published values of XXH64 with seed 0."""
    assert xxh64(text) == expected


@pytest.fixture
def read_and_told():
    """Return a part as the reader finds it, its bytes, and the statistics and passes of a session that has joined it.

    Tile 1 has no samples, tile 2 has no sample 0, and the tiles from 3 on have holes.
    """
    snapshot = room(13)
    with opened(snapshot) as worker, joiner(snapshot) as picture:
        tiles = range(3, len(worker.tiles()))
        picture.add(rendered(worker, [(0, 0, 13), (2, 3, 6), *((tile, 0, 5 + tile % 2) for tile in tiles)]))
        picture.add(rendered(worker, [(tile, 8, 5) for tile in tiles]))
        data = picture.export().tobytes()
        return ReadPart(data), data, picture.statistics(), {which: picture.read(which) for which in Pass}


def test_head_and_end(read_and_told):
    read, data, statistics, _ = read_and_told
    assert read.checksum == xxh64(data[:-8])
    assert read.rays == (statistics.camera_rays, statistics.bounce_rays, statistics.shadow_rays, statistics.vertices)
    assert sum(tile.count * len(tile.brightest) for tile in read.tiles) == read.about["samples"] == statistics.samples
    assert (read.about["tiles"], read.about["first"], read.about["end"]) == (len(read.tiles), 0, 13)


def test_sums_are_the_largest_subtrees(read_and_told):
    read, *_ = read_and_told
    sums = {tile.number: [(one.start, one.level) for one in tile.sums] for tile in read.tiles}
    after = [(8, 2), (12, 0)]
    assert list(sums) == [0, *range(2, max(sums) + 1)] and max(sums) > 6
    assert sums[0] == [(0, 3), *after]
    assert sums[2] == [(3, 0), (4, 2), (8, 0)]
    assert all(sums[tile] == [(0, 2), (4, 1 if tile % 2 else 0), *after] for tile in sums if tile > 2)
    assert [tile.number for tile in read.tiles if tile.first is None] == [2]


def test_pictures_follow_from_the_sums(read_and_told):
    read, _, _, images = read_and_told
    # Light of a component is divided by its colour, and mist and occlusion are clamped.
    light = {which for which in read.summed if which in COMPONENTS and color_of(which) != which}
    plain = set(read.summed) - light - {Pass.MIST, Pass.AMBIENT_OCCLUSION}
    assert Pass.COMBINED in plain and len(light) == 6 and len(plain) == 14
    for which in sorted(plain):
        np.testing.assert_array_equal(read.picture(which), images[which], which.name)
    # Without sample 0, a pixel has no depth and no index.
    for which in (Pass.DEPTH, Pass.POSITION, Pass.OBJECT_INDEX, Pass.MATERIAL_INDEX):
        found, image = read.picture(which), images[which]
        has = np.zeros(image.shape[:2], bool)
        for tile in read.tiles:
            has[read.place(tile.number)] = tile.first is not None
        np.testing.assert_array_equal(found[has], image[has], which.name)
        assert 0 < has.sum() < has.size and (image[~has] == (1e10 if which is Pass.DEPTH else 0.0)).all()


def test_only_what_passes_need_is_kept():
    """The colour that a component is divided by, and the passes of which halves are compared."""
    wanted = (Pass.GLOSSY_INDIRECT, Pass.NORMAL_HALVES, Pass.POSITION, Pass.ERROR)
    snapshot = room(2, passes=wanted)
    with opened(snapshot) as worker:
        read = ReadPart(rendered(worker, all_of(worker, 0, 2)))
        images = {which: worker.read(which) for which in (Pass.COMBINED, Pass.POSITION)}
    assert list(read.summed) == [Pass.COMBINED, Pass.GLOSSY_INDIRECT, Pass.GLOSSY_COLOR, Pass.DENOISING_NORMAL]
    assert (list(read.of_first), list(read.halves)) == ([Pass.POSITION], [Pass.NORMAL_HALVES])
    for which, image in images.items():
        np.testing.assert_array_equal(read.picture(which), image)


def test_sums_follow_from_single_samples():
    """So do the differences of their halves, the brightest samples, and the light of clamping and of the last bounces."""
    limits = {"clamp_indirect": 0.05, "clamp_direct": 0.05, "max_bounces": 2, "diffuse_bounces": 0, "no_reflections": True}
    snapshot = room(4, **limits)
    with opened(snapshot) as worker:
        single = [ReadPart(rendered(worker, all_of(worker, number, 1))) for number in range(4)]
        whole = ReadPart(rendered(worker, all_of(worker, 0, 4)))
    assert whole.rays == tuple(np.sum([one.rays for one in single], axis=0))
    assert whole.light == [sum(one.light[i] for one in single) for i in range(10)]
    # The room has no caustics, and neither Filter Glossy nor Fast GI.
    assert [light > 0 for light in whole.light] == [True, True, True, False, True, True, False, False, False, False]
    # The luminance of BT.709, with coefficients of 32 bits.
    weights = np.float32([0.2126, 0.7152, 0.0722]).astype(np.float64)
    assert whole.matte_kinds == 3 and whole.extra == 3 * 4 + 4 + 1
    for number, tile in enumerate(whole.tiles):
        ones = [one.tiles[number] for one in single]
        for kind in range(3):
            for pixel, sums in enumerate(tile.sums[0].mattes[kind]):
                terms = [one.sums[0].mattes[kind][pixel] for one in ones]
                alone = {key: [of.get(key, 0.0) for of in terms] for key in set().union(*terms)}
                assert sums == {key: (a + b) + (c + d) for key, (a, b, c, d) in alone.items()} and list(sums) == sorted(sums)
        channels = [one.sums[0].channels for one in ones]
        (sums,) = tile.sums
        np.testing.assert_array_equal(sums.channels, (channels[0] + channels[1]) + (channels[2] + channels[3]))
        halves = [(channels[i] + channels[i + 1]) / 2.0 for i in (0, 2)]
        earlier, later = ((half[:, :3] * weights).cumsum(axis=1)[:, 2] for half in halves)
        np.testing.assert_array_equal(sums.difference, (earlier - later).astype(np.float32))
        assert not ones[0].sums[0].difference.any() and sums.difference.any()
        pairs = ((Pass.HALVES, Pass.COMBINED), (Pass.ALBEDO_HALVES, Pass.ALBEDO), (Pass.NORMAL_HALVES, Pass.DENOISING_NORMAL))
        for which, of in pairs:
            apart = (halves[0] - halves[1])[:, whole.summed[of]][:, :3].astype(np.float32)
            np.testing.assert_array_equal(sums.halves[:, whole.halves[which]], apart)
        # Samples are of 32 bits, and so is the luminance of one.
        colors = np.abs([(one[:, :3].astype(np.float32) * np.float32(weights)).cumsum(axis=1)[:, 2] for one in channels])
        np.testing.assert_array_equal(tile.brightest, colors.max(axis=0))
        np.testing.assert_array_equal(tile.first, ones[0].first)


@pytest.mark.overflows
def test_dropped_samples_are_counted_by_the_width_of_their_number():
    snapshot = overflowing(18, samples=6, in_parts=True)
    with opened(snapshot) as worker:
        read = ReadPart(rendered(worker, all_of(worker, 0, 6)))
        found = 0
        for tile in read.tiles:
            places = [(s, y, x) for s in range(6) for y, x in zip(*map(list, read.place(tile.number)), strict=True)]
            invalid = [place for place in places if not np.isfinite(worker.debug_sample(place[2], place[1], place[0])[0]).all()]
            widths = [sum(s.bit_length() == width for s, _, _ in invalid) for width in range(4)]
            assert list(tile.dropped) == np.trim_zeros(widths, "b")
            assert tile.first_dropped == (min(invalid)[::-1] if invalid else ())
            found += len(invalid)
        assert 0 < found == worker.statistics().invalid_samples < read.about["samples"] / 2


# Settings that change no bit of a sample, or that a part tells for itself.
FREE = ("samples", "split_lights", "split_paths", "features", "threads", "tile_size", "refines")


def test_the_hash_is_of_all_that_decides_bits():
    snapshot = room()

    def read(**settings):
        with joiner(snapshot, **settings) as session:
            return ReadPart(session.export()).about

    about = read()
    fixed = about["settings"].copy()
    for name in FREE:
        fixed[name] = 0
    hashed = b"".join(one.tobytes() for one in (about["digest"], about["release"], about["camera"], fixed))
    assert about["hash"] == xxh64(hashed)
    assert about["release"].tobytes().rstrip(b"\0").decode() == abi.load_library().lancer_version().decode()
    for name in FREE[:-1]:
        assert read(**{name: 1 + getattr(snapshot.settings, name) % 2})["hash"] == about["hash"], name
    fixing = {name: OTHER_VALUES[kind] for name, (kind, _) in SETTINGS.items() if name not in (*FREE, "passes")}
    assert len(fixing) == len(SETTINGS) - len(FREE) - 1
    for name, value in {**fixing, "passes": (Pass.COMBINED,)}.items():
        assert read(**{name: value})["hash"] != about["hash"], name
    # CLASSIC renders a picture of one sample through the centres of pixels.
    classic = {samples: read(integrator=Integrator.CLASSIC, samples=samples)["hash"] for samples in (1, 2, 3)}
    assert classic[1] != classic[2] == classic[3]


def test_structs_are_written_without_padding():
    snapshot = room()
    assert by_hand(abi.Part).itemsize == np.dtype(abi.Part).itemsize
    with joiner(snapshot) as session:
        about = ReadPart(session.export()).about
    assert about["camera"].tobytes() == bytes(marshal.camera(snapshot.camera))
    told = dataclasses.replace(snapshot.settings, features=0, threads=0, tile_size=0)
    assert about["settings"].tobytes() == bytes(marshal.settings(told))
