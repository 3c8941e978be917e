"""Summarise the rows: counts, means, and missing features, ranked by the number of files that they would make right."""

import math
from collections import Counter

from tools.harness import estimates

# The words of each verdict for one file and for several, in the order of the page.
_WORDS = {
    "untold": ("differs without a message", "differ without a message"),
    "failed": ("fails in Lancer", "fail in Lancer"),
    "told": ("differs with a message", "differ with a message"),
    "cycles": ("fails in Cycles", "fail in Cycles"),
    "noise": ("equal within a noise above the limits",) * 2,
    "equal": ("equal", "equal"),
    "black": ("black", "black"),
    "unreadable": ("cannot be opened", "cannot be opened"),
    "missing": ("not there", "not there"),
}
ORDER = tuple(_WORDS)
EQUAL = ("equal", "noise")
# Verdicts with which a run fails.
FAULTS = ("untold", "failed")


def words(verdict, count=1):
    return _WORDS[verdict][count != 1]


def counts(rows):
    found = Counter(row["verdict"] for row in rows)
    return {verdict: found[verdict] for verdict in ORDER if found[verdict]}


def means(rows):
    """Return geometric means of Lancer over Cycles, of the files with equal pictures and of all: {"equal", "all": {...}}."""
    return {
        "equal": _means([row for row in rows if row["verdict"] in EQUAL]),
        "all": _means(rows),
    }


def _means(rows):
    values = {
        "speed": [row["speed"] for row in rows if "speed" in row],
        "variance": [row["variance"]["ratio"] for row in rows if "variance" in row],
        "efficiency": [row["efficiency"] for row in rows if "efficiency" in row],
    }
    usable = {name: [x for x in found if 0.0 < x < math.inf] for name, found in values.items()}
    result = {name: estimates.geometric_mean(found) if found else None for name, found in usable.items()}
    result["least_efficiency"] = min(usable["efficiency"], default=None)
    return {**result, "files": len(usable["efficiency"])}


def rank(rows):
    """Return [{"key", "completes", "total", "files", "uses"}]: each next feature makes most files right, given all before.

    rows: of all files; only files that differ with a message are completed. Of features that complete equally many files, the
    one that more of these files use comes first. files: number of all files that use the feature; uses: number of its uses.
    """
    open_ = [set(row["missing"]) for row in rows if row["verdict"] == "told" and row["missing"]]
    everywhere, uses = Counter(), Counter()
    for row in rows:
        everywhere.update(set(row["missing"]))
        uses.update(row["missing"])
    ranked, total = [], 0
    while open_:
        completes = Counter(next(iter(keys)) for keys in open_ if len(keys) == 1)
        wanted = Counter(key for keys in open_ for key in keys)
        best = min(wanted, key=lambda key: (-completes[key], -wanted[key], key))
        total += completes[best]
        open_ = [rest for rest in (keys - {best} for keys in open_) if rest]
        ranked.append(
            {"key": best, "completes": completes[best], "total": total, "files": everywhere[best], "uses": uses[best]}
        )
    return ranked


def summary(rows):
    return {"files": len(rows), "counts": counts(rows), "means": means(rows), "missing": rank(rows)}


def sentence(found):
    """Return the counts in a line."""
    return f"{found['files']} files: " + ", ".join(
        f"{count} {words(verdict, count)}" for verdict, count in found["counts"].items()
    )
