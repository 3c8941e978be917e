"""The judge of `make parity`: its arithmetic without Blender, Cycles against itself, and the fast scenes by both engines."""

import importlib.util
import os

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM
from conftest import ROOT


def _load(name):
    """A file of scenes/parity by itself: the package around it needs bpy."""
    spec = importlib.util.spec_from_file_location(f"parity_{name}", os.path.join(ROOT, "scenes", "parity", f"{name}.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


figures = _load("figures")
EXACT, LOBES, PIXELS, FURNACE = (figures.KINDS[name] for name in ("EXACT", "LOBES", "PIXELS", "FURNACE"))


def _halves(picture, sigma=0.0, seed=0):
    source = np.random.default_rng(seed)
    return tuple(picture + sigma * source.standard_normal(picture.shape) for _ in range(2))


def _judge(ours, theirs, kind=EXACT, **noise):
    numbers = figures.measure(_halves(ours, **noise), _halves(theirs, **{**noise, "seed": 9}), kind)
    return numbers, figures.judge(numbers, kind.limit)


@pytest.fixture
def picture():
    y, x = np.mgrid[0:64, 0:96]
    return np.stack([0.2 + x / 96, 0.5 + 0.3 * np.sin(y / 9), 0.4 + 0.2 * np.cos(x / 7)], axis=-1)


def test_blocks_are_means(picture):
    got = figures.blocks(picture, 8)
    assert got.shape == (8, 12, 3)
    assert np.allclose(got[2, 3], picture[16:24, 24:32].mean(axis=(0, 1)), rtol=1e-12)
    ragged = figures.blocks(picture[:60, :90], 8)
    assert ragged.shape == (8, 12, 3)
    assert np.allclose(ragged[7, 11], picture[56:60, 88:90].mean(axis=(0, 1)), rtol=1e-12)


@pytest.mark.parametrize("kind", [EXACT, LOBES, PIXELS, FURNACE])
def test_equal_pictures_pass(picture, kind):
    numbers, verdict = _judge(picture, picture, kind)
    assert (numbers.mean, numbers.p99, verdict) == (0.0, 0.0, ("pass", True))


@pytest.mark.parametrize("factor, verdict", [(1.004, "pass"), (1.006, "fail"), (0.994, "fail")])
def test_general_difference(picture, factor, verdict):
    numbers, got = _judge(factor * picture, picture)
    assert numbers.mean == pytest.approx(abs(factor - 1), rel=1e-9)
    assert got.name == verdict


def test_one_wrong_corner_fails():
    """Two of 96 blocks are off, which the mean cannot see."""
    theirs = np.full((64, 96, 3), 0.5)
    ours = theirs.copy()
    ours[:8, :16] *= 1.019
    assert _judge(ours, theirs)[1].name == "pass"
    ours[:8, :16] = 1.021 * theirs[:8, :16]
    numbers, verdict = _judge(ours, theirs)
    assert numbers.mean < EXACT.limit.mean / 4 and verdict.name == "fail"


def test_wrong_channel_and_wrong_place_fail(picture):
    assert _judge(picture[..., ::-1], picture)[1].name == "fail"
    assert _judge(picture[:, ::-1], picture)[1].name == "fail"
    assert _judge(np.roll(picture, 1, axis=1), picture)[1].name == "fail"


def test_noise_is_told_from_difference(picture):
    """Noise of 8 % in each pixel is 1 % in a block: seen as noise, and no excuse for a difference of 10 %."""
    numbers, verdict = _judge(picture, picture, sigma=0.08 * picture.mean())
    # Two halves and two pictures make the difference as noisy as one half.
    assert numbers.sigma == pytest.approx(0.01, rel=0.15)
    assert numbers.noise_mean == pytest.approx(np.sqrt(2 / np.pi) * 0.01, rel=0.15)
    assert verdict == ("noise", False)
    assert _judge(1.1 * picture, picture, sigma=0.08 * picture.mean())[1].name == "fail"


def test_verdict_settles_only_beyond_noise(picture):
    near, _ = _judge(1.01 * picture, picture, sigma=0.08 * picture.mean())
    far, _ = _judge(1.5 * picture, picture, sigma=0.08 * picture.mean())
    assert not figures.hopeless(near, EXACT.limit) and figures.hopeless(far, EXACT.limit)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_pixel_that_is_no_number_fails(picture, bad):
    ours = picture.copy()
    ours[5, 7, 1] = bad
    assert _judge(ours, picture)[1].name == "fail"


def test_black_against_black_and_light_against_black():
    black = np.zeros((16, 16, 3))
    assert _judge(black, black)[1].name == "pass"
    assert _judge(black + 0.1, black)[1].name == "fail"
    assert _judge(black, black + 0.1)[1].name == "fail"


def test_furnace_judges_each_tile(picture):
    """A dark tile 1 % off fails, though it is nothing beside the bright ones."""
    theirs = np.ones((64, 80, 3))
    theirs[:16, :16] = 0.01
    ours = theirs.copy()
    ours[:16, :16] *= 1.01
    assert _judge(ours, theirs, EXACT)[1].name == "pass"
    assert _judge(ours, theirs, FURNACE)[1].name == "fail"


def test_scale_of_the_caller(picture):
    """A difference of 0.001 at distance 2 is 0.0005 there, whatever the picture's level."""
    distance = np.full((64, 96, 1), 2.0)
    numbers = figures.measure(_halves(picture + 0.001), _halves(picture), PIXELS, distance)
    assert numbers.mean == pytest.approx(0.0005, rel=1e-9)


def test_positions_are_judged_by_pixels(picture):
    ours = picture.copy()
    # Up to a hundredth of the pixels lies on outlines.
    ours[0, :50] += 1.0
    assert _judge(ours, picture, PIXELS._replace(limit=figures.Limit(1.0, 1e-4)))[1].name == "pass"
    assert _judge(picture + 2e-4 * picture.mean(), picture, PIXELS)[1].name == "fail"


# The real program takes the longest to start; it shows that the runner and the older rules work there.
@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_the_judge_finds_cycles_equal_to_itself(which, tmp_path):
    got = blenders.run(
        which, tmp_path, "parity_cases", "subset", "CYCLES", "point_soft,image_flat,camera_perspective,principled_alpha"
    )
    wrong = [line for line in got["lines"] if not line.startswith("pass")]
    assert got["counts"] == {"pass": 4}, "\n".join(wrong)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_fast_scenes(which, tmp_path):
    got = blenders.run(which, tmp_path, "parity_cases", "subset", "LANCER", "*")
    wrong = [line for line in got["lines"] if not line.startswith(("pass", "absent"))]
    assert not wrong and got["counts"]["pass"] >= 20, "\n".join(wrong)
