"""The course's ray tracer: single pixels against formulas."""

import dataclasses
import math

import numpy as np
import pytest
import reference
import tiny_scenes
from course import EXACT, EYE, LAMP, classic, color, lamp, mirrored_sky, specular
from tiny_scenes import lambert, move, pencil, plane, rgb, rotate_x, scale, sphere

from addon.bindings.abi import Falloff, Integrator, LightKind, LobeKind, Shading
from addon.bindings.enums import Coordinate, Environment, NodeKind, Ray, VectorOperation
from addon.bindings.session import Session
from addon.bindings.snapshot import Image, Instance, Light, Lobe, Material, MeshData, Node, NodeRef, World


def test_diffuse():
    """c = Kd/pi max(0, l.n) lc with lc = I/d^2."""
    got = color([plane()], [lambert((0.5, 0.25, 1.0))], [lamp()])
    want = np.array([0.5, 0.25, 1.0]) / math.pi * (2 / 3) * np.array([9, 18, 27]) / 9
    assert np.allclose(got, want, rtol=EXACT)


def test_lights_add_up_and_those_behind_give_nothing():
    lights = [lamp(), lamp((0, 0, 2.0), 4.0), lamp((0, 0, -2.0), 1000.0)]
    want = np.array([9, 18, 27]) / 9 * (2 / 3) / math.pi + 1.0 / math.pi
    assert np.allclose(color([plane()], [lambert()], lights), want, rtol=EXACT)


def test_shadow():
    """A ball halfway to the lamp occludes it; a ball beside or beyond the path does not."""
    free = color([plane()], [lambert()], [lamp()])
    halfway = sphere(0, move(*np.array(LAMP) / 2) @ scale(0.1))
    beside = sphere(0, move(-0.5, 1.0, 1.2) @ scale(0.1))
    beyond = sphere(0, move(*np.array(LAMP) * 1.1) @ scale(0.1))
    assert np.all(color([plane(), halfway], [lambert()], [lamp()]) == 0.0)
    assert np.array_equal(color([plane(), beside], [lambert()], [lamp()]), free)
    assert np.array_equal(color([plane(), beyond], [lambert()], [lamp()]), free)


def test_sky_on_a_miss():
    snapshot = tiny_scenes.scene(world=(0.2, 0.4, 0.8), integrator=Integrator.CLASSIC)
    assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :3], (0.2, 0.4, 0.8), rtol=1e-7)


@pytest.mark.parametrize("alpha, ior", [(0.05, 1.5), (0.3, 1.33), (0.7, 2.0)])
def test_lab_bsdf(alpha, ior):
    """(Kd/pi + Ks D F G / (4 (l.n)(v.n))) (l.n) lc, at and beside the mirror direction."""
    for position in ((-3.0, 0.0, 4.0), (-2.9, 0.3, 4.1), LAMP):
        p = np.array(position)
        distance = np.linalg.norm(p)
        wi, wo = p / distance, np.array([0.6, 0, 0.8])
        material = Material("lab", lobes=lambert(0.25).lobes + tiny_scenes.beckmann(0.5, alpha, ior).lobes)
        got = color([plane()], [material], [lamp(position, 9.0)], max_bounces=0)
        f = 0.25 / math.pi + float(reference.beckmann_bsdf(wo, wi, np.float32(alpha), ior, 0.5))
        # Directions are rounded to float32: the error of h is 1e-7, and D amplifies it by 2 tan/alpha^2.
        h = (wi + wo) / np.linalg.norm(wi + wo)
        sensitivity = 4e-7 * (1 + np.hypot(h[0], h[1]) / h[2] / alpha**2)
        assert np.allclose(got, f * wi[2] * 9 / distance**2, rtol=EXACT + sensitivity), position


