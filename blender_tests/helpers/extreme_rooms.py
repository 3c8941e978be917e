"""Small scenes for extreme parameters, and their pictures by both integrators and all kernels."""

import math

import numpy as np
import tiny_scenes
from tiny_scenes import move, rotate_x

from addon.bindings.abi import Features, Integrator, LightKind
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Light, Lobe, Material

WHITE = (1.0, 1.0, 1.0)
BOTH = (Integrator.PATH, Integrator.CLASSIC)
# Rotations from +z to each side of a cube.
TURNS = [rotate_x(math.pi / 2), rotate_x(-math.pi / 2)]
TURNS += [tiny_scenes.rotate_y(-math.pi / 2), tiny_scenes.rotate_y(math.pi / 2), rotate_x(math.pi), np.eye(4)]


def picture(snapshot, **settings):
    """Return RGB of all pixels and the messages; assert that all samples are finite."""
    with Session.upload(tiny_scenes.with_settings(snapshot, **settings)) as session:
        assert session.render_all()
        pixels, statistics, messages = session.read()[..., :3].astype(float), session.statistics(), session.messages()
    assert np.all(np.isfinite(pixels)) and np.all(pixels >= 0.0)
    assert statistics.invalid_samples == 0
    return pixels, messages


def pictures(snapshot):
    """Return the pictures of both integrators; assert that the special and the general kernel agree in every bit."""
    results = []
    for integrator in BOTH:
        special, said = picture(snapshot, integrator=integrator, features=Features.SCENE)
        general, _ = picture(snapshot, integrator=integrator, features=Features.ALL)
        assert np.array_equal(special, general), integrator
        results.append(special)
    return results, said


def room(material, lights, world=0.0, extra=(), materials=(), pixels=8, **settings):
    """Return a scene with a sphere and a tilted square of the material over a grey floor."""
    camera = tiny_scenes.Camera(
        matrix=tiny_scenes.look_at((2, -4, 2.5), (0, 0, 0.7)), width=pixels, height=pixels, window=(-0.35, 0.35, -0.35, 0.35)
    )
    things = [tiny_scenes.plane(0), tiny_scenes.sphere(1, move(z=1)), square(1, move(-1.2, -0.8, 0.6) @ rotate_x(1.1)), *extra]
    settings = {"samples": 16, "max_bounces": 8, **settings}
    return tiny_scenes.scene(
        things, [tiny_scenes.lambert(0.6), material, *materials], lights, [tiny_scenes.quad(1.0)], world, camera, **settings
    )


def square(material, matrix):
    return Instance(mesh=0, matrix=matrix, materials=(material,))


def lamp(kind=LightKind.POINT, emission=1.0, matrix=None, **fields):
    return Light("lamp", move(1, -1, 3) if matrix is None else matrix, kind, emission=(emission,) * 3, **fields)


def one(kind, **fields):
    return Material(kind.name, lobes=(Lobe(kind, color=WHITE, tangent=(1, 0, 0), **fields),))
