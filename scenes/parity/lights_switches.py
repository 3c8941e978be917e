"""Effects of a lamp's settings and nodes, and of glowing meshes."""

import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import Nodes, shader
from .stages import ball, camera, floor, floor_and_block, sky

_KINDS = {"point": "POINT", "spot": "SPOT", "sun": "SUN", "area": "AREA"}


def _light(scene, kind, **fields):
    energy = 3.0 if kind == "SUN" else 200.0
    if kind == "SUN":
        fields.setdefault("angle", 0.3)
    elif kind == "AREA":
        fields.setdefault("size", 0.8)
    else:
        fields.setdefault("shadow_soft_size", 0.3)
    if kind == "SPOT":
        fields.setdefault("spot_size", 1.2)
    return parts.add_light(scene, "Light", kind, fields.pop("energy", energy), (1.2, -0.8, 2.5), **fields)


def with_light_field(name):
    def needs():
        return "" if name in bpy.types.Light.bl_rna.properties else f"lamps have no {name} in this Blender"

    return needs


@variants(values=_KINDS, bounces=0, needs=with_light_field("normalize"))
def normalize_off(scene, kind):
    floor_and_block(scene)
    # The power is per square metre instead of total.
    _light(scene, kind, normalize=False, energy={"SUN": 50.0}.get(kind, 40.0))


@case(bounces=0, needs=with_light_field("normalize"))
def normalize_off_point_without_size(scene):
    floor_and_block(scene)
    _light(scene, "POINT", normalize=False, shadow_soft_size=0.0, energy=10.0)


@case(bounces=0, needs=with_light_field("exposure"))
def exposure(scene):
    floor_and_block(scene)
    _light(scene, "AREA", exposure=-1.5)


@variants(values={"warm": (2700.0, {"quick": True}), "cold": 9000.0}, bounces=0, needs=with_light_field("temperature"))
def temperature(scene, kelvin):
    floor_and_block(scene)
    _light(scene, "AREA", use_temperature=True, temperature=kelvin, color=(1.0, 0.8, 0.9))


@variants(values=_KINDS, bounces=0)
def light_nodes(scene, kind):
    floor_and_block(scene)
    emission_nodes(_light(scene, kind).data, lambda nodes: {"Color": (0.3, 0.9, 0.5), "Strength": 2.5})


@case(bounces=0)
def light_nodes_computed(scene):
    floor_and_block(scene)

    def inputs(nodes):
        warm = nodes.add("ShaderNodeRGB")
        warm.outputs[0].default_value = (1.0, 0.6, 0.3, 1.0)
        return {"Color": warm, "Strength": nodes.add("ShaderNodeMath", 0.7, 2.0, props={"operation": "MULTIPLY"})}

    emission_nodes(_light(scene, "AREA").data, inputs)


def emission_nodes(light, inputs):
    if bpy.app.version < (5, 2):
        light.use_nodes = True
    nodes = Nodes(parts.enable_nodes(light))
    emission = nodes.add("ShaderNodeEmission", **inputs(nodes))
    nodes.link(emission, nodes.add("ShaderNodeOutputLight").inputs["Surface"])


def _cast_no_shadow(light):
    if bpy.app.version >= (4, 2):
        light.use_shadow = False
    else:
        light.cycles.cast_shadow = False


@variants(values=_KINDS, bounces=0)
def shadow_off(scene, kind):
    floor_and_block(scene)
    _cast_no_shadow(_light(scene, kind).data)


@variants(values={"camera": "camera", "diffuse": "diffuse", "glossy": "glossy", "transmission": "transmission"})
def light_invisible_to(scene, ray):
    """A lamp seen directly, in a mirror, through glass and by a matt floor, and hidden from one of these."""
    floor(scene)
    mirror = shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0)
    glass = shader("ShaderNodeBsdfRefraction", Color=(1, 1, 1), Roughness=0.0, IOR=1.2)
    pane = parts.plane_mesh("Pane", 1.0)
    parts.place(scene, "Mirror", pane, mirror, (-1.1, 0.3, 0.8), rotation=(1.45, 0, -0.5), scale=1.2)
    parts.place(scene, "Pane", pane, glass, (1.0, -0.6, 1.1), rotation=(1.4, 0, 0), scale=1.2)
    light = parts.add_light(scene, "Light", "AREA", 40.0, (0.6, 0.6, 1.2), (-0.4, -3, 0.8), size=1.3)
    setattr(light, f"visible_{ray}", False)
    sky(scene, strength=0.3)
    camera(scene, (0, -4, 1.6), (0, 0, 0.8))


@variants(values={"large": (1.0, 3.0), "small": (0.15, 60.0)}, bounces=1)
def mesh_emission(scene, value):
    size, strength = value
    floor_and_block(scene)
    glow = shader("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=strength)
    lamp = parts.place(scene, "Glow", parts.cube_mesh("Glow", size), glow, (1.1, -0.4, 1.3), rotation=(0.4, 0.3, 0))
    # The outline of a small and bright lamp would dominate the picture's noise.
    lamp.visible_camera = size > 0.5


@case(bounces=1)
def shadowless_beside_others(scene):
    """Rays find a large lamp without shadow only if nothing occludes it: the rate at which it is sampled is visible."""
    floor_and_block(scene)
    large = parts.add_light(scene, "Large", "POINT", 150.0, (1.2, -0.8, 2.5), shadow_soft_size=0.8)
    _cast_no_shadow(large.data)
    parts.add_light(scene, "Other", "POINT", 80.0, (-1.5, -1.5, 2.0), shadow_soft_size=0.2)


@case(bounces=1)
def mesh_emission_weak(scene):
    """Emission too weak to be sampled as a light: an object hidden from shadow rays alone still occludes it."""
    floor_and_block(scene)
    glow = shader("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=0.5)
    parts.place(scene, "Glow", parts.plane_mesh("Glow", 6.0), glow, (0, 0, 3.0))
    thing = ball(scene, shader("ShaderNodeBsdfDiffuse"), segments=24, radius=0.5, location=(1.1, -0.4, 1.3))
    thing.visible_shadow = False


@case(bounces=1)
def mesh_emission_scaled(scene):
    """A glowing ball under a non-uniform, mirroring scale."""
    floor_and_block(scene)
    glow = shader("ShaderNodeEmission", Color=(0.4, 0.7, 1.0), Strength=8.0)
    thing = ball(scene, glow, segments=24, radius=0.3, location=(1.1, -0.4, 1.3))
    thing.scale = (0.5, -0.2, 0.3)
    sky(scene, strength=0.3)


@case(bounces=2)
def mesh_emission_principled(scene):
    floor_and_block(scene)
    glow = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.1, 0.1, 0.1), Emission_Color=(1.0, 0.6, 0.3), Emission_Strength=6.0)
    parts.place(scene, "Glow", parts.plane_mesh("Glow", 1.0), glow, (1.1, -0.4, 1.5), rotation=(0.2, 0.3, 0))
