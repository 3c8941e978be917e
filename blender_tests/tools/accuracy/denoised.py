"""The error that is told of denoised pictures, compared with their actual error."""

import numpy as np
import oidn_versions

from addon.bindings.denoised import combine
from addon.denoise import denoiser, oidn, view_layer
from tools.harness.errors import luminance

from . import figures

# Side of the blocks whose means have bars.
BLOCK = 8


def denoised(session):
    """Return (luminance, bars of pixels, bars of blocks, Combined) of a session's picture, denoised as F12 does."""
    arguments = view_layer.inputs(session) | {"library": oidn.load(oidn_versions.newer()), "threads": 1}
    found = denoiser.denoise(**arguments)
    blocks = combine(*found.pair, block=BLOCK)
    return luminance(found.image), found.combined.bars, blocks.bars, found.combined


def blocks(pictures):
    """Return the means of blocks, (count, rows, columns); blocks at the edges may be smaller."""
    height, width = pictures.shape[1:]
    rows, columns = (np.arange(0, size, BLOCK) for size in (height, width))
    sums = np.add.reduceat(np.add.reduceat(pictures, rows, axis=1), columns, axis=2)
    return sums / np.outer(np.diff([*rows, height]), np.diff([*columns, width]))


def compared(runs, reference):
    """Return the figures of the pictures of one number of samples. runs: [(as of denoised(), PictureError)]."""
    parts = blocks(reference.parts)
    truth, variance = parts.mean(axis=0), parts.var(axis=0, ddof=1) / len(parts)
    noisy = reference.noisy
    found = {"inside": [], "inside_blocks": [], "holds": [], "holds_with_unmet": [], "real": [], "told": [], "noisy": []}
    for (picture, bars, of_blocks, told), error in runs:
        good = figures.inside(picture, bars, reference)
        found["inside"].append(float(good[noisy].mean()) if noisy.any() else None)
        reach = figures.BAR * np.sqrt(of_blocks.astype(float) ** 2 + variance)
        apart = np.abs(blocks(picture[None])[0] - truth)
        changes = blocks(noisy[None].astype(float))[0] > 0.0
        found["inside_blocks"].append(float((apart <= reach)[changes].mean()) if changes.any() else None)
        real = reference.distance(picture)
        found["real"].append(real)
        found["told"].append(told.error)
        found["noisy"].append(error.error)
        found["holds"].append(told.low <= real <= told.high)
        found["holds_with_unmet"].append(told.low <= real <= told.high + error.cannot_exclude)
    return found
