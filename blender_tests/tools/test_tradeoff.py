"""The arithmetic of `make tradeoff`, on pictures whose noise and bias are known."""

import numpy as np
import pytest

from tools.tradeoff.error import Reference, luminance, middle, seconds_to, slope

SHAPE = (200, 300, 3)


def pictures(count, level, noise, seed):
    """Grey pictures of that level, with Gaussian noise of that standard deviation."""
    generator = np.random.default_rng(seed)
    for _ in range(count):
        yield np.repeat(level + noise * generator.normal(size=(*SHAPE[:2], 1)), 3, axis=2)


def test_luminance_of_grey_is_its_level():
    assert luminance(np.full((1, 1, 4), 0.3))[0, 0] == pytest.approx(0.3, rel=1e-12)


def test_noise_and_bias_are_told_apart():
    reference = Reference(*pictures(2, 20.0, 0.2, 1))
    # The mean of two: 0.2 / sqrt 2, relative to 20 and 1 % of it. Of 60 000 pixels the square is known to 0.6 %: to the root of
    # 2 / 60 000.
    scale = 20.2
    assert reference.error == pytest.approx(0.2 / 2**0.5 / scale, rel=0.01)
    noise, bias = reference.split(list(pictures(5, 20.5, 0.4, 2)))
    assert noise == pytest.approx(0.4 / scale, rel=0.01)
    assert bias == pytest.approx(0.5 / scale, rel=0.01)
    (one,) = pictures(1, 20.5, 0.4, 3)
    # The reference's own noise counts for nothing.
    assert reference.distance(one) == pytest.approx(np.hypot(0.4, 0.5) / scale, rel=0.01)
    noise, bias = reference.split(list(pictures(5, 20.0, 0.4, 4)))
    # Its square is a difference, which is known to some thousandths of the noise's: so the bias to their root.
    assert bias < 0.1 * noise


def test_curves():
    first, second, third = ([(t * s, 1.0 / t**0.5) for t in (1, 4, 16)] for s in (1.0, 2.0, 3.0))
    points = middle([first, third, second])
    assert points[1] == (8.0, 0.5, 0.5, 0.5)
    # To a quarter of the squared error in four times the seconds.
    assert seconds_to(points, 1.0 / 8**0.5) == pytest.approx(16.0)
    assert seconds_to(points, 1.1) is None and seconds_to(points, 0.2) is None
    assert slope(points) == pytest.approx(0.5)
