"""Images in the texture cache of Blender 5.2: the level that a ray reads, from what its pixel sees there.

Each picture shows the fourth power of random texels, whose mean tells how many of them a level has averaged.
"""

import os

import bpy
import numpy as np

from .. import parts
from . import image_files, images
from .catalogue import case, variants
from .nodes import material, shader, world
from .stages import add_uv, ball, camera, displace, sky

_NEW = (5, 2)


def _texels(side=512, seed=1, channels=4):
    pixels = np.ones((side, side, channels))
    pixels[..., :3] = np.random.default_rng(seed).uniform(0.0, 1.0, (side, side, 1))
    return pixels


def _file(name="Cached", pixels=None, colorspace="Non-Color"):
    return images.from_file(name, _texels() if pixels is None else pixels, colorspace)


def _cache(scene):
    scene.render.use_texture_cache = scene.render.use_auto_generate_texture_cache = True


def _glow(nodes, value):
    """Shines by the fourth power of a value."""
    power = nodes.add("ShaderNodeMath", value, 4.0, props={"operation": "POWER"})
    return nodes.add("ShaderNodeEmission", Strength=power)


def _picture(nodes, image, vector=None, **props):
    node = nodes.add("ShaderNodeTexImage", props={"image": image, **props})
    if vector is not None:
        nodes.link(vector, node.inputs["Vector"])
    return node


def _field(scene, surface, size=40.0, repeats=8.0):
    """A plane to the horizon."""
    _cache(scene)
    thing = parts.place(scene, "Field", parts.plane_mesh("Field", size), surface)
    add_uv(thing.data, repeats)
    scene.world = None
    camera(scene, (0, -6, 1.5), (0, 0, 0.5))
    return thing


@variants(values={"linear": "Linear", "closest": "Closest", "cubic": "Cubic"}, since=_NEW, bounces=0)
def image_cached(scene, interpolation):
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, _file(), interpolation=interpolation).outputs["Color"])))
