"""Samples that are not finite: dropped, counted, reported with their pixel, and reproduced by a replay of the sample."""

import blenders
import numpy as np
import pytest
import tiny_scenes
from blenders import MODULE
from tiny_scenes import lambert, look_at, move, overflowing, plane, rotate_x

from addon.bindings.enums import LightKind, LobeKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Light, Lobe, Material

SIDE, SAMPLES = 16, 4


def replays(session, side, samples):
    """Return RGBA of each sample by itself, as (sample, y, x, 4)."""
    replayed = np.zeros((samples, side, side, 4))
    for s in range(samples):
        for y in range(side):
            for x in range(side):
                replayed[s, y, x] = session.debug_sample(x, y, s)[0]
    return replayed


def invalid_of(replayed):
    return ~np.isfinite(replayed).all(axis=-1)


def first_of(invalid):
    """Return (x, y, sample) of the first invalid sample, by sample and then by row."""
    sample, y, x = np.argwhere(invalid)[0]
    return x, y, sample


def place_in(statistics):
    return statistics.invalid_x, statistics.invalid_y, statistics.invalid_sample


@pytest.mark.overflows
def test_dropped_counted_and_replayed():
    with Session.upload(overflowing()) as session:
        assert session.render_all()
        statistics, film = session.statistics(), session.read().astype(float)
        replayed = replays(session, SIDE, SAMPLES)
    invalid = invalid_of(replayed)
    # Some samples are invalid but not all, so that the reported pixel matters.
    assert 0 < invalid.sum() < invalid.size / 2
    assert statistics.invalid_samples == invalid.sum()
    assert place_in(statistics) == first_of(invalid)
    # Dropped samples add nothing, all others count: four float32 summed in double and rounded once, 6e-8 of the value.
    expected = np.where(invalid[..., None], 0.0, replayed).sum(axis=0) / SAMPLES
    assert np.isfinite(film).all() and np.allclose(film, expected, rtol=1.2e-7, atol=0.0)


@pytest.mark.overflows
def test_any_pass_makes_a_sample_invalid_and_none_shows_it():
    """The light passes overflow where the picture does; all passes stay finite and drop the same samples."""
    wanted = (Pass.COMBINED, Pass.DEPTH, Pass.DIFFUSE_DIRECT, Pass.DIFFUSE_COLOR, Pass.NORMAL)
    with Session.upload(overflowing(passes=wanted)) as session, Session.upload(overflowing()) as alone:
        assert session.render_all() and alone.render_all()
        assert session.statistics().invalid_samples == alone.statistics().invalid_samples > 0
        assert all(np.isfinite(session.read(which)).all() for which in wanted)


