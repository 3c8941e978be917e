"""The arithmetic of `make tradeoff`: curves of error against seconds."""

import pytest

from tools.tradeoff.curves import middle, seconds_to, slope


def test_curves():
    first, second, third = ([(t * s, 1.0 / t**0.5) for t in (1, 4, 16)] for s in (1.0, 2.0, 3.0))
    points = middle([first, third, second])
    assert points[1] == (8.0, 0.5, 0.5, 0.5)
    # To a quarter of the squared error in four times the seconds.
    assert seconds_to(points, 1.0 / 8**0.5) == pytest.approx(16.0)
    assert seconds_to(points, 1.1) is None and seconds_to(points, 0.2) is None
    assert slope(points) == pytest.approx(0.5)
