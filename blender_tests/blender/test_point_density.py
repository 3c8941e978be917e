"""Point Density: the exported voxels and their place, and nodes without points."""

import blenders
from blenders import PROGRAM


def test_voxels(tmp_path):
    got = blenders.run(PROGRAM, tmp_path, "point_density_cases", "voxels")
    # Blender sums in single precision what is here in double, at most four points and at most 1 in all.
    assert got["seen"] > 0.4 and max(got["density"], got["color"]) < 1e-6
    # Matrices are of single precision, with numbers up to 8.
    for corner, expected in zip(got["corners"], ([0.0] * 3, [1.0] * 3), strict=True):
        assert all(abs(x - y) < 2e-6 for x, y in zip(corner, expected, strict=True)), corner
    assert got["option"] == 2  # cubic
    assert got["nodes"] == 1  # for two outputs
    assert got["kept"] and not got["messages"]


def test_nodes_without_points(tmp_path):
    got = blenders.run(PROGRAM, tmp_path, "point_density_cases", "nowhere")
    got.pop("console")
    reasons = {
        "object": "has no object",
        "vertices": "object 'Void' has no vertices",
        "mesh": "object 'Bar' has no vertices",
        "system": "object 'Cloud' shows no such particle system",
        "shown system": "object 'Cloud' shows no such particle system",
        "memory": "object 'Cloud': a resolution of 20000 needs more memory than there is",
    }
    who = "material 'Shown' on object 'Cube', node 'Dust'"
    assert got == {name: [[f"{who}: {reason}, 0 is used"], [0.0] * 3] for name, reason in reasons.items()}


def test_edits_of_the_points(tmp_path):
    """A window's export follows vertices, the object's place, and particles from frame to frame."""
    got = blenders.run(PROGRAM, tmp_path, "point_density_cases", "edits")
    got.pop("console")
    assert got == {"first": [2, True, True], "points": [1, True, True], "place": [1, True, True], "frame": [1, True, True]}


def test_a_density_is_no_share(tmp_path):
    got = blenders.run(PROGRAM, tmp_path, "point_density_cases", "roughness")
    assert len(got) == 1 and got[0].endswith("input 'Roughness' is clamped to 0 to 1, which Cycles 3 does not do")
