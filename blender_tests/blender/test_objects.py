"""Switches of objects, film and world in the snapshot."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name, **how: blenders.run(which, tmp_path, "object_cases", name, **how)


def test_switches(case):
    got = case("switches")
    assert got["rows"] == {
        "plain": [[[], []]],
        "camera": [[["CAMERA"], []]],
        "diffuse": [[["DIFFUSE"], []]],
        "glossy": [[["GLOSSY"], []]],
        "transmission": [[["TRANSMISSION"], []]],
        "volume_scatter": [[["VOLUME"], []]],
        "shadow": [[["SHADOW"], []]],
        "two": [[["CAMERA", "SHADOW"], []]],
        "hole": [[[], ["HOLDOUT"]]],
        "hole of a collection": [[[], ["HOLDOUT"]]],
        "indirect": [[["CAMERA"], []]],
        # A holdout must be visible to the camera.
        "hole, not indirect": [[[], ["HOLDOUT"]]],
        "catcher": [[[], ["CATCHER"]]],
    }
    seen_otherwise = [line.split("'")[1] for line in got["messages"] if "shadow rays see it and paths do not" in line]
    assert sorted(seen_otherwise) == ["diffuse", "glossy", "shadow", "transmission", "two"]
    others = [line for line in got["messages"] if "shadow rays see it" not in line]
    assert not others


def test_aovs_at_shadow_catchers_are_told(case):
    plain, caught = case("caught_aovs")
    assert plain == [] and ["twice" in line for line in caught] == [True]


def test_flat_objects_that_cycles_shows_otherwise(case):
    """Cycles hides shared meshes, turns smooth normals to the wrong side, and shadows coplanar faces by each other."""
    assert sorted(case("flat")) == [
        "object 'closed': is flat by a scale of 0 and closed, Cycles has its two sides shadow each other",
        "object 'shared': is flat by a scale of 0 and shares its mesh, Cycles leaves it out",
        "object 'turned': is flat by a scale of 0 and smooth, Cycles turns its normals away from the light",
    ]


def test_instancers_narrow_what_they_bring_in(case):
    got = case("instancers")
    assert got["rows"] == {"piece": [[["GLOSSY"], []], [["CAMERA", "GLOSSY"], []], [["GLOSSY"], ["HOLDOUT"]]]}
    assert got["meshes"] == 1


def test_instances_leave_nothing_allocated(case):
    """Blender reports memory blocks that are not freed at exit."""
    got = case("freed", alone=True)
    assert got["instances"] >= 2 + 5 + 1 + 6 and "Not freed" not in got["console"]
    assert "Not freed" not in case("freed_text", alone=True)["console"]


def test_meshes_bring_what_their_materials_read(case):
    got = case("attributes")
    got.pop("console")
    assert got["Plane"] == [] and got["Copy 0"] == ["Two"] and got["Copy 1"] in ([], ["Two"])


def test_generated_coordinates_fill_their_box(case):
    assert case("generated") == [[0.0, 0.0, 0.5], [1.0, 1.0, 0.5]]


def test_settings(case):
    got = case("settings")
    # Without a world Cycles ends ambient occlusion at 10.
    assert got["first"] == [False, False, pytest.approx(0.01), 8, 0.5, 10.0, 0.0, 100.0, 1.0]
    # A roughness of 0.5 is an alpha of 0.25.
    assert got["second"] == [True, True, 0.25, 3, 0.25, 4.0, 2.0, 30.0, 0.5]
    # Paths pass through 0 and 3 surfaces; Blender before 5 counts one more.
    assert got["bounces"] == ([1, 4] if got["version"] < [5, 0] else [1, 3])


def test_messages(case):
    got = case("told")
    assert got["empty slot"] == ["object 'Cube': material slot 1 is empty, grey is used"] and got["override"] == []
    assert got["strokes"] == [True, []]
    lost = "displacement, Wireframe, edges for the direction of hair, attribute 'Map', Pointiness"
    assert got["exact"] == [f"object 'SPHERE': its exact shape lacks what its mesh would have: {lost}"]