@pytest.mark.parametrize("shininess", [1.0, 10.0, 200.0])
@pytest.mark.parametrize("kind", [LobeKind.PHONG, LobeKind.BLINN_PHONG])
def test_phong_and_blinn_phong(kind, shininess):
    """(kd (l.n) + ks cos^n)/pi times the irradiance, cos = R.V or N.H; each channel and each light colour by itself."""
    position = np.array((-2.5, 0.6, 4.0))
    distance = np.linalg.norm(position)
    wi, wo = position / distance, np.array([0.6, 0, 0.8])
    h = (wi + wo) / np.linalg.norm(wi + wo)
    cosine = wo @ (wi * [-1, -1, 1]) if kind == LobeKind.PHONG else h[2]
    light = lamp(position, 9.0, diffuse_color=(1.0, 0.5, 0.0), specular_color=(0.25, 1.0, 2.0))
    got = color([plane()], [specular(kind, shininess)], [light])
    diffuse = 0.25 * wi[2] * np.array([1.0, 0.5, 0.0])
    shine = np.array([0.5, 0.25, 1.0]) * cosine**shininess * np.array([0.25, 1.0, 2.0])
    assert np.allclose(got, (diffuse + shine) / math.pi * 9 / distance**2, rtol=EXACT + 3e-7 * shininess)


def test_ambient():
    """Ia Ka: the sky's radiance, and each light's lc/pi by its ambient colour, without shadow or angle."""
    material = Material("ambient", lobes=(), ambient=(0.5, 0.25, 1.0))
    snapshot = tiny_scenes.scene(
        [plane()], [material], world=(0.1, 0.2, 0.4), camera=pencil(EYE), integrator=Integrator.CLASSIC
    )
    assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :3], (0.05, 0.05, 0.4), rtol=EXACT)
    # An occluder leaves only the ambient part.
    wall = sphere(0, move(*np.array(LAMP) / 2) @ scale(0.1))
    got = color([plane(), wall], [material], [lamp(ambient_color=(1.0, 0.5, 0.0))])
    want = np.array([0.5, 0.25, 1.0]) * [1.0, 0.5, 0.0] * np.array([9, 18, 27]) / 9 / math.pi
    assert np.allclose(got, want, rtol=EXACT)


def test_the_ambient_light_of_a_sky_that_varies_is_its_mean_along_the_axes():
    """A sky of 1 + x, 1 + y, 1 + z in the direction (x, y, z) has the mean 1."""
    nodes = (
        Node(kind=NodeKind.COORDINATE, option=Coordinate.GENERATED),
        Node(kind=NodeKind.VECTOR_MATH, option=VectorOperation.ADD, inputs=(NodeRef(0), (1.0, 1.0, 1.0), (0.0,) * 3, 1.0)),
    )
    material = Material("ambient", lobes=(), ambient=(0.5, 0.25, 1.0))
    snapshot = dataclasses.replace(classic([plane()], [material]), world=World(radiance=NodeRef(1), nodes=nodes))
    assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :3], (0.5, 0.25, 1.0), rtol=EXACT)


@pytest.mark.parametrize("lamps", [0, 1, 5])
def test_the_ambient_term_is_one_whatever_the_lamps(lamps):
    """I = Ka A with the world's own ambient colour A instead of the sky's, added once whatever the lamps."""
    material = Material("ambient", lobes=(), ambient=(0.5, 0.25, 1.0))
    lights = [lamp((i, 0, 2.0 + i), ambient_color=(0, 0, 0)) for i in range(lamps)]
    snapshot = classic([plane()], [material], lights)
    for sky in (0.0, 7.0):
        world = World((sky,) * 3, ambient=(0.2, 0.4, 0.8))
        got = tiny_scenes.render(dataclasses.replace(snapshot, world=world))[0, 0, :3]
        assert np.allclose(got, (0.1, 0.1, 0.8), rtol=EXACT)
    black = dataclasses.replace(snapshot, world=World((7.0,) * 3, ambient=(0, 0, 0)))
    assert np.all(tiny_scenes.render(black)[0, 0, :3] == 0.0)


