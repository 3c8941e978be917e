"""Light units against closed forms, by probes and by pictures of a Lambert plane of albedo 1."""

import math

import blenders
import numpy as np
import pytest
import reference
import tiny_scenes
from blenders import MODULE, PROGRAM
from significance import midpoints
from tiny_scenes import move, rotate_x, rotate_y

from addon.bindings.abi import AreaShape, LightKind
from addon.bindings.session import Scene
from addon.bindings.snapshot import Light

# The contract with the artist: exact light units to 1e-4.
LIMIT = 1e-4
# The midpoint rule on 256 x 256 points integrates these gentle integrands to 1e-5 and better.
GRID = midpoints(256, 256)


def irradiance(light, point=(0, 0, 0), normal=(0, 0, 1), library=None):
    """Return E at a point with a normal, by the light's sampler."""
    with Scene.upload(tiny_scenes.scene([], [], [light]), library) as scene:
        samples = scene.light(0, [point], GRID)
    cosine = np.maximum(0.0, samples.wi @ np.asarray(normal, float))
    valid = samples.pdf > 0
    value = samples.radiance[:, 0].astype(float) * cosine / np.where(valid, samples.pdf, 1.0)
    return np.where(valid, value, 0.0).mean()


def quadrature(light_points, normals, areas, radiance):
    """Return E at the origin (normal +z) from a surface of constant radiance, given by many small parts."""
    d2 = np.sum(light_points**2, axis=1)
    w = light_points / np.sqrt(d2)[:, None]
    return np.sum(radiance * np.maximum(0, w[:, 2]) * np.maximum(0, -np.sum(w * normals, axis=1)) / d2 * areas)


def point(**fields):
    fields.setdefault("matrix", move(z=2))
    return Light("lamp", kind=LightKind.POINT, emission=(3, 2, 1), **fields)


def area(z=2.0, **fields):
    return Light("lamp", matrix=move(z=z), kind=LightKind.AREA, emission=(3, 3, 3), **fields)


def disk_on_axis(diameter, distance):
    """Return E / L below the centre of a disk that faces down."""
    r = diameter / 2
    return math.pi * r * r / (distance * distance + r * r)


def spread_factor(spread):
    """Return the factor that keeps the flux: pi over the integral of (1 - tan/tan(s/2)) cos over the cone."""
    half = spread / 2
    return math.tan(half) / (math.tan(half) - half)


def spread_on_axis(diameter, distance, spread):
    """Return E / L below the centre of a disk with emission 1 - tan/tan(s/2), by an integral over rings."""
    limit = min(diameter / 2, distance * math.tan(spread / 2))
    r = (np.arange(200000) + 0.5) / 200000 * limit
    cosine2 = distance**2 / (distance**2 + r**2)
    fade = 1 - r / distance / math.tan(spread / 2)
    return spread_factor(spread) * np.sum(fade * cosine2**2 / distance**2 * 2 * math.pi * r) * limit / 200000


# light, E of the red channel at the origin with normal +z
CLOSED_FORMS = {
    "point": (point(), 3 / 4),
    "point aside": (point(matrix=move(1.5, 0, 2)), 3 / 6.25 * 2 / 2.5),
    "point behind": (point(matrix=move(z=-1)), 0.0),
    "disk facing": (point(radius=1.0), 3 / (4 + 1)),
    "disk facing aside": (point(matrix=move(3, 0, 4), radius=1.0), 3 / (25 + 1) * 0.8),
    "ball": (point(radius=1.0, soft_falloff=False), 3 / 4),
    "small ball": (point(radius=1e-4, soft_falloff=False), 3 / 4),
    "ball aside": (point(matrix=move(3, 0, 4), radius=1.0, soft_falloff=False), 3 / 25 * 0.8),
    "far ball": (point(matrix=move(z=1e5), radius=1e-2, soft_falloff=False), 3e-10),
    "sun": (Light("sun", kind=LightKind.SUN, emission=(3, 3, 3)), 3.0),
    "sun with a disk": (Light("sun", kind=LightKind.SUN, emission=(3, 3, 3), sun_angle=0.2), 3.0),
    "small sun": (Light("sun", kind=LightKind.SUN, emission=(3, 3, 3), sun_angle=1e-4), 3.0),
    "flat sun": (Light("sun", kind=LightKind.SUN, emission=(3, 3, 3), sun_angle=1.5, sun_flat=True), 3.0),
    "slanting sun": (Light("sun", rotate_x(1.0), LightKind.SUN, emission=(3, 3, 3), sun_angle=0.1), 3 * math.cos(1.0)),
    "square": (area(), 3 * float(reference.rectangle_irradiance(1, 1, 2))),
    "rectangle": (area(size=(3, 0.5)), 3 * float(reference.rectangle_irradiance(3, 0.5, 2))),
    "large square": (area(size=(20, 20)), 3 * float(reference.rectangle_irradiance(20, 20, 2))),
    "tiny square": (area(size=(1e-3, 1e-3)), 3 * 1e-6 / 4),
    "square seen from behind": (area(z=-2.0), 0.0),
    "disk": (area(size=(1, 1), shape=AreaShape.ELLIPSE), 3 * disk_on_axis(1, 2)),
    "large disk": (area(size=(9, 9), shape=AreaShape.ELLIPSE), 3 * disk_on_axis(9, 2)),
    "far ellipse": (area(z=1e4, size=(2, 1), shape=AreaShape.ELLIPSE), 3 * math.pi / 2 * 1e-8),
    "spread disk": (area(z=10, size=(1, 1), shape=AreaShape.ELLIPSE, spread=1.0), 3 * spread_on_axis(1, 10, 1.0)),
    "spread large disk": (area(size=(9, 9), shape=AreaShape.ELLIPSE, spread=1.0), 3 * spread_on_axis(9, 2, 1.0)),
}


