"""Vertices around which faces form more than one sheet: OpenSubdiv keeps them in their place, apart from smooth seams."""

import numpy as np


def odd_corners(cage, edges):
    """Return whether each vertex of a Cage stays in its place because of how the faces meet there."""
    count = len(cage.values)
    odd, border, around = (_number(edges.ends[which], count) for which in (edges.is_odd, edges.faces == 1, slice(None)))
    faces = np.bincount(cage.corners, minlength=count)
    # Two such edges, with sheets on both sides of the line that they make, leave it smooth.
    is_seam = (odd == 2) & (border == 0) & (faces > around)
    return ((odd > 0) | (_sheets(cage, edges) > 1)) & ~is_seam


def _number(ends, count):
    return np.bincount(ends.reshape(-1), minlength=count)


def _sheets(cage, edges):
    """Return the number of sets of faces around each vertex that hang together by edges."""
    after = cage.neighbours()[0]
    inside = np.flatnonzero((edges.faces == 2) & ~edges.is_odd)
    corners = np.argsort(edges.of_corner, kind="stable")
    starts = np.cumsum(edges.faces) - edges.faces
    one, other = corners[starts[inside]], corners[starts[inside] + 1]
    # The corners beside each corner at the same vertex, itself at the end of a sheet.
    left = np.arange(len(cage.corners))
    right = left.copy()
    left[one], left[other] = after[other], after[one]
    right[after[other]], right[after[one]] = one, other
    label = np.arange(len(cage.corners))
    while True:
        lower = np.minimum(label, np.minimum(label[left], label[right]))
        lower = lower[lower]
        if (lower == label).all():
            return np.bincount(cage.corners[np.unique(label)], minlength=len(cage.values))
        label = lower
