"""Adaptive subdivision: limit surfaces with closed forms, cracks, lengths of edges, sizes of pixels."""

import numpy as np
import pytest

from addon.bindings.enums import CameraKind
from addon.bindings.snapshot import Camera
from addon.export.subdivision.catmull_clark import Cage, refine
from addon.export.subdivision.edge_table import Rate
from addon.export.subdivision.limit_patches import LimitPatches
from addon.export.subdivision.non_manifold import odd_corners
from addon.export.subdivision.patches import LinearPatches
from addon.export.subdivision.pixel_size import pixel_size
from addon.export.subdivision.splitting import TooManyTrianglesError, split_patches, triangle_counts
from addon.export.subdivision.tessellation import tessellate

CUBE = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
CUBE_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
# A triangle, a quad and two pentagons around a vertex with four edges, and a quad that joins two of them.
FAN = [(0, 0), (2, 0), (2, 1.5), (0.5, 2), (-1, 2.5), (-2, 0.5), (-1.5, -1), (0.5, -2), (2, -1.5)]
FAN_FACES = [(0, 1, 2), (0, 2, 3, 4), (0, 4, 5, 6, 7), (0, 7, 8, 1)]
# Limit points are sums of at most some hundred products of numbers below 4 in double precision.
ROUNDING = 1e-12


def nothing():
    pass


def cage(points, faces, creases=(), sharpness=(), sharp_vertices=None):
    return Cage(
        values=np.array(points, float),
        corners=np.concatenate(faces).astype(np.int64),
        starts=np.cumsum([0, *map(len, faces)]),
        creases=np.array(creases, np.int64).reshape(-1, 2),
        crease_sharpness=np.array(sharpness, float),
        vertex_sharpness=np.zeros(len(points)) if sharp_vertices is None else np.array(sharp_vertices, float),
    )


def cube(sharpness=0.0):
    edges = [(face[i - 1], face[i]) for face in CUBE_FACES for i in range(4)]
    return cage(CUBE, CUBE_FACES, edges, [sharpness] * len(edges)) if sharpness else cage(CUBE, CUBE_FACES)


def everywhere(count, side=5):
    """Return patches and coordinates of a grid on each of count patches."""
    grid = np.stack(np.meshgrid(*2 * [np.linspace(0.0, 1.0, side)]), axis=-1).reshape(-1, 2)
    return np.repeat(np.arange(count), len(grid)), np.tile(grid, (count, 1))


def divided(surface, mesh, rate, most=1 << 30):
    table, quads, triangles = split_patches(surface, mesh, rate, most, nothing)
    counts = [triangle_counts(table.segments[pieces.edges]).sum() for pieces in (quads, triangles)]
    found = tessellate(table, quads, triangles, mesh, nothing)
    assert len(found.triangles) == sum(counts)
    return found


def assert_covers(found, surface, mesh):
    """Each vertex must be one place in all its patches, and the triangles must cover each face once without gaps."""
    places = surface.at(found.patches, found.uvs, nothing)
    assert np.abs(places - places[found.owners][found.vertices]).max() < ROUNDING
    # Lay each face out as a regular polygon, that its patches cover.
    sizes = np.diff(mesh.starts)
    turns = 2.0 * np.pi * (np.arange(len(mesh.corners)) - np.repeat(mesh.starts[:-1], sizes)) / np.repeat(sizes, sizes)
    laid = LinearPatches(np.stack([np.cos(turns), np.sin(turns)], axis=1), mesh).at(found.patches, found.uvs, nothing)
    a, b, c = (laid[found.triangles[:, corner]] for corner in range(3))
    area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert area.min() > 0.0
    faces = np.repeat(np.arange(len(sizes)), sizes)[found.patches[found.triangles[:, 0]]]
    assert np.bincount(faces, area) == pytest.approx(0.5 * sizes * np.sin(2.0 * np.pi / sizes), rel=1e-9)


