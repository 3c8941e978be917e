"""Parts of a picture in Python: joined in any order they give the bits of one session, and they tell what they belong to."""

import random

import numpy as np
import pytest
from part_reader import ReadPart
from picture_parts import OTHER_VALUES, all_of, different, finish, joiner, opened, rendered, room, told
from rich_snapshot import rich
from tiny_scenes import overflowing, scene, with_settings

from addon.bindings.enums import CameraKind, Features, Integrator, PixelFilter
from addon.bindings.parts import describe_part
from addon.bindings.session import LancerError, Pass, Session
from addon.bindings.snapshot import Camera, SceneSnapshot, Settings
from addon.bindings.structs import SETTINGS


def random_parts(worker, samples, chance):
    """Return parts of random ranges, in random order, which are all samples together; some parts are joins of others."""
    left = []
    for tile in range(len(worker.tiles())):
        cuts = sorted({0, samples, *(chance.randrange(samples) for _ in range(chance.randrange(4)))})
        left += [(tile, begin, end - begin) for begin, end in zip(cuts, cuts[1:], strict=False)]
    chance.shuffle(left)
    parts = []
    while left:
        # A session renders one range of a tile at a time.
        chosen = {}
        for one in left[: chance.randrange(1, 12)]:
            chosen.setdefault(one[0], one)
        left = [one for one in left if one not in chosen.values()]
        parts.append(rendered(worker, list(chosen.values())))
    while len(parts) > 4 and chance.random() < 0.7:
        chance.shuffle(parts)
        with joined(parts[:3]) as session:
            parts = [*parts[3:], session.export()]
    chance.shuffle(parts)
    return parts


def joined(parts):
    """Return a session that knows nothing but the parts."""
    about = describe_part(parts[0])
    session = Session.joiner(about.digest, about.camera, about.settings)
    for part in parts:
        session.add(part)
    return session


PICTURES = {
    "path": (room(), {}),
    "threads": (room(), {"threads": 3, "features": Features.ALL, "tile_size": 8}),
    "found splits": (room(16, split_lights=0, split_paths=0), {"threads": 2}),
    "one row": (room(9, (19, 1)), {}),
    "clamped": (room(clamp_indirect=0.2, max_bounces=2, pixel_filter=PixelFilter.BLACKMAN_HARRIS, filter_width=1.5), {}),
    "classic": (room(7, integrator=Integrator.CLASSIC), {"threads": 2}),
    "classic with one sample": (room(1, integrator=Integrator.CLASSIC), {}),
    "normals": (room(5, integrator=Integrator.NORMALS, passes=(Pass.COMBINED, Pass.ERROR)), {}),
    "background": (scene(world=(0.3, 0.2, 0.1), camera=room().camera, samples=6, in_parts=True), {}),
    "dropped": (overflowing(18, samples=9, in_parts=True), {"threads": 2}),
}


@pytest.mark.overflows
@pytest.mark.parametrize("name", PICTURES)
def test_parts_in_any_order_are_one_picture(name):
    """One session renders without parts, by tiles of another size; the others only ranges of it."""
    snapshot, others = PICTURES[name]
    samples = snapshot.settings.samples
    with Session.upload(with_settings(snapshot, in_parts=False, tile_size=32, threads=2)) as whole:
        whole.render_all()
        expected = told(whole)
    assert (expected["invalid_samples"] > 0) == (name == "dropped")
    with opened(snapshot) as session, opened(snapshot, **others) as worker:
        session.render_all()
        assert different(told(session), expected) == []
        for seed in range(3):
            parts = random_parts(worker, samples, random.Random(seed))
            with joined(parts) as picture:
                assert different(told(picture), expected) == []
                assert picture.export().tobytes() == session.export().tobytes()


def test_a_session_that_renders_takes_parts_and_goes_on():
    snapshot = room(12)
    with opened(snapshot) as whole, opened(snapshot) as worker, opened(snapshot) as session:
        whole.render_all()
        session.add(rendered(worker, all_of(worker, 0, 5)).tobytes())
        session.render(5, 7)
        finish(session)
        assert different(told(session), told(whole)) == []


def test_planned_rounds_are_the_rounds_of_one_session():
    snapshot = room(32, (40, 36), passes=(Pass.COMBINED, Pass.ERROR, Pass.HALVES))
    with opened(snapshot) as whole, opened(snapshot) as worker, joiner(snapshot) as picture:
        whole.render_all(4)
        picture.add(rendered(worker, all_of(worker, 0, 4)))
        doubled = []
        while len(ranges := picture.plan(0.9 * picture.error().bound, 0.9)):
            assert whole.refine(0.9 * whole.error().bound, 0.9)
            finish(whole)
            for one in ranges[::-1]:
                picture.add(rendered(worker, [one]))
            assert different(told(picture), told(whole)) == []
            doubled.append(len(ranges))
        assert whole.refine(0.0) is False
        # Some rounds must have chosen among the tiles.
        assert len(doubled) > 3 and min(doubled) < len(worker.tiles())


