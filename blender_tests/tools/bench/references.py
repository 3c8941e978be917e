"""Converged pictures, kept from run to run: a renderer's own, for its own errors."""

import hashlib

import numpy as np

from . import estimates, jobs

# Far from the seeds of the rounds.
_SEEDS = (1001, 1002)


def digest_of_scene(path):
    """Of the arrays in a snapshot's file, whatever their packing."""
    result = hashlib.sha256()
    with np.load(path) as arrays:
        for name in sorted(arrays.files):
            result.update(name.encode())
            result.update(np.ascontiguousarray(arrays[name]).tobytes())
    return result.hexdigest()[:16]


def find(renderer, version, scene, snapshot, render):
    """(reference, variance of its pixels), rendered in two halves where it is not at hand."""
    folder = jobs.OUTPUT / "references"
    folder.mkdir(parents=True, exist_ok=True)
    key = f"{version} {digest_of_scene(snapshot)} {scene.reference}"
    name = f"{scene.name}-{renderer.key}-{hashlib.sha256(key.encode()).hexdigest()[:16]}"
    halves = []
    for number, seed in enumerate(_SEEDS):
        path = folder / f"{name}-{number}.npy"
        if not path.exists():
            unfinished = path.with_suffix(".part.npy")
            render(renderer, scene, samples=scene.reference // 2, seed=seed, picture=str(unfinished), first_look=False)
            unfinished.rename(path)
        halves.append(np.load(path))
    return estimates.join_halves(*halves)
