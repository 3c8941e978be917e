"""The sky: its table in thin air, and the disc of the sun, found behind any rotation and sampled as a light."""

import math

import numpy as np
import pytest
import tiny_scenes
from charts import unit
from significance import LEVEL, chi_square, uniforms
from test_world import DIRECTION, even_directions, scene

from addon.bindings import sky
from addon.bindings.enums import AlphaMode, MathOperation, MixMode, NodeKind, SkyModel
from addon.bindings.session import Scene
from addon.bindings.shading import Image, Node, NodeRef, World

SUN = 400.0  # radiance at the middle of the disc
SKY = 0.5
SHARE = 0.8  # of all suns, at most
UP = unit(np.array([0.3, -0.5, 0.7]))
TURNED = (0.9, 0.3, -0.4)


def even_table(level=SKY):
    return Image("sky", texels=np.full((4, 8, 3), level, np.float32), alpha=AlphaMode.CHANNEL_PACKED)


def sun_node(vector, diameter, direction=UP, light=SUN, lowest=-1.0):
    matrix = (*(light,) * 6, *direction, diameter, lowest, 0.0)
    return Node(NodeKind.SKY, option=SkyModel.MULTIPLE_SCATTERING, inputs=(NodeRef(vector),), matrix=matrix)


def mapped(rotation=TURNED, scale=(1, 1, 1)):
    return Node(NodeKind.MAPPING, inputs=(NodeRef(0), (0, 0, 0), rotation, scale))


def sunny(diameter, mapping=None, **fields):
    """An even sky with a sun."""
    nodes = (DIRECTION, mapping or mapped(), sun_node(1, diameter, **fields))
    return World(radiance=NodeRef(2), nodes=nodes)


def beside(axis, angles, azimuths):
    """Directions at angles from an axis."""
    across = unit(np.cross(axis, (0.31, 0.2, -0.9)))
    up = np.cross(axis, across)
    sides = np.cos(azimuths)[:, None] * across + np.sin(azimuths)[:, None] * up
    return np.cos(angles)[:, None] * axis + np.sin(angles)[:, None] * sides


def middle_of(uploaded, count=40000):
    """The axis of the sun, as the mean of the samples with the largest radiance."""
    samples = uploaded.light(0, [(0, 0, 0)], uniforms(count, 2, 3))
    bright = samples.radiance[:, 0] > 2 * SKY
    assert np.any(bright)
    return unit(samples.wi[bright].astype(float).mean(axis=0)), bright.mean()


@pytest.mark.parametrize("diameter", [0.0005, 0.0095, 0.2, math.pi / 2])
@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1)])
def test_sun_is_sampled(library, diameter, scale):
    """Chi-square of samples in rings about the sun and beside it; density and radiance are those of the sampled direction."""
    count, rings, sectors = 200_000, 5, 4
    strength = SUN * max(1.0, (0.1 / diameter) ** 2)
    world = sunny(diameter, mapped(scale=scale), light=strength)
    with Scene.upload(scene(world, (even_table(),)), library) as uploaded:
        axis, share = middle_of(uploaded)
        # BSDF samples find an even sky as well: the sun gets the largest share. Its cone is 4e-6 wider than it.
        if diameter < 0.5:
            assert share == pytest.approx(SHARE * (1 + 8e-6 / diameter) ** -2, abs=0.01)
        samples = uploaded.light(0, [(0, 0, 0)], uniforms(count, 2, 8))
        told, density = uploaded.world(samples.wi)
        # Rings of equal solid angle over the disc and a little more, which are cells of one density.
        half = diameter / 2
        versines = np.linspace(0, 1 - math.cos(half * 0.99) if half > 0.01 else 0.5 * (half * 0.99) ** 2, rings + 1)
        radii = 2 * np.arcsin(np.sqrt(versines / 2))
        middles = 0.5 * (radii[1:] + radii[:-1])
        azimuths = 2 * np.pi * (np.arange(sectors) + 0.5) / sectors
        where = beside(axis, np.repeat(middles, sectors), np.tile(azimuths, rings))
        pdf = uploaded.world(where)[1].astype(float)
    assert np.all(samples.pdf > 0)
    assert np.array_equal(samples.pdf, density) and np.allclose(samples.radiance, told, rtol=1e-5)
    w = samples.wi.astype(float)
    angle = 2 * np.arcsin(np.clip(np.linalg.norm(w - axis, axis=1) / 2, 0, 1))
    across = unit(np.cross(axis, (0.31, 0.2, -0.9)))
    turn = np.mod(np.arctan2(w @ np.cross(axis, across), w @ across) / (2 * np.pi), 1)
    inside = angle < radii[-1]
    ring = np.searchsorted(radii, angle[inside], side="right") - 1
    counts = np.bincount(ring * sectors + (turn[inside] * sectors).astype(int), minlength=rings * sectors)
    solid = 2 * np.pi * np.diff(versines) / sectors
    expected = count * pdf * np.repeat(solid, sectors)
    # All the rest is one more cell.
    counts, expected = np.append(counts, count - counts.sum()), np.append(expected, count - expected.sum())
    # Axes and edges of float have an error of a few 1e-7, to which the smallest disc's counts are blind in wide rings.
    assert chi_square(counts, expected) > LEVEL


def test_density_is_one_in_all(library):
    with Scene.upload(scene(sunny(0.3), (even_table(),)), library) as uploaded:
        _, pdf = uploaded.world(even_directions(600))
    # 720 000 midpoints, 4000 of them in the disc: its edge is resolved to half a percent.
    assert pdf.mean() * 4 * np.pi == pytest.approx(1.0, abs=0.005)
    assert np.all(pdf > 0)


