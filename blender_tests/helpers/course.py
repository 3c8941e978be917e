"""Single pixels of the course's ray tracer: eye, lamp and sky of its tests."""

import tiny_scenes
from tiny_scenes import move, pencil, plane, rgb

from addon.bindings.abi import Integrator, LightKind
from addon.bindings.snapshot import Light, Lobe, Material

# One sample through the centre of pixel and lens has no noise: the error is that of a dozen float32 products, 6e-8 each.
EXACT = 2e-6
EYE = (3.0, 0.0, 4.0)  # v = (0.6, 0, 0.8) at the origin
LAMP = (-1.0, 2.0, 2.0)  # l = (-1, 2, 2)/3, distance 3


def lamp(position=LAMP, intensity=(9.0, 18.0, 27.0), **fields):
    return Light("lamp", move(*position), LightKind.POINT, emission=rgb(intensity), **fields)


def classic(instances, materials, lights=(), camera=None, **settings):
    settings = {"integrator": Integrator.CLASSIC, "samples": 1, "max_bounces": 10, **settings}
    return tiny_scenes.scene(instances, materials, lights, camera=camera or pencil(EYE), **settings)


def color(*arguments, **fields):
    return tiny_scenes.render(classic(*arguments, **fields))[0, 0, :3]


def mirrored_sky(material, **settings):
    snapshot = tiny_scenes.scene(
        [plane()],
        [material],
        world=(1, 2, 3),
        camera=pencil(EYE),
        integrator=Integrator.CLASSIC,
        samples=1,
        **{"max_bounces": 10, **settings},
    )
    return tiny_scenes.render(snapshot)[0, 0, :3]


def specular(kind, shininess):
    return Material("shiny", lobes=(Lobe(color=rgb(0.25)), Lobe(kind, color=(0.5, 0.25, 1.0), shininess=shininess)))
