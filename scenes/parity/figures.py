"""The difference between two pictures, and the test whether noise explains it. Depends on numpy, not on Blender.

A picture comes in two halves, rendered with different seeds. Half of their difference is distributed as the error of their
mean, so the same figures of that difference show the effect of noise alone."""

import math
from typing import NamedTuple

import numpy as np


class Limit(NamedTuple):
    mean: float  # of the mean absolute difference
    p99: float  # of the 99th percentile of the absolute difference


class Kind(NamedTuple):
    """The rules by which a class of scenes is judged."""

    limit: Limit
    block: int  # side, in pixels, of the squares whose means are compared
    relative: bool  # each block relative to its own level, not to the picture's
    averages: bool = True  # more samples mean less noise; of data passes Cycles keeps one sample


KINDS = {
    # The same mathematics in both engines.
    "EXACT": Kind(Limit(0.005, 0.02), 8, False),
    # The same mathematics, where the feature covers a few pixels and has no noise.
    "EDGES": Kind(Limit(0.005, 0.02), 1, False),
    # Tables approximate parts of the mathematics: Principled, multiple scattering.
    "LOBES": Kind(Limit(0.01, 0.04), 8, False),
    # Data at pixel centres. Single precision keeps 1e-7 of a coordinate, the ray at the edge of the narrow filter 1e-4; pixels
    # on outlines, a hundredth of all, may belong to either side.
    "PIXELS": Kind(Limit(0.005, 1e-4), 1, False, averages=False),
    # One tile of 16 pixels for each angle and roughness.
    "FURNACE": Kind(Limit(0.003, 0.003), 16, True),
    # One square that a lamp lights.
    "LIGHT": Kind(Limit(1e-3, 1e-3), 8, True),
}
# With fewer blocks, one hundredth is no more than one or two, and a fault would hide there: then all blocks count.
FEW_BLOCKS = 200
# Renderers store 1e10 as the depth of the background; no distance in a scene here exceeds this bound.
_NOWHERE = 1e9


class Figures(NamedTuple):
    mean: float
    p99: float
    noise_mean: float  # the figures of noise alone
    noise_p99: float
    sigma: float  # standard deviation of a block's noise
    level: float  # the divisor of differences: the mean of Cycles' picture
    # The figures of the standard deviations of blocks by the noise of their pixels, of which a picture with few lit blocks has
    # more, and the effective number of blocks with noise.
    spread_mean: float = 0.0
    spread_p99: float = 0.0
    spread_count: float = 1.0
    # The same figures with each block relative to its own level, or to a common level where the block is darker; bright parts
    # do not raise that level.
    dim: "Figures | None" = None


class Verdict(NamedTuple):
    name: str  # "pass", "fail", or "noise": beyond the limit, but within the range of the noise
    quiet: bool  # the noise is below a third of the limit, or far too small to change the verdict


WORST_FIRST = ("fail", "noise", "pass")


def blocks(picture, size):
    """Returns the means of squares of size x size pixels, (rows, columns, channels); the last ones may be smaller."""
    picture = np.asarray(picture, np.float64)
    for axis in (0, 1):
        starts = np.arange(0, picture.shape[axis], size)
        counts = np.diff(np.append(starts, picture.shape[axis]))
        sums = np.add.reduceat(picture, starts, axis=axis)
        picture = sums / np.expand_dims(counts, tuple(i for i in range(3) if i != axis))
    return picture


def measure(ours, theirs, kind, scale=None):
    """Returns the figures of two pictures, each a pair of halves of shape (height, width, channels).

    scale: the divisor of each difference, an array that fits the blocks; by default the kind's own."""
    shapes = {half.shape for half in (*ours, *theirs)}
    if len(shapes) != 1:
        raise ValueError(f"the pictures have different shapes: {sorted(shapes)}")
    if not all(np.isfinite(half).all() for half in (*ours, *theirs)):
        return _HOPELESS
    spread = _spread(ours, theirs, kind.block) if kind.averages else None
    ours, theirs = ([blocks(half, kind.block) for half in pair] for pair in (ours, theirs))
    if not kind.averages:
        seen = _seen(ours, theirs)
        if seen is None:
            return _HOPELESS
        # Pixels that are empty in both pictures are not counted; where only one picture shows a surface, the other has the
        # value 0.
        ours, theirs = ([np.where(_shows(half), half, 0.0)[seen][:, None] for half in pair] for pair in (ours, theirs))
        scale = None if scale is None else np.broadcast_to(scale, (*seen.shape, 1))[seen][:, None]
    reference = np.abs(theirs[0] + theirs[1]) / 2
    level = float(reference.mean()) if reference.size else 0.0
    difference = (ours[0] + ours[1]) / 2 - (theirs[0] + theirs[1]) / 2
    noise = ((ours[0] - ours[1]) - (theirs[0] - theirs[1])) / 2
    even = np.full_like(reference, level)
    if scale is not None:
        return _figures(difference, noise, scale, level, spread)
    if kind.relative:
        return _figures(difference, noise, reference, level, spread)
    if not kind.averages:
        return _figures(difference, noise, even, level)
    dim = _dim_level(reference)
    figures = _figures(difference, noise, even, level, spread)
    return figures._replace(dim=_figures(difference, noise, np.maximum(reference, dim), dim, spread))


def _spread(ours, theirs, size):
    """Returns the standard deviations of the blocks' noise, with that of their pixels as independent values."""
    noise = ((ours[0] - ours[1]) - (theirs[0] - theirs[1])) / 2
    rows, columns = (np.diff(np.append(np.arange(0, length, size), length)) for length in noise.shape[:2])
    return np.sqrt(blocks(noise**2, size) / np.outer(rows, columns)[..., None])


