"""The check before a render: glass that is no body, normals that point away, geometry lost in rounding; and near misses."""

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
    # The place is on the body, where it stands in the world.
    assert np.abs(np.subtract(finding.place, (5, 0, 0))).max() <= 0.5


@pytest.mark.parametrize("thorough", [True, False])
def test_glass_that_is_whole(thorough):
    assert found(one(box(), GLASS_), thorough) == []
    assert found(one(ball(), GLASS_, scale(1, -1, 1)), thorough) == []
    # Faces that share places, but no vertices, as files of other programs have them.
    split = box()
    split = dataclasses.replace(
        split, positions=split.positions[split.triangles].reshape(-1, 3), triangles=np.arange(36).reshape(-1, 3)
    )
    assert found(one(split, GLASS_), thorough) == []
    # Minus zero is the same place as zero.
    signed = split.positions - 0.5
    signed[::2][signed[::2] == 0.0] = -0.0
    assert found(one(dataclasses.replace(split, positions=signed), GLASS_), thorough) == []
    # An opaque thing may be open, and glass without refraction.
    assert found(one(box(faces=BOX_FACES[2:]), GREY_), thorough) == []
    # What an opaque part closes is closed.
    slots = np.array([0, 0] + [1] * 10, np.uint16)
    assert found(one(box(material_slots=slots), (GREY_, GLASS_)), thorough) == []


def test_glass_that_ends_in_an_opaque_part():
    """Only edges of glass count: here those of the opaque part are open."""
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
    assert "opposite ways at 3 edges" in finding.what and "Recalculate" in finding.advice
    assert found(one(box(faces=faces), GREY_)) == []


def test_wall_within_glass():
    """An inner wall meets the sides where two faces meet already."""
    finding = only(one(box(faces=[*BOX_FACES, (0, 2, 7), (0, 7, 5)]), GLASS_))
    assert "more than two" in finding.what and finding.faces > 0


def test_shells_of_glass():
    """Bodies that touch along an edge are closed each; a cavity faces its air, which lies within the body."""

    def joined(*meshes):
        starts = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
        faces = [mesh.triangles + np.uint32(start) for mesh, start in zip(meshes, starts, strict=False)]
        return MeshData("joined", np.concatenate([mesh.positions for mesh in meshes]), np.concatenate(faces))

    inner = box(faces=np.array(BOX_FACES)[:, ::-1], size=0.5)
    assert found(one(joined(box(), inner), GLASS_)) == []
    assert found(one(joined(box(), box(shift=(1, 1, 0))), GLASS_)) == []
    # Beside it the same body is inside out, though all of the mesh together is not.
    finding = only(one(joined(box(), dataclasses.replace(inner, positions=inner.positions + np.float32(2))), GLASS_))
    assert "inside out: 12 faces" in finding.what and min(finding.place) > 1.0


@pytest.mark.parametrize("thorough", [True, False])
def test_glass_inside_out(thorough):
    assert found(one(ball(turned=True), GLASS_), thorough) == GLASS_WRONG
    assert found(one(ball(turned=True), GREY_), thorough) == []
    # An infinitely thin body has no outside: it is nothing that could be turned.
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
    """Up to upright is how smooth shading works; beyond it light breaks off."""
    flat = sheet()
    for angle, kind in ((80, []), (89, []), (100, [("normals", "WRONG")])):
        normal = (np.sin(np.radians(angle)), 0.0, np.cos(np.radians(angle)))
        assert found(one(dataclasses.replace(flat, normals=np.tile(normal, (4, 1))))) == kind, angle
    # Nor do all of them reversed help.
    reversed_ = dataclasses.replace(ball(), normals=-ball().normals)
    assert found(one(reversed_)) == [("normals", "WRONG")]
    # Where normals are not used they cannot hurt.
    assert found(scene([placed(0, shading=Shading.FLAT)], [reversed_])) == []
    assert found(one(reversed_, GLOW_)) == []
    # Neither zeros nor a cube without hard edges point away.
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
    # What is round has no flat faces; flat shading shows them as they are; true points of light do not ask.
    assert found(one(ball(), lights=(panel,)), thorough) == []
    assert found(scene([placed(0, shading=Shading.FLAT)], [cube], lights=(panel,)), thorough) == []
    assert found(one(cube), thorough) == []
    # Smooth edges round flat faces are what a Weighted Normal modifier makes.
    rim = dataclasses.replace(cube, normals=np.repeat(_upright(cube)[:, None], 3, axis=1))
    assert found(one(rim, lights=(panel,)), thorough) == []


@pytest.mark.parametrize("thorough", [True, False])
@pytest.mark.parametrize("whole", [0.2, 0.8])
def test_the_larger_fault_of_normals_is_told(thorough, whole):
    """Of a mesh some faces of which turn away at all corners and others at one: what more of its area does."""
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
    """Two squares that meet along the x-axis, each that many degrees down from level; of its smooth normals some are turned."""
    c, s = np.cos(np.radians(slope)), np.sin(np.radians(slope))
    points = np.array([(0, 0, 0), (1, 0, 0), (0, c, -s), (1, c, -s), (0, -c, -s), (1, -c, -s)])
    normals = np.array([(0, 0, 1)] * 2 + [(0, s, c)] * 2 + [(0, -s, c)] * 2)
    # Vertices that several programs write once for each face, at the same place.
    faces = np.array([(0, 1, 3), (0, 3, 2), (1, 0, 4), (1, 4, 5)])
    corners = normals[faces].copy()
    for face, corner in turned:
        corners[face, corner] *= -1.0
    return MeshData("roof", points[faces].reshape(-1, 3), np.arange(12).reshape(4, 3), normals=corners)


@pytest.mark.parametrize("thorough", [True, False])
def test_smooth_shading_round_folds(thorough):
    """The mean at a fold turns away from neither side of a roof, but from a third face under its edge."""
    assert found(one(_roof(80)), thorough) == []
    roof = _roof(80)
    # The apron hangs from the ridge, inwards under the first slope: the ridge's normal turns away from it.
    apron = np.array([(0, 0, 0), (1, 0, 0), (0.5, 0.8, -0.6)])
    normals = np.array([(0.0, 0.0, 1.0), (0.0, 0.0, 1.0), (0.0, -0.6, -0.8)])
    folded = MeshData(
        "folded",
        np.concatenate((roof.positions, apron)),
        np.concatenate((roof.triangles, [(13, 12, 14)])).astype(np.uint32),
        normals=np.concatenate((roof.normals, normals[None, [1, 0, 2]])),
    )
    assert found(one(folded), thorough) == ([("normals", "HINT")] if thorough else [])
    # Normals that turn away from all faces around are a fault wherever they are.
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
    # The same near the origin, at any size; far away by its matrix, which costs its shape nothing.
    for size in (1e-6, 1.0, 1e6):
        assert found(one(ball(64, size))) == []
    assert found(one(ball(8), GREY_, move(1e5, 0, 0))) == []


def test_fine_parts_of_a_large_mesh():
    """A town of a kilometre has doors; a tenth of a millimetre is lost in it."""

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
    """Blades whose width is a few steps; a fan whose triangles only share a fine tip is none."""

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
    # Flat and turned is not sheared.
    assert found(one(ball(), GREY_, rotate_x(0.4) @ rotate_y(1.1) @ scale(1, 1e-9, 1))) == []
    assert found(one(ball(), GREY_, scale(1e6, 1.0, 1e-6))) == []
