"""Flat shading in CLASSIC: one colour for each polygon, computed at its centre, against formulas."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes
from course import EXACT, lamp, specular
from tiny_scenes import lambert, look_at, move, pencil, scale, sphere

from addon.bindings.abi import CameraKind, Integrator, LancerError, LobeKind, Pass, Shading
from addon.bindings.enums import Domain, NodeKind
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Instance, Lobe, Material, MeshAttribute, MeshData, Node, NodeRef, World

EYE = np.array([1.0, -2.0, 6.0])
SOURCE = np.array([0.5, 0.25, 3.0])
# An irregular hexagon as a fan of four triangles: its centroid is not the mean of its vertices.
CORNERS = np.array([(-1, -1, 0), (1.5, -1, 0), (2, 0.5, 0), (1, 1, 0), (-0.5, 1.5, 0), (-1, 0.5, 0)], float)
FAN = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
HEXAGON = MeshData("hexagon", CORNERS, FAN, polygons=[0, 0, 0, 0])
CENTER = CORNERS.mean(axis=0)
# The centre of each triangle of the fan.
PLACES = [CORNERS[list(face)].mean(axis=0) for face in FAN]


def camera(pixels=1, target=(0, 0, 0), width=1e-6):
    r = width / 2
    return Camera(look_at(EYE, target), CameraKind.PERSPECTIVE, pixels, pixels, window=(-r, r, -r, r), clip_start=1e-6)


def flat(meshes, material, lights, view, instances=None, materials=(), **settings):
    settings = {"integrator": Integrator.CLASSIC, "samples": 1, "max_bounces": 2, **settings}
    placed = [Instance(shading=Shading.FLAT)] if instances is None else instances
    return tiny_scenes.scene(placed, [material, *materials], lights, meshes, camera=view, **settings)


def seen_at(place, *arguments, **fields):
    return tiny_scenes.render(flat(*arguments, view=camera(target=place), **fields))[0, 0, :3]


def lit(p, n=(0, 0, 1), power=9.0):
    way = SOURCE - p
    d = np.linalg.norm(way)
    return max(0.0, way @ np.array(n, float) / d) * power / d**2 / math.pi


def test_a_polygon_has_one_colour_and_it_is_that_of_its_centre():
    want = lit(CENTER)
    for place in PLACES:
        got = seen_at(place, [HEXAGON], lambert(), [lamp(SOURCE, 9.0)])
        assert np.allclose(got, want, rtol=EXACT), place
    # Without polygons each triangle is a polygon.
    bare = dataclasses.replace(HEXAGON, polygons=None)
    for place in PLACES:
        got = seen_at(0.9 * place + 0.1 * CORNERS[0], [bare], lambert(), [lamp(SOURCE, 9.0)])
        assert np.allclose(got, lit(place), rtol=EXACT) and not np.allclose(got, want, rtol=1e-3)


def test_path_lights_every_point_of_the_face():
    """PATH varies light over the face; a point lamp and the pixel's centre give no noise."""
    for place in PLACES:
        got = seen_at(place, [HEXAGON], lambert(), [lamp(SOURCE, 9.0)], integrator=Integrator.PATH, max_bounces=0)
        assert np.allclose(got, lit(place), rtol=1e-5)


def test_the_highlight_is_that_of_the_view_of_the_centre():
    material = specular(LobeKind.PHONG, 30.0)
    to_light, to_eye = SOURCE - CENTER, EYE - CENTER
    d = np.linalg.norm(to_light)
    wi, wo = to_light / d, to_eye / np.linalg.norm(to_eye)
    shine = np.array([0.5, 0.25, 1.0]) * (wo @ (wi * [-1, -1, 1])) ** 30
    want = (0.25 * wi[2] + shine) / math.pi * 9 / d**2
    for place in PLACES:
        # The exponent amplifies the rounding of directions.
        assert np.allclose(seen_at(place, [HEXAGON], material, [lamp(SOURCE, 9.0)]), want, rtol=EXACT + 3e-7 * 30)


