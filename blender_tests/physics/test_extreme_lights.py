"""Extreme lights, by strength, size and position: closed forms, equal kernels, correct reported errors."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes
from extreme_rooms import TURNS, lamp, one, pictures, room, square
from tiny_scenes import move, rotate_x, scale

from addon.bindings.abi import AreaShape, LightKind, LobeKind
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Material

LAMPS = {
    "point": lamp(),
    "ball": lamp(radius=0.3, soft_falloff=False),
    "disk": lamp(radius=0.3),
    "spot": lamp(LightKind.SPOT, spot_angle=2.0, radius=0.1),
    "sun": lamp(LightKind.SUN, matrix=rotate_x(0.5), sun_angle=0.1),
    "area": lamp(LightKind.AREA, size=(0.5, 0.5)),
    "narrow area": lamp(LightKind.AREA, size=(2.5, 2.5), spread=0.3, shape=AreaShape.ELLIPSE),
}


@pytest.mark.parametrize("name", [*LAMPS, "mesh", "sphere", "sky"])
def test_emission_is_linear_to_its_ends(library, name):
    """The picture is proportional to the emission from 1e-20 to 1e30, on diffuse and on nearly smooth surfaces."""

    def lit(material, power):
        glow = Material("glow", lobes=(), emission=(power,) * 3)
        if name == "mesh":
            return room(material, [], extra=[square(2, move(1, -1, 3) @ rotate_x(math.pi))], materials=[glow])
        if name == "sphere":
            return room(material, [], extra=[tiny_scenes.sphere(2, move(1, -1, 3) @ scale(0.2))], materials=[glow])
        if name == "sky":
            return room(material, [], world=power)
        return room(material, [dataclasses.replace(LAMPS[name], emission=(power,) * 3)])

    for material in (tiny_scenes.lambert(0.8), tiny_scenes.beckmann(1.0, 3e-5, np.inf), one(LobeKind.GLASS, roughness=0.05)):
        plain, _ = pictures(lit(material, 1.0))
        for power in (1e-20, 1e30):
            for got, want in zip(pictures(lit(material, power))[0], plain, strict=True):
                # Some dozen roundings; Russian roulette is independent of the scale, so every path is the same.
                assert np.allclose(got / power, want, rtol=1e-5, atol=1e-12)
        assert not np.any(pictures(lit(material, 0.0))[0][0])


@pytest.mark.parametrize("radius", [1e-30, 1e-12, 1e-6])
def test_smallest_lamps_are_points(library, radius):
    """A tiny lamp equals a point lamp; a message reports when the disk's radiance exceeds float."""
    for kind, field in ((LightKind.POINT, "radius"), (LightKind.SPOT, "radius"), (LightKind.SUN, "sun_angle")):
        for power in (1.0, 1e30):
            fields = dict(kind=kind, emission=power, spot_angle=2.0, matrix=move(1, -1, 3) @ rotate_x(-0.2))
            point, _ = pictures(room(tiny_scenes.lambert(0.8), [lamp(**fields)]))
            for soft in (True, False):
                tiny, said = pictures(room(tiny_scenes.lambert(0.8), [lamp(**fields, **{field: radius}, soft_falloff=soft)]))
                # Directions to the lamp differ by 1e-6 over its extent, and shadows have an edge of that width.
                for got, want in zip(tiny, point, strict=True):
                    assert np.allclose(got, want, rtol=2e-4), (kind, power, soft)
                if power / (math.pi * (radius if field == "radius" else radius / 2) ** 2) > 1e36:
                    assert any("was replaced by 0" in line for line in said), said


@pytest.mark.parametrize("ratio", [1.0, 0.1, 1e-3])
def test_lamp_touches_the_floor(library, ratio):
    """A ball lamp that touches a plane is entirely visible from it: E = I cos / d^2, near the contact too."""
    radius = 0.5
    ball = lamp(emission=3.0, matrix=move(z=radius), radius=radius, soft_falloff=False)
    x = ratio * radius
    camera = tiny_scenes.pencil((x + 1e3, 0, 1e-2), (x, 0, 0), width=1e-9, pixels=8)
    # The camera's ray passes below the ball.
    snapshot = tiny_scenes.scene([tiny_scenes.plane()], [tiny_scenes.lambert()], [ball], camera=camera, samples=256)
    (path, _), _ = pictures(tiny_scenes.with_settings(snapshot, max_bounces=0))
    d2 = x * x + radius * radius
    want = 3.0 * radius / d2**1.5 / math.pi
    error = path[..., 0].std(ddof=1) / 8
    assert error < 0.01 * want and abs(path[..., 0].mean() - want) <= 4 * error + 1e-4 * want


