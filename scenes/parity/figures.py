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
    # The same, where what is shown lies within a few pixels and has no noise.
    "EDGES": Kind(Limit(0.005, 0.02), 1, False),
    # Tables stand for parts of the mathematics: Principled, multiple scattering.
    "LOBES": Kind(Limit(0.01, 0.04), 8, False),
    # Data at pixel centres. Single precision keeps 1e-7 of a coordinate, the ray at the edge of the narrow filter 1e-4;
    # the hundredth of the pixels that lie on outlines may belong to either side.
    "PIXELS": Kind(Limit(0.005, 1e-4), 1, False, averages=False),
    # One tile of 16 pixels for each angle and roughness.
    "FURNACE": Kind(Limit(0.003, 0.003), 16, True),
    # One square that a lamp lights.
    "LIGHT": Kind(Limit(1e-3, 1e-3), 8, True),
}
# Below so many blocks one hundredth is no more than one or two, and a fault would hide there: then all of them count.
FEW_BLOCKS = 200
# What a renderer stores as the depth of nothing, and more than any distance of a scene here.
_NOWHERE = 1e9


class Figures(NamedTuple):
    mean: float
    p99: float
    noise_mean: float  # what the noise alone gives
    noise_p99: float
    sigma: float  # standard deviation of a block's noise
    level: float  # what differences are a share of: the mean of Cycles' picture
    # The same of each block by its own level, and by a common one where it is darker than that: one that no bright part raises.
    dim: "Figures | None" = None


class Verdict(NamedTuple):
    name: str  # "pass", "fail", or "noise": beyond the limit, but no farther than the noise reaches
    quiet: bool  # the noise is below a third of the limit, or far too little to reach it from what was measured


WORST_FIRST = ("fail", "noise", "pass")


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
        return _HOPELESS
    if not kind.averages:
        seen = _seen(ours, theirs)
        if seen is None:
            return _HOPELESS
        # What neither shows is no agreement; and where but one shows something, the other has 0 of it.
        ours, theirs = ([np.where(_shows(half), half, 0.0)[seen][:, None] for half in pair] for pair in (ours, theirs))
        scale = None if scale is None else np.broadcast_to(scale, (*seen.shape, 1))[seen][:, None]
    reference = np.abs(theirs[0] + theirs[1]) / 2
    level = float(reference.mean()) if reference.size else 0.0
    difference = (ours[0] + ours[1]) / 2 - (theirs[0] + theirs[1]) / 2
    noise = ((ours[0] - ours[1]) - (theirs[0] - theirs[1])) / 2
    even = np.full_like(reference, level)
    if scale is not None:
        return _figures(difference, noise, scale, level)
    if kind.relative:
        return _figures(difference, noise, reference, level)
    if not kind.averages:
        return _figures(difference, noise, even, level)
    dim = _dim_level(reference)
    return _figures(difference, noise, even, level)._replace(dim=_figures(difference, noise, np.maximum(reference, dim), dim))


_HOPELESS = Figures(math.inf, math.inf, 0.0, 0.0, 0.0, math.nan)


def _dim_level(reference):
    """The mean of a picture in which nothing is brighter than twice the middle of what is not black."""
    lit = reference[reference > 0.0]
    return float(np.minimum(reference, 2.0 * np.median(lit)).mean()) if lit.size else 0.0


def _seen(ours, theirs):
    """Where either picture shows a surface, (rows, columns); None if they disagree elsewhere than on an outline of both."""
    one, other = (np.any(_shows(pair[0]) | _shows(pair[1]), axis=-1) for pair in (ours, theirs))
    return None if np.any((one != other) & ~(_outline(one) & _outline(other))) else one | other


def _outline(mask):
    """Where a pixel or one of its eight neighbours differs from another of these."""
    around = np.pad(mask, 1, mode="edge")
    rows, columns = mask.shape
    near = np.stack([around[y : y + rows, x : x + columns] for y in range(3) for x in range(3)])
    return near.any(axis=0) & ~near.all(axis=0)


def _shows(picture):
    return (picture != 0.0) & (np.abs(picture) < _NOWHERE)


def _figures(difference, noise, scale, level):
    ratio = _ratio(noise, scale)
    return Figures(*_sizes(_ratio(difference, scale)), *_sizes(ratio), _root_mean_square(ratio), level)


def _root_mean_square(ratio):
    return float(np.sqrt(np.mean(ratio**2))) if ratio.size else 0.0


def _ratio(value, scale):
    """value / scale, where nothing of nothing is no difference."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(value == 0.0, 0.0, value / scale)


def _sizes(ratio):
    """The mean, and the 99th percentile over blocks of their worst channel: of few blocks the greatest."""
    ratio = np.abs(ratio)
    if not ratio.size:
        return 0.0, 0.0
    worst = ratio.max(axis=-1)
    percentile = 99 if worst.size >= FEW_BLOCKS else 100
    return float(ratio.mean()), float(np.percentile(worst, percentile, method="higher"))


def allowance(figures):
    """What noise may add to each figure.

    The mean of |d + n| is at most mean |d| + mean |n|, and the measured mean |n| is one draw of a hundred values or more
    that nears the next within half of itself. Of the 99th percentile the noise of few blocks decides: 4 standard deviations,
    or, where that noise has long tails, twice what the tail was measured to be.
    """
    return Limit(1.5 * figures.noise_mean, max(4.0 * figures.sigma, 2.0 * figures.noise_p99))


def judge(figures, limit):
    """The worse of the verdicts by both levels."""
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
    """How much of its limits a difference takes; beyond 1 it is too large."""
    return max(figures.mean / limit.mean, figures.p99 / limit.p99)


def decisive(figures, limit):
    """Of the two levels' figures those nearer to the limits, or farther beyond them."""
    return max((numbers for numbers in (figures, figures.dim) if numbers), key=lambda numbers: share(numbers, limit))


def enough(figures, limit):
    """Whether a pass needs no more samples: noise widens what lies between two pictures, it does not hide it.

    The mean of |d + n| is no less than |d|; half of the limit keeps chance from saying otherwise.
    """
    return 2.0 * figures.noise_mean <= limit.mean and 2.0 * figures.noise_p99 <= limit.p99


def hopeless(figures, limit):
    """Whether more samples cannot change the verdict: far beyond the limit, or far beyond what noise explains."""
    more = allowance(figures)
    return figures.mean > limit.mean + 3.0 * more.mean or figures.p99 > limit.p99 + 3.0 * more.p99