_HOPELESS = Figures(math.inf, math.inf, 0.0, 0.0, 0.0, math.nan)


def _dim_level(reference):
    """Returns the mean of the picture clamped to twice the median of its pixels that are not black."""
    lit = reference[reference > 0.0]
    return float(np.minimum(reference, 2.0 * np.median(lit)).mean()) if lit.size else 0.0


def _seen(ours, theirs):
    """Returns where either picture shows a surface, (rows, columns); None if they disagree beyond an outline of both."""
    one, other = (np.any(_shows(pair[0]) | _shows(pair[1]), axis=-1) for pair in (ours, theirs))
    return None if np.any((one != other) & ~(_outline(one) & _outline(other))) else one | other


def _outline(mask):
    """Returns where a pixel and its eight neighbours are not all equal."""
    around = np.pad(mask, 1, mode="edge")
    rows, columns = mask.shape
    near = np.stack([around[y : y + rows, x : x + columns] for y in range(3) for x in range(3)])
    return near.any(axis=0) & ~near.all(axis=0)


def _shows(picture):
    return (picture != 0.0) & (np.abs(picture) < _NOWHERE)


def _figures(difference, noise, scale, level, spread=None):
    ratio = _ratio(noise, scale)
    figures = Figures(*_sizes(_ratio(difference, scale)), *_sizes(ratio), _root_mean_square(ratio), level)
    if spread is None:
        return figures
    spread = _ratio(spread, scale)
    mean, p99 = _sizes(spread)
    return figures._replace(spread_mean=mean, spread_p99=p99, spread_count=_effective_count(spread))


def _effective_count(ratio):
    """Returns the number of equal blocks whose mean is as uncertain as that of these; 1 where the level is 0."""
    worst = ratio.max(axis=-1)
    return float(worst.sum() ** 2 / (worst**2).sum()) if worst.any() and np.isfinite(worst).all() else 1.0


def _root_mean_square(ratio):
    return float(np.sqrt(np.mean(ratio**2))) if ratio.size else 0.0


def _ratio(value, scale):
    """Returns value / scale, and 0 where value is 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(value == 0.0, 0.0, value / scale)


def _sizes(ratio):
    """Returns the mean, and the 99th percentile over blocks of their worst channel; with few blocks, the maximum."""
    ratio = np.abs(ratio)
    if not ratio.size:
        return 0.0, 0.0
    worst = ratio.max(axis=-1)
    percentile = 99 if worst.size >= FEW_BLOCKS else 100
    return float(ratio.mean()), float(np.percentile(worst, percentile, method="higher"))


def allowance(figures):
    """Returns the amount that noise may add to each figure.

    The mean of |d + n| is at most mean |d| + mean |n|, and the measured mean |n| averages a hundred values or more, so two
    measurements of it agree within half of its value. Of few lit blocks, whose deviations their pixels show, |n| has the mean
    0.8 and the deviation 0.6 in units of theirs; the mean of k of them stays within 3 deviations, 1.8 / sqrt(k), of 0.8. The
    99th percentile depends on the noise of few blocks: 4 standard deviations of all or 3 of the noisiest, or, where that noise
    has long tails, twice the measured tail."""
    mean = max(1.5 * figures.noise_mean, (0.8 + 1.8 / figures.spread_count**0.5) * figures.spread_mean)
    return Limit(mean, max(4.0 * figures.sigma, 2.0 * figures.noise_p99, 3.0 * figures.spread_p99))


def judge(figures, limit):
    """Returns the worse of the verdicts by both levels."""
    verdicts = [_judge(numbers, limit) for numbers in (figures, figures.dim) if numbers]
    name = next(name for name in WORST_FIRST if any(verdict.name == name for verdict in verdicts))
    return Verdict(name, all(verdict.quiet for verdict in verdicts))


def _judge(figures, limit):
    quiet = 3.0 * figures.noise_mean <= limit.mean and 3.0 * figures.noise_p99 <= limit.p99
    more = allowance(figures)
    if figures.mean <= limit.mean and figures.p99 <= limit.p99:
        return Verdict("pass", quiet or (figures.mean + more.mean <= limit.mean and figures.p99 + more.p99 <= limit.p99))
    within = figures.mean <= limit.mean + more.mean and figures.p99 <= limit.p99 + more.p99
    return Verdict("noise" if within else "fail", quiet)


def share(figures, limit):
    """Returns the difference as a share of its limits; beyond 1 it is too large."""
    return max(figures.mean / limit.mean, figures.p99 / limit.p99)


def decisive(figures, limit):
    """Returns those figures of the two levels that are nearer to the limits, or farther beyond them."""
    return max((numbers for numbers in (figures, figures.dim) if numbers), key=lambda numbers: share(numbers, limit))


def enough(figures, limit):
    """Whether a pass needs no more samples: noise increases a measured difference, it does not hide one.

    The expected |d + n| is no less than |d|; half of the limit leaves room for chance."""
    return 2.0 * figures.noise_mean <= limit.mean and 2.0 * figures.noise_p99 <= limit.p99


def hopeless(figures, limit):
    """Whether more samples cannot change the verdict: the figures are far beyond the limit, or far beyond the noise."""
    more = allowance(figures)
    return figures.mean > limit.mean + 3.0 * more.mean or figures.p99 > limit.p99 + 3.0 * more.p99
