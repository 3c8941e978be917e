"""Significance tests for samplers and images. test_significance.py tests that they reject wrong ones."""

import math

import numpy as np
from scipy import stats

# The probability of a false alarm of one test function. Seeds are fixed, so a test that has passed once always passes.
LEVEL = 0.001


def sidak(level, count):
    """Return the level of each of count independent tests so that together they raise a false alarm with probability level."""
    return -math.expm1(math.log1p(-level) / count)


def z_test(mean, standard_error, expected):
    """Return the two-sided p-value of the mean of many samples against its expectation; works on arrays."""
    mean, standard_error, expected = (np.asarray(x, dtype=np.float64) for x in (mean, standard_error, expected))
    difference = np.abs(mean - expected)
    with np.errstate(divide="ignore", invalid="ignore"):
        z = np.where(difference == 0.0, 0.0, difference / standard_error)
    p = 2.0 * stats.norm.sf(z)
    return np.where(np.isnan(z), 0.0, p)


def chi_square(observed, expected, smallest=5.0):
    """Return the p-value of observed counts under the expected ones.

    Cells with expected counts below `smallest` are pooled, since the chi-square distribution requires well-filled cells.
    Hits in a cell where none are expected reject at once.
    """
    observed = np.asarray(observed, dtype=np.float64).ravel()
    expected = np.asarray(expected, dtype=np.float64).ravel()
    assert observed.shape == expected.shape
    if not (np.all(np.isfinite(expected)) and np.all(expected >= 0.0)):
        return 0.0
    total = observed.sum()
    # A cell with an expected count below 0.001 and more than 5 hits is impossible, not just unlikely.
    if np.any((expected < 1e-3) & (observed > 5)):
        return 0.0
    order = np.argsort(expected)
    observed, expected = observed[order], expected[order]
    # Pool the smallest cells until their sum is large enough.
    thin = int(np.searchsorted(expected, smallest))
    if thin:
        while thin < len(expected) and expected[:thin].sum() < smallest:
            thin += 1
        observed = np.concatenate([[observed[:thin].sum()], observed[thin:]])
        expected = np.concatenate([[expected[:thin].sum()], expected[thin:]])
    if len(expected) < 2:
        return 1.0 if abs(total - expected.sum()) <= 5.0 * math.sqrt(max(total, 1.0)) else 0.0
    statistic = np.sum((observed - expected) ** 2 / np.maximum(expected, 1e-300))
    return float(stats.chi2.sf(statistic, len(expected) - 1))


def uniforms(count, dimensions, seed):
    """Return independent uniform numbers in [0, 1) as float32, (count, dimensions)."""
    u = np.random.default_rng(seed).random((count, dimensions)).astype(np.float32)
    return np.minimum(u, np.float32(1.0) - np.float32(2.0**-24))


def midpoints(*counts):
    """Return the midpoints of a regular grid in the unit cube as float32, (product of counts, len(counts))."""
    axes = [(np.arange(n) + 0.5) / n for n in counts]
    return np.stack([a.ravel() for a in np.meshgrid(*axes, indexing="ij")], axis=1).astype(np.float32)


def mean_and_error(samples, axis=0):
    """Return the mean and its standard error along an axis."""
    samples = np.asarray(samples, dtype=np.float64)
    count = samples.shape[axis]
    return samples.mean(axis=axis), samples.std(axis=axis, ddof=1) / math.sqrt(count)
