"""Biases in `make accuracy`: the blocks beyond chance, and their relative biases."""

import numpy as np
import pytest

from tools.accuracy import figures, goals
from tools.harness.errors import Reference


def pictures(random, count, left):
    """Return pictures of two blocks: one of luminance left, one of 3; noise of a thousandth."""
    level = np.repeat([[left] * 16 + [3.0] * 16], 16, axis=0)
    return level + 1e-3 * random.standard_normal((count, 16, 32))


@pytest.fixture
def bias():
    """Return the bias of pictures whose left block is 1.1, where the truth is 1."""
    random = np.random.default_rng(1)
    return figures.bias(pictures(random, 8, 1.1), Reference(pictures(random, 8, 1.0)))


def test_blocks_are_off_as_errors_are_told(bias):
    """The bias is 0.1 over 1 plus a hundredth of the mean, which is 2. The mean of 8 x 256 numbers has an error of 2e-5."""
    assert bias["off"] == pytest.approx([0.1 / 1.02, 0.0], abs=1e-4)
    assert bias["blocks"][0] > 4.0 > abs(bias["blocks"][1])


def test_a_verdict_tells_how_far_blocks_are_off(bias):
    verdict = goals._blocks([{"target": 0.2, "bias": bias}])
    assert not verdict.reached and verdict.measured.endswith("; these are off by up to 49.0 % of their target")
    assert "target" not in goals._blocks([{"bias": bias}]).measured
