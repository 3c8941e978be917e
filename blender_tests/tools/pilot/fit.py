"""The fit of a linear model of costs to times, where each scene has its own speed.

The time of run i of scene s is speed_s * (w . counts_i) * exp(noise). The speed absorbs the size of the scene and the machine,
so the fit uses only the ratios of times within a scene: it minimises the squared deviations of log time - log(w . counts) from
their mean over the scene. One weight is fixed, because a common factor of all weights is a speed.
"""

from dataclasses import dataclass

import numpy as np

_STEPS = 200


@dataclass(frozen=True)
class Fit:
    weights: np.ndarray  # in the order of the columns of counts
    errors: np.ndarray  # standard errors of the weights; 0 for the fixed one
    deviation: float  # standard deviation of a predicted time, relative


def _centred(values, scenes):
    """Returns values minus the mean over the rows of each scene."""
    result = np.array(values, float)
    for scene in np.unique(scenes):
        rows = scenes == scene
        result[rows] -= result[rows].mean(axis=0)
    return result


def _residuals(weights, counts, seconds, scenes):
    """Returns the deviations of log time from the model without each scene's speed; None where the model has a time below 0."""
    costs = counts @ weights
    return _centred(np.log(seconds) - np.log(costs), scenes) if np.all(costs > 0.0) else None


def _slopes(weights, counts, scenes, free):
    """Returns the derivatives of log(w . counts) by the free weights."""
    return _centred(counts[:, free] / (counts @ weights)[:, None], scenes)


def deviation(weights, counts, seconds, scenes, fitted=0):
    """Returns the standard deviation of a predicted time, relative; fitted: the number of weights that were fitted."""
    square = np.sum(_residuals(weights, counts, seconds, scenes) ** 2)
    return float(np.sqrt(square / (len(seconds) - len(np.unique(scenes)) - fitted)))


def fit(counts, seconds, scenes, start, fixed):
    """Returns the Fit of runs by Levenberg's method. Raises ValueError where the runs do not determine the weights.

    counts: (runs, weights); scenes: the scene of each run; start: the first guess; fixed: the column of the fixed weight. A
    weight may come out below 0 where noise exceeds its share of the times.
    """
    free = [column for column in range(counts.shape[1]) if column != fixed]
    if len(seconds) <= len(np.unique(scenes)) + len(free):
        raise ValueError(f"{len(seconds)} runs of {len(np.unique(scenes))} scenes do not determine {len(free)} weights")
    weights, damping = np.array(start, float), 1e-3
    found = _residuals(weights, counts, seconds, scenes)
    for _ in range(_STEPS):
        slopes = _slopes(weights, counts, scenes, free)
        normal = slopes.T @ slopes
        if not np.linalg.cond(normal) < 1e12:
            raise ValueError("the counts of the runs are too similar to determine the weights")
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), slopes.T @ found)
        trial = weights.copy()
        trial[free] += step
        other = _residuals(trial, counts, seconds, scenes)
        if other is None or np.sum(other**2) > np.sum(found**2):
            damping *= 5.0
            continue
        weights, found, damping = trial, other, damping / 3.0
        if np.abs(step).max() < 1e-9 * np.abs(weights).max():
            break
    spread = deviation(weights, counts, seconds, scenes, len(free))
    errors = np.zeros(len(weights))
    slopes = _slopes(weights, counts, scenes, free)
    errors[free] = spread * np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    return Fit(weights, errors, spread)
