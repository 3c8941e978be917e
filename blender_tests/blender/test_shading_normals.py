"""Shading normals and tangents equal those of Cycles in each Blender: of vertices, corners, faces, and custom ones."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

# Pixels on edges may show either face: samples are within 0.01 pixel widths of the centre. An edge crosses a pixel with
# probability below 0.5, and the offset crosses the edge with probability 0.01 x 0.5.
ON_EDGES = 0.5 * 0.01 * 0.5


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("fins", ["no", "yes"])
def test_normals_are_those_of_cycles(which, tmp_path, fins):
    """fins: up to three faces share an edge."""
    got = blenders.run(which, tmp_path, "normal_cases", "shaded", fins)
    got.pop("console")
    assert len(got) >= 10 and all(pixels > 5000 for _, pixels in got.values())
    assert {kind: share for kind, (share, _) in got.items() if share > ON_EDGES} == {}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_tangents(which, tmp_path):
    """Tangents of exported triangles against Blender's MikkTSpace, which fails on faces of more than four corners."""
    got = blenders.run(which, tmp_path, "tangent_cases", "compare")
    # Triangles have angles down to 15 degrees; arc cosine in single precision has an error of 2^-23 / sin 15 = 5e-7, or 2e-6
    # of the angle; sums of six tangents that partly cancel have eight times that error.
    for name in ("plain", "mirrored", "barrel"):
        furthest, signs, _, count = got[name]
        assert furthest < 1.6e-5 and signs == 0 and count > 100, name
    assert got["plain"][2] == 0 and got["mirrored"][2] == got["mirrored"][3] / 2
    # Tangents are orthogonal to the normals, up to rounding of 2^-24 per component.
    assert got["upright"] < 1e-6
    assert got["without map"][0] == got["without map"][1]
