"""Furnaces with known radiance: 1/(1 - a), each depth by itself, Russian roulette, the white sky."""

import numpy as np
import pytest
import tiny_scenes
from significance import LEVEL, mean_and_error, z_test
from tiny_scenes import furnace, move, rotate_x, scale, sphere

from addon.bindings.abi import LobeKind
from addon.bindings.snapshot import Instance, Lobe, Material

# Pixels that all see the same point are independent estimates of one number.
PIXELS = 32


def pixels_of(snapshot):
    """Return the red radiance of all pixels."""
    return tiny_scenes.render(snapshot)[..., 0].ravel()


def many(snapshot, **settings):
    import dataclasses

    camera = dataclasses.replace(snapshot.camera, width=PIXELS, height=PIXELS, region_width=PIXELS, region_height=PIXELS)
    return tiny_scenes.with_settings(dataclasses.replace(snapshot, camera=camera), **settings)


def assert_mean(values, expected, largest_error=None):
    mean, error = mean_and_error(values)
    # The sum of float32 radiances over a path rounds at 1e-7 per vertex, which limits the z-test.
    p = z_test(mean, np.hypot(error, 2e-6 * abs(expected)), expected)
    assert p > LEVEL, f"mean {mean} +- {error}, expected {expected}, p {p}"
    if largest_error is not None:
        assert error <= largest_error, "the test has become blind"


@pytest.mark.parametrize("depth", range(11))
@pytest.mark.parametrize("albedo", [0.5, 0.9])
def test_each_depth(library, albedo, depth):
    """Emission (1 - a) and at most depth + 1 scatterings: the radiance is 1 - a^(depth + 2)."""
    values = pixels_of(many(furnace(albedo, 1.0 - albedo, max_bounces=depth), samples=64))
    assert_mean(values, 1.0 - albedo ** (depth + 2), largest_error=3e-3)


@pytest.mark.parametrize("albedo", [0.0, 0.3, 0.8])
def test_closed_form(library, albedo):
    """Emission 1, all depths: 1/(1 - a). 0.8^200 of energy is beyond the limit of depth: 4e-20."""
    values = pixels_of(many(furnace(albedo, 1.0, max_bounces=200), samples=256))
    assert_mean(values, 1.0 / (1.0 - albedo), largest_error=2e-2)


def test_russian_roulette_is_unbiased(library):
    """The mean of deep paths is the closed form, and Russian roulette keeps their length far below the depth limit."""
    albedo = 0.9
    snapshot = many(furnace(albedo, 1.0 - albedo, max_bounces=500), samples=256)
    with tiny_scenes.Session.upload(snapshot) as session:
        session.render_all()
        values = session.read()[..., 0].astype(float).ravel()
        statistics = session.statistics()
    assert_mean(values, 1.0, largest_error=3e-3)
    # Without roulette each sample would trace all 500 vertices.
    assert statistics.bounce_rays < 100 * statistics.samples


@pytest.mark.parametrize("kind", ["cube", "mesh sphere"])
def test_furnaces_made_of_triangles(library, kind):
    """Furnaces of meshes with corners: no light leaks in or out of a closed room."""
    import meshes

    shape = meshes.primitives()["box" if kind == "cube" else "bumpy"]
    albedo = 0.7
    material = tiny_scenes.lambert(albedo, emission=(0.3, 0.3, 0.3))
    snapshot = tiny_scenes.scene(
        [Instance(matrix=scale(3.0))],
        [material],
        meshes=[meshes.data(shape)],
        world=(1000, 1000, 1000),
        camera=tiny_scenes.pencil((0, 0, 0), (0.3, 0.2, -1)),
    )
    # 0.7^60 = 5e-10 of the energy is beyond the depth limit; a single leak to the bright sky would be seen.
    assert_mean(pixels_of(many(snapshot, samples=64, max_bounces=60)), 1.0, largest_error=5e-3)


WHITE = {
    "lambert": (Lobe(LobeKind.LAMBERT, color=(1, 1, 1)),),
    "mirror": (Lobe(LobeKind.MIRROR, color=(1, 1, 1)),),
    "glass": (Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.5),),
    "thin glass": (Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.0000001),),
    "dense glass": (Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=4.0),),
}