def test_splits_are_decided_once_and_told_by_parts():
    snapshot = room(16, split_lights=0, split_paths=0)
    with opened(snapshot) as decider, opened(snapshot) as worker, joiner(snapshot) as picture:
        assert (decider.statistics().split_lights, decider.statistics().split_paths) == (0, 0)
        decider.decide()
        finish(decider)
        decided = decider.statistics()
        assert decided.samples == 0 and decided.split_lights * decided.split_paths > 1
        part = rendered(worker, all_of(worker, 3, 2))
        about = describe_part(part)
        picture.add(part)
        used = picture.statistics()
    for one in (about.settings, used):
        assert (one.split_lights, one.split_paths) == (decided.split_lights, decided.split_paths)


def test_a_cleared_session_has_no_samples():
    snapshot = room()
    with opened(snapshot) as worker, joiner(snapshot) as fresh:
        once = rendered(worker, all_of(worker, 2, 3)).tobytes()
        worker.clear()
        # The numbers of lights and paths stay.
        assert different(told(worker), told(fresh)) == ["split_lights", "split_paths"]
        assert rendered(worker, all_of(worker, 2, 3)).tobytes() == once


def test_a_part_of_a_loaded_snapshot_fits(tmp_path):
    snapshot = with_settings(rich(), in_parts=True, samples=2, threads=1)
    snapshot.save(tmp_path / "scene.npz")
    with opened(snapshot) as one, opened(SceneSnapshot.load(tmp_path / "scene.npz")) as other, joiner(snapshot) as picture:
        one.render_all(2)
        picture.add(rendered(other, all_of(other, 1, 1)))
        picture.add(rendered(one, all_of(one, 0, 1)))
        one.clear()
        one.render_all(2)
        assert different(told(picture), told(one)) == []


CAMERAS = {
    "plain": Camera(width=7, height=5),
    "region": Camera(width=40, height=30, x=3, y=4, region_width=17, region_height=9, lens_radius=0.1, aperture_blades=5),
    "panorama": Camera(
        np.diag([1.0, 1.0, -1.0, 1.0]), CameraKind.EQUIRECTANGULAR, 8, 4, window=(0.0, 1.0, 0.25, 0.75),
        panorama=(-1.25, 1.5, -3.0, 3.0, 0.1, 0.2, 0.3, 0.4), clip_start=0.125, clip_end=99.0, focal_distance=3.0,
        aperture_rotation=0.3, aperture_ratio=1.7,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CAMERAS)
def test_a_part_tells_camera_and_settings(name):
    given = {name: OTHER_VALUES[kind] for name, (kind, _) in SETTINGS.items() if name not in ("passes", "refines")}
    assert all(given[name] != default for name, (_, default) in SETTINGS.items() if name in given)
    settings = Settings(**given, passes=(Pass.COMBINED, Pass.DEPTH, Pass.NORMAL_HALVES), in_parts=True)
    digest = bytes(range(32))
    with Session.joiner(digest, CAMERAS[name], settings) as session:
        about = describe_part(session.export())
    assert (about.digest, about.camera) == (digest, CAMERAS[name])
    # A part does not tell settings that change no bit.
    assert about.settings == settings.replaced(features=0, threads=0, tile_size=0)
    assert (about.samples, about.tiles, about.first, about.end) == (0, 0, 0, 0)
    with Session.joiner(about.digest, about.camera, about.settings) as again:
        assert describe_part(again.export()) == about


def test_a_part_tells_its_samples():
    with opened(room()) as worker:
        pixels = worker.tiles().astype(int)
        about = describe_part(rendered(worker, [(6, 9, 1), (0, 3, 4), (3, 0, 6)]))
    assert (about.tiles, about.first, about.end) == (3, 0, 10)
    assert about.samples == pixels[6] + 4 * pixels[0] + 6 * pixels[3]


@pytest.mark.parametrize("size", [(21, 18), (16, 16), (33, 1), (1, 36)])
def test_tiles_are_all_pixels(size):
    """Squares of 16 pixels, each of them the two colours of a chessboard."""
    with joiner(room(size=size)) as session:
        tiles = session.tiles()
        read = ReadPart(session.export())
    assert tiles.dtype == np.uint32 and len(tiles) == 2 * -(-size[0] // 16) * -(-size[1] // 16)
    assert [len(read.place(number)[0]) for number in range(len(tiles))] == tiles.tolist()
    assert tiles.sum() == size[0] * size[1]


def spoiled(part, place):
    copy = part.copy()
    copy[place] ^= 1
    return copy


def test_a_part_that_does_not_fit_changes_nothing():
    snapshot = room()
    with opened(snapshot) as worker, opened(snapshot, seed=5) as other, joiner(snapshot) as picture:
        part, foreign = rendered(worker, [(0, 0, 4), (2, 2, 3)]), rendered(other, [(1, 0, 4)])
        picture.add(memoryview(part))
        before = picture.export().tobytes()
        refused = {
            "the session has them already": part,
            "seed is 5, the session's 0": foreign,
            "no part": b"",
            "incomplete": part[:-1],
            "damaged": spoiled(part, len(part) // 2),
            "is damaged": spoiled(part, len(part) - 1),
        }
        for words, wrong in refused.items():
            with pytest.raises(LancerError, match=words):
                picture.add(wrong)
            assert picture.export().tobytes() == before, words
        for wrong in list(refused.values())[2:]:
            with pytest.raises(LancerError, match="^part: "):
                describe_part(wrong)
