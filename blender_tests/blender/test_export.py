"""Export of Blender's data to a snapshot, in the bpy module of this Python and in Debian's Blender 3.4.1, without rendering.

Blender stores single precision: the tolerance is 1e-6, sixteen times its rounding of 2^-24.
"""

import math

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM
from stored import near

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])
H = math.sqrt(0.5)  # of the normals of slopes of 45 degrees


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "export_cases", name)


def test_modifiers_are_applied_as_for_a_render(case):
    """Six faces, each divided into 2 x 2 quads at render level (not in the viewport), in an array of three with 2 m steps."""
    got = case("modifiers")
    assert (got["meshes"], got["instances"], got["triangles"]) == (1, 1, [6 * 4 * 2 * 3])
    assert got["low"] == near([-1, -1, -1]) and got["high"] == near([5, 1, 1])


def test_collection_instances_share_their_mesh(case):
    got = case("collection_instances")
    assert (got["meshes"], got["instances"], got["triangles"]) == (1, 3, [12])
    assert got["places"] == [[1, 0, 1], [2, 0, 1], [3, 0, 1]]


def test_particle_instances_share_their_mesh(case):
    """Seven hairs, the instanced object, and the ground."""
    got = case("particle_instances")
    assert (got["meshes"], got["instances"]) == (2, 9) and sorted(got["triangles"]) == [2, 12]
    assert got["names"] == ["Ground"] + ["Seed"] * 8
    # Seed and ground are at the origin; hairs have separate positions on the ground, which extends to 1 m.
    assert len({tuple(place) for place in got["places"]}) == 8
    assert all(abs(x) <= 1 and abs(y) <= 1 and abs(z) < 1e-6 for x, y, z in got["places"])


def test_node_instances_share_their_mesh(case):
    got = case("node_instances")
    assert (got["meshes"], got["instances"], got["triangles"]) == (2, 6, [12, 12])
    assert max(got["mesh of"].count(mesh) for mesh in (0, 1)) == 5
    assert got["places"] == near(np.array([[0, 0, 0], [0, 9, 0], [2, 0, 0], [4, 0, 0], [6, 0, 0], [8, 0, 0]]))


def test_rows_are_what_blender_tells_of_each_entry(case):
    """Rows equal Blender's entries, with matrices to the last bit; that of a plane is moved by whole metres."""
    got = case("walked")
    names = [row[0] for row in got["told"]]
    assert {"Child 0", "Copy", "Piece", "Other", "Ground", "Flat"} < set(names) and len(names) > 20
    assert "Gone" not in names and "Bare" not in names
    assert got["rows"] == got["told"]


def test_curve_text_and_metaball_come_once_each(case):
    got = case("surfaces")
    assert got["names"] == ["Curve", "Meta", "Text"] and sorted(got["mesh of"]) == [0, 1, 2]
    assert len(got["triangles"]) == 3 and min(got["triangles"]) > 0


def test_exact_shapes_fit_the_bounding_box(case):
    """Centre (2, 4, 6) and half extents (1, 2, 3), scaled by 2, moved 10 m along x. A plane uses only the centre."""
    rows = case("shapes")["rows"]
    plain = [[2, 0, 0, 10], [0, 2, 0, 0], [0, 0, 2, 0]]
    middle = [[2, 0, 0, 14], [0, 2, 0, 8], [0, 0, 2, 12]]
    fitted = [[2, 0, 0, 14], [0, 4, 0, 8], [0, 0, 6, 12]]
    wanted = {"MESH": plain, "SPHERE": fitted, "PLANE": middle, "CYLINDER": fitted, "CONE": fitted}
    for kind, matrix in wanted.items():
        assert rows[kind]["kind"] == kind and rows[kind]["matrix"] == near(np.array(matrix)), kind


def test_exact_shapes_bring_no_mesh_and_shading_is_told(case):
    got = case("shapes")
    # One object of shape MESH, and four cubes that differ in shading.
    assert got["meshes"] == 5
    shadings = {name[8:]: row["shading"] for name, row in got["rows"].items() if name.startswith("shading ")}
    assert shadings == {way: way for way in ("AS_MESH", "FLAT", "GOURAUD", "PHONG")}
    assert got["rows"]["SPHERE"]["shading"] == "AS_MESH"


def test_normals(case):
    meshes = case("attributes")
    left, right = [-H, 0, H], [H, 0, H]
    assert meshes["flat"]["normals"] is None
    assert np.array(meshes["smooth"]["normals"]) == near(np.array([left, left, [0, 0, 1], [0, 0, 1], right, right]))
    # A sharp ridge splits the two slopes: each corner has its face's normal.
    assert np.array(meshes["sharp"]["normals"]) == near(np.array([[left] * 3] * 2 + [[right] * 3] * 2))
    # Flat beside smooth needs corners too; the flat face keeps its own normal.
    mixed = np.array(meshes["mixed"]["normals"])
    assert mixed.shape == (4, 3, 3) and mixed[:2] == near(np.array([[left] * 3] * 2))
    # Blender stores custom normals as two angles up to 2 pi, in 2^15 steps of 1.9e-4.
    custom = np.array(meshes["custom"]["normals"])
    assert custom.shape == (4, 3, 3) and np.abs(custom - [0.6, 0.0, 0.8]).max() < 2 * 1.9e-4


