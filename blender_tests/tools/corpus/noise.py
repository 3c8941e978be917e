"""How noisy the pictures of two engines are at equal samples, from renders that differ in their seeds alone."""

import numpy as np

from tools.harness import estimates
from tools.harness.errors import level_of, luminance

# Share of the pixels that a comparison leaves out: those where either engine's variance is largest. What a few fireflies add is
# another number with every seed.
_LEFT_OUT = 0.01
_GROUPS = 32


def relative_variance(ours, theirs):
    """Two maps (h, w): the variance of one picture's luminance, relative as the library has it: lancer_error of lancer.h.

    ours, theirs: (seeds, h, w, channels) each, the same number of samples in all.
    """
    maps = [luminance(pictures) for pictures in (ours, theirs)]
    # Both are measured against the same level: half the squared difference of two is the variance of each.
    scale = level_of(np.abs(0.5 * (maps[0].mean(axis=0) + maps[1].mean(axis=0))))
    scale = np.where(scale > 0.0, scale, 1.0)
    return tuple(values.var(axis=0, ddof=1) / scale**2 for values in maps)


def compare(ours, theirs):
    """{"ours", "theirs", "ratio", "low", "high", "all"} of two maps; None where either has no noise.

    Means of what is kept, the 95 % interval of their ratio, and the ratio over all pixels.
    """
    ours, theirs = ours.ravel(), theirs.ravel()
    # Fireflies of both count, each as a share of its own engine's noise.
    worst = np.maximum(ours / max(ours.mean(), 1e-300), theirs / max(theirs.mean(), 1e-300))
    kept = worst <= np.quantile(worst, 1.0 - _LEFT_OUT)
    if not (ours[kept].any() and theirs[kept].any()):
        return None
    # Pixels are independent: groups that each hold every 32nd of them are as many measurements.
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
