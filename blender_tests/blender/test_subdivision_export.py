"""Adaptive subdivision of Blender's objects: when, by which settings, with which layers, within which memory."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "subdivision_cases", name)


def test_what_is_divided(case):
    got = case("objects")
    # A pixel is 0.1 wide. Two squares of side 2 have halves of 1, in edges of 0.26: 4 segments each. Before 4.5 Cycles divides
    # the eight squares of side 1 that the modifier makes, whose halves have 2 segments.
    assert got["divided"]["triangles"] == 2 * 8 * 8 * 2 and got["kept"]
    size, *others = got["divided"]["told"]
    assert size == "object 'Plane': adaptive subdivision makes 256 triangles, which need 0 MB"
    # Cycles before 4.5 splits faces by other rules.
    assert len(others) == (got["version"] < [4, 5])
    for name in ("not last", "off"):
        assert got[name]["told"] == [], name
    # Two squares, or the eight of the modifier, in two triangles each.
    assert got["off"]["triangles"] == 4 and got["not last"]["triangles"] == 16
    assert got["levels"]["triangles"] == (2 * 4 * 2 if got["version"] >= [4, 5] else 8 * 4 * 2)
    # Edges of twice the length.
    assert got["coarser"]["triangles"] == 2 * 4 * 4 * 2
    assert got["instances"]["meshes"] == 1 and got["instances"]["triangles"] == got["coarser"]["triangles"]


def test_layers(case):
    got = case("layers")
    assert got["triangles"] > 1000 and got["slots agree"] and got["normals at corners"]
    # Coordinates below 1 in single precision.
    assert max(got["uv error"], got["color error"], got["normal error"]) < 1e-6


def test_memory_is_a_limit(case):
    got = case("limited")
    assert "object 'Cube': adaptive subdivision by 0.5 pixels would make more than the 1000 triangles" in got["error"]
    assert got["kept"]


def test_blender_does_not_divide_what_lancer_divides(which, tmp_path):
    got = blenders.run(which, tmp_path, "subdivision_cases", "undivided", alone=True)
    # Before 4.5 the modifier's faces are those that Cycles divides. Else Blender's mesh of 2.6 million faces would need 200 MB
    # at least: 16 bytes for each of their corners and vertices; the export needs 2 kB for each of 10 thousand faces.
    assert got["version"] < [4, 5] or got["grown"] < 100.0 and got["triangles"] == 80000


def test_a_letter_is_divided(case):
    got = case("letter")
    told = [line for line in got["told"] if "Cycles divides the mesh before the modifier" in line]
    # Its level makes fewer than 100 triangles. Before 4.5 Cycles divides the same mesh.
    assert got["triangles"] > 500 and len(told) == (got["version"] >= [4, 5])


def test_linked_objects_are_divided_once(case):
    got = case("linked")
    assert got["counts"] == got["counts"][:1] * 3 and got["kept"]


def test_creases_of_a_border_keep_its_corners(case):
    reach, divides_cage = case("creased_border")
    # The corner is at 1 along both axes, in single precision. Before 4.5 Cycles divides the modifier's mesh, not the square.
    assert abs(reach - 1.0) < 1e-6 or not divides_cage


def test_a_dicing_camera_without_a_frame(case):
    got = case("dicing_cameras")
    assert got["plain"] == [] and got["counts"] == 2 * [2 + 2 * 8 * 8 * 2]
    assert any(line.startswith("the dicing camera is not used: camera 'Camera.001': ") for line in got["told"])


def test_a_view_divides_by_its_own_pixels(case):
    got = case("views")
    # As in test_what_is_divided: a pixel is 0.1 wide, then 0.2. A view that moves keeps its meshes.
    assert got["fine"] == got["later"] == 2 * 8 * 8 * 2 and got["coarse"] == 2 * 4 * 4 * 2
    assert got["none"]["told"] == ["object 'Plane': adaptive subdivision by pixels needs a camera, Blender's mesh is shown"]
