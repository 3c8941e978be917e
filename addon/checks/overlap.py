"""Overlap tests of many boxes in space and triangles in a plane, by sorting instead of testing all pairs."""

import numpy as np

_NEAREST = 256
_ENDLESS = 1e20
_AT_ONCE = 1 << 21


def box_pairs(low, high, most, group=None):
    """Return (i, j), i < j, of overlapping boxes, by a sweep along the axis with the fewest candidates.

    low, high: (n, 3). group: a whole number for each box; only boxes of the same group are tested. None if there are more than
    most candidates.
    """
    group = np.zeros(len(low)) if group is None else group.astype(float)
    best = None
    for axis in range(3):
        first, last = _within_one(low[:, axis], high[:, axis])
        # Place the groups one after the other along the axis.
        order = np.argsort(group + first, kind="stable")
        # Candidates of a box begin within its interval.
        ends = np.searchsorted((group + first)[order], (group + last)[order], side="right")
        counts = ends - np.arange(len(order)) - 1
        total = int(counts.sum())
        if best is None or total < best[0]:
            best = total, order, counts
    total, order, counts = best
    if total > most:
        return None
    found, sums = [np.empty((2, 0), np.int64)], np.cumsum(counts)
    # Test in blocks to limit memory.
    for first in range(0, total, _AT_ONCE):
        part = np.arange(*np.searchsorted(sums, (first, first + _AT_ONCE), side="right"))
        before = sums[part] - counts[part]
        one = np.repeat(part, counts[part])
        other = one + 1 + np.arange(len(one)) - np.repeat(before - before[0], counts[part])
        i, j = order[one], order[other]
        meet = group[i] == group[j]
        for axis in range(3):
            meet &= (low[i, axis] <= high[j, axis]) & (low[j, axis] <= high[i, axis])
        found.append(np.stack((i[meet], j[meet])))
    return tuple(np.sort(np.concatenate(found, axis=1), axis=0))


def _within_one(low, high):
    """Return both ends of intervals scaled to 0 to 1, with a margin at the upper end for the rounding of sums with groups.

    Infinite intervals reach to the end of the scale.
    """
    finite = (low > -_ENDLESS) & (high < _ENDLESS)
    if not finite.any():
        return np.zeros(len(low)), np.full(len(low), 0.5)
    start, end = low[finite].min(), high[finite].max()
    scale = 0.999 / max(end - start, np.finfo(float).tiny)
    return np.clip((low - start) * scale, 0.0, 0.999), np.clip((high - start) * scale, 0.0, 0.999) + 2.0**-30


def triangles_over(one, other, margin):
    """Return (n,) bool: whether pairs of triangles, (n, 3, 2), overlap by more than margin, (n,)."""
    over = np.ones(len(one), bool)
    for sides in (one, other):
        for corner in range(3):
            # Two triangles are separate if a line along one of their edges separates them.
            edge = sides[:, (corner + 1) % 3] - sides[:, corner]
            length = np.hypot(edge[:, 0], edge[:, 1])
            across = np.stack((-edge[:, 1], edge[:, 0]), axis=1) / length[:, None]
            mine, theirs = (np.einsum("ijk,ik->ij", t, across) for t in (one, other))
            apart = np.maximum(mine.min(axis=1) - theirs.max(axis=1), theirs.min(axis=1) - mine.max(axis=1))
            over &= apart < -margin
    return over


def overlapping_triangles(one, other, most):
    """Return (i, j) of triangles of two sets, (n, 3, 2) and (m, 3, 2), that overlap by 1 % of the smaller one's size.

    With more than most candidates only the triangles nearest to the centre of the sets' intersection are tested.
    """
    corners = np.concatenate((one, other))
    low, high = corners.min(axis=1), corners.max(axis=1)
    flat = np.zeros((len(corners), 1))
    pairs = box_pairs(np.hstack((low, flat)), np.hstack((high, flat)), most)
    if pairs is None:
        # Too many candidates: test those nearest to the centre of the sets' intersection.
        sets = (low[: len(one)], high[: len(one)]), (low[len(one) :], high[len(one) :])
        middle = np.maximum(*(part.min(axis=0) for part, _ in sets)) + np.minimum(*(part.max(axis=0) for _, part in sets))
        away = [np.maximum(a - 0.5 * middle, 0.5 * middle - b).max(axis=1) for a, b in sets]
        i, j = (
            part.ravel() for part in np.meshgrid(*(np.argsort(part, kind="stable")[:_NEAREST] for part in away), indexing="ij")
        )
    else:
        crossing = (pairs[0] < len(one)) & (pairs[1] >= len(one))
        i, j = pairs[0][crossing], pairs[1][crossing] - len(one)
    size = (high - low).max(axis=1)
    over = triangles_over(one[i], other[j], 0.01 * np.minimum(size[i], size[j + len(one)]))
    return i[over], j[over]