def test_the_own_ambient_colour_is_no_light():
    """Only Ka reflects the ambient colour: no diffuse surface, mirror or background shows it."""
    world = World((0, 0, 0), ambient=(1, 1, 1))
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(1, 1, 1)),))
    for instances, material in (([plane()], lambert()), ([plane()], mirror), ([], lambert())):
        snapshot = dataclasses.replace(classic(instances, [material]), world=world)
        assert np.all(tiny_scenes.render(snapshot)[0, 0, :3] == 0.0)


ATTENUATIONS = {
    Falloff.PHYSICAL: lambda d, r: 1 / d**2,
    Falloff.CONSTANT: lambda d, r: 1.0,
    Falloff.LINEAR: lambda d, r: max(0.0, 1 - d / r),
    Falloff.QUADRATIC: lambda d, r: max(0.0, 1 - d**2 / r**2),
    Falloff.SMOOTH: lambda d, r: max(0.0, 1 - d**2 / r**2) ** 2,
    Falloff.GAUSSIAN: lambda d, r: math.exp(-(d**2) / r**2),
}


@pytest.mark.parametrize("kind", [LightKind.POINT, LightKind.SPOT])
@pytest.mark.parametrize("falloff", Falloff)
def test_falloffs(falloff, kind):
    for d, r in ((3.0, 4.0), (3.0, 3.5), (3.0, 2.0), (300.0, 1000.0)):
        light = Light("lamp", move(z=d), kind, emission=rgb(6.0), falloff=falloff, falloff_radius=r, spot_blend=0.0)
        got = color([plane()], [lambert()], [light])
        # 1 - d/r loses digits for d near r: the distance has one rounding error, and 1 - d/r is at least 0.1 here.
        assert np.allclose(got, 6 * ATTENUATIONS[falloff](d, r) / math.pi, rtol=EXACT * 10, atol=0), (d, r)


@pytest.mark.parametrize("blend", [0.0, 0.5])
def test_spot_edges(blend):
    """A spot without blend has a hard edge; with blend the edge is a smooth step of the cosine."""
    half, height = 0.4, 5.0
    for angle in (0.0, 0.3, 0.38, 0.42):
        light = Light(
            "spot",
            move(height * math.tan(angle), 0, height),
            LightKind.SPOT,
            emission=rgb(7.0),
            spot_angle=2 * half,
            spot_blend=blend,
        )
        distance = height / math.cos(angle)
        over, edge = math.cos(angle) - math.cos(half), (1 - math.cos(half)) * blend
        fade = float(over > 0) if edge == 0 else reference.smoothstep(over / edge)
        want = 7 * fade / distance**2 * math.cos(angle) / math.pi
        # The cosine in float32 over an edge 0.04 wide.
        assert np.allclose(color([plane()], [lambert()], [light]), want, rtol=2e-5, atol=1e-7), angle


def test_sun():
    light = Light("sun", rotate_x(math.acos(0.5)), LightKind.SUN, emission=(2, 4, 6))
    assert np.allclose(color([plane()], [lambert()], [light]), np.array([2, 4, 6]) * 0.5 / math.pi, rtol=EXACT)


def test_reflection():
    """c = F c_reflected c_s, F at the reflected direction: v.n = 0.8."""
    got = mirrored_sky(tiny_scenes.beckmann((0.5, 1.0, 0.25), 0.3, 1.5))
    f = float(reference.fresnel(np.float32(0.8), 1.5))
    assert np.allclose(got, f * np.array([0.5, 2.0, 0.75]), rtol=EXACT)
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(0.5, 1.0, 0.25)),))
    assert np.allclose(mirrored_sky(mirror), (0.5, 2.0, 0.75), rtol=EXACT)


