"""Tangents of exported triangles against Blender's own MikkTSpace, which stops at faces of more than four corners."""

import blenders
import pytest
from blenders import MODULE, PROGRAM


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_tangents(which, tmp_path):
    got = blenders.run(which, tmp_path, "tangent_cases", "compare")
    # Triangles have angles down to 15 degrees, which single precision's arc cosine knows to 2^-23 / sin 15 = 5e-7, or 2e-6 of
    # them; sums of six of them, of tangents that half cancel, to eight times that.
    for name in ("plain", "mirrored", "barrel"):
        furthest, signs, _, count = got[name]
        assert furthest < 1.6e-5 and signs == 0 and count > 100, name
    assert got["plain"][2] == 0 and got["mirrored"][2] == got["mirrored"][3] / 2
    # Tangents lie across the normals, to their rounding of 2^-24 a component.
    assert got["upright"] < 1e-6
    assert got["without map"][0] == got["without map"][1]