@pytest.mark.parametrize("name", WHITE)
@pytest.mark.parametrize("shape", ["sphere", "cylinder", "cone"])
def test_white_things_vanish_in_a_white_sky(library, name, shape):
    """A body of albedo 1 is invisible in a white sky."""
    kind = {"sphere": 1, "cylinder": 3, "cone": 4}[shape]
    snapshot = tiny_scenes.scene(
        [Instance(kind=kind)],
        [Material(name, lobes=WHITE[name])],
        world=1.0,
        samples=16,
        max_bounces=400,
        camera=tiny_scenes.Camera(
            matrix=tiny_scenes.look_at((3, 2, 2), (0, 0, 0)), width=16, height=16, window=(-0.4, 0.4, -0.4, 0.4)
        ),
    )
    values = pixels_of(snapshot)
    # Convex bodies: every path carries exactly 1 up to float32 rounding; glass loses the light inside at the depth limit.
    # Multiple importance sampling leaves noise for Lambert only: test it by its error.
    if name == "lambert":
        assert_mean(values, 1.0, largest_error=5e-3)
    else:
        assert np.allclose(values, 1.0, rtol=1e-4), (values.min(), values.max())


@pytest.mark.parametrize(
    "name, lobe",
    {
        "beckmann": Lobe(LobeKind.BECKMANN, color=(1, 1, 1), roughness=0.4, ior=np.inf),
        "phong": Lobe(LobeKind.PHONG, color=(1, 1, 1), shininess=20.0),
        "blinn": Lobe(LobeKind.BLINN_PHONG, color=(1, 1, 1), shininess=20.0),
    }.items(),
)
def test_no_lobe_makes_light(library, name, lobe):
    """In a white sky a plane of one lobe is at most white and not black, from normal to grazing views.

    Phong's lobes lose the part below the horizon, most of it at a grazing view.
    """
    for height in (5.0, 1.0, 0.2):
        snapshot = tiny_scenes.scene(
            [tiny_scenes.plane()],
            [Material(name, lobes=(lobe,))],
            world=1.0,
            camera=tiny_scenes.pencil((1, 0, height)),
        )
        mean, error = mean_and_error(pixels_of(many(snapshot, samples=64)))
        assert 0.05 < mean <= 1.0 + 4 * error + 1e-5, (height, mean, error)


def test_opacity_lets_the_rest_pass(library):
    """A black veil of opacity 0.25 before a white sky shows 0.75 of it; alpha is 1 since the sky is opaque."""
    veil = tiny_scenes.veiled(Material("veil", lobes=()), 0.25)
    snapshot = tiny_scenes.scene([tiny_scenes.plane()], [veil], world=1.0, camera=tiny_scenes.pencil((0, 0, 1)))
    values = pixels_of(many(snapshot, samples=64))
    mean, error = mean_and_error(values)
    assert abs(mean - 0.75) <= 4 * error + 1e-6 and error < 5e-3


def test_film_transparent(library):
    """With a transparent film the environment has alpha 0 and no colour; solid surfaces have alpha 1."""
    for transparent, alpha in ((False, 1.0), (True, 0.0)):
        sky = tiny_scenes.render(tiny_scenes.scene(world=(1, 2, 3), film_transparent=transparent))[0, 0]
        assert sky.tolist() == ([0, 0, 0, 0] if transparent else [1, 2, 3, 1]) and sky[3] == alpha
        solid = tiny_scenes.scene(
            [sphere()],
            [tiny_scenes.lambert(0.5)],
            world=1.0,
            film_transparent=transparent,
            camera=tiny_scenes.pencil((0, 0, 3)),
        )
        pixel = tiny_scenes.render(tiny_scenes.with_settings(solid, samples=16))[0, 0]
        assert pixel[3] == 1.0 and pixel[0] > 0.1


@pytest.mark.parametrize("size", [1e-6, 1e9])
def test_the_same_room_at_any_size(library, size):
    """A scene of two planes scaled by 1e-6 and 1e9 gives the same picture."""

    def room(s):
        glow = Material("glow", lobes=(), emission=(1, 1, 1))
        items = [
            tiny_scenes.plane(0),
            tiny_scenes.plane(1, move(z=2 * s) @ rotate_x(np.pi)),
            sphere(1, move(z=s) @ scale(0.3 * s)),
        ]
        camera = tiny_scenes.pencil((2.0 * s, 0, s), (s, 0.1 * s, 2 * s), 1e-6 * s)
        return many(tiny_scenes.scene(items, [glow, tiny_scenes.lambert(0.6)], camera=camera), samples=16, max_bounces=4)

    one, other = pixels_of(room(1.0)), pixels_of(room(size))
    # Equal random numbers and geometry: only rays that graze an edge may differ by rounding.
    assert np.mean(np.isclose(one, other, rtol=1e-5)) > 0.99
    assert abs(one.mean() - other.mean()) < 1e-3
