"""The charts' solid angles and inverse maps are correct."""

import numpy as np
import pytest
from charts import Half, Power, Slopes, Sphere, histogram, integrate_cells, unit
from significance import LEVEL, chi_square, uniforms

WO = unit(np.array([0.6, 0.2, 0.5]))
CHARTS = {
    "sphere": (Sphere(), 4 * np.pi),
    "cap": (Sphere((1, 2, 3), 0.5), np.pi),
    "crowded": (Sphere((0, 0, 1), 0.0, 3.0), None),
    "power": (Power((0.3, 0.2, 0.9), 20.0), None),
    "slopes": (Slopes(0.3), None),
    "slopes behind": (Slopes(0.3, -1.0), None),
    "half": (Half(WO, Slopes(0.2)), None),
}


@pytest.mark.parametrize("name", CHARTS)
def test_back_and_forth(name):
    chart, area = CHARTS[name]
    u = uniforms(1000, 2, 1).astype(float) * 0.98 + 0.01
    w, density = chart.direct(u)
    reached = density > 0
    assert reached.sum() > 900
    # The charts use logarithms and angles of numbers of order 1: the error is at most a thousand roundings of double.
    assert np.allclose(chart.back(w[reached]), u[reached], rtol=0, atol=1e-10)
    assert np.allclose(np.linalg.norm(w, axis=1), 1.0, rtol=0, atol=1e-12)
    if area:
        assert np.isclose(density.mean(), area, rtol=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 30.0])
def test_charts_agree_about_the_integral_of_a_lobe(exponent):
    """cos^n around the axis integrates to 2 pi/(n + 1)."""

    def lobe(w):
        return np.maximum(w[:, 2], 0.0) ** exponent

    want = 2 * np.pi / (exponent + 1)
    for chart in (Sphere(lowest=0.0), Power((0, 0, 1), 0.5), Half(np.array([0.0, 0.0, 1.0]), Power((0, 0, 1), 2.0))):
        # Gauss-Legendre with 8 nodes in 16 cells has an error below 1e-4 even if the chart is not analytic at its rim.
        assert np.isclose(integrate_cells(chart, lobe, 16, 8).sum(), want, rtol=1e-4), chart


def test_a_histogram_of_the_charts_own_directions_is_flat():
    for chart, _ in CHARTS.values():
        if isinstance(chart, Half):
            continue
        w, _ = chart.direct(uniforms(20000, 2, 5).astype(float))
        counts, outside = histogram(chart, w, 8)
        assert outside == 0
        assert chi_square(counts, np.full((8, 8), 20000 / 64)) > LEVEL