def halves(side):
    """Return the number of each pixel's part, 0 to 7: squares of 16 pixels, each divided like a chessboard."""
    y, x = np.mgrid[:side, :side]
    return 2 * (2 * (y // 16) + x // 16) + (x + y) % 2


def finished(session):
    while not session.wait(0.05).finished:
        pass


@pytest.mark.overflows
def test_told_is_what_the_film_has_while_it_is_refined():
    side, tiles = 32, halves(32)
    with Session.upload(overflowing(side, target_error=0.1, samples=32)) as session:
        replayed = replays(session, side, 32)
        dropped = np.where(invalid_of(replayed)[..., None], 0.0, replayed)
        invalid = invalid_of(replayed)
        assert session.render_all(4)
        counts = np.full((side, side), 4)
        # One round of all pixels, then two rounds of the pixels with the largest error.
        for share in (0.0, 0.8, 0.8):
            assert session.refine(share * session.error().bound)
            finished(session)
            film = session.read().astype(float)
            for tile in range(8):
                inside = tiles == tile
                means = {n: dropped[:n].sum(axis=0)[inside] / n for n in (4, 8, 16, 32)}
                # Sums in double are rounded once to float32, by 6e-8 of the value.
                (count,) = [n for n, mean in means.items() if np.allclose(film[inside], mean, rtol=1.2e-7, atol=0.0)]
                counts[inside] = count
            error, statistics = session.error(), session.statistics()
            assert (counts.min(), counts.max()) == (error.least_samples, error.most_samples)
            taken = np.arange(32)[:, None, None] < counts
            assert statistics.invalid_samples == (invalid & taken).sum() > 0
            assert place_in(statistics) == first_of(invalid & taken)
        # The rounds must have refined only some pixels.
        assert error.least_samples < error.most_samples


@pytest.mark.overflows
def test_what_a_stopped_range_takes_back_is_not_told():
    with Session.upload(overflowing(target_error=0.1, samples=64)) as session:
        assert session.render_all(8)
        eight = session.statistics()
        session.render(8, 7)
        finished(session)
        assert session.statistics().invalid_samples > eight.invalid_samples
        session.stop()
        finished(session)
        assert session.error().most_samples == 8
        assert session.statistics().invalid_samples == eight.invalid_samples > 0
        assert place_in(session.statistics()) == place_in(eight)
        # Rendering the same samples again counts them once.
        session.render(8, 8)
        finished(session)
        with Session.upload(overflowing(samples=64)) as whole:
            assert whole.render_all(16)
            assert session.statistics().invalid_samples == whole.statistics().invalid_samples


@pytest.mark.overflows
@pytest.mark.parametrize("clamp", [0.0, 1.0])
def test_what_is_dropped_is_no_part_of_what_settings_take(clamp):
    """The floor in a mirror: light after two scatterings, which overflows in some pixels."""
    lamp = Light("lamp", move(z=1e-6), LightKind.POINT, emission=(1e30,) * 3)
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(1.0, 1.0, 1.0)),))
    camera = Camera(look_at((0.0, 0.0, 2.0), (0.0, 0.0, 4.0)), width=SIDE, height=SIDE, window=(-1e-4, 1e-4, -1e-4, 1e-4))
    floor_and_mirror = [plane(0), plane(1, move(z=4.0) @ rotate_x(np.pi))]
    snapshot = tiny_scenes.scene(
        floor_and_mirror, [lambert(0.5), mirror], [lamp], camera=camera, samples=4, max_bounces=3, clamp_indirect=clamp
    )
    with Session.upload(snapshot) as session:
        assert session.render_all()
        assert session.statistics().invalid_samples > 0
        error = session.error()
    # All light is indirect: clamping to 1 leaves less than 1e-30 of it.
    assert (error.clipped, error.missing) == ((1.0, 0.0) if clamp else (0.0, 0.0))


def test_a_finite_scene_reports_none():
    with Session.upload(tiny_scenes.showroom(16)) as session:
        assert session.render_all()
        statistics = session.statistics()
    assert (statistics.invalid_samples, statistics.invalid_x, statistics.invalid_y, statistics.invalid_sample) == (0, 0, 0, 0)


def test_blender_tells_the_place(tmp_path):
    got = blenders.run(MODULE, tmp_path, "overflow_cases", "told")
    assert got["error"] == "" and got["finite"]
    count, x, y, sample = (got["statistics"][name] for name in ("invalid_samples", "invalid_x", "invalid_y", "invalid_sample"))
    assert count > 0
    assert (
        f"{count} samples were not finite and are left out, the first at pixel ({x}, {y}), sample {sample}" in got["messages"]
    )


def test_a_case_that_does_not_say_so_may_drop_none(tmp_path):
    code, said, value = blenders.attempt(MODULE, tmp_path, "overflow_cases", "not_told")
    assert code != 0 and value is None and "samples were not finite" in said


def test_a_bake_tells_the_texel(tmp_path):
    got = blenders.run(MODULE, tmp_path, "overflow_cases", "baked")
    assert got["finite"]
    told = [text for text in got["messages"] if "not finite" in text]
    assert len(told) == 1 and "samples were not finite and are left out, the first at texel of 'Floor' (" in told[0]
