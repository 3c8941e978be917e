"""A first comparison with Cycles: the same scene, the same integral, by both engines of one Blender."""

import blenders
import numpy as np
import pytest
from blenders import MODULE

# Scene -> (bounces, samples of each of four pictures).
SCENES = {
    "lambert": (4, 256),
    "emission": (1, 1024),
    "point": (1, 256),
    "soft_point": (0, 256),
    "spot": (1, 512),
    "sun": (1, 256),
    "area": (1, 256),
    "ellipse": (0, 256),
    "spread": (0, 256),
    "sheared_rectangle": (0, 256),
    "sheared_ellipse": (0, 256),
    "sheared_spot": (0, 256),
    "mirror": (4, 256),
    "glass": (6, 512),
    "depth_of_field": (2, 256),
    "orthographic": (2, 256),
    "background": (1, 64),
}
# Relative to the picture's mean level; barely visible side by side.
LIMIT = 0.01


# The fast scenes of parity compare the same things in less time.
@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_blocks(name, tmp_path):
    bounces, samples = SCENES[name]
    got = blenders.run(MODULE, tmp_path, "cycles_cases", "compare", name, bounces, samples)
    ours, theirs = np.array(got["LANCER"]), np.array(got["CYCLES"])
    level = theirs.mean()
    difference = (ours - theirs) / level
    worst = np.unravel_index(np.abs(difference).argmax(), difference.shape)
    noise = np.hypot(got["LANCER noise"], got["CYCLES noise"]) / level
    typical = np.sqrt(np.mean(noise**2))
    figures = (
        f"{name}: level {level:.5f}, Lancer/Cycles {ours.mean() / level:.5f}, worst block {worst[0]}, {worst[1]} (row 0 below) "
        f"{ours[worst[0], worst[1]]} against {theirs[worst[0], worst[1]]}, noise {typical:.5f}, there {noise[worst]:.5f}\n"
        f"{np.array2string(difference.mean(axis=2)[::-1], precision=4, suppress_small=True)}"
    )
    # Blocks with noise far below the limit must be within the limit; these must be nearly all blocks. The few noisier blocks
    # are allowed 4 standard errors more, which one of 16 000 values exceeds.
    assert level > 0.01 and np.mean(noise < LIMIT / 4) > 0.95, figures
    assert np.all(np.abs(difference) <= LIMIT + np.where(noise < LIMIT / 4, 0.0, 4.0 * noise)), figures
    # The noise of the mean of 192 values is 14 times smaller: a mean difference of 0.3 % is significant.
    assert abs(ours.mean() / level - 1.0) <= 0.003, figures
