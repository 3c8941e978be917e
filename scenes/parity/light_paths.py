"""Limits of light: bounces by kind and of lamps, clamped direct light, caustics, and blurred gloss."""

import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import shader, world
from .stages import ball, camera, floor, lamp, sky


def room(scene, *materials):
    """Balls of the materials between two matt walls under a large lamp: light of many bounces."""
    floor(scene)
    wall = shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.5, 0.4))
    for x in (-1.9, 1.9):
        parts.place(scene, "Wall", parts.plane_mesh("Wall", 4.0), wall, (x, 0, 1.5), rotation=(0, 1.5708, 0))
    for index, material in enumerate(materials):
        thing = ball(scene, material, segments=48, radius=0.6, location=(1.5 * index - 0.75, 0.2, 0.6))
        thing.name = f"Ball {index}"
    lamp(scene, 120.0, (0, -2.5, 3.5))
    sky(scene, strength=0.4)
    camera(scene, (0, -4.5, 1.8), (0, 0, 0.8))


def _matt():
    return shader("ShaderNodeBsdfDiffuse", Color=(0.3, 0.5, 0.75))


def glossy(roughness=0.3):
    return shader("ShaderNodeBsdfGlossy", Color=(0.8, 0.8, 0.8), Roughness=roughness)


def glass(roughness=0.2):
    return shader("ShaderNodeBsdfGlass", Color=(0.9, 1.0, 0.9), Roughness=roughness, IOR=1.45)


@variants(
    "LOBES",
    values={
        "diffuse_0": (("diffuse_bounces", 0), {"limited": {"diffuse_bounces": 0}}),
        "diffuse_1": (("diffuse_bounces", 1), {"limited": {"diffuse_bounces": 1}}),
        "glossy_0": (("glossy_bounces", 0), {"limited": {"glossy_bounces": 0}, "quick": True}),
        "glossy_1": (("glossy_bounces", 1), {"limited": {"glossy_bounces": 1}}),
        "transmission_0": (("transmission_bounces", 0), {"limited": {"transmission_bounces": 0}}),
        "transmission_2": (("transmission_bounces", 2), {"limited": {"transmission_bounces": 2}}),
    },
    bounces=4,
)
def bounces_by_kind(scene, _limit):
    room(scene, glossy(), glass())


@case("LOBES", bounces=4, limited={"diffuse_bounces": 2, "glossy_bounces": 1, "transmission_bounces": 1})
def bounces_of_all_kinds(scene):
    """With a transparent veil, which a path that has ended passes."""
    mixed = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.3, 0.5, 0.75), Roughness=0.3, Alpha=0.5)
    room(scene, mixed, glass(0.05))


@variants(values={"0": 0, "1": 1}, bounces=3)
def lamp_bounces(scene, limit):
    """A lamp that lights the first surfaces of paths alone; rays that run into it find it at any bounce."""
    room(scene, _matt())
    scene.objects["Lamp"].data.cycles.max_bounces = limit


def _dim_sky(scene):
    """A sky that is sampled as a light, which an even one is not."""
    world(scene, lambda nodes: nodes.add("ShaderNodeBackground", Color=nodes.add("ShaderNodeTexGradient"), Strength=1.5))
    scene.world.cycles.max_bounces = 0


@case(bounces=3, since=(4, 0), limited={"use_light_tree": True})
def sky_bounces(scene):
    """The light that is lost depends on the choice among lamps, which is that of Cycles' tree."""
    room(scene, _matt())
    _dim_sky(scene)


@case(bounces=3)
def sky_bounces_alone(scene):
    room(scene, _matt())
    bpy.data.objects.remove(scene.objects["Lamp"])
    _dim_sky(scene)


@variants(
    values={"low": (0.3, {"limited": {"sample_clamp_direct": 0.3}}), "high": (2.0, {"limited": {"sample_clamp_direct": 2.0}})},
    bounces=0,
)
def clamp_direct(scene, _limit):
    """A small lamp near a floor: contributions are clamped one by one, so the choice among several would show."""
    floor(scene)
    parts.add_light(scene, "Light", "POINT", 60.0, (0.5, -0.2, 0.8), shadow_soft_size=0.2)
    sky(scene, strength=1.0)
    camera(scene)


@variants(
    "LOBES",
    values={
        "reflective": ("reflective", {"limited": {"caustics_reflective": False}}),
        "refractive": ("refractive", {"limited": {"caustics_refractive": False}}),
        "both": ("both", {"limited": {"caustics_reflective": False, "caustics_refractive": False}}),
    },
    bounces=3,
)
def caustics_off(scene, _which):
    """Principled, metallic and glass balls before matt walls: their light on the walls is left out, their own look stays."""
    plastic = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.6, 0.3, 0.2), Roughness=0.25, Metallic=0.3)
    room(scene, plastic, glass())


@variants(
    "LOBES",
    values={"1": (1.0, {"limited": {"blur_glossy": 1.0}}), "10": (10.0, {"limited": {"blur_glossy": 10.0}})},
    bounces=3,
)
def filter_glossy(scene, _value):
    room(scene, glossy(0.05), glass(0.0))