def test_triangles_are_those_that_blender_tells(case):
    """Triangles are read from Blender's own array without a copy in every supported version, which saves 0.1 s a million."""
    got = case("triangulation")
    assert len(got["told"]) == 2 + 1 + 3 and not got["copied"]
    assert got["told"] == [list(row) for row in zip(got["corners"], got["faces"], strict=True)]


def test_uvs_colours_and_slots_of_faces(case):
    """Attributes set from corner positions are found at the same positions after triangulation."""
    meshes = case("attributes")
    painted, points = meshes["painted"], meshes["points"]
    at = np.array(painted["positions"])[painted["triangles"]]
    assert at.shape == (4, 3, 3)
    # The UV map for renders is used.
    assert np.array(painted["uvs"]) == near(at[..., :2] * [0.5, 0.25])
    face = np.array([0, 0, 1, 1])
    assert painted["material_slots"] == face.tolist()
    wanted = np.stack([at[..., 2], np.tile(face[:, None], 3), np.full((4, 3), 0.5)], axis=2)
    assert np.array(painted["colors"]) == near(wanted)
    # Colours of vertices are copied to the corners.
    at = np.array(points["positions"])[points["triangles"]]
    assert np.array(points["colors"]) == near(at * [1.0, 0.25, 1.0] + [1.0, 0.0, 0.0])
    for name in ("uvs", "colors", "material_slots"):
        assert meshes["flat"][name] is None


def test_object_materials_and_mirrors_share_the_mesh(case):
    got = case("sharing")
    assert got["meshes"] == 1 and len(got["rows"]) == 3
    materials = {name: row["materials"] for name, row in got["rows"].items()}
    assert materials == {"plain": ["of the mesh"], "own": ["of the object"], "mirrored": ["of the mesh"]}
    assert got["rows"]["mirrored"]["matrix"] == near(np.array([[-1, 0, 0, 5], [0, 2, 0, 0], [0, 0, 3, 0]]))


def test_light_power_in_physical_units(case):
    """Ten watts. Point and spot: W/sr over the whole sphere; sun: W/m^2; area: W/(m^2 sr) of a one-sided cosine emitter."""
    got = case("lights")
    tint = np.array([1.0, 0.5, 0.25])
    # Before 4.0 the sun loses the mean cosine of its disk, of Blender's default angle.
    sun = 1.0 if got["version"] >= [4, 0] else 0.5 * (1.0 + math.cos(0.5 * 0.00918043))
    for kind, factor in (("POINT", 1 / (4 * math.pi)), ("SPOT", 1 / (4 * math.pi)), ("SUN", sun)):
        assert got[kind]["kind"] == kind and got[kind]["emission"] == near(list(10 * factor * tint)), kind
    # The sides of 2 and 0.5 m are scaled by 3; before 4.0 Blender divides by 4 instead of pi.
    share = math.pi if got["version"] >= [4, 0] else 4.0
    assert got["rectangle"]["kind"] == got["disk"]["kind"] == "AREA"
    assert got["rectangle"]["size"] == near([6.0, 1.5]) and got["rectangle"]["emission"] == near([10 / (9 * share)] * 3)
    assert got["disk"]["size"] == near([2.0, 2.0]) and got["disk"]["emission"] == near([10 / (math.pi * share)] * 3)


def test_light_exposure_and_temperature_where_blender_has_them(case):
    got = case("lights")
    present = got["version"] >= [4, 5]
    assert ("exposure" in got, "temperature" in got) == (present, present)
    if present:
        assert got["exposure"]["emission"] == near([4 * 10 / (4 * math.pi)] * 3)
        warm = got["temperature color"]
        assert warm[0] > 1 > warm[1] > warm[2]
        assert got["temperature"]["emission"] == near([10 / (4 * math.pi) * c for c in warm])


def test_camera_window(case):
    """Lens 50 on a sensor of 36: 0.36 to each side along the longer edge; shift is relative to the whole of it, 0.72."""
    got = case("cameras")
    wanted = {
        "portrait": (0.18, 0.36, 0.0, 0.0),
        "shift": (0.36, 0.18, 0.072, -0.144),
        "wide pixels": (0.36, 0.18, 0.0, 0.0),
        # 20 x 50 pixels 1.5 times as wide as high are like 30 x 50; Blender's shift is relative to the longer edge.
        "all": (0.216, 0.36, 0.18, 0.09),
    }
    for name, (x, y, shift_x, shift_y) in wanted.items():
        window = got[name]["window"]
        assert window == near([shift_x - x, shift_x + x, shift_y - y, shift_y + y]), name
        # Blender's projection maps the window's corners to those of the image.
        left, right, bottom, top = window
        for corner, place in (((left, bottom), (-1, -1)), ((right, top), (1, 1))):
            x_, y_, _, w = np.array(got[name]["projection"]) @ [*corner, -1.0, 1.0]
            assert (x_ / w, y_ / w) == near(place), name


def test_border_region(case):
    """The border of 40 x 20 pixels is the middle half in x, and 10 to 18 in y; the image keeps its size."""
    assert case("cameras")["border"] == [40, 20, 10, 10, 20, 8]


def test_what_is_hidden_in_renders_stays_out(case):
    """Objects, lights and collections hidden in renders are left out; those hidden only in viewports are rendered."""
    assert case("hidden") == ["hidden in viewports", "shown", "shown light"]
