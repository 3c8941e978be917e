"""Chi-square test of each light's sampler against its pdf, and consistency of sample and pdf."""

import numpy as np
import pytest
import tiny_scenes
from charts import Sphere, histogram, unit
from significance import LEVEL, chi_square, sidak, uniforms
from tiny_scenes import move, rotate_x, rotate_y, scale

from addon.bindings.abi import AreaShape, LancerError, LightKind
from addon.bindings.session import Scene
from addon.bindings.snapshot import Instance, Light, Material, MeshData

COUNT = 100000
TENT = MeshData(
    "tent",
    [(-1, -1, 0), (0, -1, 0.4), (1, -1, 0), (-1, 1, 0), (0, 1, 0.4), (1, 1, 0)],
    [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)],
)


def area(shape, size=(1.0, 0.6), matrix=None, **fields):
    matrix = move(0.3, 0.2, 2.0) @ rotate_y(0.5) @ rotate_x(0.2) if matrix is None else matrix
    return Light("lamp", matrix, LightKind.AREA, emission=(1, 1, 1), size=size, shape=shape, **fields)


def sheared(xy=0.8, xz=0.3, yz=-0.4):
    shear = np.eye(4)
    shear[0, 1], shear[0, 2], shear[1, 2] = xy, xz, yz
    return move(0.3, 0.2, 2.0) @ rotate_y(0.5) @ rotate_x(0.2) @ shear


LIGHTS = {
    "ball": Light("lamp", move(1, 0, 2), emission=(1, 1, 1), radius=0.5, soft_falloff=False),
    "small ball": Light("lamp", move(1, 0, 2), emission=(1, 1, 1), radius=1e-3, soft_falloff=False),
    "near ball": Light("lamp", move(0, 0, 1.001), emission=(1, 1, 1), radius=1.0, soft_falloff=False),
    "disk": Light("lamp", move(1, 0, 2), emission=(1, 1, 1), radius=0.5),
    "spot disk": Light("lamp", move(0.2, 0, 2), LightKind.SPOT, emission=(1, 1, 1), radius=0.3, spot_angle=1.5),
    "sun": Light("lamp", rotate_x(0.3), LightKind.SUN, emission=(1, 1, 1), sun_angle=0.3),
    "small sun": Light("lamp", rotate_x(0.3), LightKind.SUN, emission=(1, 1, 1), sun_angle=0.0093),
    "flat sun": Light("lamp", rotate_x(0.3), LightKind.SUN, emission=(1, 1, 1), sun_angle=1.5, sun_flat=True),
    "rectangle": area(AreaShape.RECTANGLE),
    "large rectangle": area(AreaShape.RECTANGLE, (30.0, 20.0)),
    "small rectangle": area(AreaShape.RECTANGLE, (1e-3, 2e-3)),
    "ellipse": area(AreaShape.ELLIPSE),
    "spread": area(AreaShape.RECTANGLE, spread=1.2),
    # A spread so narrow that only a part of the lamp lights the origin.
    "narrow rectangle": area(AreaShape.RECTANGLE, (3.0, 2.0), matrix=move(0.3, 0.2, 2.0), spread=0.5),
    "narrow ellipse": area(AreaShape.ELLIPSE, (1.6, 2.0), matrix=move(0.3, 0.2, 2.0), spread=0.5),
    "stretched spot": Light("lamp", move(0.2, 0, 2), LightKind.SPOT, emission=(1, 1, 1), radius=0.3, size=(1.5, 0.6)),
    "sheared rectangle": area(AreaShape.RECTANGLE, matrix=sheared()),
    "large sheared rectangle": area(AreaShape.RECTANGLE, (30.0, 20.0), matrix=sheared(-0.8)),
    "small sheared rectangle": area(AreaShape.RECTANGLE, (1e-3, 2e-3), matrix=sheared()),
    "narrow sheared rectangle": area(AreaShape.RECTANGLE, (3.0, 2.0), matrix=sheared(0.8, -0.6, 0.2), spread=0.9),
    "sheared ellipse": area(AreaShape.ELLIPSE, matrix=sheared()),
    "narrow sheared ellipse": area(AreaShape.ELLIPSE, (3.0, 2.0), matrix=sheared(0.8, -0.6, 0.2), spread=0.9),
    "sheared spot": Light("lamp", sheared(), LightKind.SPOT, emission=(1, 1, 1), radius=0.3, spot_angle=2.4, size=(1.5, 0.6)),
}


# Height over the origin: near faces are sampled by solid angle, far ones by area.
MESHES = {"mesh": 2.0, "sheared mesh": 2.0, "near mesh": 0.4, "far mesh": 30.0}


def upload(library, name):
    """Upload a scene with one light."""
    if name in MESHES:
        shear = np.eye(4)
        shear[0, 1] = 0.7 if "sheared" in name else 0.0
        matrix = move(0.2, 0, MESHES[name]) @ rotate_x(np.pi) @ shear @ scale(0.8, 0.5, 0.6)
        lamp = Instance(mesh=0, matrix=matrix)
        glow = Material("glow", lobes=(), emission=(1, 1, 1))
        return Scene.upload(tiny_scenes.scene([lamp], [glow], meshes=[TENT]), library)
    return Scene.upload(tiny_scenes.scene(lights=[LIGHTS[name]]), library)


NAMES = [*LIGHTS, *MESHES]