def edge_uses(found):
    corners = found.vertices[found.triangles]
    ends = np.sort(np.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    return np.unique(ends, axis=0, return_counts=True)


def test_the_limit_of_a_cube():
    surface = LimitPatches(cube(), nothing)
    corners = surface.at(np.arange(24), np.zeros((24, 2)), nothing)
    # By the mask (9 v + 4 sum of neighbours + sum of opposites) / 24, in which both sums shrink the corner (1, 1, 1).
    assert np.abs(np.abs(corners) - 0.5).max() < ROUNDING
    # After one refinement the centre of a face has height 1, its neighbours 3/4 and the corners beside 5/9.
    centres = surface.at(np.arange(24), np.ones((24, 2)), nothing)
    assert np.sort(np.abs(centres), axis=1) == pytest.approx(np.tile((0.0, 0.0, 68.0 / 81.0), (24, 1)), abs=ROUNDING)
    normals = surface.normals(np.arange(24), np.zeros((24, 2)), nothing)
    assert np.abs(normals - corners / np.linalg.norm(corners, axis=1, keepdims=True)).max() < 1e-3


@pytest.mark.parametrize("is_creased", [False, True])
def test_regular_faces_keep_their_limit_when_refined(is_creased):
    """A torus of 6 x 7 quads with rough places, whose faces away from a crease are patches as a whole."""
    rng = np.random.default_rng(5)
    turns = 2.0 * np.pi * np.stack(np.meshgrid(np.arange(6) / 6, np.arange(7) / 7), axis=-1).reshape(-1, 2)
    ring = 2.0 + np.cos(turns[:, 0])
    places = np.stack([ring * np.cos(turns[:, 1]), ring * np.sin(turns[:, 1]), np.sin(turns[:, 0])], axis=1)
    faces = [
        (6 * (j % 7) + i % 6 for j, i in ((y, x), (y, x + 1), (y + 1, x + 1), (y + 1, x))) for y in range(7) for x in range(6)
    ]
    faces = [tuple(face) for face in faces]
    creases = [(0, 1)] if is_creased else []
    mesh = cage(places + rng.normal(0.0, 0.2, places.shape), faces, creases, [np.inf] * len(creases))
    finer = refine(mesh, turned=False)
    corners, uvs = everywhere(len(mesh.corners))
    # The first corner of each quad is the vertex of the corner that makes it.
    surfaces = LimitPatches(mesh, nothing), LimitPatches(finer, nothing)
    for name in ("at", "normals"):
        coarse = getattr(surfaces[0], name)(corners, 0.5 * uvs, nothing)
        fine = getattr(surfaces[1], name)(4 * corners, uvs, nothing)
        far = np.repeat([not is_creased or not {0, 1} & set(face) for face in faces], 4 * 25)
        # Normals are quotients of differences of such numbers.
        assert np.abs(coarse - fine)[far].max() < 100.0 * ROUNDING
        if name == "at":
            # Beside the dart the patches are made after different numbers of refinements.
            assert np.abs(coarse - fine).max() < 1e-2


@pytest.mark.parametrize("sharpness", [0.0, 0.6, 2.0, np.inf])
def test_a_plane_stays_a_plane(sharpness):
    points = [(x, y, 0.5 * x - 0.25 * y + 1.0) for x, y in FAN]
    flat = cage(points, FAN_FACES, [(0, 2), (0, 4)], [sharpness] * 2)
    surface = LimitPatches(flat, nothing)
    at = everywhere(len(flat.corners))
    x, y, z = surface.at(*at, nothing).T
    assert np.abs(z - (0.5 * x - 0.25 * y + 1.0)).max() < ROUNDING
    upright = np.array((-0.5, 0.25, 1.0)) / np.linalg.norm((-0.5, 0.25, 1.0))
    assert np.abs(surface.normals(*at, nothing) - upright).max() < 1e-9


def test_a_fully_creased_cube_stays_a_cube():
    sharp = cube(np.inf)
    surface = LimitPatches(sharp, nothing)
    places = surface.at(*everywhere(24), nothing)
    assert np.abs(np.abs(places).max(axis=1) - 1.0).max() < ROUNDING
    assert np.abs(places).max(axis=0) == pytest.approx((1.0, 1.0, 1.0), abs=ROUNDING)


def test_semi_sharp_creases_lie_between():
    heights = []
    for sharpness in (0.0, 0.5, 1.0, 2.0, np.inf):
        surface = LimitPatches(cube(sharpness), nothing)
        heights.append(np.abs(surface.at(np.arange(1), np.zeros((1, 2)), nothing)).max())
    assert heights == sorted(heights) and heights[0] < heights[1] < heights[2] < heights[3] < heights[4] == pytest.approx(1.0)


def test_sharp_vertices_stay():
    surface = LimitPatches(cage(CUBE, CUBE_FACES, sharp_vertices=[np.inf] + 7 * [0.0]), nothing)
    places = surface.at(np.arange(24), np.zeros((24, 2)), nothing)
    assert places[0] == pytest.approx(CUBE[0], abs=ROUNDING) and np.abs(places[6]).max() < 0.9


def stays(mesh):
    """Return the vertices that stay in their places because of how the faces meet there."""
    return np.flatnonzero(odd_corners(mesh, mesh.edges)).tolist()


def test_edges_of_many_faces_end_in_corners():
    """Three sheets of two squares each around the line from 0 over 1 to 2, the vertices of a sheet beyond the others."""
    line = [(0, 0, 0), (0, 0, 1), (0, 0, 2)]
    sheets = [(x, y, z) for x, y in ((1, 0), (-1, 1), (-1, -1)) for z in range(3)]
    faces = [(i, first + i, first + i + 1, i + 1) for first in (3, 6, 9) for i in range(2)]
    mesh = cage([*line, *sheets], faces)
    # The line's middle has two edges of three faces, and six faces for five edges.
    assert stays(mesh) == [0, 2]
    one = cage([*line, *sheets], faces[::2])
    assert stays(one) == [0, 1]


def test_faces_that_run_the_same_way_are_sharp():
    mesh = cage([(0, -1, 0), (0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (-1, 0, 1), (-1, 1, 1)], [(1, 3, 4, 2), (1, 5, 6, 2)])
    edges = mesh.edges
    assert edges.ends[(edges.faces == 2) & np.isinf(edges.sharpness)].tolist() == [[1, 2]] and stays(mesh) == [1, 2]
    assert stays(cage(mesh.values, [(1, 3, 4, 2), (2, 6, 5, 1)])) == []


def test_a_vertex_between_two_bodies_stays():
    """Two cubes that share a corner, the last of one and the first of the other."""
    faces = [*CUBE_FACES, *(tuple(7 + vertex for vertex in face) for face in CUBE_FACES)]
    mesh = cage([*CUBE, *(np.array(CUBE[1:]) + 2)], faces)
    assert stays(cube()) == [] and stays(mesh) == [7]


@pytest.mark.parametrize("smooth", [True, False])
def test_no_cracks(smooth):
    """A solid of all kinds of faces, divided so that edges have many numbers of segments."""
    closed = cage(
        [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, 1, 3)], [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    )
    surface = LimitPatches(closed, nothing) if smooth else LinearPatches(closed.values[closed.corners], closed)
    eye = Camera(matrix=np.array([(1, 0, 0, 1.0), (0, 1, 0, -0.5), (0, 0, 1, 4.0)]), width=40, height=40)
    found = divided(surface, closed, Rate(1.0, 12, np.eye(4), pixel_size(eye, 1.0)))
    assert_covers(found, surface, closed)
    _, uses = edge_uses(found)
    assert len(found.triangles) > 1000 and (uses == 2).all()
    # Euler's formula of a closed surface without holes.
    assert len(found.owners) - len(uses) + len(found.triangles) == 2


def test_pieces_of_three_corners():
    """A flat trapezium: where its short side has one segment and the opposite must be split, triangles are cut off."""
    strip = cage([(-20, 0, 0), (20, 0, 0), (0.45, 0.1, 0), (-0.45, 0.1, 0)], [(0, 1, 2, 3)])
    surface = LinearPatches(strip.values[strip.corners], strip)
    table, quads, triangles = split_patches(surface, strip, Rate(0.5, 12), 1 << 30, nothing)
    assert len(triangles.patches)
    assert_covers(tessellate(table, quads, triangles, strip, nothing), surface, strip)


def test_edges_are_no_longer_than_the_rate():
    flat = cage([(0, 0, 0), (3, 0, 0), (3, 2, 0), (0, 2, 0)], [(0, 1, 2, 3)])
    surface = LinearPatches(flat.values[flat.corners], flat)
    found = divided(surface, flat, Rate(0.07, 12))
    places = surface.at(found.patches[found.owners], found.uvs[found.owners], nothing)
    ends, _ = edge_uses(found)
    along = np.abs(places[ends[:, 0]] - places[ends[:, 1]])
    # Sides of the rectangles that the triangles halve; the diagonals are longer.
    assert along.max() <= 0.07 * (1.0 + ROUNDING)
    # Halves of 1.5 and 1 have 22 and 15 segments, that are cut at the middle as long as there are more than eight.
    assert len(found.triangles) == 2 * (4 * 6 * 2) * (4 * 4 * 2)


def test_the_coarsest_quad_has_a_centre():
    """Its first cut has two segments, as its own edges."""
    flat = cage([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    surface = LinearPatches(flat.values[flat.corners], flat)
    found = divided(surface, flat, Rate(100.0, 12))
    places = surface.at(found.patches[found.owners], found.uvs[found.owners], nothing)
    assert len(found.triangles) == 8 and len(places) == 9 and (places == (0.5, 0.5, 0.0)).all(axis=1).any()


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.filterwarnings("ignore:invalid value")
def test_numbers_that_are_not_finite(bad):
    """The faces beside a bad vertex have few triangles, which the library leaves out; the others are as they are without."""
    points = [(x, y, 0.0) for y in range(7) for x in range(7)]
    faces = [(7 * y + x, 7 * y + x + 1, 7 * y + x + 8, 7 * y + x + 7) for y in range(6) for x in range(6)]
    eye = Camera(matrix=np.array([(1, 0, 0, 3.0), (0, 1, 0, 3.0), (0, 0, 1, 9.0)]), width=40, height=40)
    for rate in (Rate(0.2, 12), Rate(1.0, 12, np.eye(4), pixel_size(eye, 4.0))):
        places = []
        for first in (points[0], (bad, 0.0, 0.0)):
            mesh = cage([first, *points[1:]], faces)
            surface = LimitPatches(mesh, nothing)
            found = divided(surface, mesh, rate)
            corners = surface.at(found.patches, found.uvs, nothing)[found.triangles]
            # Limit points follow the vertices of two rings of faces.
            places.append(corners[(corners[..., :2] > 3.0).all(axis=(1, 2))])
        assert len(places[0]) and np.array_equal(*places)


def test_levels_limit_the_segments():
    flat = cage([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    surface = LinearPatches(flat.values[flat.corners], flat)
    for levels in (1, 2, 4):
        assert len(divided(surface, flat, Rate(1e-3, levels)).triangles) == 2 * 4**levels


def test_too_many_triangles_end_early():
    flat = cage([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    surface = LinearPatches(flat.values[flat.corners], flat)
    with pytest.raises(TooManyTrianglesError):
        divided(surface, flat, Rate(1e-6, 24), most=10_000)


def test_the_size_of_a_pixel():
    eye = Camera(matrix=np.eye(4)[:3], width=200, height=100, window=(-1.0, 1.0, -0.5, 0.5))
    points = np.array([(0.0, 0.0, -7.0), (3.0, 1.0, -5.0), (8.0, 0.0, -4.0), (0.0, 0.0, 2.0)])
    # The angle of a pixel of 1/100 at the centre is atan(1/100); its chord's part across the ray is the sine.
    expected = np.sin(np.arctan(0.01)) * np.linalg.norm(points, axis=1)
    assert pixel_size(eye, 1.0)(points) == pytest.approx(expected, rel=1e-9)
    # The third point is outside the right side, x = 1 at z = -1, by (8 - 4) / sqrt 2; the fourth is behind the eye.
    outside = np.array((0.0, 0.0, 4.0 / np.sqrt(2.0), 2.0))
    grown = expected + 3.0 * np.sin(np.arctan(0.01)) * outside
    assert pixel_size(eye, 4.0)(points) == pytest.approx(grown, rel=1e-9)


def test_the_size_of_a_pixel_without_perspective():
    eye = Camera(matrix=np.eye(4)[:3], kind=CameraKind.ORTHOGRAPHIC, width=100, height=50, window=(-2.0, 2.0, -1.0, 1.0))
    points = np.array([(0.0, 0.0, -7.0), (5.0, 0.0, -1.0)])
    assert pixel_size(eye, 1.0)(points) == pytest.approx([0.04, 0.04])
    assert pixel_size(eye, 3.0)(points) == pytest.approx([0.04, 0.04 * (1.0 + 2.0 * 3.0 / np.sqrt(2.5))])
