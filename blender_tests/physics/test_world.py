"""The world: its radiance by direction, the pdf of its sampling, and its light."""

import dataclasses
import math

import blenders
import numpy as np
import pytest
import tiny_scenes
from blenders import MODULE, PROGRAM
from charts import unit
from significance import LEVEL, chi_square, uniforms

from addon.bindings.enums import (
    AlphaMode,
    CameraKind,
    Coordinate,
    Environment,
    Extension,
    Integrator,
    Interpolation,
    LightKind,
    NodeKind,
    Pass,
    Ray,
)
from addon.bindings.session import Scene, Session
from addon.bindings.shading import Image, Material, Node, NodeRef, World
from addon.bindings.snapshot import Camera, Light

DIRECTION = Node(kind=NodeKind.COORDINATE, option=Coordinate.GENERATED)


def picture(texels):
    texels = np.asarray(texels, np.float32)
    return Image("sky", texels=texels.reshape(*texels.shape[:2], -1), alpha=AlphaMode.NONE)


def sky(
    texels, projection=Environment.EQUIRECTANGULAR, interpolation=Interpolation.LINEAR, rotation=(0, 0, 0), count=1, **fields
):
    """Return (world, images) of environment textures."""
    images = tuple(picture(t) for t in (texels if count > 1 else [texels]))
    mapping = Node(kind=NodeKind.MAPPING, inputs=(NodeRef(0), (0, 0, 0), rotation, (1, 1, 1)))
    flags = int(Extension.EXTEND if count > 1 else Extension.REPEAT) | int(interpolation) << 4
    shown = Node(kind=NodeKind.ENVIRONMENT, option=projection, flags=flags, image_count=count, inputs=(NodeRef(1),))
    return World(radiance=NodeRef(2), nodes=(DIRECTION, mapping, shown), **fields), images


def scene(world, images, **fields):
    return dataclasses.replace(tiny_scenes.scene(**fields), world=world, images=images)


def even_directions(count):
    """Return midpoints of cells of equal solid angle."""
    z = 1 - 2 * (np.arange(count) + 0.5) / count
    phi = 2 * np.pi * (np.arange(2 * count) + 0.5) / (2 * count)
    z, phi = (a.ravel() for a in np.meshgrid(z, phi, indexing="ij"))
    r = np.sqrt(1 - z**2)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)


def cells(width):
    """Return centres and solid angles of the cells of a map, width by width / 2 in azimuth and polar angle."""
    height = width // 2
    phi, theta = 2 * np.pi * (np.arange(width) + 0.5) / width - np.pi, np.pi * (np.arange(height) + 0.5) / height
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    theta, phi = (a.ravel() for a in np.meshgrid(theta, phi, indexing="ij"))
    middles = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    return middles, np.repeat((edges[:-1] - edges[1:]) * 2 * np.pi / width, width)


def gradient(width=64, height=32):
    rng = np.random.default_rng(3)
    texels = rng.uniform(0.1, 1.0, (height, width, 3))
    # Bright at both poles and at the seam.
    texels[0], texels[-1], texels[:, 0] = 6.0, 9.0, 4.0
    return texels


def test_texels_stand_where_cycles_puts_them(library):
    """u decreases with the angle around z, 0.5 at +x; v increases upwards; row 0 is the bottom row."""
    texels = gradient(16, 8)
    world, images = sky(texels, interpolation=Interpolation.CLOSEST)
    column, row = (a.ravel() for a in np.meshgrid(np.arange(16), np.arange(8)))
    phi, theta = np.pi * (1 - 2 * (column + 0.5) / 16), np.pi * (1 - (row + 0.5) / 8)
    directions = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    with Scene.upload(scene(world, images), library) as uploaded:
        radiance, pdf = uploaded.world(directions)
    # Texels are float and returned without arithmetic.
    assert np.array_equal(radiance, texels[row, column].astype(np.float32)) and np.all(pdf > 0)


