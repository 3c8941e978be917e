"""Figures of denoised pictures at equal time."""

import numpy as np
import pytest

from tools.harness import denoised
from tools.harness.displayed import Displayed, displayed


def curve(speed, error):
    """Squared error and FLIP that fall as one over the samples, and over their root."""
    return [
        {"samples": n, "seconds": 0.5 + n / speed, "square": error / n, "flip": (error / n) ** 0.5} for n in denoised.COUNTS
    ]


def test_errors_are_compared_at_equal_time():
    ours, theirs = curve(40.0, 1.0), curve(20.0, 2.0)
    found = denoised.compared(ours, theirs)
    # At the time of Cycles we have twice the samples, each with half of its squared error.
    for count in ("16", "32", "64"):
        assert found["square"][count] == pytest.approx(0.25) and found["flip"][count] == pytest.approx(0.5)
    # A quarter of the samples, at twice the speed, besides the half second that both need.
    assert found["time"] == pytest.approx((0.5 + 64 / 40.0) / (0.5 + 128 / 20.0))
    assert denoised.compared(ours[:3], theirs)["square"] == {}
    means = denoised.means([found, found])
    assert means["square"]["32"] == pytest.approx(0.25) and means["time"] == pytest.approx(found["time"])
    assert denoised.cells(means)[0] == "0.25x" and len(denoised.cells(means)) + 1 == len(denoised.HEAD)


def test_the_noise_of_references_cancels():
    generator = np.random.default_rng(5)
    truth = np.full((200, 200, 3), 0.5)
    halves = [truth + generator.normal(0.0, 0.05, truth.shape) for _ in range(2)]
    # The curve of the display bends: noise of 0.05 darkens the references by 0.001. Its square is a thousandth of that of the
    # noise; twice that times the distance of 0.06 below is 3 % of the distance's square.
    noise = float(np.mean((displayed(halves[0]) - displayed(truth)) ** 2))
    assert Displayed.of(halves).square(truth) < 0.02 * noise
    apart = displayed(truth + 0.1) - displayed(truth)
    assert Displayed.of(halves).square(truth + 0.1) == pytest.approx(float(np.mean(apart**2)), rel=0.04)


def test_relative_errors_are_in_the_unit_of_the_told_ones():
    """The difference over the luminance plus 1 % of its mean. Noise of a hundredth in the references shifts it by 0.1 %."""
    generator = np.random.default_rng(6)
    truth = np.full((200, 200, 3), 0.5)
    reference = Displayed.of([truth + generator.normal(0.0, 0.005, truth.shape) for _ in range(2)])
    assert reference.relative(truth + 0.05) == pytest.approx(0.05 / 0.505, rel=0.004)
    assert reference.relative(truth) < 0.002
