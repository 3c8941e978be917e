"""Figures of repeated measurements: squared errors, efficiency, and their intervals."""

import functools
import math

import numpy as np

_RESAMPLES = 2000


def squared_error(picture, reference, reference_variance=0.0):
    """Return the mean over pixels and channels of (I - R)^2, less the reference's own variance; never below zero."""
    difference = np.asarray(picture, np.float64) - np.asarray(reference, np.float64)
    return max(0.0, float(np.mean(difference**2)) - reference_variance)


def join_halves(first, second):
    """Return (reference, the mean variance of its pixels) of two independent pictures of equal weight."""
    first, second = np.asarray(first, np.float64), np.asarray(second, np.float64)
    # The mean of two pictures has half the variance of one, their difference twice that of one.
    return 0.5 * (first + second), float(np.mean((first - second) ** 2)) / 4.0


@functools.cache
def student_quantile(freedom, probability=0.975):
    """Return a quantile of Student's t: the density is integrated by Simpson's rule, and the integral inverted by bisection."""
    scale = math.exp(math.lgamma((freedom + 1) / 2) - math.lgamma(freedom / 2)) / math.sqrt(freedom * math.pi)

    def distribution(t):
        x = np.linspace(0.0, t, 2001)
        y = (1.0 + x * x / freedom) ** (-(freedom + 1) / 2)
        return 0.5 + scale * (t / 6000.0) * (y[0] + y[-1] + 4.0 * y[1:-1:2].sum() + 2.0 * y[2:-1:2].sum())

    low, high = 0.0, 1000.0
    while high - low > 1e-9 * high:
        half = 0.5 * (low + high)
        low, high = (half, high) if distribution(half) < probability else (low, half)
    return 0.5 * (low + high)


def interval(rows, statistic, seed=1):
    """Return (value, low, high), the 95 % interval of a positive function of the means of columns; rows are measurements.

    Resampled rows give the standard error of its logarithm. A resample of n rows has (n - 1)/n times the variance of n new
    rows, and the spread of few rows is uncertain: so the error is widened by sqrt(n/(n - 1)) and by Student's t. low and high
    are None for a single row.
    """
    rows = np.asarray(rows, np.float64)
    value, count = float(statistic(rows.mean(axis=0))), len(rows)
    if count < 2 or not 0.0 < value < math.inf:
        return value, None, None
    picks = np.random.default_rng(seed).integers(0, count, (_RESAMPLES, count))
    error = float(np.std(np.log(statistic(rows[picks].mean(axis=1)))))
    factor = math.exp(student_quantile(count - 1) * error * math.sqrt(count / (count - 1)))
    return value, value / factor, value * factor


def efficiency(errors, seconds):
    """Return 1 / (mean squared error x seconds) over runs with different seeds: {"value", "low", "high"}."""
    rows = np.stack([errors, seconds], axis=1)
    value, low, high = interval(rows, lambda means: _inverse(means[..., 0] * means[..., 1]))
    return {"value": value, "low": low, "high": high}


def efficiency_ratio(ours, theirs):
    """Return our efficiency over theirs; each is (errors, seconds) of runs that took turns."""
    count = min(len(ours[0]), len(theirs[0]))
    rows = np.stack([column[:count] for column in (*ours, *theirs)], axis=1)

    def ratio(means):
        return means[..., 2] * means[..., 3] * _inverse(means[..., 0] * means[..., 1])

    value, low, high = interval(rows, ratio)
    return {"value": value, "low": low, "high": high}


def _inverse(x):
    with np.errstate(divide="ignore"):
        return 1.0 / np.asarray(x, np.float64)


def geometric_mean(values):
    values = list(values)
    return math.exp(sum(math.log(value) for value in values) / len(values))