def test_spread_is_blenders():
    """As measured in Blender 4.5: one radian multiplies E by 11.714 for a square of 0.1 m, 10 m away."""
    side = 0.1
    fade = 1 - side * (math.sqrt(2) + math.asinh(1)) / 6 / 10 / math.tan(0.5)
    assert abs(spread_factor(1.0) * fade - 11.714) < 5e-3


# Only pictures use multiple importance sampling, which a lamp over the whole sky requires.
HUGE = {"huge square": (area(size=(2000, 2000)), 3 * float(reference.rectangle_irradiance(2000, 2000, 2)))}


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_probe(library, name):
    light, want = CLOSED_FORMS[name]
    # The emission of a spread has a kink at its rim, which limits the midpoint rule.
    limit = 1e-3 if name == "spread large disk" else LIMIT
    assert np.isclose(irradiance(light, library=library), want, rtol=limit, atol=0.0), name


@pytest.mark.parametrize("name", {**CLOSED_FORMS, **HUGE})
def test_picture(library, name):
    """A Lambert plane of albedo 1 has radiance E/pi without bounces."""
    light, want = {**CLOSED_FORMS, **HUGE}[name]
    # 32 x 32 pixels see the same point, each with its own stratified samples: 1024 estimates of one number.
    pixels = 1 if light.radius == 0 and light.sun_angle == 0 and light.kind != LightKind.AREA else 32
    eye = (30.0, 40.0, 0.5 if "huge" in name or "large" in name else 5.0)
    snapshot = tiny_scenes.scene(
        [tiny_scenes.plane()], [tiny_scenes.lambert()], [light], camera=tiny_scenes.pencil(eye, pixels=pixels), samples=256
    )
    picture = tiny_scenes.render(snapshot)[..., :3].reshape(-1, 3)
    got = picture.mean(axis=0)
    error = picture[:, 0].std(ddof=1) / math.sqrt(len(picture)) if len(picture) > 1 else 0.0
    ratio = np.array(light.emission) / light.emission[0]
    # LIMIT plus 4 standard errors; lamps that fill much of the sky are noisier, within a bound.
    assert error <= (2e-3 if "huge" in name or "large" in name else 1e-4) * want
    assert np.all(np.abs(got - want / math.pi * ratio) <= (LIMIT * want / math.pi + 4 * error) * ratio), got / want * math.pi
    # The three channels have the same noise.
    assert np.allclose(got / ratio, got[0], rtol=1e-6)


def grid_of_rectangle(width, height, count=400):
    x, y = ((np.arange(count) + 0.5) / count - 0.5) * width, ((np.arange(count) + 0.5) / count - 0.5) * height
    return np.stack([a.ravel() for a in np.meshgrid(x, y)], axis=1), width * height / count**2


@pytest.mark.parametrize("shape", AreaShape)
@pytest.mark.parametrize("position", [(0, 0, 3), (2, 1, 3), (5, 0, 0.8), (40, -30, 20)])
def test_area_lights_off_axis_against_quadrature(library, shape, position):
    matrix = move(*position) @ rotate_y(0.4) @ rotate_x(-0.3)
    size = (1.5, 0.8)
    light = Light("lamp", matrix=matrix, kind=LightKind.AREA, emission=(2, 2, 2), size=size, shape=shape)
    xy, piece = grid_of_rectangle(*size)
    if shape == AreaShape.ELLIPSE:
        xy = xy[(2 * xy[:, 0] / size[0]) ** 2 + (2 * xy[:, 1] / size[1]) ** 2 <= 1]
        piece = math.pi / 4 * size[0] * size[1] / len(xy)
    points = np.concatenate([xy, np.zeros((len(xy), 1)), np.ones((len(xy), 1))], axis=1) @ matrix[:3].T
    want = quadrature(points, -matrix[:3, 2], piece, 2.0)
    assert np.isclose(irradiance(light, library=library), want, rtol=LIMIT)