def test_parallel_rays_see_the_centre_along_themselves():
    """Under an orthographic camera the polygon has one colour too, with the highlight of the rays' direction."""
    wo = np.array([0.6, 0.0, 0.8])
    to_light = SOURCE - CENTER
    d = np.linalg.norm(to_light)
    wi = to_light / d
    want = (0.25 * wi[2] + np.array([0.5, 0.25, 1.0]) * (wo @ (wi * [-1, -1, 1])) ** 5) / math.pi * 9 / d**2
    for place in PLACES:
        view = pencil(place + 5 * wo, place)
        got = tiny_scenes.render(flat([HEXAGON], specular(LobeKind.PHONG, 5.0), [lamp(SOURCE, 9.0)], view))[0, 0, :3]
        assert np.allclose(got, want, rtol=EXACT + 3e-7 * 5)


def test_one_shadow_ray_decides_for_the_polygon():
    """A ball that occludes the centre darkens the whole polygon; a ball elsewhere has no effect."""
    light = lamp(SOURCE, 9.0)
    for at, want in ((CENTER, 0.0), (PLACES[0], lit(CENTER))):
        ball = sphere(0, move(*(0.9 * at + 0.1 * SOURCE)) @ scale(0.01))
        instances = [Instance(shading=Shading.FLAT), ball]
        for place in PLACES[1:]:
            assert np.allclose(seen_at(place, [HEXAGON], lambert(), [light], instances=instances), want, rtol=EXACT)


def test_the_mirrored_ray_starts_at_the_centre():
    """Under a wall with three bands the whole polygon shows the band reflected at its centre."""
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(1, 1, 1)),))
    along = (CENTER - EYE) * [1, 1, -1]
    met = CENTER + along * (8.0 / along[2])
    bands = [
        Instance(mesh=1, matrix=move(met[0] + dx, met[1], 8.0), materials=(1 + i,)) for i, dx in enumerate((-0.1, 0.0, 0.1))
    ]
    board = MeshData("band", [(-0.05, -9, 0), (0.05, -9, 0), (0.05, 9, 0), (-0.05, 9, 0)], [(0, 1, 2), (0, 2, 3)])
    glow = [Material(f"glow {i}", lobes=(), emission=tuple(float(k == i) for k in range(3))) for i in range(3)]
    instances = [Instance(shading=Shading.FLAT), *bands]
    for place in PLACES:
        got = seen_at(place, [HEXAGON, board], mirror, [], instances=instances, materials=glow)
        assert got.tolist() == [0.0, 1.0, 0.0], place


def test_textures_are_those_of_the_centre():
    """An attribute that is linear over the polygon has its value at the centre, which lies in one triangle."""
    ramp = MeshAttribute("ramp", CORNERS[:, :1] * [0.1, 0.05, 0.0] + [0.3, 0.4, 0.5], Domain.VERTEX)
    mesh = dataclasses.replace(HEXAGON, attributes=(ramp,))
    nodes = (Node(NodeKind.ATTRIBUTE, name="ramp"),)
    material = Material("painted", lobes=(Lobe(color=NodeRef(0)),), nodes=nodes)
    want = (CENTER[0] * np.array([0.1, 0.05, 0.0]) + [0.3, 0.4, 0.5]) * lit(CENTER)
    for place in PLACES:
        assert np.allclose(seen_at(place, [mesh], material, [lamp(SOURCE, 9.0)]), want, rtol=EXACT)


def test_a_warped_polygon_has_its_mean_normal_and_a_place_of_its_own():
    """The normal is Newell's; the centre is the point on the surface below the mean of the corners."""
    corners = np.array([(-1, -1, 0.0), (1, -1, 0.3), (1, 1, 0.0), (-1, 1, 0.3)])
    mesh = MeshData("warped", corners, [(0, 1, 2), (0, 2, 3)], polygons=[0, 0])
    area = np.cross(corners[2] - corners[0], corners[3] - corners[1])
    # The mean lies above the common edge of both triangles, from corner 0 to corner 2.
    p = np.array([0.0, 0.0, 0.0])
    want = lit(p, area / np.linalg.norm(area))
    for place in ((0.4, -0.5, 0.15), (-0.4, 0.5, 0.15)):
        assert np.allclose(seen_at(place, [mesh], lambert(), [lamp(SOURCE, 9.0)]), want, rtol=EXACT)


