"""Simulated parts of a picture: the ranges of samples that they hold, and their bytes by lancer.h, "parts of a picture"."""

import bisect

import numpy as np

from addon.bindings.session import LancerError

# Bytes of a tile's four numbers, and of the start and level of a sum.
_TILE, _SUM = 16, 8


class Part:
    """A part of a picture: the ranges that it holds, and its size."""

    def __init__(self, ranges, nbytes):
        self.ranges, self.nbytes = ranges, nbytes


def part_of(ranges, pixels, costs):
    """Return the Part of ranges; pixels: of each tile; costs: PartCosts."""
    pixels = pixels[ranges["tile"]].astype(np.int64)
    sums, tiles = sums_of(ranges), np.unique(ranges["tile"], return_index=True)[1]
    nbytes = costs.head_bytes + len(tiles) * _TILE + int(np.sum(sums)) * _SUM
    nbytes += int(np.sum(sums * pixels)) * costs.sum_bytes + int(np.sum(pixels[tiles])) * costs.tile_bytes
    return Part(ranges, nbytes + int(np.sum(pixels[ranges["first"] == 0])) * costs.first_bytes)


def sums_of(ranges):
    """Return the number of sums that hold each range's samples: aligned powers of two."""
    first, count = ranges["first"].astype(np.int64), ranges["count"].astype(np.int64)
    end = first + count
    # Nearly all ranges are aligned.
    if not np.any(count & (count - 1) | first & (count - 1)):
        return np.ones(len(ranges), np.int64)
    found = np.zeros(len(ranges), np.int64)
    while np.any(left := first < end):
        aligned = np.where(first > 0, first & -first, np.int64(1) << 62)
        fits = np.int64(1) << np.log2(np.maximum(end - first, 1)).astype(np.int64)
        first = np.where(left, first + np.minimum(aligned, fits), first)
        found += left
    return found


def joined(several):
    """Return the ranges of several parts as one array, where ranges of a tile that follow each other are one."""
    ranges = np.concatenate(several)
    ranges = ranges[np.lexsort((ranges["first"], ranges["tile"]))]
    begins = np.ones(len(ranges), bool)
    begins[1:] = (ranges["tile"][1:] != ranges["tile"][:-1]) | (ranges["first"][1:] != (ranges["first"] + ranges["count"])[:-1])
    made = ranges[begins]
    made["count"] = np.add.reduceat(ranges["count"], np.flatnonzero(begins))
    return made


def with_span(spans, first, end):
    """Return sorted (first, end) spans with one more, where neighbours are one; raise LancerError if some samples are there."""
    at = bisect.bisect(spans, (first, end))
    before, after = spans[:at], spans[at:]
    if before and before[-1][1] > first or after and after[0][0] < end:
        raise LancerError("part: samples that the session has already")
    if before and before[-1][1] == first:
        first = before.pop()[0]
    if after and after[0][0] == end:
        end = after.pop(0)[1]
    return [*before, (first, end), *after]
