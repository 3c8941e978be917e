"""All simulations of a run: each still with each number of workers, then without each term of the time."""

import dataclasses

from .cases import GIGABIT
from .costs import TERMS, Assumed, without
from .simulate import simulate

# Least saving that counts as a limit.
LEAST_GAIN = 0.05


def study(still, workers, costs, say):
    """Return the rows of a still. gains: the share of the time that each term takes."""
    assumed = Assumed(bytes_per_second=still.gigabits * GIGABIT)
    rows = []
    for count in workers:
        found = simulate(still.case, count, costs, assumed)
        gains = {}
        for term in TERMS:
            faster = simulate(still.case, count, *without(term, costs, assumed))
            gains[term] = 1.0 - faster.seconds / found.seconds
        row = dataclasses.asdict(found) | {"workers": count, "efficiency": found.speedup / count, "gains": gains}
        rows.append(row)
        say(f"{still.letter}: {count} workers, {found.seconds:.0f} s, {found.speedup:.1f}x; {limit(row)}")
    return rows


def limits(row):
    """Return the terms that take a part of the time which counts, the largest first."""
    return sorted((term for term in row["gains"] if row["gains"][term] >= LEAST_GAIN), key=lambda term: -row["gains"][term])


def limit(row):
    """Return the term that takes most of the time, with its share."""
    found = limits(row)
    return f"{found[0]}, {100 * row['gains'][found[0]]:.0f} %" if found else "none but the samples"
