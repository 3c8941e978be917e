"""Meshes' normals are those that Cycles takes in each Blender: of vertices, corners, faces, the user's; and tangents."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

# Pixels on edges of faces may show either: both engines see a pixel at its middle to 0.01 of its width, which moves some over
# an edge. A pixel is crossed by an edge with a chance below a half, and its middle moved over that with one of 0.01 x 0.5.
ON_EDGES = 0.5 * 0.01 * 0.5


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("fins", ["no", "yes"])
def test_normals_are_those_of_cycles(which, tmp_path, fins):
    """With fins, up to three faces share an edge."""
    got = blenders.run(which, tmp_path, "normal_cases", "shaded", fins)
    got.pop("console")
    assert len(got) >= 10 and all(pixels > 5000 for _, pixels in got.values())
    assert {kind: share for kind, (share, _) in got.items() if share > ON_EDGES} == {}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_tangents(which, tmp_path):
    """Of exported triangles, against Blender's own MikkTSpace, which stops at faces of more than four corners."""
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
