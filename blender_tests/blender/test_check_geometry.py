"""Checks of geometry: open glass, normals that point away, geometry lost in rounding; and near misses."""

import dataclasses

import numpy as np
import pytest
from check_scenes import (
    BOX_FACES,
    CLEAR_,
    GLASS_,
    GLOW_,
    GREY_,
    ball,
    box,
    exact,
    found,
    one,
    only,
    placed,
    scene,
    sheet,
)
from tiny_scenes import move, rotate_x, rotate_y, scale

from addon.bindings.enums import LightKind, Shading
from addon.bindings.snapshot import Light, MeshData
from addon.checks.finding import Severity

GLASS_WRONG, NORMALS, PRECISION = [("glass", "WRONG")], [("normals", "WRONG")], [("precision", "WRONG")]


@pytest.mark.parametrize("thorough", [True, False])
@pytest.mark.parametrize("material", [GLASS_, CLEAR_])
def test_open_glass(material, thorough):
    finding = only(one(box(faces=BOX_FACES[2:]), material, move(5, 0, 0)), thorough)
    assert (finding.kind, finding.severity) == ("glass", Severity.WRONG)
    assert "4 edges" in finding.what and "Solidify" in finding.advice
    assert (finding.object, finding.mesh, finding.material) == ("thing", "box", ("glass", "clear")[material == CLEAR_])
    # The reported place is on the body, in world space.
    assert np.abs(np.subtract(finding.place, (5, 0, 0))).max() <= 0.5


@pytest.mark.parametrize("thorough", [True, False])
def test_glass_that_is_whole(thorough):
    assert found(one(box(), GLASS_), thorough) == []
    assert found(one(ball(), GLASS_, scale(1, -1, 1)), thorough) == []
    # Faces with equal positions but separate vertices, as in imported files.
    split = box()
    split = dataclasses.replace(
        split, positions=split.positions[split.triangles].reshape(-1, 3), triangles=np.arange(36).reshape(-1, 3)
    )
    assert found(one(split, GLASS_), thorough) == []
    # Minus zero is the same place as zero.
    signed = split.positions - 0.5
    signed[::2][signed[::2] == 0.0] = -0.0
    assert found(one(dataclasses.replace(split, positions=signed), GLASS_), thorough) == []
    # Opaque objects may be open, and so may glass without refraction.
    assert found(one(box(faces=BOX_FACES[2:]), GREY_), thorough) == []
    # Glass closed by an opaque part is closed.
    slots = np.array([0, 0] + [1] * 10, np.uint16)
    assert found(one(box(material_slots=slots), (GREY_, GLASS_)), thorough) == []


def test_glass_that_ends_in_an_opaque_part():
    """Only open edges of glass count, not those of opaque parts."""
    faces = BOX_FACES[2:]
    slots = np.zeros(10, np.uint16)
    # A triangle away from the hole, then one beside it.
    slots[0] = 1
    assert found(one(box(faces=faces, material_slots=slots), (GREY_, GLASS_))) == []
    slots[3] = 1
    assert "open at 1 edge:" in only(one(box(faces=faces, material_slots=slots), (GREY_, GLASS_))).what


def test_flipped_faces_of_glass():
    faces = [BOX_FACES[0][::-1], *BOX_FACES[1:]]
    finding = only(one(box(faces=faces), GLASS_))
    assert "opposite directions at 3 edges" in finding.what and "Recalculate" in finding.advice
    assert found(one(box(faces=faces), GREY_)) == []


def test_wall_within_glass():
    """An inner wall meets the sides where two faces meet already."""
    finding = only(one(box(faces=[*BOX_FACES, (0, 2, 7), (0, 7, 5)]), GLASS_))
    assert "more than two" in finding.what and finding.faces > 0


def test_shells_of_glass():
    """Bodies that touch along an edge are each closed; a cavity inside a body has inward faces."""

    def joined(*meshes):
        starts = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
        faces = [mesh.triangles + np.uint32(start) for mesh, start in zip(meshes, starts, strict=False)]
        return MeshData("joined", np.concatenate([mesh.positions for mesh in meshes]), np.concatenate(faces))

    inner = box(faces=np.array(BOX_FACES)[:, ::-1], size=0.5)
    assert found(one(joined(box(), inner), GLASS_)) == []
    assert found(one(joined(box(), box(shift=(1, 1, 0))), GLASS_)) == []
    # The same body outside is inside out, although the volume of the whole mesh is positive.
    finding = only(one(joined(box(), dataclasses.replace(inner, positions=inner.positions + np.float32(2))), GLASS_))
    assert "inside out: 12 faces" in finding.what and min(finding.place) > 1.0


@pytest.mark.parametrize("thorough", [True, False])
def test_glass_inside_out(thorough):
    assert found(one(ball(turned=True), GLASS_), thorough) == GLASS_WRONG
    assert found(one(ball(turned=True), GREY_), thorough) == []
    # A sheet has no outside.
    assert found(one(sheet(), GREY_), thorough) == []


