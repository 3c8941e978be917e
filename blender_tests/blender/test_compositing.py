"""One compositing script, two engines: the same picture within noise."""

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_a_script_composites_both_engines_alike(which, tmp_path):
    """Four view layers, a matte, denoised light groups and a catcher; means of blocks of 8 x 8 pixels."""
    got = blenders.run(which, tmp_path, "compositing_cases", "both")
    ours, theirs = (np.array(got["pictures"][engine]) for engine in ("LANCER", "CYCLES"))
    # The matte, the last to join the picture, tells in it.
    assert np.max(theirs.mean(axis=0) - np.array(got["without"])) > 0.05
    # Three seeds are too few for the spread of one block: its variance is the mean over all blocks' relative to their levels.
    level = theirs.mean(axis=0) + 0.1 * theirs.mean()
    variance = sum(np.mean(np.var(found / level, axis=0, ddof=1)) / len(found) for found in (ours, theirs))
    apart = np.abs(ours.mean(axis=0) - theirs.mean(axis=0)) / level
    # The largest of 48 normal differences is below five standard errors but once in 40 000. The denoiser smooths noise of
    # one spread over a few hundredths of the light, by which engines of unequal noise may differ where a block has an edge.
    assert np.max(apart) < 5.0 * np.sqrt(variance) + 0.005
    assert 0.0 < np.sqrt(variance) < 0.01