# Columns of unit length that are not orthogonal.
SHEARED = np.array([[1.0, 0.6, 0.48, 0.0], [0.0, 0.8, -0.36, 0.0], [0.0, 0.0, 0.8, 0.0], [0.0, 0.0, 0.0, 1.0]])


@pytest.mark.parametrize("mirror", [1.0, -1.0])
@pytest.mark.parametrize("shape", AreaShape)
@pytest.mark.parametrize("position", [(0, 0, 3), (2, 1, 3), (0.2, 0.1, 0.4), (40, -30, 20)])
def test_sheared_area_lights_against_quadrature(library, shape, position, mirror):
    """The columns x and y are the sides; light leaves along the normal of their plane, to the side of -z."""
    matrix = move(*position) @ rotate_y(0.4) @ rotate_x(-0.3) @ SHEARED @ np.diag([mirror, 1.0, 1.0, 1.0])
    size = (1.5, 0.8)
    light = Light("lamp", matrix=matrix, kind=LightKind.AREA, emission=(2, 2, 2), size=size, shape=shape)
    xy, _ = grid_of_rectangle(*size)
    area_ = size[0] * size[1]
    if shape == AreaShape.ELLIPSE:
        xy = xy[(2 * xy[:, 0] / size[0]) ** 2 + (2 * xy[:, 1] / size[1]) ** 2 <= 1]
        area_ *= math.pi / 4
    normal = np.cross(matrix[:3, 0], matrix[:3, 1])
    piece = area_ * np.linalg.norm(normal) / len(xy)
    normal *= np.sign(normal @ matrix[:3, 2]) / np.linalg.norm(normal)
    points = np.concatenate([xy, np.zeros((len(xy), 1)), np.ones((len(xy), 1))], axis=1) @ matrix[:3].T
    want = quadrature(points, -normal, piece, 2.0)
    # One of the grid's 256 columns straddles the two triangles of a parallelogram and is off by half of what their cosines
    # differ by: up to 1 close by, a tenth further away.
    limit = (1.0 if position[2] < 1 else 0.1) / 512 + LIMIT
    assert np.isclose(irradiance(light, library=library), want, rtol=limit)


def test_only_the_front_of_an_area_light_shines(library):
    light = area(z=-1.0)
    assert irradiance(light, normal=(0, 0, -1), library=library) == 0.0
    assert irradiance(light, point=(0, 0, -2), library=library) > 0.0


@pytest.mark.parametrize("blend", [0.0, 0.15, 1.0])
def test_spot_cone_and_blend(library, blend):
    """The intensity is that of a point lamp, not renormalised; the rim is a smooth step of width (1 - cos(half)) blend."""
    half, height = 0.5, 2.0
    light = Light("spot", move(z=height), LightKind.SPOT, emission=(3, 3, 3), spot_angle=2 * half, spot_blend=blend)
    with Scene.upload(tiny_scenes.scene([], [], [light]), library) as scene:
        angles = np.array([0.0, 0.1, 0.3, 0.4, 0.45, 0.49, 0.51, 0.6, 1.5, 3.0])
        points = np.stack([np.sin(angles), 0 * angles, height - np.cos(angles)], axis=1)
        samples = scene.light(0, points, [[0.5, 0.5]])
    edge = (1 - math.cos(half)) * blend
    for angle, got in zip(angles, np.where(samples.pdf > 0, samples.radiance[:, 0], 0), strict=True):
        over = math.cos(angle) - math.cos(half)
        want = 3 * (float(over > 0) if edge == 0 else reference.smoothstep(over / edge))
        # The cosine is good to 1e-7, the edge is 1e-2 wide and the step's slope 1.5.
        assert abs(got - want) <= 1e-4 * 3, (angle, got, want)