def test_custom_normals_that_point_away():
    mesh = ball()
    corners = mesh.normals[mesh.triangles].copy()
    rng = np.random.default_rng(1)
    some = rng.random(corners.shape[:2]) < 0.1
    corners[some] *= -1.0
    finding = only(one(dataclasses.replace(mesh, normals=corners)))
    assert finding.kind == "normals" and finding.severity == Severity.WRONG and 100 < finding.faces < len(mesh.triangles)
    assert abs(np.linalg.norm(finding.place) - 1.0) < 0.1
    assert found(one(dataclasses.replace(mesh, normals=corners)), thorough=False) == NORMALS
    # A corner of a thousand.
    few = mesh.normals[mesh.triangles].copy()
    few[7, 1] *= -1.0
    assert found(one(dataclasses.replace(ball(48), normals=None))) == []
    fine = ball(48)
    few = fine.normals[fine.triangles].copy()
    few[500, 1] *= -1.0
    assert found(one(dataclasses.replace(fine, normals=few))) == []


def test_normals_that_lean():
    """Smooth normals may lean up to 90 degrees; beyond that light ends abruptly."""
    flat = sheet()
    for angle, kind in ((80, []), (89, []), (100, [("normals", "WRONG")])):
        normal = (np.sin(np.radians(angle)), 0.0, np.cos(np.radians(angle)))
        assert found(one(dataclasses.replace(flat, normals=np.tile(normal, (4, 1))))) == kind, angle
    # Normals that are all reversed are a fault too.
    reversed_ = dataclasses.replace(ball(), normals=-ball().normals)
    assert found(one(reversed_)) == [("normals", "WRONG")]
    # Unused normals are no fault.
    assert found(scene([placed(0, shading=Shading.FLAT)], [reversed_])) == []
    assert found(one(reversed_, GLOW_)) == []
    # Zero normals and those of a smooth cube do not point away.
    assert found(one(dataclasses.replace(ball(), normals=0.0 * ball().normals))) == []
    assert found(one(box(normals=box().positions))) == []


@pytest.mark.parametrize("thorough", [True, False])
def test_large_flat_faces_shaded_as_round(thorough):
    panel = Light("panel", move(0, 0, 3), LightKind.AREA, emission=(1, 1, 1), size=(2.0, 2.0))
    cube = box(normals=box().positions)
    finding = only(one(cube, lights=(panel,)), thorough)
    # Corners lean by the angle between a face and the diagonal.
    assert (finding.kind, finding.severity, finding.faces) == ("normals", Severity.HINT, 12) and "by 55 degrees" in finding.what
    assert finding.key
    # No finding for round meshes, flat shading, and point lamps.
    assert found(one(ball(), lights=(panel,)), thorough) == []
    assert found(scene([placed(0, shading=Shading.FLAT)], [cube], lights=(panel,)), thorough) == []
    assert found(one(cube), thorough) == []
    # A Weighted Normal modifier makes flat faces with smooth edges.
    rim = dataclasses.replace(cube, normals=np.repeat(_upright(cube)[:, None], 3, axis=1))
    assert found(one(rim, lights=(panel,)), thorough) == []


@pytest.mark.parametrize("thorough", [True, False])
@pytest.mark.parametrize("whole", [0.2, 0.8])
def test_the_larger_fault_of_normals_is_told(thorough, whole):
    """In a mesh with faces that turn away at all corners, and others at one corner, the fault with more area is reported."""
    flat = sheet(parts=20)
    up, down = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
    count = round(whole * len(flat.triangles))
    normals = np.array([[down] * 3] * count + [[up, down, up]] * (len(flat.triangles) - count))
    finding = only(one(dataclasses.replace(flat, normals=normals)), thorough)
    assert finding.severity == Severity.WRONG and finding.weight > 0.5
    assert ("light reaches only from behind" if whole > 0.5 else "at some corners") in finding.what


def _upright(mesh):
    a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(float) for k in range(3))
    normals = np.cross(b - a, c - a)
    return normals / np.linalg.norm(normals, axis=1)[:, None]


def _roof(slope, turned=()):
    """Return two squares that meet on the x axis, sloped by that many degrees, with smooth normals, some of them reversed."""
    c, s = np.cos(np.radians(slope)), np.sin(np.radians(slope))
    points = np.array([(0, 0, 0), (1, 0, 0), (0, c, -s), (1, c, -s), (0, -c, -s), (1, -c, -s)])
    normals = np.array([(0, 0, 1)] * 2 + [(0, s, c)] * 2 + [(0, -s, c)] * 2)
    # Separate vertices for each face, at equal positions.
    faces = np.array([(0, 1, 3), (0, 3, 2), (1, 0, 4), (1, 4, 5)])
    corners = normals[faces].copy()
    for face, corner in turned:
        corners[face, corner] *= -1.0
    return MeshData("roof", points[faces].reshape(-1, 3), np.arange(12).reshape(4, 3), normals=corners)