@pytest.mark.parametrize("rotation", [(0, 0, 0), (0.5, -1.0, 2.0)])
@pytest.mark.parametrize("resolution", [0, 12, 200])
def test_density_is_one_in_all_and_nowhere_zero(library, rotation, resolution):
    world, images = sky(gradient(), rotation=rotation, map_resolution=resolution)
    with Scene.upload(scene(world, images), library) as uploaded:
        radiance, pdf = uploaded.world(even_directions(400))
        # By default the map is as wide as the image.
        middles, solid_angle = cells(resolution or 64)
        cell_pdf = uploaded.world(middles)[1]
    assert np.all(pdf > 0)
    # The pdf is constant in each cell; the error is rounding of single precision.
    assert np.sum(cell_pdf * solid_angle) == pytest.approx(1.0, abs=1e-6)
    if resolution != 12:
        # With a map as fine as the image the pdf follows the channels' mean, up to the variation within a cell.
        level = radiance.mean(axis=1) / radiance.mean(axis=1).mean()
        assert np.corrcoef(pdf * 4 * np.pi, level)[0, 1] > 0.8


def test_chi_square(library):
    """Samples against the probe's pdf, in cells of equal solid angle, including poles and seams."""
    rows, columns, fine, count = 20, 12, 30, 200_000
    world, images = sky(gradient(), rotation=(0.3, 0.2, 0.1), map_resolution=24)
    with Scene.upload(scene(world, images), library) as uploaded:
        samples = uploaded.light(0, [(0, 0, 0)], uniforms(count, 2, 4))
        z = 1 - 2 * (np.arange(rows * fine) + 0.5) / (rows * fine)
        phi = 2 * np.pi * (np.arange(columns * fine) + 0.5) / (columns * fine)
        zz, pp = (a.ravel() for a in np.meshgrid(z, phi, indexing="ij"))
        r = np.sqrt(1 - zz**2)
        radiance, pdf = uploaded.world(np.stack([r * np.cos(pp), r * np.sin(pp), zz], axis=1))
        told, density = uploaded.world(samples.wi)
    assert np.all(samples.pdf > 0) and np.all(np.isinf(samples.distance)) and np.all(samples.delta == 0)
    # Radiance and pdf of a sample are those of its direction, except for rounding at the edges of cells.
    assert np.mean(np.isclose(samples.pdf, density, rtol=1e-5)) > 0.999
    assert np.allclose(samples.radiance, told, rtol=1e-4)
    expected = pdf.astype(float).reshape(rows, fine, columns, fine).mean(axis=(1, 3)).ravel() * 4 * np.pi / (rows * columns)
    w = samples.wi
    row = np.minimum(((1 - w[:, 2]) / 2 * rows).astype(int), rows - 1)
    column = np.minimum((np.mod(np.arctan2(w[:, 1], w[:, 0]) / (2 * np.pi), 1) * columns).astype(int), columns - 1)
    counts = np.bincount(row * columns + column, minlength=rows * columns)
    # The error of the midpoint rule is a fraction of a percent, a fifth of the counts' standard error.
    assert chi_square(counts, expected * count / expected.sum()) > LEVEL


def test_tangents_lie_across_the_ray(library):
    """Flag 2 of TANGENT: (1, 1, 1) x n, or (-1, 1, 1) x n along the diagonal, of the normal n against the ray; flag 1: 0."""
    directions = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [3**-0.5] * 3])
    for flag in (1, 2):
        node = Node(kind=NodeKind.TANGENT, option=2, flags=flag)
        with Scene.upload(scene(World(radiance=NodeRef(0), nodes=(node,)), [])) as uploaded:
            shown, _ = uploaded.world(directions)
        n = -directions
        across = np.cross([[1, 1, 1], [1, 1, 1], [-1, 1, 1]], n)
        expected = across / np.linalg.norm(across, axis=1, keepdims=True) if flag == 2 else np.zeros((3, 3))
        # Some roundings to float of numbers below 1.
        assert np.allclose(shown, expected, atol=4 * 2.0**-24)


