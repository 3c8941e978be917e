"""Displacement by each of Blender's methods: what is moved, and what is only shaded as if it were."""

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
        # The bump is the material's, and of every lobe that has no normal of its own.
        for normal in (case["normal"], case["lobe normal"]):
            assert isinstance(normal, dict) if bumps else normal == NONE, method
        assert isinstance(case["displacement"], dict) if moves else case["displacement"] == NONE, method
        rise = np.array(case["places"]) @ SLOPE[:2] if moves else np.zeros(3)
        # Vertices are stored in float.
        assert case["heights"] == pytest.approx(rise.tolist(), abs=1e-6), method
        # The plane leans once, whoever tilts it. Coordinates below 2 are known to 2^-23, and a bump looks at least a tenth of
        # half a pixel of 1 aside: four times their quotient.
        assert case["shown"] == pytest.approx(leaning.tolist(), abs=1e-5), method