def hall(bounces, colour=0.5, **settings):
    """Return the radiance between two parallel mirrors, at right angles: the path ends at the depth limit."""
    glow = Material("wall", lobes=(Lobe(LobeKind.MIRROR, color=rgb(colour)),), emission=rgb(1.0))
    floor, ceiling = plane(0), plane(0, move(z=2.0) @ rotate_x(math.pi))
    return color([floor, ceiling], [glow], camera=pencil((0, 0, 1.0), (0, 0, 0)), max_bounces=bounces, **settings)


@pytest.mark.parametrize("bounces", [0, 1, 5, 10])
def test_chain_of_reflections_is_black_beyond_the_depth_limit(bounces):
    """1 + c + c^2 + ... up to the depth limit."""
    assert np.allclose(hall(bounces), sum(0.5**k for k in range(bounces + 1)), rtol=EXACT)


def test_threshold_stops_rays_that_cannot_matter():
    """Weights 1, 1/2, 1/4 ...: a ray that can add no more than the threshold is not traced; 0 = never."""
    assert np.allclose(hall(10, contribution_threshold=0.2), 1 + 0.5 + 0.25, rtol=EXACT)
    assert np.allclose(hall(10, contribution_threshold=0.25), 1 + 0.5, rtol=EXACT)
    assert np.allclose(hall(10, contribution_threshold=0.0), 2 - 0.5**10, rtol=EXACT)


def test_refraction():
    """A slab of glass at normal incidence transmits (1 - F)^2 of the sky and reflects F at each face, without loss."""
    glass = Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.5),))
    slab = Instance(kind=3, matrix=scale(100.0, 100.0, 0.5))
    camera = pencil((0.3, 0.0, 3.0), (0.3, 0.0, 0.0))
    f = 0.04
    for bounces, series in ((2, f + (1 - f) ** 2), (4, f + (1 - f) ** 2 * (1 + f + f**2)), (10, 1.0)):
        snapshot = tiny_scenes.scene(
            [slab], [glass], world=1.0, camera=camera, integrator=Integrator.CLASSIC, max_bounces=bounces
        )
        got = tiny_scenes.render(snapshot)[0, 0, :3]
        # At depth 10 only f^9 of the light is left inside: the rest beyond the limit is below rounding.
        assert np.allclose(got, series, rtol=EXACT), bounces


def test_refraction_bends_by_snell():
    """Through the slab an emitting strip is displaced by Snell's law."""
    eta, thickness, angle = 1.5, 1.0, 0.7
    inside = math.asin(math.sin(angle) / eta)
    glass = Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=eta),))
    glow = Material("glow", lobes=(), emission=(1, 1, 1))
    strip = MeshData("strip", [(-0.01, -9, 0), (0.01, -9, 0), (0.01, 9, 0), (-0.01, 9, 0)], [(0, 1, 2), (0, 2, 3)])
    slab = Instance(kind=3, matrix=scale(100.0, 100.0, thickness / 2))
    eye = (-math.sin(angle), 0.0, thickness / 2 + math.cos(angle))
    reach = thickness * math.tan(inside) + 2.0 * math.tan(angle)

    def seen(offset):
        place = Instance(mesh=0, matrix=move(reach + offset, 0, -thickness / 2 - 2.0), materials=(1,))
        snapshot = tiny_scenes.scene(
            [slab, place],
            [glass, glow],
            meshes=[strip],
            camera=pencil(eye, (0, 0, thickness / 2)),
            integrator=Integrator.CLASSIC,
            max_bounces=2,
        )
        return tiny_scenes.render(snapshot)[0, 0, 0]

    f_in, f_out = (float(reference.fresnel(math.cos(a), n)) for a, n in ((angle, eta), (inside, 1 / eta)))
    assert np.isclose(seen(0.0), (1 - f_in) * (1 - f_out), rtol=1e-5)
    assert seen(0.03) == 0.0 and seen(-0.03) == 0.0


