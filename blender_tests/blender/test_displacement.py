"""Displacement by each of Blender's methods: true displacement, bump, and both."""

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM

SLOPE = (0.5, -0.25, 0.0)
NONE = [0.0, 0.0, 0.0]


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_methods(which, tmp_path):
    got = blenders.run(which, tmp_path, "displacement_cases", "methods", *SLOPE)
    leaning = np.array([-0.5, 0.25, 1.0]) / np.sqrt(1 + 0.5**2 + 0.25**2)
    for method, moves, bumps in (("BUMP", False, True), ("DISPLACEMENT", True, False), ("BOTH", True, True)):
        case = got[method]
        assert case["messages"] == [] and set(case["mesh"]) == {0.0}
        # The bump applies to the material and to every lobe without a normal of its own.
        for normal in (case["normal"], case["lobe normal"]):
            assert isinstance(normal, dict) if bumps else normal == NONE, method
        assert isinstance(case["displacement"], dict) if moves else case["displacement"] == NONE, method
        rise = np.array(case["places"]) @ SLOPE[:2] if moves else np.zeros(3)
        # Vertices are stored in float.
        assert case["heights"] == pytest.approx(rise.tolist(), abs=1e-6), method
        # The plane is tilted once, by displacement or by bump. Coordinates below 2 have an error of 2^-23, and a bump's offset
        # is at least a tenth of half a pixel of size 1: the tolerance is four times their quotient.
        assert case["shown"] == pytest.approx(leaning.tolist(), abs=1e-5), method
