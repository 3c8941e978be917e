"""Vertices that count as one for Pointiness: compare the export's search with one over all pairs."""

import numpy as np

from addon.export.pointiness import _first_of_equals

_EPSILON = np.float32(2.0**-23)


def _over_all_pairs(positions):
    """Return for each vertex the last one of the chain from it: each next is the nearest by sum that is equal."""
    sums = positions[:, 0] + positions[:, 1] + positions[:, 2]
    order = np.argsort(sums, kind="stable")
    sums, places, last = sums[order], positions[order], np.arange(len(order))
    for one in reversed(range(len(order))):
        rest = slice(one + 1, None)
        is_equal = ((places[rest] - places[one]) ** 2).sum(axis=1) < _EPSILON
        is_equal &= sums[rest] - sums[one] <= np.float32(3.0) * _EPSILON
        if is_equal.any():
            last[one] = last[one + 1 + np.argmax(is_equal)]
    first = np.empty(len(order), np.int64)
    first[order] = order[last]
    return first


def _sets():
    generator = np.random.default_rng(1)
    x, y = np.meshgrid(*(np.arange(40) / 64,) * 2)
    grid = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    near = generator.random((200, 3)).repeat(4, axis=0) + 3e-7 * generator.random((800, 3))
    return {
        "grid": np.concatenate([grid, grid]) - 0.25,
        "near": near,
        "steps": generator.integers(-20, 20, (1500, 3)) * 2.0**-13,
        "large": generator.integers(-20, 20, (1500, 3)) * 1e15,
        "one place": np.zeros((50, 3)),
        "none": np.zeros((0, 3)),
    }


def equals():
    """Return {set: whether both searches agree}, and the steps of the search on a plane with all vertices doubled."""
    found = {}
    for name, places in _sets().items():
        places = places.astype(np.float32)
        found[name] = bool((_first_of_equals(places, lambda: None) == _over_all_pairs(places)).all())
    x, y = np.meshgrid(*(np.arange(200) / 64,) * 2)
    plane = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1).astype(np.float32)
    steps = []
    _first_of_equals(np.concatenate([plane, plane]), lambda: steps.append(1))
    return {"agree": found, "steps": len(steps)}