def test_cube_sides(library):
    """Six colours, +x -x +y -y +z -z, each seen along its axis."""
    colors = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1)], np.float32)
    world, images = sky([np.full((4, 4, 3), c) for c in colors], Environment.CUBE, count=6)
    axes = np.concatenate([np.eye(3), -np.eye(3)])[[0, 3, 1, 4, 2, 5]]
    with Scene.upload(scene(world, images), library) as uploaded:
        radiance, pdf = uploaded.world(axes)
        aside, _ = uploaded.world([unit(axes[0] * 1.1 + axes[2]), unit(axes[5] * 1.1 - axes[2])])
    assert np.array_equal(radiance, colors) and np.all(pdf > 0)
    assert np.array_equal(aside, colors[[0, 5]])


TURNED = (0.9, 0.3, -0.4)


# A texel at the image's pole is a needle, which a rotated map resolves only by chance.
@pytest.mark.parametrize("hot, rotation", [((5, 3), TURNED), ((16, 0), TURNED), ((0, 0), (0, 0, 0)), ((31, 63), (0, 0, 0))])
def test_one_bright_texel_lights_a_plane(library, hot, rotation):
    """E on a plane under a sun of one texel, against a sum over all directions."""
    texels = np.full((32, 64, 1), 0.05)
    texels[hot] = 3000.0
    world, images = sky(texels, rotation=rotation)
    floor = scene(
        world,
        images,
        instances=[tiny_scenes.plane()],
        materials=[tiny_scenes.lambert()],
        camera=tiny_scenes.pencil((1, 0, 1), pixels=16),
        samples=256,
    )
    # Equal steps of both angles, 16 per texel, also at the poles.
    theta, phi = np.pi * (np.arange(512) + 0.5) / 512, 2 * np.pi * (np.arange(1024) + 0.5) / 1024
    theta, phi = (a.ravel() for a in np.meshgrid(theta, phi, indexing="ij"))
    directions = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    with Scene.upload(floor, library) as uploaded:
        radiance, _ = uploaded.world(directions)
    want = np.mean(radiance[:, 0] * np.maximum(directions[:, 2], 0) * np.sin(theta)) * 2 * np.pi
    picture_of_it = tiny_scenes.render(floor)[..., 0].ravel()
    error = picture_of_it.std(ddof=1) / math.sqrt(len(picture_of_it))
    # The sum's error is at most 1 % with that many midpoints on the texel; plus 4 standard errors of the picture.
    assert abs(picture_of_it.mean() - want) <= 0.01 * want + 4 * error
    assert error < 0.02 * want


def test_hidden_world(library):
    """A world hidden from the camera still lights diffuse surfaces; hidden from diffuse rays it does not."""
    floor = dict(instances=[tiny_scenes.plane()], materials=[tiny_scenes.lambert()], samples=64)
    for varying in (False, True):
        for hidden, seen, lit in ((0, 0.5, 0.5), (Ray.CAMERA, 0.0, 0.5), (Ray.DIFFUSE, 0.5, 0.0)):
            world, images = sky(np.full((4, 8, 1), 0.5), hidden_from=int(hidden))
            if not varying:
                world, images = World(radiance=(0.5, 0.5, 0.5), hidden_from=int(hidden)), ()
            down = scene(world, images, camera=tiny_scenes.pencil((1, 0, 1), pixels=8), **floor)
            up = scene(world, images, camera=tiny_scenes.pencil((1, 0, 1), (1, 0, 2)), **floor)
            # 64 pixels of 64 samples each: below 1 % of noise where it is sampled as a light.
            assert np.allclose(tiny_scenes.radiance(down), lit, rtol=0.01), (varying, hidden)
            assert np.allclose(tiny_scenes.radiance(up), seen, rtol=1e-6), (varying, hidden)


