"""Checks of coincident faces: a fault if both are visible or light passes through them; otherwise harmless."""

import dataclasses

import numpy as np
import pytest
from check_scenes import (
    BOX_FACES,
    EYE,
    GLASS_,
    GLOW_,
    GREY,
    GREY_,
    RED_,
    VEIL_,
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
from tiny_scenes import look_at, move, rotate_x, rotate_y, scale

from addon.bindings.enums import CameraKind, Ray
from addon.bindings.snapshot import MeshData
from addon.checks.facets import mesh_facets
from addon.checks.finding import Severity

COINCIDENT = [("coincident", "WRONG")]
TOUCHING = [("coincident", "HINT")]
DARKER = [("coincident", "DIFFERENT")]


def two(first=GREY_, second=RED_, matrix=None, mesh=None, camera=EYE):
    return scene(
        [placed(0, first, name="one"), placed(1, second, matrix, name="two")], [sheet(), mesh or sheet(3.0)], camera=camera
    )


@pytest.mark.parametrize("thorough", [True, False])
def test_two_planes_at_one_height(thorough):
    finding = only(two(), thorough)
    assert finding.kind == "coincident" and finding.severity == Severity.WRONG
    assert {finding.object, *finding.what.split("'")} >= {"one", "two"}
    assert abs(finding.place[2]) < 1e-6 and max(map(abs, finding.place)) <= 2.0
    # The direction of the faces does not matter.
    for matrix in (rotate_x(np.pi), move(1, 1, 0)):
        assert found(two(matrix=matrix), thorough) == COINCIDENT
    # A distance of one step of single precision counts as 0, many steps do not.
    assert found(two(matrix=move(0.1, 0, 1e-9)), thorough) == COINCIDENT
    for height in (1e-4, 1e-5, -1e-5):
        assert found(two(matrix=move(0.1, 0, height)), thorough) == []
        assert found(two(matrix=move(0.1, 0, height) @ rotate_x(np.pi)), thorough) == []


@pytest.mark.parametrize(
    "turn", [np.eye(4), rotate_x(0.5), rotate_x(np.pi / 6) @ rotate_y(np.pi / 3), move(300, -20, 7) @ rotate_y(1.0)]
)
def test_planes_in_any_position(turn):
    """Two planes in the same place by different matrices and meshes, rounded as in Blender."""
    other = sheet(2.0, shift=(0.25, 0.5, 0.0))
    matrix = (turn @ move(0.3, -0.2, 0.0)).astype(np.float32).astype(float)
    instances = [placed(0, GREY_, turn.astype(np.float32).astype(float), "one"), placed(1, RED_, matrix, "two")]
    assert found(scene(instances, [sheet(), other])) == COINCIDENT
    lifted = (turn @ move(0.3, -0.2, 1e-3)).astype(np.float32).astype(float)
    assert found(scene([instances[0], placed(1, RED_, lifted, "two")], [sheet(), other])) == []
    # In the plane, but beside it.
    beside = (turn @ move(3.0, 0.0, 0.0)).astype(np.float32).astype(float)
    assert found(scene([instances[0], placed(1, RED_, beside, "two")], [sheet(), other])) == []


@pytest.mark.parametrize("thorough", [True, False])
def test_planes_that_look_alike(thorough):
    """Lancer renders one of them, in Cycles they shadow each other: reported if they cover enough of the picture."""
    finding = only(two(GREY_, GREY_), thorough)
    assert finding.key and finding.severity == Severity.DIFFERENT and "Cycles would show them darker" in finding.what
    assert {finding.object, *finding.what.split("'")} >= {"one", "two"}
    twin = dataclasses.replace(GREY, name="grey.001")
    snapshot = scene([placed(0, 0), placed(1, 1, name="two")], [sheet(), sheet(3.0)], materials=(GREY, twin))
    assert found(snapshot, thorough) == DARKER
    # Faces of one mesh that share no edge.
    large, small = sheet(), sheet(3.0)
    both = np.concatenate((large.positions, small.positions)), np.concatenate((large.triangles, small.triangles + 4))
    assert found(one(MeshData("both", *both), GREY_), thorough) == DARKER
    lifted = small.positions + np.float32((0.0, 0.0, 1e-4))
    assert found(one(MeshData("both", np.concatenate((large.positions, lifted)), both[1]), GREY_), thorough) == []
    # If one mesh has two such places, the check reports the visible one.
    for height in (-1.0, 1.0):
        far = both[0] + np.float32((0.0, 900.0, height))
        pairs = MeshData("pairs", np.concatenate((both[0], far)), np.concatenate((both[1], both[1] + 8)))
        finding = only(one(pairs, GREY_), thorough)
        assert finding.severity == Severity.DIFFERENT and abs(finding.place[1]) < 4.0
    # Flush tops of two bodies, seen from above and from below.
    tops = [placed(0, GREY_, name="one"), placed(0, GREY_, move(0.3, 0.2, 0.1), name="two")]
    assert found(scene(tops, [box()]), thorough) == []
    tops[1] = placed(0, GREY_, move(0.3, 0.2, 0.0), name="two")
    assert found(scene(tops, [box()]), thorough) == DARKER
    # Faces that touch between two bodies, or a body and a floor, are hidden.
    tower = [placed(0, GREY_, name="one"), placed(0, GREY_, move(0.2, 0.1, 1.0), name="two")]
    assert found(scene(tower, [box()]), thorough) == []
    assert found(scene([placed(0, GREY_), placed(1, GREY_, name="floor")], [box(shift=(0, 0, 0.5)), sheet()]), thorough) == []
    # Behind the camera, beside its view, and too small.
    for eye in (
        look_at((1.0, -6.0, 3.0), (2, -12, 6)),
        look_at((1.0, -6.0, 3.0), (9, 0, 0)),
        look_at((1, -600, 300), (0, 0, 0)),
    ):
        assert found(two(GREY_, GREY_, camera=dataclasses.replace(EYE, matrix=eye)), thorough) == []
    above = dataclasses.replace(EYE, kind=CameraKind.ORTHOGRAPHIC, matrix=look_at((0, -0.1, 6), (0, 0, 0)))
    assert found(two(GREY_, GREY_, camera=above), thorough) == DARKER
    aside = dataclasses.replace(above, matrix=look_at((4, -0.1, 6), (4, 0, 0)))
    assert found(two(GREY_, GREY_, camera=aside), thorough) == []


@pytest.mark.parametrize("thorough", [True, False])
def test_copies_that_cycles_shows_darker(thorough):
    finding = only(scene([placed(0, GREY_, name="one"), placed(0, GREY_, name="two")], [sheet()]), thorough)
    assert finding.key and finding.severity == Severity.DIFFERENT and "Cycles would show them darker" in finding.what
    for turn in (slice(None), slice(None, None, -1)):
        board = sheet(parts=4)
        double = dataclasses.replace(board, triangles=np.concatenate((board.triangles, board.triangles[:, turn])))
        finding = only(one(double, GREY_), thorough)
        assert finding.key and finding.severity == Severity.DIFFERENT and "Cycles would show them darker" in finding.what
    # Different materials in one plane are a fault in Lancer too.
    assert "Cycles" not in only(two(GREY_, RED_), thorough).what


@pytest.mark.parametrize("thorough", [True, False])
def test_planes_that_hurt_nobody(thorough):
    # Hidden from the camera.
    hidden = placed(1, RED_, name="two", hidden_from=Ray.CAMERA)
    assert found(scene([placed(0, GREY_), hidden], [sheet(), sheet(3.0)]), thorough) == []
    # Crossing, and meeting at an edge.
    assert found(two(matrix=rotate_x(0.3)), thorough) == []
    assert found(two(matrix=move(3.5, 0, 0)), thorough) == []
    # Tiles side by side in one plane.
    tiles = [placed(0, (GREY_, RED_)[(x + y) % 2], move(x, y, 0), f"tile {x} {y}") for x in range(8) for y in range(8)]
    assert found(scene(tiles, [sheet(1.0)]), thorough) == []


def test_parts_of_one_mesh():
    """A chessboard of two materials in one mesh is no fault; a face over another is."""
    board = sheet(parts=8)
    slots = np.array([(x + y) % 2 for y in range(8) for x in range(8)] * 2, np.uint16)
    assert found(one(dataclasses.replace(board, material_slots=slots), (GREY_, RED_))) == []
    over = dataclasses.replace(
        board, triangles=np.concatenate((board.triangles, [(0, 8, 80)])), material_slots=np.append(slots * 0, 1)
    )
    assert found(one(over, (GREY_, RED_))) == COINCIDENT


@pytest.mark.parametrize("floor", [placed(1, RED_, name="floor"), exact("PLANE", RED_, name="floor")])
@pytest.mark.parametrize("thorough", [True, False])
def test_box_on_a_floor(floor, thorough):
    """From above a box hides the faces that touch; from below, through the floor's back, both are visible."""
    meshes = [box(shift=(0, 0, 0.5)), sheet()]
    assert found(scene([placed(0, GREY_), floor], meshes), thorough) == []
    below = dataclasses.replace(EYE, matrix=look_at((1.0, -6.0, -3.0), (0, 0, 0)))
    assert found(scene([placed(0, GREY_), floor], meshes, camera=below), thorough) == COINCIDENT
    # Glass that touches an opaque surface is a hint from any view, since it may be intended.
    assert found(scene([placed(0, GLASS_), floor], meshes), thorough) == (TOUCHING if thorough else [])
    for gap in (1e-5, -1e-5):
        assert found(scene([placed(0, GLASS_, move(0, 0, gap)), floor], meshes), thorough) == []


def test_glass_that_rests_or_fights():
    """Glass on an opaque surface is a hint; glass flush with an opaque face, or against other glass, is a fault."""
    ground = box(shift=(0, 0, -0.5), name="ground")
    for other, expected in ((GREY_, TOUCHING), (VEIL_, COINCIDENT), (GLASS_, COINCIDENT)):
        assert found(scene([placed(0, GLASS_), placed(1, other)], [box(shift=(0, 0, 0.5)), ground])) == expected
    flush = scene([placed(0, GLASS_), placed(0, GREY_, move(0.3, 0.3, 0.0))], [box()])
    assert found(flush) == COINCIDENT


def test_directions_at_the_border_of_cells():
    """Directions are grouped by cells of 1/64: pairs that rounding places on both sides of a border are found too."""
    for part in range(1, 32, 2):
        turn = rotate_y(np.arcsin(0.5 * part / 64))
        first, second = (turn @ matrix for matrix in (np.eye(4), move(0.3, 0.1, 0) @ rotate_y(1e-8)))
        assert found(scene([placed(0, 0, first, "one"), placed(1, 1, second, "two")], [sheet(), sheet(3.0)])) == COINCIDENT


def test_flat_parts():
    """Parallel parts at two heights are two parts, and curved surfaces have none."""
    low, high = sheet(parts=4), sheet(parts=4, shift=(0, 0, 0.1))
    both = MeshData(
        "both", np.concatenate((low.positions, high.positions)), np.concatenate((low.triangles, high.triangles + 25))
    )
    assert sorted(len(part) for part in mesh_facets(both).faces) == [32, 32]
    assert len(mesh_facets(box())) == 6 and len(mesh_facets(ball(32))) == 0


def test_boxes_side_by_side():
    # Glass boxes touch, even with the same material.
    assert found(scene([placed(0, GLASS_, move(x, 0, 0), f"box {x}") for x in (0, 1)], [box()])) == COINCIDENT
    row = [placed(0, number % 2, move(number, 0, 0), f"box {number}") for number in range(6)]
    assert found(scene(row, [box()])) == []
    # Half into one another with one top: seen from above.
    row = [placed(0, number % 2, move(0.5 * number, 0.1 * number, 0), f"box {number}") for number in range(2)]
    assert found(scene(row, [box()])) == COINCIDENT
    below = dataclasses.replace(EYE, matrix=look_at((0.0, 0.0, 0.1), (0, 0, 5)))
    assert found(scene(row, [box()], camera=below)) == []


def test_exact_shapes_in_one_plane():
    up = move(0, 0, 1)
    assert found(scene([exact("PLANE", 0, name="a"), exact("PLANE", 1, name="b")])) == COINCIDENT
    assert found(scene([exact("PLANE", 0, name="a"), exact("PLANE", 1, move(0, 0, 1e-4), "b")])) == []
    assert found(scene([exact("CYLINDER", GLASS_, up), exact("PLANE", 1, name="floor")])) == TOUCHING
    assert found(scene([exact("CYLINDER", GREY_, up), exact("PLANE", 1, name="floor")])) == []
    assert found(scene([exact("CONE", GLASS_, up), placed(0, 1, name="floor")], [sheet()])) == TOUCHING
    assert found(scene([exact("CONE", GLASS_, up), placed(0, 1, move(4, 0, 0), "floor")], [sheet()])) == []
    assert found(scene([exact("SPHERE", GLASS_, up), exact("PLANE", 1, name="floor")])) == []


@pytest.mark.parametrize("thorough", [True, False])
def test_copies_in_place(thorough):
    """A copy in the same place is darker in Cycles; with transparent or emitting materials it is a fault."""
    snapshot = scene([placed(0, GREY_, move(1, 2, 3), "one"), placed(0, GREY_, move(1, 2, 3), "two")], [ball()])
    finding = only(snapshot, thorough)
    assert (finding.kind, finding.severity, finding.object) == (
        "coincident",
        Severity.DIFFERENT,
        "two",
    ) and "'one'" in finding.what
    # Its mesh may be a copy, too.
    copied = scene([placed(0, GREY_, name="one"), placed(1, GREY_, name="two")], [ball(), ball(name="ball.001")])
    assert found(copied, thorough) == [("coincident", "DIFFERENT")]
    for material in (VEIL_, GLOW_):
        assert found(scene([placed(0, material), placed(0, material)], [ball()]), thorough) == COINCIDENT
    assert found(scene([placed(0, GREY_), placed(0, RED_)], [ball()]), thorough) == COINCIDENT
    # Different meshes or ray visibility in one place are no copies.
    assert found(scene([placed(0, GREY_), placed(1, GREY_)], [ball(16), ball(20)]), thorough) == []
    seen, unseen = placed(0, GREY_), placed(0, RED_, hidden_from=Ray.CAMERA)
    assert found(scene([seen, unseen], [ball()]), thorough) == []
    assert found(scene([exact("SPHERE"), exact("SPHERE", name="b")]), thorough) == [("coincident", "DIFFERENT")]
    assert found(scene([exact("SPHERE"), exact("SPHERE", 0, scale(0.9), "b")]), thorough) == []


def test_faces_twice():
    faces = np.array(BOX_FACES)
    twice = box(faces=np.concatenate((faces, np.roll(faces, 1, axis=1))))
    assert found(one(twice)) == [("coincident", "DIFFERENT")]
    assert only(one(twice, VEIL_)).faces == 12 and found(one(twice, VEIL_)) == COINCIDENT
    # A second face for every face's back counts too.
    backed = box(faces=np.concatenate((faces, faces[:, ::-1])))
    assert found(one(backed)) == DARKER and found(one(backed, VEIL_)) == COINCIDENT and found(one(backed, GLASS_)) == COINCIDENT
    slots = np.repeat([0, 1], 12).astype(np.uint16)
    assert found(one(dataclasses.replace(twice, material_slots=slots), (GREY_, RED_))) == COINCIDENT
    assert found(one(dataclasses.replace(twice, material_slots=slots), (GREY_, GREY_))) == [("coincident", "DIFFERENT")]
    # Faces that cover little of the picture are a hint; faces without area are ignored.
    some = one(box(faces=[*BOX_FACES, BOX_FACES[0]]))
    far = dataclasses.replace(some, camera=dataclasses.replace(EYE, matrix=look_at((1.0, -600.0, 300.0), (0, 0, 0))))
    assert found(some) == found(some, thorough=False) == DARKER
    assert found(far) == found(far, thorough=False) == [("coincident", "HINT")]
    assert found(one(box(faces=[*BOX_FACES, (0, 0, 1), (0, 0, 1)]))) == []


@pytest.mark.parametrize("thorough", [True, False])
def test_small_faces_of_a_mesh_on_instances_of_another(thorough):
    """Leaves realised as a mesh while their instances remain: small parts of the mesh, reported in one line."""
    rng = np.random.default_rng(1)
    turns = [move(*rng.uniform(-2, 2, 3)) @ rotate_x(3 * rng.random()) @ rotate_y(3 * rng.random()) for _ in range(200)]
    leaf = sheet(0.2, name="leaf")
    points = [leaf.positions @ turn[:3, :3].T + turn[:3, 3] for turn in turns]
    real = MeshData("real", np.concatenate(points), np.concatenate([leaf.triangles + 4 * k for k in range(len(turns))]))
    leaves = [placed(1, RED_, turn, name="leaf") for turn in turns]
    finding = only(scene([placed(0, GREY_, name="tree"), *leaves], [real, leaf]), thorough)
    assert finding.kind == "coincident" and finding.severity == Severity.WRONG and finding.key
    assert {finding.object, *finding.what.split("'")} >= {"tree", "leaf"}
    # A quarter of a leaf away they are apart.
    moved = [placed(1, RED_, turn @ move(0, 0, 0.05), name="leaf") for turn in turns]
    assert found(scene([placed(0, GREY_, name="tree"), *moved], [real, leaf]), thorough) == []