def test_two_suns_and_none(library):
    """Each sun of a mix takes a share by its light; a sun that the mix hides takes none."""
    other = unit(np.array([-0.6, 0.2, 0.5]))
    nodes = (DIRECTION, sun_node(0, 0.02, light=1000 * SUN), sun_node(0, 0.04, other, 500 * SUN))

    def shares(factor):
        mixed = Node(NodeKind.MIX, option=MixMode.MIX, inputs=(factor, NodeRef(1), NodeRef(2)))
        with Scene.upload(scene(World(radiance=NodeRef(3), nodes=(*nodes, mixed)), (even_table(),)), library) as uploaded:
            w = uploaded.light(0, [(0, 0, 0)], uniforms(20_000, 2, 6)).wi
        return [np.mean(np.linalg.norm(w - axis, axis=1) < 0.03) for axis in (UP, other)]

    first, second = shares((0.5,) * 3)
    # The second has half the radiance in four times the solid angle.
    assert first == pytest.approx(SHARE / 3, abs=0.02) and second == pytest.approx(2 * SHARE / 3, abs=0.02)
    first, second = shares((0.0,) * 3)
    assert first > 0.5 and second < 1e-3


@pytest.mark.parametrize("change", ["stretched", "bent"])
def test_only_a_rotation_keeps_the_disc(library, change):
    """A disc that is no disc in the world is found by the map alone; it is sampled without one density in a cone."""
    bend = Node(NodeKind.MATH, option=MathOperation.MULTIPLY, inputs=(NodeRef(0), NodeRef(0), 0.0))
    nodes = (DIRECTION, mapped(scale=(1, 1, 2)) if change == "stretched" else bend, sun_node(1, 1.2))
    with Scene.upload(scene(World(radiance=NodeRef(2), nodes=nodes), (even_table(),)), library) as uploaded:
        samples = uploaded.light(0, [(0, 0, 0)], uniforms(1000, 2, 5))
    assert np.all(samples.pdf > 0)


@pytest.mark.parametrize("diameter", [0.0005, 0.0095, 1.0])
def test_sun_and_sky_light_a_plane(library, diameter):
    """E of the plane z = 0 against the closed form."""
    half = diameter / 2
    light = SUN * (0.01 / diameter) ** 2
    nodes = (DIRECTION, sun_node(0, diameter, (0, 0, 1), light))
    floor = scene(
        World(radiance=NodeRef(1), nodes=nodes),
        (even_table(),),
        instances=[tiny_scenes.plane()],
        materials=[tiny_scenes.lambert()],
        camera=tiny_scenes.pencil((1, 0, 1), pixels=16),
        samples=256,
    )
    # 2 pi L times the integral of limb(t / half) cos t sin t, and pi times the sky.
    t = (np.arange(10000) + 0.5) / 10000 * half
    limb = 0.4 + 0.6 * np.sqrt(1 - (t / half) ** 2)
    want = SKY + 2 * light * np.mean(limb * np.cos(t) * np.sin(t)) * half
    got = tiny_scenes.render(floor)[..., 0].ravel()
    error = got.std(ddof=1) / math.sqrt(len(got))
    # 4 standard errors, and a thousandth for the sum and single precision.
    assert abs(got.mean() - want) <= 1e-3 * want + 4 * error
    assert error < 0.01 * want


def test_thin_air_scatters_by_its_mass():
    """Without absorption, zenith radiance is the sun's light times phase function, coefficient and mass of the air."""
    xyz, rims = sky.compute(SkyModel.NISHITA, math.radians(60), 0.01, 1.0, (1e-4, 0.0, 0.0))
    empty, plain = sky.compute(SkyModel.NISHITA, math.radians(60), 0.01, 1.0, (0.0, 0.0, 0.0))
    assert not empty.any() and np.allclose(rims, plain, rtol=1e-3)
    mass = 8000 * (1 - math.exp(-7.5))
    phase = 3 / (16 * math.pi) * (1 + math.sin(math.radians(60)) ** 2)
    # The sun's Y times its solid angle is its irradiance.
    irradiance = plain[0, 1] * 2 * math.pi * (1 - math.cos(0.005))
    coefficient = xyz[-1, 0, 1] / (1e-4 * mass * phase * irradiance)
    # 1.158e-5 per metre at 559 nm, the middle of y. It falls as the 4th power over y's spread of 42 nm, whose mean is
    # 1 + 10 (42 / 559)^2 times as much. The next term of this series is 1 %, the solid angle in single precision 0.5 %.
    assert coefficient == pytest.approx(1.158e-5 * 1.056, rel=0.02)
    # Symmetric about the sun, and brighter the longer the way.
    assert np.array_equal(xyz, xyz[:, ::-1]) and np.all(np.diff(xyz[8:64, 0, 1]) < 0)


@pytest.mark.parametrize("model", [SkyModel.NISHITA, SkyModel.SINGLE_SCATTERING, SkyModel.MULTIPLE_SCATTERING])
def test_extremes_are_finite_and_not_negative(model):
    for elevation in (-math.pi / 2, -0.1, 0.0, math.pi / 2):
        for altitude in (0.0, 60000.0, 100000.0):
            for density in (0.0, 10.0):
                xyz, rims = sky.compute(model, elevation, 0.0005, altitude, (density,) * 3)
                assert np.isfinite(xyz).all() and np.isfinite(rims).all()
                assert rims.min() >= 0.0
