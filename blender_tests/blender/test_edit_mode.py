"""Objects in Edit Mode, Sculpt Mode and paint modes are rendered as in Cycles, from a file and from a real window."""

import json

import blenders
import pytest
from blenders import MODULE, PROGRAM
from test_window import Window, display  # noqa: F401 - a fixture

both = pytest.mark.parametrize("which", [MODULE, PROGRAM])
MODES = ("OBJECT", "EDIT", "SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT", "PARTICLE_EDIT")
# Emission is rounded by one product and by the film's sum of one sample.
ROUNDING = 2.0**-22
# Pixels, from the centre, that show a box. No mode moves Plain, and Keyed, moved by one by a shape key; ...
STILL = [[-7, -7], [3, -4]]
# ... Edited with its copies by modifiers, its duplicate, the instance of its collection, Wrapped and its instance.
AT_REST = [[-4, -7], [-2, -7], [-4, -5], [-2, -5], [-4, 3], [3, 2], [5, 2], [3, 4], [5, 4], [2, -7], [-6, 6]]
# In Edit Mode: one pixel to the right, without the modifier hidden in Edit Mode and with the one hidden in renders; Wrapped by
# three. Keyed shows the edited key, which moves nothing.
EDITED = [[-7, -7], [2, -4], [-3, -7], [-1, -7], [-3, 3], [-3, 1], [4, 2], [6, 2], [5, -7], [-3, 6]]


@pytest.fixture
def case(which, tmp_path):
    return lambda name, *arguments: blenders.run(which, tmp_path, "edit_cases", name, *arguments)


@both
def test_every_mode_shows_what_cycles_shows(case):
    got = case("modes")
    for mode in MODES:
        assert got[mode]["mode"][0] == mode
        assert got[mode]["difference"] <= ROUNDING, mode
        assert not got[mode]["messages"], mode
        assert got[mode]["lit"] == sorted(EDITED if mode == "EDIT" else STILL + AT_REST), mode
    assert got["EDIT"]["mode"] == ["EDIT"] * 3


@both
def test_a_file_saved_in_edit_mode(case):
    got = case("saved")
    assert got["difference"] <= ROUNDING and got["lit"] == sorted(EDITED)


@both
def test_an_exact_shape_stands_where_its_mesh_is_edited(case):
    """A cube of two metres, moved by one."""
    got = case("exact")
    assert got["place"] == [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] and not got["messages"]


def test_f12_in_edit_mode_in_a_window(display, tmp_path):  # noqa: F811
    """Three objects in Edit Mode with edits that have not been flushed; F12 shows the edits and keeps the mode."""
    window = Window(str(tmp_path), display, "edit")
    try:
        window.wait_for("ready")
        window.press("F12")
        window.wait_for("render_complete")
        window.tell("compare")
        window.wait_for("compared")
    finally:
        code = window.close()
    assert code == 0, f"Blender ended with {code}"
    with open(tmp_path / "edited.json", encoding="utf-8") as file:
        got = json.load(file)
    assert got["mode"] == ["EDIT"] * 3
    assert got["difference"] <= ROUNDING and got["lit"] == sorted(EDITED)