@pytest.mark.parametrize("integrator", [Integrator.PATH, Integrator.CLASSIC])
def test_a_backdrop_takes_no_samples_from_lamps(library, integrator):
    """A world visible only to the camera changes neither the bits nor the number of rays of surfaces."""
    lights = [Light("lamp", tiny_scenes.move(2, -1, 3), LightKind.POINT, emission=(20, 20, 20), radius=0.3)]
    camera = tiny_scenes.pencil((1, 0, 1), pixels=8)
    floor = dict(instances=[tiny_scenes.plane()], materials=[tiny_scenes.lambert()], lights=lights, samples=4, camera=camera)
    world, images = sky(np.full((4, 8, 1), 0.5), hidden_from=int(Ray.DIFFUSE | Ray.GLOSSY | Ray.TRANSMISSION))
    found = []
    for snapshot in (scene(world, images, integrator=integrator, **floor), scene(World(), (), integrator=integrator, **floor)):
        with Session.upload(snapshot) as session:
            session.render_all()
            found.append((session.read(Pass.COMBINED), session.statistics().shadow_rays))
    assert np.array_equal(found[0][0], found[1][0]) and found[0][0][..., :3].min() > 0.0
    assert found[0][1] == found[1][1] > 0
    # Without other lights it is not sampled either.
    alone = scene(world, images, integrator=integrator, **{**floor, "lights": []})
    assert tiny_scenes.render(alone)[..., :3].max() == 0.0


@pytest.mark.parametrize("integrator", Integrator)
def test_a_world_that_asks_for_the_window(library, integrator):
    """Cycles 5.0.1: window coordinates of a camera ray are its position in the picture."""
    world = World(radiance=NodeRef(0), nodes=(Node(kind=NodeKind.COORDINATE, option=Coordinate.WINDOW),))
    middles = (np.arange(4) + 0.5) / 4
    x, y = np.meshgrid(middles, middles)
    for kind in (CameraKind.PERSPECTIVE, CameraKind.ORTHOGRAPHIC, CameraKind.EQUIRECTANGULAR):
        camera = Camera(
            matrix=tiny_scenes.look_at((1, -6, 3), (0, 0, 0.5)),
            kind=kind,
            panorama=(-1.2, 1.2, -2.0, 2.0, 0, 0, 0, 0),
            width=4,
            height=4,
            window=(0, 1, 0, 1) if kind == CameraKind.EQUIRECTANGULAR else (-1, 1, -1, 1),
        )
        got = tiny_scenes.render(scene(world, (), camera=camera, integrator=integrator, samples=1))
        # One sample of PATH lies anywhere in its pixel, that of other integrators at the centre; directions round at 1e-7.
        apart = 0.125 if integrator == Integrator.PATH else 2e-6
        assert np.allclose(got[..., 0], x, rtol=0, atol=apart + 1e-6) and np.allclose(got[..., 1], y, rtol=0, atol=apart + 1e-6)


# Red and green of Cycles 5.0.1 at the pixel's centre for a mirror on the ground: with an orthographic camera the reflected
# direction is used as a point in world space.
@pytest.mark.parametrize("integrator", [Integrator.PATH, Integrator.CLASSIC])
@pytest.mark.parametrize(
    "kind, seen", [(CameraKind.PERSPECTIVE, (0.338729, 1.646432)), (CameraKind.ORTHOGRAPHIC, (0.5, 0.620373))]
)
def test_a_mirror_asks_the_window_of_its_ray(library, integrator, kind, seen):
    world = World(radiance=NodeRef(0), nodes=(Node(kind=NodeKind.COORDINATE, option=Coordinate.WINDOW),))
    mirror = Material("mirror", lobes=(tiny_scenes.Lobe(tiny_scenes.LobeKind.MIRROR, color=(1, 1, 1)),))
    # Half of the window's width: 36 mm / 50 mm / 2 for the perspective, 1 for the orthographic camera.
    half = 0.36 if kind == CameraKind.PERSPECTIVE else 1.0
    camera = Camera(
        matrix=tiny_scenes.look_at((1, -6, 3), (0, 0, 0.5)), kind=kind, width=4000, height=4000, window=(-half, half) * 2,
        x=1500, y=2500, region_width=1, region_height=1,
    )  # fmt: skip
    snapshot = scene(
        world, (), instances=[tiny_scenes.plane()], materials=[mirror], camera=camera, integrator=integrator, max_bounces=1
    )
    # The pixel extends 1/8000 to each side, Cycles' sample was 1.3e-4 from its centre; the reflected position changes less than
    # twice as fast.
    assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :2], seen, rtol=0, atol=2 * (1 / 8000 + 1.3e-4))


