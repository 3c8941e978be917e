"""How far two pictures lie apart, and whether that is noise. Knows numpy and nothing of Blender.

A picture comes in two halves, rendered with different seeds. Half of their difference is distributed as the error of their
mean, so the same figures taken of it tell what noise alone would show.
"""

import math
from typing import NamedTuple

import numpy as np


class Limit(NamedTuple):
    mean: float  # of the mean absolute difference
    p99: float  # of the 99th percentile of the absolute difference


class Kind(NamedTuple):
    """What a class of scenes is judged by."""

    limit: Limit
    block: int  # side of the squares, in pixels, whose means are compared
    relative: bool  # each block against its own level, not against the picture's
    averages: bool = True  # more samples mean less noise; of data Cycles keeps one sample's


KINDS = {
    # The same mathematics in both engines.
    "EXACT": Kind(Limit(0.005, 0.02), 8, False),
    # Tables stand for parts of the mathematics: Principled, multiple scattering.
    "LOBES": Kind(Limit(0.01, 0.04), 8, False),
    # Data at pixel centres. Single precision keeps 1e-7 of a coordinate, the ray at the edge of the narrow filter 1e-4;
    # the hundredth of the pixels that lie on outlines may belong to either side.
    "PIXELS": Kind(Limit(0.005, 1e-4), 1, False, averages=False),
    # One tile of 16 pixels for each angle and roughness.
    "FURNACE": Kind(Limit(0.003, 0.003), 16, True),
}


class Figures(NamedTuple):
    mean: float
    p99: float
    noise_mean: float  # what the noise alone gives
    noise_p99: float
    sigma: float  # standard deviation of a block's noise
    level: float  # mean of Cycles' picture


class Verdict(NamedTuple):
    name: str  # "pass", "fail", or "noise": beyond the limit, but no farther than the noise reaches
    quiet: bool  # the noise is below a third of the limit


def blocks(picture, size):
    """Means of squares of size x size pixels, (rows, columns, channels); those at the right and lower edge may be smaller."""
    picture = np.asarray(picture, np.float64)
    for axis in (0, 1):
        starts = np.arange(0, picture.shape[axis], size)
        counts = np.diff(np.append(starts, picture.shape[axis]))
        sums = np.add.reduceat(picture, starts, axis=axis)
        picture = sums / np.expand_dims(counts, tuple(i for i in range(3) if i != axis))
    return picture


def measure(ours, theirs, kind, scale=None):
    """Figures of two pictures, each a pair of halves of shape (height, width, channels).

    scale: what each difference is a share of, an array that fits the blocks; by default the kind's own.
    """
    shapes = {half.shape for half in (*ours, *theirs)}
    if len(shapes) != 1:
        raise ValueError(f"pictures of different shapes: {sorted(shapes)}")
    ours, theirs = ([blocks(half, kind.block) for half in pair] for pair in (ours, theirs))
    if not all(np.isfinite(half).all() for half in (*ours, *theirs)):
        return Figures(math.inf, math.inf, 0.0, 0.0, 0.0, math.nan)
    reference = (theirs[0] + theirs[1]) / 2
    level = float(np.abs(reference).mean())
    difference = (ours[0] + ours[1]) / 2 - reference
    noise = ((ours[0] - ours[1]) - (theirs[0] - theirs[1])) / 2
    if scale is None:
        scale = np.abs(reference) if kind.relative else np.full_like(reference, level)
    return Figures(
        *_sizes(_ratio(difference, scale)),
        *_sizes(_ratio(noise, scale)),
        float(np.sqrt(np.mean(_ratio(noise, scale) ** 2))),
        level,
    )


def _ratio(value, scale):
    """value / scale, where nothing of nothing is no difference."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(value == 0.0, 0.0, value / scale)


def _sizes(ratio):
    ratio = np.abs(ratio)
    return float(ratio.mean()), float(np.percentile(ratio, 99, method="higher"))


def allowance(figures):
    """What noise may add to each figure.

    The mean of |d + n| is at most mean |d| + mean |n|, and the measured mean |n| is one draw of a hundred values or more
    that nears the next within half of itself. Of the 99th percentile the noise of few blocks decides: 4 standard deviations,
    or, where that noise has long tails, twice what the tail was measured to be.
    """
    return Limit(1.5 * figures.noise_mean, max(4.0 * figures.sigma, 2.0 * figures.noise_p99))


def judge(figures, limit):
    quiet = 3.0 * figures.noise_mean <= limit.mean and 3.0 * figures.noise_p99 <= limit.p99
    if figures.mean <= limit.mean and figures.p99 <= limit.p99:
        return Verdict("pass", quiet)
    more = allowance(figures)
    within = figures.mean <= limit.mean + more.mean and figures.p99 <= limit.p99 + more.p99
    return Verdict("noise" if within else "fail", quiet)


def hopeless(figures, limit):
    """Whether more samples cannot change the verdict: far beyond the limit, or far beyond what noise explains."""
    more = allowance(figures)
    return figures.mean > limit.mean + 3.0 * more.mean or figures.p99 > limit.p99 + 3.0 * more.p99
