"""Stereoscopy: every view shows what Cycles shows in it."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


def alike(got):
    """Both engines' pictures of places agree to noise at the edges of a cube, 3 units before its background."""
    assert got["same"] and got["views"] > 0.05, got
    assert all(apart < 0.1 * got["views"] for apart in got["engines"].values()), got


def test_eyes(which, tmp_path):
    got = blenders.run(which, tmp_path, "view_cases", "stereo", str(tmp_path))
    got.pop("console", None)
    assert len(got) == 12
    for name, differences in got.items():
        assert sorted(differences["engines"]) == ["left", "right"], name
        alike(differences)


def test_cameras(which, tmp_path):
    got = blenders.run(which, tmp_path, "view_cases", "cameras", str(tmp_path))
    assert sorted(got["engines"]) == ["A", "B"]
    alike(got)


def test_cameras_that_move(which, tmp_path):
    got = blenders.run(which, tmp_path, "view_cases", "blurred", str(tmp_path))
    got.pop("console", None)
    assert sorted(got) == ["cameras", "eyes"]
    for kind, differences in got.items():
        alike(differences)
        assert all(differences["engines"][view] < 0.2 * blur for view, blur in differences["blur"].items()), (kind, differences)


def test_vectors_of_each_view(which, tmp_path):
    """But for one pixel in fifty, at edges; Cycles' single precision keeps 1e-3 of a pixel's place."""
    got = blenders.run(which, tmp_path, "view_cases", "vectors", str(tmp_path))
    got.pop("console", None)
    assert sorted(got) == ["cameras A", "cameras B", "eyes left", "eyes right"]
    assert all(apart < 0.02 and most > 2.0 for apart, most in got.values()), got


def test_the_accuracy_of_each_view_is_told(which, tmp_path):
    got = blenders.run(which, tmp_path, "view_cases", "told")
    assert [name.split(", ")[-1] for name in got["layers"]] == ["left", "right"]
    assert all(name in line for name, line in zip(got["layers"], sorted(got["lines"]), strict=True))