def test_stretched_spot(library):
    """A non-uniform scale stretches the cone of a spot: twice as wide, half as high."""
    half, height = 0.5, 2.0
    fields = dict(spot_angle=2 * half, spot_blend=0.3)
    round_spot = Light("spot", move(z=height), LightKind.SPOT, emission=(3, 3, 3), **fields)
    stretched = Light("spot", move(z=height), LightKind.SPOT, emission=(3, 3, 3), size=(2.0, 0.5), **fields)
    below = np.stack([a.ravel() for a in np.meshgrid(np.linspace(-2, 2, 21), np.linspace(-2, 2, 21))], axis=1)

    def intensity(light, xy):
        points = np.concatenate([xy, np.zeros((len(xy), 1))], axis=1)
        with Scene.upload(tiny_scenes.scene([], [], [light]), library) as scene:
            samples = scene.light(0, points, [[0.5, 0.5]])
        return np.where(samples.pdf > 0, samples.radiance[:, 0], 0) * (np.sum(xy**2, axis=1) + height**2)

    got, want = intensity(stretched, below), intensity(round_spot, below / [2.0, 0.5])
    # One rounding to float on each side of a step whose slope is 1.5 over a rim of 1/30.
    assert np.allclose(got, want, rtol=0, atol=1e-4) and np.any(got > 0) and np.any(got == 0)


def test_sheared_spot(library):
    """A direction is inside the cone if it is in the space of the lamp's columns."""
    fields = dict(emission=(3, 3, 3), spot_angle=1.0, spot_blend=0.3)
    size = np.array([1.5, 0.6, 1.0])
    place = move(0.2, -0.1, 2) @ rotate_y(0.3) @ SHEARED
    sheared = Light("spot", place, LightKind.SPOT, size=tuple(size[:2]), **fields)
    round_spot = Light("spot", np.eye(4), LightKind.SPOT, **fields)
    xy = np.stack([a.ravel() for a in np.meshgrid(np.linspace(-3, 3, 31), np.linspace(-3, 3, 31))], axis=1)
    points = np.concatenate([xy, np.zeros((len(xy), 1))], axis=1)
    local = (points - place[:3, 3]) @ np.linalg.inv(place[:3, :3] * size).T

    def intensity(light, points):
        with Scene.upload(tiny_scenes.scene([], [], [light]), library) as scene:
            samples = scene.light(0, points, [[0.5, 0.5]])
        from_lamp = points - light.matrix[:3, 3]
        return np.where(samples.pdf > 0, samples.radiance[:, 0], 0) * np.sum(from_lamp**2, axis=1)

    got, want = intensity(sheared, points), intensity(round_spot, local)
    # As above.
    assert np.allclose(got, want, rtol=0, atol=1e-4) and np.mean(got > 0) > 0.05 and np.any(got == 0)


def test_spot_of_old_blenders(library):
    """Before 4.0 the intensity is also multiplied by the cosine of the angle to the axis."""
    light = Light("spot", move(z=2), LightKind.SPOT, emission=(3, 3, 3), spot_angle=2.5, spot_blend=0.0, spot_cosine=True)
    for angle in (0.0, 0.5, 1.0):
        point = (2 * math.tan(angle), 0, 0)
        want = 3 * math.cos(angle) * (math.cos(angle) / 2) ** 2 * math.cos(angle)
        assert np.isclose(irradiance(light, point, library=library), want, rtol=LIMIT)


def test_spot_angles_of_half_and_full_turns(library):
    for full in (math.radians(1), math.pi):
        light = Light("spot", move(z=2), LightKind.SPOT, emission=(3, 3, 3), spot_angle=full, spot_blend=0.0)
        assert np.isclose(irradiance(light, library=library), 0.75, rtol=LIMIT)


def test_constant_environment(library):
    """E = pi L on an open plane: a plane of albedo 1 shows L, and so does the sky itself."""
    snapshot = tiny_scenes.scene(
        [tiny_scenes.plane()],
        [tiny_scenes.lambert()],
        [],
        world=(0.7, 0.5, 0.2),
        samples=256,
        camera=tiny_scenes.pencil((1, 0, 1), pixels=16),
    )
    assert np.allclose(tiny_scenes.radiance(snapshot), (0.7, 0.5, 0.2), rtol=LIMIT)
    empty = tiny_scenes.scene(world=(0.7, 0.5, 0.2))
    # One rounding to float32 each way.
    assert np.allclose(tiny_scenes.radiance(empty), (0.7, 0.5, 0.2), rtol=2e-7)