def test_total_internal_reflection():
    """Beyond the critical angle all light is reflected: the emitting floor has its full radiance."""
    glass = Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.5),))
    glow = Material("glow", lobes=(), emission=(1, 1, 1))
    camera = pencil((0, 0, -1.0), (1.5, 0, 0.0))
    snapshot = tiny_scenes.scene(
        [plane(0), plane(1, move(z=-2.0))],
        [glass, glow],
        world=50.0,
        camera=camera,
        integrator=Integrator.CLASSIC,
        max_bounces=3,
    )
    assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :3], 1.0, rtol=EXACT)


TILTED = MeshData(
    "tilted",
    [(-1, -1, 0), (2, -1, 0), (-1, 2, 0)],
    [(0, 1, 2)],
    normals=np.float32([(0.6, 0, 0.8), (0, 0, 1), (0, -0.6, 0.8)]),
)


def shaded(shading, point, light):
    snapshot = tiny_scenes.scene(
        [Instance(shading=shading)],
        [lambert()],
        [light],
        [TILTED],
        camera=pencil((point[0], point[1], 5.0), (*point, 0.0)),
        integrator=Integrator.CLASSIC,
    )
    return tiny_scenes.render(snapshot)[0, 0, 0]


def test_flat_gouraud_and_phong_shading():
    """FLAT: the face's colour at its centre; PHONG: normals interpolated; GOURAUD: illumination at corners, interpolated."""
    source = np.array([0.5, 0.25, 3.0])
    light = lamp(source, 9.0)
    corners, normals = TILTED.positions.astype(float), TILTED.normals.astype(float)

    def lit(p, n):
        way = source - p
        d = np.linalg.norm(way)
        return max(0.0, way @ n / d) * 9 / d**2 / math.pi

    for point in ((0.2, 0.1), (-0.8, -0.9), (0.9, -0.6)):
        v = (point[1] + 1) / 3
        u = (point[0] + 1) / 3
        weights = np.array([1 - u - v, u, v])
        p = np.array([*point, 0.0])
        n = weights @ normals
        want = {
            Shading.FLAT: lit(corners.mean(axis=0), np.array([0, 0, 1.0])),
            Shading.PHONG: lit(p, n / np.linalg.norm(n)),
            Shading.AS_MESH: lit(p, n / np.linalg.norm(n)),
            Shading.GOURAUD: float(weights @ [lit(c, m) for c, m in zip(corners, normals, strict=True)]),
        }
        assert len({round(x, 4) for x in want.values()}) == 3, "the test's point tells them apart"
        for shading, value in want.items():
            assert np.isclose(shaded(shading, point, light), value, rtol=1e-5), (shading, point)


def test_gouraud_under_parallel_rays():
    """Highlights at the corners use the direction of the orthographic rays."""
    source, wo, n = np.array([0.5, 0.25, 3.0]), np.array([0.6, 0.0, 0.8]), 5.0
    mesh = dataclasses.replace(TILTED, normals=np.float32([(0, 0, 1)] * 3))
    shiny = Material("shiny", lobes=(Lobe(LobeKind.PHONG, color=rgb(1.0), shininess=n),))

    def lit(p):
        way = source - p
        d = np.linalg.norm(way)
        return max(0.0, wo @ (way / d * [-1, -1, 1])) ** n * 9 / d**2 / math.pi

    corners = [lit(p) for p in mesh.positions.astype(float)]
    for point in ((0.2, 0.1), (-0.8, -0.9)):
        v, u = (point[1] + 1) / 3, (point[0] + 1) / 3
        place = np.array([*point, 0.0])
        camera = pencil(tuple(place + 5 * wo), tuple(place))
        got = color([Instance(shading=Shading.GOURAUD)], [shiny], [lamp(source, 9.0)], camera=camera, meshes=[mesh])
        assert np.allclose(got, np.array([1 - u - v, u, v]) @ corners, rtol=EXACT + 3e-7 * n), point


