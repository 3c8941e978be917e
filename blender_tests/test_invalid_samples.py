"""Samples that are not finite: dropped, counted, told with their place, and there again when that place is replayed."""

import blenders
import numpy as np
import pytest
import tiny_scenes
from bindings.abi import LightKind, Pass
from bindings.session import Session
from bindings.snapshot import Camera, Light
from blenders import MODULE
from tiny_scenes import lambert, look_at, move, plane

SIDE, SAMPLES = 16, 4


def overflowing(**settings):
    """A floor right under a lamp: in its middle 1e30 W/sr over the square of 1e-6 m is beyond float's 3.4e38, beside it not."""
    lamp = Light("lamp", move(z=1e-6), LightKind.POINT, emission=(1e30,) * 3)
    camera = Camera(look_at((0.0, 0.0, 2.0), (0.0, 0.0, 0.0)), width=SIDE, height=SIDE, window=(-1e-4, 1e-4, -1e-4, 1e-4))
    return tiny_scenes.scene(
        [plane(0)], [lambert(0.5)], [lamp], camera=camera, **{"samples": SAMPLES, "threads": 2, **settings}
    )


@pytest.mark.overflows
def test_dropped_counted_and_replayed():
    with Session.upload(overflowing()) as session:
        assert session.render_all()
        statistics, film = session.statistics(), session.read().astype(float)
        replayed = np.zeros((SAMPLES, SIDE, SIDE, 4))
        for s in range(SAMPLES):
            for y in range(SIDE):
                for x in range(SIDE):
                    replayed[s, y, x] = session.debug_sample(x, y, s)[0]
    invalid = ~np.isfinite(replayed).all(axis=-1)
    # Some and not all, or the place told of could be any.
    assert 0 < invalid.sum() < invalid.size / 2
    assert statistics.invalid_samples == invalid.sum()
    assert invalid[statistics.invalid_sample, statistics.invalid_y, statistics.invalid_x]
    # What is dropped adds nothing, and all else is there: four float32 summed in double, rounded once, 6e-8 of the value.
    expected = np.where(invalid[..., None], 0.0, replayed).sum(axis=0) / SAMPLES
    assert np.isfinite(film).all() and np.allclose(film, expected, rtol=1.2e-7, atol=0.0)


@pytest.mark.overflows
def test_any_pass_makes_a_sample_invalid_and_none_shows_it():
    """The light passes overflow where the picture does; all passes stay finite and agree in what was dropped."""
    wanted = (Pass.COMBINED, Pass.DEPTH, Pass.DIFFUSE_DIRECT, Pass.DIFFUSE_COLOR, Pass.NORMAL)
    with Session.upload(overflowing(passes=wanted)) as session, Session.upload(overflowing()) as alone:
        assert session.render_all() and alone.render_all()
        assert session.statistics().invalid_samples == alone.statistics().invalid_samples > 0
        assert all(np.isfinite(session.read(which)).all() for which in wanted)


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