def test_mesh_light_equals_area_light(library):
    """An emitting square mesh gives the light of a rectangular lamp of the same radiance."""
    glow = tiny_scenes.Material("glow", lobes=(), emission=(3, 3, 3))
    lamp = tiny_scenes.Instance(mesh=0, matrix=move(z=2) @ rotate_x(np.pi), materials=(1,))
    snapshot = tiny_scenes.scene(
        [tiny_scenes.plane(), lamp],
        [tiny_scenes.lambert(), glow],
        [],
        [tiny_scenes.quad(1.0)],
        samples=256,
        camera=tiny_scenes.pencil((3, 4, 1), pixels=32),
    )
    want = 3 * float(reference.rectangle_irradiance(1, 1, 2)) / math.pi
    assert np.allclose(tiny_scenes.radiance(snapshot), want, rtol=2 * LIMIT)


def test_exact_sphere_as_lamp(library):
    """An emitting exact sphere: E = pi L r^2/d^2."""
    glow = tiny_scenes.Material("glow", lobes=(), emission=(3, 3, 3))
    snapshot = tiny_scenes.scene(
        [tiny_scenes.plane(), tiny_scenes.sphere(1, move(z=3))],
        [tiny_scenes.lambert(), glow],
        samples=1024,
        camera=tiny_scenes.pencil((3, 4, 1), pixels=32),
    )
    got = tiny_scenes.radiance(snapshot)
    # BSDF sampling alone hits the sphere with p = 1/9 of 1e6 samples: 4 standard errors are 1.1 %.
    limit = 4 * math.sqrt(8 / 1024**2)
    assert np.allclose(got, 3 / 9, rtol=limit)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_export(which, tmp_path):
    """Export of ray visibility, shadows, stretch, portals, nodes and messages of lamps; units are compared with Cycles."""
    got = blenders.run(which, tmp_path, "light_cases", "export")
    new = got["version"] >= [4, 0]
    assert got["plain"] == {"hidden_from": 1, "no_shadow": False, "size": [1.0, 1.0]}
    assert got["seen"]["hidden_from"] == 4 + 32 and got["unshadowed"]["no_shadow"]
    assert np.allclose(got["stretched"]["size"], (3.0, 0.5) if new else (1.0, 1.0))
    portal = got["portal"]
    assert portal["opening"] and portal["emission"] == [0.0, 0.0, 0.0]
    assert ["round portal" in line for line in got["round portal"]] == [True]
    assert np.allclose(got["nodes"], np.array((0.5, 0.25, 1.0)) * 3.0)
    assert got["messages"] == []


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_export_under_transforms(which, tmp_path):
    """A flattened lamp lights like Cycles' lamps, measured in 3.4.1, 4.2, 4.5, 5.0.1 and 5.2.3; a message names shears."""
    got = blenders.run(which, tmp_path, "light_cases", "transforms")
    new = got["version"] >= [4, 0]
    dark = {"SPOT flat z", "SUN flat z", "DISK flat z", "AREA flat x", "AREA flat y"}
    dark |= {"SPOT flat x", "SPOT flat y", "BALL flat x", "BALL flat y", "AREA flat z"} if new else {"BALL flat z"}
    told = {"AREA flat x": "area is zero", "AREA flat y": "area is zero", "AREA sheared": "true shape"}
    told |= {"SPOT sheared": "all of it", "BALL sheared": "all of it"} if new else {"AREA flat z": "rays meet it"}
    told |= {"BALL flat z": "to all sides"} if new else {}
    told |= {"DISK flat z": "arbitrary direction"} if got["version"] >= [5, 0] else {}
    for name, (matrix, share, messages) in got["lamps"].items():
        assert (matrix is None) == (name in dark), name
        word = told.get(name, "gives no light" if name in dark else None)
        assert len(messages) == (word is not None) and (word is None or word in messages[0]), (name, messages)
        # The sides (1, 0) and (0.75, 1) span the area 1; Blender's numbers are of single precision.
        if name == "AREA sheared":
            assert np.allclose(matrix, [[1, 0.6, 0.2**0.5], [0, 0.8, 0], [0, 0, 0.8**0.5]])
        if name in ("SPOT flat x", "SPOT flat y", "AREA flat z", "SPOT sheared") and not new:
            assert np.allclose(np.transpose(matrix) @ matrix, np.eye(3), atol=1e-6), name
        if name not in dark:
            assert np.isclose(share, 1.0, rtol=1e-6), (name, share)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_lights_that_are_not_known_keep_their_power(which, tmp_path):
    share, messages = blenders.run(which, tmp_path, "light_cases", "unknown")
    assert share == 1.0 and len(messages) == 1 and "white is used" in messages[0]


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_the_nodes_of_a_light_reach_the_tracer(which, tmp_path):
    got = blenders.run(which, tmp_path, "light_cases", "textured")
    node, kinds, messages = got["TexImage"]
    assert node == len(kinds) - 1 and messages == []
    assert got["RGB"] == [-1, [], []]