def test_a_crowded_recursion_begins_anew_in_small_parts():
    """Glass doubles the rays at every depth. With tiles of 8 x 8 pixels batches stay small; with 32 x 32 the rays exceed the
    capacity and the batch restarts in parts. Both give the same bits and the same number of rays."""
    glass = Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.5),))
    balls = [sphere(0, scale(1.0 - 0.1 * i)) for i in range(6)]
    camera = dataclasses.replace(pencil((0, -3, 0), width=1.6, pixels=32), width=32, height=32)
    snapshot = tiny_scenes.scene(balls, [glass], [lamp()], world=(0.2, 0.4, 0.6), camera=camera)
    found = []
    for tile_size in (8, 32):
        settings = dict(integrator=Integrator.CLASSIC, max_bounces=10, samples=1, tile_size=tile_size)
        with Session.upload(tiny_scenes.with_settings(snapshot, **settings)) as session:
            session.render_all()
            found.append((session.read(0), session.statistics()))
    assert np.array_equal(found[0][0], found[1][0])
    assert found[0][1].bounce_rays == found[1][1].bounce_rays and found[0][1].camera_rays == 32 * 32
    # The capacity was exceeded: more than 8 rays per sample, the limit for 1024 samples.
    assert found[0][1].bounce_rays > 10 * 8 * 32 * 32


def test_normals_view():
    """c = 0.5 n + 0.5; the sky on a miss."""
    snapshot = tiny_scenes.scene(
        [sphere()], [lambert()], world=(0.1, 0.2, 0.3), integrator=Integrator.NORMALS, camera=pencil((0.6, 0, 5), (0.6, 0, 0))
    )
    assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :3], (0.8, 0.5, 0.9), atol=1e-6)
    missed = tiny_scenes.scene(world=(0.1, 0.2, 0.3), integrator=Integrator.NORMALS)
    assert np.allclose(tiny_scenes.render(missed)[0, 0, :3], (0.1, 0.2, 0.3), rtol=1e-7)
    hidden = dataclasses.replace(missed, world=World((0.1, 0.2, 0.3), hidden_from=int(Ray.CAMERA)))
    assert tiny_scenes.render(hidden)[0, 0].tolist() == [0, 0, 0, 1]


def test_one_sample_is_deterministic():
    """With one sample the seed has no effect: the sample uses the centres of pixel, lens and lamp."""
    pictures = [
        tiny_scenes.render(tiny_scenes.showroom(16, integrator=Integrator.CLASSIC, samples=1, seed=seed)).tobytes()
        for seed in (0, 1, 77)
    ]
    assert pictures[0] == pictures[1] == pictures[2]
    many = [
        tiny_scenes.render(tiny_scenes.showroom(16, integrator=Integrator.CLASSIC, samples=2, seed=seed)).tobytes()
        for seed in (0, 1)
    ]
    assert many[0] != many[1]


def cube_world(snapshot):
    """Return the snapshot with the course's cube environment: one colour per side, 1 to 6 in order."""
    sides = tuple(Image(f"side {i}", np.full((1, 1, 3), i + 1, np.float32)) for i in range(6))
    direction = Node(NodeKind.COORDINATE, Coordinate.GENERATED)
    cube = Node(NodeKind.ENVIRONMENT, Environment.CUBE, image_count=6, inputs=(NodeRef(0),))
    return dataclasses.replace(snapshot, images=sides, world=World(NodeRef(1), nodes=(direction, cube)))


@pytest.mark.parametrize("cheap, want", [(False, 0.25), (True, 5.0)])
def test_environment_mapping_looks_past_what_stands_between(cheap, want):
    """A mirror reflects the view to (-0.6, 0, 0.8), side +z, the fifth, or to the emitting ball if rays are traced."""
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=rgb(1.0)),))
    glow = Material("glow", lobes=(), emission=rgb(0.25))
    ball = sphere(1, move(-3.0, 0.0, 4.0) @ scale(0.5))
    snapshot = cube_world(classic([plane(), ball], [mirror, glow], environment_reflections=cheap))
    assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :3], want, rtol=EXACT)
