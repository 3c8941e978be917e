"""Messages of renders, in the bpy module of this Python and in Debian's Blender 3.4.1."""

import json

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name, where="message_cases": blenders.run(which, tmp_path, where, name)


def test_each_render_tells_its_own(case):
    """Persistent Data keeps the engine between renders, but not its messages."""
    got = case("persistent")
    assert len(got["first"]) == 3 and got["second"] == got["first"]
    # The message of the removed cube is gone.
    assert got["fewer"] == [line for line in got["first"] if "'Cube.001'" not in line] and len(got["fewer"]) == 2
    assert got["animation"] == got["fewer"]
    assert got["samples"][0] == got["samples"][1]


def test_the_messages_of_view_layers_add_up(case):
    got = case("layers")
    for kept in (False, True):
        alone, both = got[f"second {kept}"], got[f"both {kept}"]
        # Each layer has all objects: counts double with both layers.
        assert len(alone) == 3 and alone[0].endswith("magenta is used (2 times)")
        assert both == [alone[0].replace("(2 times)", "(4 times)"), f"{alone[1]} (2 times)", f"{alone[2]} (2 times)"]


def test_the_error_of_a_layer_outlasts_the_next(which, tmp_path):
    """The panel keeps the first layer's error beside the second layer's messages. In background mode the exit code is 1."""
    path = tmp_path / "panel.json"
    code, said, got = blenders.attempt(which, tmp_path, "message_cases", "failed_layer", path, alone=True)
    assert code == (0 if which == MODULE else 1) and "the first layer fails" in (got or said), said[-2000:]
    panel = json.loads(path.read_text(encoding="utf-8"))
    assert panel[0] == "the first layer fails" and len(panel) == 3, panel
    assert "magenta" in panel[1] and "'Cube'" in panel[2]


def test_light_paths_that_differ_are_told_in_one_line(case):
    got = case("light_paths", "setting_cases")
    # Cycles' defaults are a hint; only changed settings of Cycles are a difference.
    severities = got.pop("severities")
    hints = {"few bounces here", "same clamp", "own clamp", "clamped here alone", "same kinds"}
    assert {name: severity for name, (severity,) in severities.items()} == {
        name: "HINT" if name in hints else "DIFFERENT" for name in severities
    } and len(severities) == 8

    def line(theirs, ours):
        return [f"scene 'Scene': Cycles limits light by {theirs}, Lancer by {ours}: set both alike for a comparison"]

    rest = "Filter Glossy 1 and Clamp Indirect 10"
    kinds = "Diffuse 4, Glossy 4"
    # Defaults of both engines are not told.
    assert got["start"] == []
    # A limit of four bounces of a kind has no effect with a total of three.
    assert got["few bounces here"] == line(f"Total 12, {rest}", "Max Bounces 3")
    assert got["other number"] == line(f"Total 10, {kinds}, {rest}", "Max Bounces 12")
    assert got["few bounces there"] == line(f"Total 3, {rest}", "Max Bounces 12")
    assert got["few of light through glass"] == line(f"{kinds}, Transmission 2, {rest}", "Max Bounces 12")
    assert got["same clamp"] == line(f"{kinds} and Filter Glossy 1", "Max Bounces 12 and Clamp Indirect 10")
    assert got["own clamp"] == line(f"{kinds}, {rest}", "Max Bounces 12 and Clamp Indirect 2.5")
    assert got["clamped here alone"] == line(f"{kinds} and Filter Glossy 1", "Max Bounces 12 and Clamp Indirect 2.5")
    assert got["same kinds"] == line("Clamp Indirect 10", "Max Bounces 12, Diffuse 4, Glossy 4 and Filter Glossy 1")
    # The other integrators are not compared with Cycles.
    assert got["classic"] == got["normals"] == []


def test_settings_of_cycles_without_counterpart(case):
    got = case("settings", "setting_cases")
    assert got["alike"] == got["neutral"] == []
    assert len(got["words"]) == 7
    for word, lines in got["words"].items():
        assert len(lines) == 1 and word in lines[0] and lines[0].startswith("scene 'Scene'"), (word, lines)


def test_settings_of_objects_without_counterpart(case):
    got = case("objects", "setting_cases")
    for silent in ("plain", "divided"):
        assert got[silent] == [], silent
    words = {
        "terminator": "shadow terminator is left out, use the geometry offset",
        "caustics": "shadow caustics",
    }
    for name, word in words.items():
        assert len(got[name]) == 1 and word in got[name][0] and "object 'Cube'" in got[name][0], name


def test_what_is_left_out_says_what_is_shown_instead(case):
    got = case("left_out")
    expected = {
        "object 'Smoke': type VOLUME is not supported, it is left out",
        "material 'Fog' on object 'Cube': volumes are not supported, nothing of it is shown",
        "material 'Milk' on object 'Cube.001': volumes are not supported, its surface alone is shown",
        "world 'World': volumes are not supported, its background alone is shown",
    }
    if got["version"] < [4, 2]:
        expected.add("light 'Light': custom distance has no effect, as in Cycles")
    assert set(got["told"]) == expected and len(got["told"]) == len(expected)


def test_groups_of_addons_are_entered(case):
    got = case("custom_group")
    assert got["emission"] == [0.25, 0.5, 0.75] and got["messages"] == []


def test_nodes_that_cycles_does_not_know_have_no_effect(case):
    got = case("foreign_node")
    assert got["emission"] == [0.25, 0.5, 0.75]
    assert got["messages"] == ["material 'Shown' on object 'Cube', node 'Foreign': Foreign has no effect, as in Cycles"]


def test_light_that_depends_on_sampling_is_named(case):
    """A sky that looks different to the camera alone is no such light."""
    got = case("by_sampling")
    lamp, sky = (line for line in got["after"] if line not in got["before"] and line.startswith(("light", "world")))
    assert not any("sampling" in line or "ends paths" in line for line in got["before"])
    assert lamp.startswith("light 'Light': with at most 0 transparent bounces Cycles ends paths at lamps")
    assert sky.startswith("world 'World': its nodes read Light Path")


def test_meshes_and_skies_with_rules_of_cycles_own_are_named(case):
    got = case("meshes_apart")
    version, before = got["version"], got["before"]
    (sky,) = set(got["after"]) - set(before)
    assert (
        sky.startswith("world 'World': ray visibility hides it from some lobes")
        and "Diffuse, Glossy and Transmission equal" in sky
    )
    # Both planes lack the map.
    tangents = [line for line in before if "has no UV map 'Gone'" in line]
    assert [line.split(":")[0] for line in tangents] == ["object 'Plane'", "object 'Plane.001'"]
    assert all("add the map" in line for line in tangents)
    creases = [line for line in before if "displacement renews its normals" in line]
    assert [line.split(":")[0] for line in creases] == ["object 'Half'"]
    flat = [line.split(":")[0] for line in before if "flat faces with Displacement and Bump" in line]
    assert flat == (["object 'Flat'"] if [5, 0] <= version < [5, 2] else [])
    assert len(before) == len(tangents) + len(creases) + len(flat)


def test_passes_that_an_integrator_leaves_black_are_named(case):
    got = case("empty_passes")
    assert got["PATH"] == {"black": [], "told": []}
    for integrator, title in (("CLASSIC", "Classic"), ("NORMALS", "Normals")):
        black, (line,) = got[integrator]["black"], got[integrator]["told"]
        assert title in line and "Path Tracing" in line
        assert len(line.split(": ")[-1].split(", ")) == len(black) > 0, (black, line)
