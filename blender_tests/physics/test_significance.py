"""The significance tests accept correct samplers, reject slightly wrong ones, and err with the nominal probability."""

import numpy as np
from scipy import stats
from significance import LEVEL, chi_square, mean_and_error, midpoints, sidak, uniforms, z_test


def cosine_histogram(exponent, count, seed):
    """Return counts in 32 equal cells of cos^2 for directions of density cos^exponent; uniform for exponent 1."""
    u = uniforms(count, 1, seed)[:, 0].astype(np.float64)
    cosine = u ** (1.0 / (exponent + 1.0))
    return np.histogram(cosine**2, bins=32, range=(0.0, 1.0))[0]


def test_chi_square_accepts_the_right_sampler_as_often_as_promised():
    expected = np.full(32, 20000 / 32)
    p = [chi_square(cosine_histogram(1.0, 20000, seed), expected) for seed in range(300)]
    # p-values of a true hypothesis are uniform; 1e-3 is the accepted chance that this fixed draw looks otherwise.
    assert stats.kstest(p, "uniform").pvalue > 1e-3
    assert np.mean(np.array(p) < 0.05) < 0.05 + 4.0 * np.sqrt(0.05 * 0.95 / 300)


def test_chi_square_rejects_a_sampler_wrong_by_three_percent():
    # cos^1.03 instead of cos: with 200 000 samples the expected statistic exceeds the limit several times over.
    expected = np.full(32, 200000 / 32)
    assert chi_square(cosine_histogram(1.03, 200000, 1), expected) < LEVEL
    assert chi_square(cosine_histogram(1.0, 200000, 1), expected) > LEVEL


def test_chi_square_rejects_hits_where_nothing_may_be():
    assert chi_square([1000, 6], [1006.0, 0.0]) == 0.0
    assert chi_square([10, 10], [np.nan, 20.0]) == 0.0


def test_chi_square_pools_thin_cells():
    expected = np.concatenate([np.full(10, 100.0), np.full(1000, 0.01)])
    observed = np.concatenate([np.full(10, 100), np.zeros(1000)])
    observed[:5] += 1
    observed[20:25] += 1
    assert chi_square(observed, expected) > 0.1
    observed[20:70] += 1
    assert chi_square(observed, expected) < LEVEL


def test_z_test():
    # 1.96 standard errors are the 5 % of the normal law to 1e-3.
    assert abs(float(z_test(1.0 + 1.96e-3, 1e-3, 1.0)) - 0.05) < 1e-3
    assert float(z_test(1.0, 0.0, 1.0)) == 1.0
    assert float(z_test(1.1, 0.0, 1.0)) == 0.0
    assert float(z_test(np.nan, 1.0, 1.0)) == 0.0
    assert float(z_test(1.0, np.nan, 2.0)) == 0.0


def test_z_test_rejects_a_biased_mean():
    samples = uniforms(100000, 1, 3)[:, 0]
    mean, error = mean_and_error(samples)
    assert z_test(mean, error, 0.5) > LEVEL
    # 1 % of bias is 5.5 standard errors here: 0.005 / (0.2887 / sqrt(1e5)).
    assert z_test(mean * 1.01, error, 0.5) < LEVEL


def test_sidak():
    assert abs(sidak(0.05, 1) - 0.05) < 1e-15
    single = sidak(0.05, 20)
    assert abs((1.0 - (1.0 - single) ** 20) - 0.05) < 1e-12


def test_grids_and_random_numbers():
    grid = midpoints(4, 2)
    assert grid.shape == (8, 2) and grid.min() == 0.125 and grid.max() == 0.875
    assert uniforms(10, 3, 1).max() < 1.0
