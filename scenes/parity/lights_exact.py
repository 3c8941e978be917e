"""Every kind of lamp and each of its switches on one matt plane: the amount of light, to a thousandth."""

import math

import bpy

from .. import parts
from .catalogue import case, variants
from .lights_switches import emission_nodes, with_light_field
from .nodes import shader

_FIELDS = {"bounces": 0, "size": (32, 32), "quick": True}


def _spot(scene):
    """Adds a camera that sees two hundredths of a plane, so that only noise varies over the picture."""
    grey = shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8))
    parts.place(scene, "Plane", parts.plane_mesh("Plane", 2.0), grey)
    eye = parts.add_camera(scene, (0, 0, 1), (0, 0, 0))
    eye.rotation_euler = (0, 0, 0)
    eye.data.type, eye.data.ortho_scale = "ORTHO", 0.02


def _lamp(scene, kind, scale=(1, 1, 1), **fields):
    _spot(scene)
    energy = 3.0 if kind == "SUN" else 200.0
    thing = parts.add_light(scene, "Light", kind, energy, (1.2, -0.8, 2.5), **fields)
    thing.scale = scale
    return thing


_LAMPS = {
    "point_hard": {"kind": "POINT", "shadow_soft_size": 0.0},
    "point_soft": {"kind": "POINT", "shadow_soft_size": 0.5},
    "point_colour": {"kind": "POINT", "shadow_soft_size": 0.1, "color": (1.0, 0.4, 0.1)},
    "point_scaled": {"kind": "POINT", "shadow_soft_size": 0.4, "scale": (2.0, 2.0, 2.0)},
    "spot_hard": {"kind": "SPOT", "shadow_soft_size": 0.0, "spot_size": 1.0, "spot_blend": 0.0},
    "spot_soft": {"kind": "SPOT", "shadow_soft_size": 0.5, "spot_size": 1.0, "spot_blend": 0.0},
    "spot_mirrored": {"kind": "SPOT", "shadow_soft_size": 0.0, "spot_size": 0.5, "spot_blend": 1.0, "scale": (-2.0, 1.0, 1.0)},
    "spot_wide": {"kind": "SPOT", "shadow_soft_size": 0.2, "spot_size": math.radians(175), "spot_blend": 0.3},
    "sun_hard": {"kind": "SUN", "angle": 0.0},
    "sun_soft": {"kind": "SUN", "angle": 0.2},
    # Its noise with few samples exceeds the limit, as that of glowing meshes does.
    "sun_wide": ({"kind": "SUN", "angle": 1.5}, {"quick": False}),
    "area_square": {"kind": "AREA", "shape": "SQUARE", "size": 1.2},
    "area_rectangle": {"kind": "AREA", "shape": "RECTANGLE", "size": 2.0, "size_y": 0.5},
    "area_disk": {"kind": "AREA", "shape": "DISK", "size": 1.2},
    "area_ellipse": {"kind": "AREA", "shape": "ELLIPSE", "size": 2.0, "size_y": 0.7},
    "area_scaled": {"kind": "AREA", "shape": "ELLIPSE", "size": 1.0, "size_y": 1.0, "scale": (2.0, 0.5, 3.0)},
    "area_mirrored": {"kind": "AREA", "shape": "RECTANGLE", "size": 1.0, "size_y": 1.0, "scale": (-2.0, 0.5, 1.0)},
    "area_spread": {"kind": "AREA", "shape": "SQUARE", "size": 0.8, "spread": math.radians(60)},
    "area_spread_disk": {"kind": "AREA", "shape": "DISK", "size": 0.8, "spread": math.radians(100)},
}


@variants("LIGHT", values=_LAMPS, **_FIELDS)
def light(scene, fields):
    _lamp(scene, **fields)


@variants("LIGHT", values={"half": (0.5, 0.35), "full": (1.0, 0.3)}, **_FIELDS)
def light_spot_blend(scene, value):
    """Between the edge of the cone and its fully lit part."""
    blend, aside = value
    _spot(scene)
    lamp = parts.add_light(scene, "Light", "SPOT", 200.0, (1.2, -0.8, 2.5), (aside, 0, 0), shadow_soft_size=0.0)
    lamp.data.spot_size, lamp.data.spot_blend = 0.5, blend


@variants("LIGHT", values={"point": "POINT", "spot": "SPOT"}, since=(4, 0), **_FIELDS)
def light_true_sphere(scene, kind):
    light = _lamp(scene, kind, shadow_soft_size=0.5).data
    # Blender 4.0 always has this falloff, without a switch.
    if hasattr(light, "use_soft_falloff"):
        light.use_soft_falloff = False


def _turned(scene, kind, scale):
    """A lamp that faces away, which a scale turns round again."""
    lamp = _lamp(scene, kind, scale)
    lamp.rotation_euler.rotate_axis("X", math.pi)
    return lamp


@variants("LIGHT", values={"spot": "SPOT", "sun": "SUN", "area": "AREA"}, **_FIELDS)
def light_inside_out(scene, kind):
    _turned(scene, kind, (-1.0, -1.0, -1.0))


# Without the tree Cycles asks lamps that give no light as often as others.
_FLAT = {"point": "POINT", "spot": ("SPOT", {"quick": False}), "sun": "SUN", "area": "AREA"}


