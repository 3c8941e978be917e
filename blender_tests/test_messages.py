"""What a render tells, in the bpy module of this Python and in Debian's Blender 3.4.1."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "message_cases", name)


def test_each_render_tells_its_own(case):
    """Persistent Data keeps the engine from render to render, but not what it said."""
    got = case("persistent")
    assert len(got["first"]) == 3 and got["second"] == got["first"]
    # The cube that is gone takes its message along.
    assert got["fewer"] == [line for line in got["first"] if "'Cube.001'" not in line] and len(got["fewer"]) == 2
    assert got["animation"] == got["fewer"]
    assert got["samples"][0] == got["samples"][1]


def test_the_messages_of_view_layers_add_up(case):
    got = case("layers")
    for kept in (False, True):
        alone, both = got[f"second {kept}"], got[f"both {kept}"]
        # Each layer shows all: what one alone says once, both say twice.
        assert len(alone) == 3 and alone[2].endswith("magenta is used (2 times)")
        assert both == [f"{alone[0]} (2 times)", f"{alone[1]} (2 times)", alone[2].replace("(2 times)", "(4 times)")]


def test_settings_of_cycles_without_counterpart(case):
    got = case("settings")
    assert got["start"] == got["neutral"] == got["simplify"] == got["nobody culled"] == got["panorama"] == []
    assert len(got["words"]) == 12
    for word, lines in got["words"].items():
        assert len(lines) == 1 and word in lines[0] and lines[0].startswith("scene 'Scene'"), (word, lines)


def test_settings_of_objects_without_counterpart(case):
    got = case("objects")
    for silent in ("plain", "divided", "not rendered", "not last"):
        assert got[silent] == [], silent
    assert got.get("supported features", []) == []
    words = {"terminator": "shadow terminator", "caustics": "shadow caustics", "adaptive": "'Round'"}
    for name, word in words.items():
        assert len(got[name]) == 1 and word in got[name][0] and "object 'Cube'" in got[name][0], name


def test_groups_of_addons_are_entered(case):
    got = case("custom_group")
    assert got["emission"] == [0.25, 0.5, 0.75] and got["messages"] == []


def test_passes_that_an_integrator_leaves_black_are_named(case):
    got = case("empty_passes")
    assert got["PATH"] == {"black": [], "told": []}
    for integrator, title in (("CLASSIC", "Classic"), ("NORMALS", "Normals")):
        black, (line,) = got[integrator]["black"], got[integrator]["told"]
        assert title in line and "Path Tracing" in line
        assert len(line.split(": ")[-1].split(", ")) == len(black) > 0, (black, line)
