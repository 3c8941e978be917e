"""The fit of `make pilot` on synthetic times, and the weights that it reads from the core."""

import numpy as np
import pytest

from tools.pilot import fit, run

TRUE = np.array([4.0, 20.0, 15.0])
SPLITS = ((1, 1), (4, 1), (1, 4), (4, 4))


def synthetic(noise=0.0, scenes=20, seed=1):
    """Returns (counts, seconds, scenes) of scenes with speeds that differ up to a thousandfold."""
    rng = np.random.default_rng(seed)
    counts, seconds, names = [], [], []
    for scene in range(scenes):
        vertices, shadows, speed = rng.uniform(0.5, 6.0), rng.uniform(0.1, 1.0), 10.0 ** rng.uniform(-9.0, -6.0)
        for lights, paths in SPLITS:
            met = 1.0 + (vertices - 1.0) * paths if vertices > 1.0 else vertices
            count = 1e6 * np.array([1.0, met - min(vertices, 1.0) + shadows * (lights + met - 1.0), met])
            counts.append(np.maximum(count, 1.0))
            seconds.append(speed * (counts[-1] @ TRUE) * np.exp(noise * rng.standard_normal()))
            names.append(scene)
    return np.array(counts), np.array(seconds), np.array(names)


def test_exact_times_give_the_weights():
    counts, seconds, scenes = synthetic()
    found = fit.fit(counts, seconds, scenes, (1.0, 20.0, 1.0), fixed=1)
    np.testing.assert_allclose(found.weights, TRUE, rtol=1e-6)
    assert found.deviation < 1e-9


def test_errors_cover_the_weights():
    """Over 100 draws of 10 % noise, deviations over their standard errors have the spread 1."""
    ratios, spreads = [], []
    for seed in range(100):
        found = fit.fit(*synthetic(0.1, seed=seed), (1.0, 20.0, 1.0), fixed=1)
        ratios.append((found.weights - TRUE)[[0, 2]] / found.errors[[0, 2]])
        spreads.append(found.deviation)
    # The mean of 100 squares of a Gaussian variable has the standard deviation sqrt(2 / 100); the bound is four of them.
    assert np.all(np.abs(np.mean(np.square(ratios), axis=0) - 1.0) < 0.57), ratios
    # 58 degrees of freedom a draw: the mean of 100 spreads has the standard deviation 0.1 / sqrt(2 * 58 * 100), and the root of
    # a variance the bias 1 - 1 / (4 * 58); the bound is four standard deviations.
    assert abs(np.mean(spreads) - 0.0996) < 0.0038, np.mean(spreads)


def test_another_speed_of_a_scene_changes_nothing():
    counts, seconds, scenes = synthetic(0.1)
    slower = seconds * np.where(scenes == 3, 50.0, 1.0)
    a, b = (fit.fit(counts, each, scenes, TRUE, fixed=1) for each in (seconds, slower))
    np.testing.assert_allclose(a.weights, b.weights, rtol=1e-6)


@pytest.mark.parametrize("runs", [2, 4])
def test_too_little_is_refused(runs):
    """Fewer runs than unknowns, and equal counts in all runs."""
    counts, seconds, scenes = np.tile(TRUE, (runs, 1)), np.ones(runs), np.zeros(runs, int)
    with pytest.raises(ValueError, match="determine"):
        fit.fit(counts, seconds, scenes, TRUE, fixed=1)


def test_source_has_the_weights():
    assert np.all(run.weights_of_source() > 0)


def test_report_names_source_and_fit():
    lines = list(run.report(*synthetic(0.05)))
    assert [line.split()[0] for line in lines[1:4]] == list(run.WEIGHTS)
    assert lines[2].endswith("fixed") and lines[-1].startswith("standard deviation")
