"""Variance against Cycles at equal samples, with the lights and paths that the pilot chooses."""

import blenders
import pytest
from blenders import MODULE, PROGRAM


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_sun_and_sky_are_no_noisier_than_in_cycles(which, tmp_path):
    """Four pictures give a ratio to some percent."""
    got = blenders.run(which, tmp_path, "noise_cases", "skies")
    got.pop("console")
    assert len(got) == 3 and all(ratio < 0.9 for ratio in got.values()), got


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_slides_and_photometric_lamps_are_hardly_noisier_than_in_cycles(which, tmp_path):
    got = blenders.run(which, tmp_path, "noise_cases", "lamps")
    got.pop("console")
    assert len(got) == 4 and all(ratio < 1.5 for ratio in got.values()), got
