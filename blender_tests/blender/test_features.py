"""Only what the scene requires: the specialised kernel gives the bits of the general one, on every scene of the project."""

import blenders
import pytest
from blenders import MODULE

SCENES = ("showcase", "balls", "spheres600", "default_cube", "cornell", "lab")


@pytest.mark.parametrize("name", SCENES)
def test_the_special_kernel_gives_the_general_picture(name, tmp_path):
    got = blenders.run(MODULE, tmp_path, "feature_cases", "both_kernels", name)
    for integrator in ("PATH", "CLASSIC"):
        kernels, difference, level = got[integrator]
        assert difference == 0.0, (integrator, kernels)
        assert level > 0.0
    # PATH had something to specialise, so the comparison is not of a thing with itself.
    special, general = got["PATH"][0]
    assert special != general
