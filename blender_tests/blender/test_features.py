"""Kernels made for a scene, and the features that a scene uses, as reported by a render and as measured."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

SCENES = ("showcase", "balls", "spheres600", "default_cube", "cornell", "lab")
both = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.mark.parametrize("name", SCENES)
def test_the_special_kernel_gives_the_general_picture(name, tmp_path):
    """Both kernels give equal bits on scenes of the project."""
    got = blenders.run(MODULE, tmp_path, "uses_cases", "both_kernels", name)
    for integrator in ("PATH", "CLASSIC"):
        kernels, difference, level = got[integrator]
        assert difference == 0.0, (integrator, kernels)
        assert level > 0.0


@both
def test_statistics_name_features_and_memory_by_kind(which, tmp_path):
    got = blenders.run(which, tmp_path, "uses_cases", "statistics")
    used = {feature["name"]: feature for feature in got["uses"]}
    assert used["glass"]["text"] == "1 material uses refraction" and used["glass"]["owners"] == ["Glass"]
    assert used["textures"]["owners"] == ["Pictured"] and used["triangles"]["count"] == 14
    assert used["smooth"]["count"] == 12 and used["environment"] and used["point-lights"]["owners"] == ["Light"]
    # 16 x 16 pixels of three bytes, without the unused alpha.
    assert got["memory"]["texture_bytes"] == 16 * 16 * 3
    assert all(value > 0 for value in got["memory"].values()) and got["costs"] is None


@both
def test_the_operator_measures_and_changes_nothing(which, tmp_path):
    got = blenders.run(which, tmp_path, "uses_cases", "measured")
    assert got["result"] == ["FINISHED"] and got["changed"] == [] and got["compared"] > 500
    share, uncertainty, text = got["costs"]["glass"]
    assert text.startswith("1 material uses refraction; without it this frame would take ")
    assert got["old"] == [False, True]
    assert set(got["hints"]) <= set(got["costs"]) and sorted(got["costs"]) == got["kept"] == got["kept after a render"]


@both
def test_nothing_to_measure_without_a_camera(which, tmp_path):
    got = blenders.run(which, tmp_path, "uses_cases", "without_camera")
    assert "The scene has no camera" in got["error"]
