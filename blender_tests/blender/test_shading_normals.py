"""Meshes are shaded with the normals that Cycles takes in each Blender: of vertices, corners, faces, triangles, the user's."""

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