def test_a_texture_shines_as_it_looks(library):
    """A square emitter whose texture darkens one half, against an emitter of the bright half."""
    texels = np.zeros((1, 2, 1), np.float32)
    texels[0, 1] = 4.0
    shown = Node(
        kind=NodeKind.IMAGE,
        flags=int(Extension.EXTEND) | int(Interpolation.CLOSEST) << 4,
        image_count=1,
        inputs=(NodeRef(0),),
    )
    nodes = (Node(kind=NodeKind.COORDINATE, option=Coordinate.UV), shown)
    textured = Material("textured", lobes=(), emission=NodeRef(1), nodes=nodes)
    plain = Material("plain", lobes=(), emission=(4, 4, 4))
    facing = tiny_scenes.move(z=2) @ tiny_scenes.rotate_x(np.pi)
    levels = []
    for material, mesh in ((textured, _square(0.0)), (plain, _square(0.5))):
        lamp = tiny_scenes.Instance(mesh=0, matrix=facing, materials=(1,))
        snapshot = scene(
            World(),
            (picture(texels),),
            instances=[tiny_scenes.plane(), lamp],
            materials=[tiny_scenes.lambert(), material],
            meshes=[mesh],
            samples=256,
            camera=tiny_scenes.pencil((3, 4, 1), pixels=32),
        )
        levels.append(tiny_scenes.radiance(snapshot)[0])
    # 1024 stratified estimates of 256 samples each.
    assert np.isclose(levels[0], levels[1], rtol=5e-3)


def _square(start):
    """Return the part u >= start of the unit square, with texture coordinates."""
    corners = [(start, 0), (1, 0), (1, 1), (start, 1)]
    return tiny_scenes.MeshData(
        "square",
        [(x - 0.5, y - 0.5, 0) for x, y in corners],
        [(0, 1, 2), (0, 2, 3)],
        uvs=[[corners[i] for i in face] for face in ((0, 1, 2), (0, 2, 3))],
    )


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_export(which, tmp_path):
    got = blenders.run(which, tmp_path, "world_cases", "export")
    assert got["none"] == [0.0, 0.0, 0.0]
    assert np.allclose(got["constant"], np.array([0.2, 0.4, 0.6]) * 2.5)
    assert np.allclose(got["mixed"], 0.75 * np.array([1, 0, 0]) + 0.25 * np.array([0, 0, 2]))
    assert got["hidden"] == [1 + 32, 2]
    assert got["resolution"] == [0, 512]
    assert got["equirectangular"] == [3, 0, 1] and got["mirror ball"] == [3, 1, 1]
    assert got["cube"] == [3, 2, 6] and got["cube images"] == [
        f"cube_{sign}_{axis}" for axis in "xyz" for sign in ("positive", "negative")
    ]
    assert got["cube without a picture"] == 1
    assert got["messages"] == []


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_a_sky_without_its_picture_is_still_sampled(which, tmp_path):
    """Such a sky is magenta but no constant: Cycles samples a textured sky as a light, also past objects without shadows."""
    got = blenders.run(which, tmp_path, "world_cases", "missing")
    for name in ("none", "lost"):
        varies, pictures, messages = got[name]
        assert varies and pictures == 0 and len(messages) == 1 and "magenta is used" in messages[0], name
    assert any("Sampling None is not supported" in line for line in got["unsampled"][2])


def test_a_sky_without_its_picture_is_magenta(library):
    world = World(radiance=NodeRef(1), nodes=(DIRECTION, Node(kind=NodeKind.ENVIRONMENT, inputs=(NodeRef(0),))))
    with Scene.upload(scene(world, ()), library) as uploaded:
        radiance, pdf = uploaded.world(even_directions(4))
    # All directions are equal; a cell's area is a difference of two cosines, which is inaccurate near a pole.
    assert np.array_equal(radiance, np.tile(np.float32((1.0, 0.0, 1.0)), (32, 1))) and np.allclose(pdf, 0.25 / np.pi, rtol=1e-3)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_a_cube_of_sequences_shows_the_frame_or_the_file(which, tmp_path):
    got = blenders.run(which, tmp_path, "world_cases", "sequence")
    # 0.1, 0.2 ... of 255.
    assert got["red"] == [26, 51, 77, 102, 128, 255]
    assert got["messages"] == []