def test_a_centre_beside_a_concave_polygon_is_moved_to_it():
    corners = np.array([(-1, -1, 0), (1, -1, 0), (1, -0.8, 0), (-0.8, -0.8, 0), (-0.8, 3, 0), (-1, 3, 0)], float)
    mesh = MeshData("angle", corners, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)], polygons=[0] * 4)
    mean = corners.mean(axis=0)
    assert mean[0] > -0.8 and mean[1] > -0.8
    nearest = np.array([-0.8, mean[1], 0.0])
    for place in ((0.5, -0.95, 0), (-0.95, 0.5, 0)):
        assert np.allclose(seen_at(place, [mesh], lambert(), [lamp(SOURCE, 9.0)]), lit(nearest), rtol=EXACT)


def test_placement_mirrors_and_stretches_the_centre():
    matrix = move(0.2, 0.1, 0.4) @ scale(-1.5, 0.7, 1.0)
    for place in PLACES:
        instances = [Instance(matrix=matrix, shading=Shading.FLAT)]
        got = seen_at((matrix @ [*place, 1])[:3], [HEXAGON], lambert(), [lamp(SOURCE, 9.0)], instances=instances)
        assert np.allclose(got, lit((matrix @ [*CENTER, 1])[:3]), rtol=EXACT)


def test_the_picture_with_passes_is_the_picture_without_them():
    """The passes depth and position vary over the face; they do not change the picture."""
    ball = MeshData("ball", *_uv_sphere(), polygons=None)
    view = camera(24, width=0.5)
    snapshot = flat([ball], specular(LobeKind.BECKMANN, 1.0), [lamp(SOURCE, 9.0)], view)
    plain, told = (
        dataclasses.replace(snapshot, settings=dataclasses.replace(snapshot.settings, passes=passes))
        for passes in ((Pass.COMBINED,), (Pass.COMBINED, Pass.POSITION, Pass.MIST))
    )
    assert np.array_equal(tiny_scenes.render(plain), tiny_scenes.render(told))
    with Session.upload(told) as session:
        session.render_all()
        position = session.read(Pass.POSITION)
    on_ball = np.linalg.norm(position, axis=-1)
    # A facet of 16 by 8 lies at most 1 - cos(pi / 8) inside the ball, and each pixel has its own position on it.
    assert on_ball[12, 12] > math.cos(math.pi / 8) ** 2 and len(np.unique(position[8:16, 8:16].reshape(-1, 3), axis=0)) == 64


def _uv_sphere(turns=16, rings=8):
    theta, phi = np.meshgrid(np.linspace(0, math.pi, rings + 1), np.arange(turns) * 2 * math.pi / turns, indexing="ij")
    points = np.stack((np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), axis=-1).reshape(-1, 3)
    faces = []
    for i in range(rings):
        for j in range(turns):
            a, b = i * turns + j, i * turns + (j + 1) % turns
            faces += [(a, a + turns, b + turns), (a, b + turns, b)]
    return points, faces


def test_a_sphere_has_as_many_colours_as_faces():
    points, faces = _uv_sphere()
    ball = MeshData("ball", points, faces, polygons=np.arange(len(faces)) // 2)
    snapshot = flat([ball], lambert(), [lamp((5, -4, 9), 300.0)], camera(96, width=0.5), world=0.0)
    snapshot = dataclasses.replace(snapshot, world=World((0, 0, 0), ambient=(0, 0, 0)))
    colors = np.unique(tiny_scenes.render(snapshot)[..., 0].round(9))
    # About half of the 128 faces are visible; background and the dark side are black.
    assert 20 < len(colors) < 80


def test_a_polygon_out_of_range_is_refused():
    with pytest.raises(LancerError, match="polygon 4 >= 4 triangles"):
        tiny_scenes.render(flat([dataclasses.replace(HEXAGON, polygons=[0, 0, 4, 0])], lambert(), [], camera()))