@pytest.mark.parametrize("thorough", [True, False])
def test_smooth_shading_round_folds(thorough):
    """The mean normal at a fold turns away from neither side of a roof, but from a third face under the ridge."""
    assert found(one(_roof(80)), thorough) == []
    roof = _roof(80)
    # The apron hangs from the ridge under the first slope: the ridge's normal turns away from it.
    apron = np.array([(0, 0, 0), (1, 0, 0), (0.5, 0.8, -0.6)])
    normals = np.array([(0.0, 0.0, 1.0), (0.0, 0.0, 1.0), (0.0, -0.6, -0.8)])
    folded = MeshData(
        "folded",
        np.concatenate((roof.positions, apron)),
        np.concatenate((roof.triangles, [(13, 12, 14)])).astype(np.uint32),
        normals=np.concatenate((roof.normals, normals[None, [1, 0, 2]])),
    )
    assert found(one(folded), thorough) == ([("normals", "HINT")] if thorough else [])
    # Normals that turn away from all adjacent faces are a fault.
    for turned in ([(0, 2)], [(1, 1)], [(0, 0), (0, 1)]):
        assert found(one(_roof(30, turned)), thorough) == NORMALS, turned


def test_flipped_faces_of_a_smooth_mesh():
    mesh = ball()
    faces = np.array(mesh.triangles)
    faces[::7] = faces[::7, ::-1]
    finding = only(one(dataclasses.replace(mesh, triangles=faces)))
    assert finding.kind == "normals" and "Recalculate" in finding.advice
    # Without smooth normals an opaque face has no wrong side.
    assert found(one(dataclasses.replace(mesh, triangles=faces, normals=None))) == []


def test_geometry_smaller_than_its_steps():
    """At 1e6 a step is 1/16: details of a metre are 16 steps, those of ten metres 160."""
    for thorough in (True, False):
        assert found(one(ball(8, 1.0, (1e6, 0, 0), smooth=False)), thorough) == PRECISION
        assert found(one(ball(8, 50.0, (1e6, 0, 0), smooth=False)), thorough) == []
    finding = only(one(ball(8, 1.0, (1e6, 0, 0), smooth=False)))
    assert "0.06" in finding.what and "origin" in finding.advice and abs(finding.place[0] - 1e6) < 10.0
    # No finding near the origin at any size, and none if only the object's transform is far away.
    for size in (1e-6, 1.0, 1e6):
        assert found(one(ball(64, size))) == []
    assert found(one(ball(8), GREY_, move(1e5, 0, 0))) == []


def test_fine_parts_of_a_large_mesh():
    """In a mesh of a kilometre details of a door's size are exact, details of 0.1 mm are lost."""

    def town(detail):
        big, small = sheet(1000.0), ball(8, detail, (500, 400, 0))
        return MeshData(
            "town",
            np.concatenate((big.positions, small.positions)),
            np.concatenate((big.triangles, small.triangles + np.uint32(4))),
        )

    assert found(one(town(1.0))) == [] and found(one(town(0.05))) == []
    assert found(one(town(1e-4))) == PRECISION


def test_needles():
    """Blades with a width of a few steps are needles; a fan whose triangles share a fine tip is not."""

    def blades(width, far):
        base = np.arange(20)[:, None, None] * np.array([0.0, 1.0, 0.0])
        points = base + np.array([(far, 0, 0), (far + width, 0, 0), (far, 0, 3.0)])
        return MeshData("blades", points.reshape(-1, 3), np.arange(60).reshape(-1, 3))

    # At 1e5 a step is 1/128.
    assert found(one(blades(0.02, 1e5))) == PRECISION and found(one(blades(0.2, 1e5))) == []
    assert found(one(blades(0.02, 1e3))) == []
    # One blade of twenty is no fault.
    one_thin = blades(0.2, 1e5)
    points = one_thin.positions.copy()
    points[1, 0] = points[0, 0] + np.float32(0.02)
    assert found(one(dataclasses.replace(one_thin, positions=points))) == []


def test_objects_smaller_than_their_place():
    for thing, meshes in ((placed(0), [ball()]), (exact("SPHERE"), []), (exact("CONE"), [])):
        for position, kind in ((1e8, PRECISION), (1e5, [])):
            moved = dataclasses.replace(thing, matrix=move(position, 0, 0))
            assert found(scene([moved], meshes)) == kind
    assert found(scene([exact("PLANE", 0, move(1e8, 0, 0))])) == []
    finding = only(scene([placed(0, GREY_, move(1e8, 0, 0), str(number)) for number in range(1)], [ball()]))
    assert "8" in finding.what and finding.place[0] == 1e8


def test_shear():
    sheared = np.eye(4)
    sheared[0, 2], sheared[2, 2] = 1.0, 1e-7
    assert found(one(ball(), GREY_, sheared)) == PRECISION
    sheared[2, 2] = 1e-3
    assert found(one(ball(), GREY_, sheared)) == []
    # A flattened and rotated object is not sheared.
    assert found(one(ball(), GREY_, rotate_x(0.4) @ rotate_y(1.1) @ scale(1, 1e-9, 1))) == []
    assert found(one(ball(), GREY_, scale(1e6, 1.0, 1e-6))) == []
