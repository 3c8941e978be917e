"""Object > Bake: texels reach tiles, several images and colour attributes, from selected to active, as in Cycles."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

both = pytest.mark.parametrize("which", [MODULE, PROGRAM])

# Places of some metres in single precision: each engine rounds a few times by 2e-7.
_PLACE = 1e-5
# Paths of either engine begin within the triangle, some 1e-4 of an edge of 0.3 m from its corner, each by its own rule.
_CORNER = 1e-4
# The steps of sRGB bytes near 1 are 0.0088, and the engines' places may lie on two sides of an edge.
_BYTE = 0.009


def check(beside, bound=_PLACE):
    """Both engines fill the same values, not none."""
    assert beside["apart"] < bound, beside
    ours, theirs = beside["filled"]
    assert ours == theirs > 0, beside
    return ours / beside["all"]


@both
def test_tiles(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_target_cases", "tiles", tmp_path)
    for beside in got["tiles"]:
        # Each tile has three faces of 0.9 by 0.9 in a grid of three by two.
        assert 0.3 < check(beside) < 0.5
    assert got["apart from one"] < _PLACE


@both
def test_selected_to_active(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_target_cases", "onto_another")
    got.pop("console")
    shares = {name: check(beside) for name, beside in got.items()}
    assert shares["extrusion"] > shares["distance"]


@both
def test_light_of_another_object(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_target_cases", "lit")
    # No block is five standard errors apart, of which a block of the mean level has less than a hundredth.
    assert got["bias"] < 0.0 and got["noise"] < 0.01 < got["level"]
    assert got["other alpha"] == 0


@both
def test_margins(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_target_cases", "margins")
    got.pop("console")
    shares = {name: check(beside) for name, beside in got.items()}
    assert shares["none"] < min(shares["EXTEND"], shares["ADJACENT_FACES"])


@both
def test_color_attributes(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_target_cases", "attributes")
    assert got["same"]
    for name, beside in got["attributes"].items():
        check(beside, _BYTE if "BYTE" in name else _CORNER)


@both
def test_images_of_one_object_share_its_export(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_target_cases", "several_images")
    shares = {name: check(beside) for name, beside in got["images"].items()}
    assert shares["shared"] > shares["first"] > shares["other"]
    assert got["exports"] == [1, 2]
    assert got["open"] == 0


@both
def test_an_interrupted_bake_leaves_nothing(which, tmp_path):
    # Without an end the samples of either image take minutes.
    got = blenders.run(which, tmp_path, "bake_target_cases", "interrupted", alone=True)
    assert "sent" in got and got["waits after"] < 10, got
    assert got["finite"] and not got["running"] and got["open"] == 0
    assert got["level"] > 0.05
