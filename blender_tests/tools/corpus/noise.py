"""The noise of two engines' pictures at equal samples, from renders that differ in their seeds alone."""

import numpy as np

from tools.harness import estimates
from tools.harness.errors import level_of, luminance

# Share of the pixels, those where either engine's variance is largest, that a comparison leaves out: the contribution of a few
# fireflies differs with every seed.
_LEFT_OUT = 0.01
_GROUPS = 32


def relative_variance(ours, theirs):
    """Return two maps (h, w): the variance of one picture's luminance, relative like lancer_error of lancer.h.

    ours, theirs: (seeds, h, w, channels) each, all with the same number of samples.
    """
    maps = [luminance(pictures) for pictures in (ours, theirs)]
    # The two errors are relative to the same level. Half the squared difference of two pictures estimates the variance of one.
    scale = level_of(np.abs(0.5 * (maps[0].mean(axis=0) + maps[1].mean(axis=0))))
    scale = np.where(scale > 0.0, scale, 1.0)
    return tuple(values.var(axis=0, ddof=1) / scale**2 for values in maps)


def compare(ours, theirs):
    """Return {"ours", "theirs", "ratio", "low", "high", "all"} of two maps; None if either has no noise.

    These are the means over the kept pixels, the 95 % interval of their ratio, and the ratio over all pixels.
    """
    ours, theirs = ours.ravel(), theirs.ravel()
    # Fireflies of both engines are left out, measured relative to the noise of their own engine.
    worst = np.maximum(ours / max(ours.mean(), 1e-300), theirs / max(theirs.mean(), 1e-300))
    kept = worst <= np.quantile(worst, 1.0 - _LEFT_OUT)
    if not (ours[kept].any() and theirs[kept].any()):
        return None
    # Pixels are independent: 32 groups, each of every 32nd pixel, are 32 measurements.
    numbers = np.flatnonzero(kept)
    groups = [numbers[start::_GROUPS] for start in range(_GROUPS)]
    rows = np.array([[ours[group].mean(), theirs[group].mean()] for group in groups if len(group)])
    ratio, low, high = estimates.interval(rows, lambda means: means[..., 0] / means[..., 1])
    return {
        "ours": float(ours[kept].mean()),
        "theirs": float(theirs[kept].mean()),
        "ratio": ratio,
        "low": low,
        "high": high,
        "all": float(ours.mean() / theirs.mean()) if theirs.any() else None,
    }