@variants("LIGHT", since=(4, 0), values=_FLAT, **_FIELDS)
def light_flattened(scene, kind):
    """Beside a sun, a lamp that is scaled to 0 along each axis in turn; the tree of lights is off, as in all these scenes."""
    _spot(scene)
    parts.add_light(scene, "Base", "SUN", 1.0, (0.5, 0.5, 3.0), angle=0.0)
    # A spot that is flat along z shines to all sides; see light_flat_spot.
    for axis in range(2 if kind == "SPOT" else 3):
        energy = 1.0 if kind == "SUN" else 50.0
        lamp = parts.add_light(scene, f"Light {axis}", kind, energy, (1.2, -0.8, 2.5 + 0.1 * axis))
        if kind in ("POINT", "SPOT"):
            lamp.data.shadow_soft_size = 0.0
        lamp.scale = [0.0 if axis == other else 1.5 for other in range(3)]


@variants("LIGHT", since=(4, 0), values={"ball": 0.3, "point": 0.0}, **_FIELDS)
def light_flat_spot(scene, radius):
    """A spot without a direction shines to all sides; one that is a point does so without the tree of lights alone."""
    lamp = _lamp(scene, "SPOT", (0.7, 1.3, 0.0), shadow_soft_size=radius).data
    lamp.spot_size, lamp.spot_blend = 0.6, 0.5


_KINDS = {
    "point": {"kind": "POINT", "shadow_soft_size": 0.3},
    "spot": {"kind": "SPOT", "shadow_soft_size": 0.3, "spot_size": 1.2},
    "sun": {"kind": "SUN", "angle": 0.3},
    "area": {"kind": "AREA", "size": 0.8},
}


@variants("LIGHT", values=_KINDS, needs=with_light_field("normalize"), **_FIELDS)
def light_normalize_off(scene, fields):
    _lamp(scene, normalize=False, **fields)


@variants("LIGHT", values=_KINDS, needs=with_light_field("exposure"), **_FIELDS)
def light_exposure(scene, fields):
    _lamp(scene, exposure=-1.5, **fields)


@variants("LIGHT", values=_KINDS, needs=with_light_field("use_temperature"), **_FIELDS)
def light_temperature(scene, fields):
    _lamp(scene, use_temperature=True, temperature=2700.0, **fields)


# Cycles needs a thousand samples where an area lamp takes most of the light away.
@variants("LIGHT", values={**_KINDS, "area": (_KINDS["area"], {"quick": False})}, **_FIELDS)
def light_negative(scene, fields):
    """A lamp that takes away a part of what a sun gives."""
    lamp = _lamp(scene, **fields)
    lamp.data.energy *= -0.2
    parts.add_light(scene, "Base", "SUN", 3.0, (0.5, 0.5, 3.0), angle=0.0)


@variants("LIGHT", values={"nodes": True, "alone": False}, **_FIELDS)
def light_negative_strength(scene, nodes):
    """By its Emission node; and beside no other lamp, where all is below 0."""
    lamp = _lamp(scene, **_KINDS["point"])
    if nodes:
        emission_nodes(lamp.data, lambda nodes: {"Color": (0.3, 0.9, 0.5), "Strength": -0.5})
        parts.add_light(scene, "Base", "SUN", 3.0, (0.5, 0.5, 3.0), angle=0.0)
    else:
        lamp.data.energy *= -1.0


@case("LIGHT", **_FIELDS)
def light_negative_sky(scene):
    _spot(scene)
    parts.add_light(scene, "Base", "SUN", 3.0, (0.5, 0.5, 3.0), angle=0.0)
    parts.set_world(scene, (0.3, 0.4, 0.5), -0.5)


@variants("LIGHT", values=_KINDS, **_FIELDS)
def light_own_nodes(scene, fields):
    emission_nodes(_lamp(scene, **fields).data, lambda nodes: {"Color": (0.3, 0.9, 0.5), "Strength": 2.5})


@variants("LIGHT", values=_KINDS, **_FIELDS)
def light_shadow_off(scene, fields):
    """A card between lamp and plane, which the light of such a lamp ignores."""
    light = _lamp(scene, **fields).data
    grey = shader("ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.5))
    parts.place(scene, "Card", parts.plane_mesh("Card", 0.4), grey, (0.4, -0.27, 0.83))
    if bpy.app.version >= (4, 2):
        light.use_shadow = False
    else:
        light.cycles.cast_shadow = False


@variants(
    "LIGHT", values={"plain": (1, 1, 1), "scaled": (0.5, 1.5, 1.0), "mirrored": (-1.0, 0.7, 1.0)}, **{**_FIELDS, "quick": False}
)
def light_mesh(scene, scale):
    _spot(scene)
    glow = shader("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=20.0)
    parts.place(scene, "Glow", parts.plane_mesh("Glow", 1.0), glow, (1.0, -0.6, 1.8), scale, rotation=(0.4, 0.5, 0))


@variants("LIGHT", values={"emission": False, "principled": True}, **{**_FIELDS, "quick": False})
def light_negative_mesh(scene, principled):
    """Cycles 5.0 alone takes a negative strength of Principled as 0."""
    _spot(scene)
    parts.add_light(scene, "Base", "SUN", 3.0, (0.5, 0.5, 3.0), angle=0.0)
    if principled:
        color = "Emission_Color" if bpy.app.version >= (4, 0) else "Emission"
        glow = shader("ShaderNodeBsdfPrincipled", Emission_Strength=-5.0, **{color: (1.0, 0.7, 0.4)})
    else:
        glow = shader("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=-5.0)
    parts.place(scene, "Glow", parts.plane_mesh("Glow", 1.0), glow, (1.0, -0.6, 1.8), rotation=(0.4, 0.5, 0))