def test_lamp_within_a_closed_mesh(library):
    """Outside the mesh it is dark; inside, the wall has the geometric series of reflections."""
    import trimesh

    albedo, power = 0.5, 2.0
    shell = tiny_scenes.MeshData.from_trimesh(trimesh.creation.icosphere(subdivisions=3))
    light = lamp(emission=power, matrix=np.eye(4))
    box = [Instance(mesh=0)]
    outside = tiny_scenes.scene(
        box, [tiny_scenes.lambert(albedo)], [light], [shell], camera=tiny_scenes.pencil((0, 0, 3)), samples=64, max_bounces=3
    )
    assert not np.any(pictures(outside)[0])
    hollow = tiny_scenes.scene(
        [tiny_scenes.sphere()],
        [tiny_scenes.lambert(albedo)],
        [light],
        camera=tiny_scenes.pencil((0, 0, 0), (0, 0, -1), pixels=16),
    )
    for bounces in (0, 1, 4):
        (path, _), _ = pictures(tiny_scenes.with_settings(hollow, max_bounces=bounces, samples=64))
        want = power * albedo / math.pi * (1 - albedo ** (bounces + 1)) / (1 - albedo)
        error = path[..., 0].std(ddof=1) / 16
        # The distance to the wall is 1 up to rounding of directions.
        assert error < 1e-2 * want and abs(path[..., 0].mean() - want) <= 4 * error + 1e-5 * want


@pytest.mark.parametrize("others", [0, 6])
def test_dim_lamp_beside_a_blinding_one(library, others):
    """A lamp of 1e-6 W is sampled where a lamp of 1e12 W is below the horizon, with few lamps and with a light tree."""
    watt = 1 / (4 * math.pi**2)
    dim = lamp(emission=1e-6 * watt, matrix=move(z=2))
    blinding = lamp(emission=1e12 * watt, matrix=move(z=-1))
    dark = [lamp(emission=1e12 * watt, matrix=move(0.1 * i, 0, -2)) for i in range(others)]
    floor = [tiny_scenes.plane()], [tiny_scenes.lambert()]
    camera = tiny_scenes.pencil((3, 4, 5), pixels=4)
    (path, classic), _ = pictures(tiny_scenes.scene(*floor, [dim, blinding, *dark], camera=camera, samples=16))
    want = 1e-6 * watt / 4 / math.pi
    # Float roundings of positions and of the product.
    assert np.allclose(path, want, rtol=1e-5) and np.allclose(classic, want, rtol=1e-5)
    above = dataclasses.replace(blinding, matrix=move(z=1))
    (path, classic), _ = pictures(tiny_scenes.scene(*floor, [dim, above, *dark], camera=camera, samples=1024))
    both = want + 1e12 * watt / math.pi
    # At most 1/256 of the choices goes to the dim lamp, in case the other is occluded; these samples miss the other lamp.
    deviation = math.sqrt(1 / 256 / 1024)
    assert np.allclose(path, both, rtol=4 * deviation) and np.allclose(classic, both, rtol=1e-5)
    assert abs(path[..., 0].mean() - both) <= 4 * deviation * both / 4  # of 16 pixels


@pytest.mark.parametrize("others", [0, 6])
def test_dim_lamp_beside_a_hidden_blinding_one(library, others):
    """A lamp of 1e-6 W lights a room, lamps of 1e12 W are in a closed box: the picture and its error are correct.

    One sample of 1024, with many lamps of 4096, chooses the dim lamp and carries all of the light.
    """
    watt = 1 / (4 * math.pi**2)
    dim = lamp(emission=1e-6 * watt, matrix=move(z=2))
    hidden = [lamp(emission=1e12 * watt, matrix=move(3 + 0.05 * i, 0, 1)) for i in range(1 + others)]
    box = [square(0, move(3, 0, 1) @ turn @ move(z=0.5)) for turn in TURNS]
    camera = tiny_scenes.pencil((-3, -4, 5), pixels=16)
    snapshot = tiny_scenes.scene(
        [tiny_scenes.plane(), *box], [tiny_scenes.lambert()], [dim, *hidden], [tiny_scenes.quad(1.2)], camera=camera
    )
    want = 1e-6 * watt / 4 / math.pi
    samples = 4096 if others else 1024
    with Session.upload(tiny_scenes.with_settings(snapshot, samples=samples, max_bounces=0)) as session:
        assert session.render_all()
        got, error = session.read()[..., 0].astype(float), session.error()
    mean, deviation = got.mean(), got.std(ddof=1) / 16
    off = math.sqrt(np.mean((got - want) ** 2)) / (1.01 * want)
    low = error.low
    if not others:
        # Choices are stratified: one in 1026 chooses the dim lamp, so that 1024 samples do once, or in 1 of 500 pixels never,
        # a deviation of sqrt(0.002). The estimate from halves is far larger, since the hit lies in one half.
        deviation, low = max(deviation, 0.0028 * want), 0.0
        assert off < 4 * math.sqrt(0.002), off
    assert deviation < 0.2 * want and abs(mean - want) <= 4 * deviation, (mean, deviation, want)
    # The true relative error of the pixels: from 256 pixels with one hit each it is known to 10 %.
    assert 0.8 * low <= off <= 1.2 * (error.high + error.cannot_exclude), (off, error)
