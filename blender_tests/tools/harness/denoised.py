"""Errors of denoised pictures of Lancer and of Cycles at equal time."""

import math
import statistics

# Samples per pixel of the pictures, and those of Cycles at whose time both are compared.
COUNTS = (1, 2, 4, 8, 16, 32, 64, 128, 256)
DRAFTS = (16, 32, 64)
# Samples of Cycles whose FLIP is to be reached.
REACHED = 128


def measured(points, reference):
    """Return a list of {"samples", "seconds", "square", "flip", "error"}: medians over seeds.

    points: curves, one of each seed.
    """
    rows = []
    for of_seeds in zip(*points, strict=True):
        squares = [reference.square(picture) for *_, picture in of_seeds]
        flips = [reference.flip(picture) for *_, picture in of_seeds]
        errors = [reference.relative(picture) for *_, picture in of_seeds]
        rows.append(
            {
                "samples": of_seeds[0][0],
                "seconds": statistics.median(seconds for _, seconds, _ in of_seeds),
                "square": statistics.median(squares),
                "flip": statistics.median(flips),
                "error": statistics.median(errors),
            }
        )
    return rows


def compared(ours, theirs):
    """Return {"square", "flip": {samples: ratio at Cycles' time}, "time": ratio of the times to Cycles' FLIP at REACHED}.

    Values between two pictures are interpolated by logarithms. A ratio that would need a picture beyond the ends is missing.
    """
    found = {"square": {}, "flip": {}, "time": None}
    for row in theirs:
        if row["samples"] in DRAFTS:
            for name in ("square", "flip"):
                value = at(ours, "seconds", row["seconds"], name)
                if value is not None and row[name] > 0.0:
                    found[name][str(row["samples"])] = value / row[name]
        if row["samples"] == REACHED:
            seconds = at(ours, "flip", row["flip"], "seconds")
            found["time"] = seconds / row["seconds"] if seconds is not None else None
    return found


def at(rows, key, value, wanted):
    """Return wanted where key has this value, on a curve that rises or falls with it; None beyond its ends."""
    for before, after in zip(rows[:-1], rows[1:], strict=True):
        low, high = sorted((before[key], after[key]))
        if low <= value <= high and low < high and min(before[wanted], after[wanted]) > 0.0:
            share = math.log(value / before[key]) / math.log(after[key] / before[key])
            return before[wanted] * (after[wanted] / before[wanted]) ** share
    return None


HEAD = ["denoised, over Cycles", *(f"squared error, {n}" for n in DRAFTS), *(f"FLIP, {n}" for n in DRAFTS)]
HEAD.append(f"time to FLIP of {REACHED}")


def cells(found):
    """Return the cells of HEAD after the first one; found: as from compared()."""
    ratios = [found[kind].get(str(n)) for kind in ("square", "flip") for n in DRAFTS]
    return [f"{ratio:.2f}x" if ratio is not None else "" for ratio in (*ratios, found["time"])]


def table(found, name="Lancer"):
    """Return (head, rows) of one comparison."""
    return HEAD, [[name, *cells(found)]]


def means(compared):
    """Return the geometric means of several comparisons, in the form of one."""
    found = {kind: {str(n): mean(one[kind].get(str(n)) for one in compared) for n in DRAFTS} for kind in ("square", "flip")}
    return found | {"time": mean(one["time"] for one in compared)}


def mean(ratios):
    """Return the geometric mean, or None."""
    ratios = [ratio for ratio in ratios if ratio is not None and ratio > 0.0]
    return math.exp(sum(math.log(ratio) for ratio in ratios) / len(ratios)) if ratios else None