@pytest.mark.parametrize("name", NAMES)
def test_sample_agrees_with_pdf(library, name):
    with upload(library, name) as scene:
        samples = scene.light(0, [(0, 0, 0)], uniforms(5000, 2, 1))
        good = (samples.pdf > 0) & (samples.delta == 0)
        assert good.mean() > 0.5
        assert np.allclose(np.linalg.norm(samples.wi, axis=1)[good], 1.0, rtol=0, atol=1e-6)
        assert np.all(samples.distance[good] > 0)
        pdf = scene.light_pdf(0, [(0, 0, 0)], samples.wi[good])
        # Rounding may move a direction across the rim: at most one in a thousand here.
        same = np.isclose(pdf, samples.pdf[good], rtol=1e-4)
        assert same.mean() > 0.999, (samples[good][~same][:3], pdf[~same][:3])


@pytest.mark.parametrize("name", NAMES)
def test_chi_square(library, name):
    """A histogram over a cap around the light, against the midpoint rule with 32 x 32 points per cell."""
    cells, fine = 10, 32
    with upload(library, name) as scene:
        samples = scene.light(0, [(0, 0, 0)], uniforms(COUNT, 2, 2))
        good = samples.pdf > 0
        w = samples.wi[good]
        axis = unit(w.mean(axis=0))
        # 1 - cos from the chord, since tiny lights subtend less than the rounding of a cosine.
        away = 0.5 * np.sum((w - axis) ** 2, axis=1).max()
        chart = Cap(axis, 1.02 * away)
        counts, outside = histogram(chart, w, cells)
        assert outside == 0
        u = (np.arange(cells * fine) + 0.5) / (cells * fine)
        u = np.stack([a.ravel() for a in np.meshgrid(u, u, indexing="ij")], axis=1)
        directions, solid_angle = chart.direct(u)
        density = scene.light_pdf(0, [(0, 0, 0)], directions).astype(float) * solid_angle
    expected = density.reshape(cells, fine, cells, fine).mean(axis=(1, 3)) / cells**2
    # The midpoint rule locates the rim to 1/fine^1.5 of a cell, 0.5 %: the total is correct to a few 1e-3.
    assert abs(expected.sum() - good.mean()) < 5e-3
    # The error of cells on the rim, 0.5 %, is less than a quarter of their standard error with COUNT samples.
    p = chi_square(counts, expected * len(w) / expected.sum())
    assert p > sidak(LEVEL, len(NAMES)), (name, p)


class Cap(Sphere):
    """Directions within 1 - cos < depth of an axis; stable for depths far below the rounding of a cosine."""

    def __init__(self, axis, depth):
        super().__init__(axis, 1.0 - depth)
        self.depth = depth

    def direct(self, u):
        x = self.depth * u[:, 0]
        r = np.sqrt(x * (2.0 - x))
        w = np.stack([r * np.cos(2 * np.pi * u[:, 1]), r * np.sin(2 * np.pi * u[:, 1]), 1.0 - x], axis=1) @ self.frame
        return w, np.full(len(u), 2 * np.pi * self.depth)

    def back(self, w):
        local = w @ self.frame.T
        u0 = 0.5 * np.sum((local - [0, 0, 1]) ** 2, axis=1) / self.depth
        u = np.stack([u0, np.mod(np.arctan2(local[:, 1], local[:, 0]) / (2 * np.pi), 1.0)], axis=1)
        return np.where(u0[:, None] > 1.0, np.nan, u)


@pytest.mark.parametrize("name", ["point", "spot", "sun"])
def test_points_and_parallel_light_are_single_directions(library, name):
    kind = LightKind[name.upper()]
    light = Light("lamp", move(z=4), kind, emission=(8, 8, 8), spot_angle=2.0, spot_blend=0.0)
    with Scene.upload(tiny_scenes.scene(lights=[light]), library) as scene:
        samples = scene.light(0, [(0, 0, 0)], uniforms(100, 2, 3))
        assert np.all(samples.delta == 1) and np.all(samples.pdf == 1)
        assert np.allclose(samples.wi, (0, 0, 1), atol=1e-12)
        # Intensity / distance^2, exact powers of two here.
        assert np.all(samples.radiance == (8.0 if name == "sun" else 0.5))
        assert np.all(np.isinf(samples.distance) if name == "sun" else np.abs(samples.distance - 4) < 1e-12)
        assert np.all(scene.light_pdf(0, [(0, 0, 0)], samples.wi) == 0)


def test_lights_are_numbered_as_added_then_emitters(library):
    glow = Material("glow", lobes=(), emission=(5, 5, 5))
    dark = tiny_scenes.lambert()
    instances = [Instance(mesh=0, matrix=move(z=9), materials=(1,)), Instance(mesh=0, matrix=move(z=3) @ rotate_x(np.pi))]
    snapshot = tiny_scenes.scene(
        instances, [glow, dark], [Light("lamp", move(z=7), emission=(49, 49, 49))], [tiny_scenes.quad()], world=(2, 2, 2)
    )
    with Scene.upload(snapshot, library) as scene:
        lamp, mesh = (scene.light(i, [(0, 0, 0)], [(0.5, 0.5)])[0] for i in range(2))
        with pytest.raises(LancerError, match="light 2 >= 2 lights"):
            scene.light(2, [(0, 0, 0)], [(0.5, 0.5)])
    assert lamp.delta == 1 and abs(lamp.radiance[0] - 1) < 1e-6
    assert mesh.radiance[0] == 5 and abs(mesh.distance * mesh.wi[2] - 3) < 1e-6
