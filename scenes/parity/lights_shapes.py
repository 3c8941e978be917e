"""Lamps of every kind and shape over a floor with a block on it, direct light only."""

import math

from .. import parts
from .catalogue import case, variants
from .nodes import shader
from .stages import camera, floor, floor_and_block, sky


@variants(values={"hard": (0.0, {"quick": True}), "soft": (0.4, {"quick": True})}, bounces=0)
def point(scene, radius):
    floor_and_block(scene)
    parts.add_light(scene, "Light", "POINT", 300.0, (1.5, -1, 2.5), shadow_soft_size=radius)


@variants(values={"point": "POINT", "spot": "SPOT"}, bounces=0, since=(4, 0))
def true_sphere(scene, kind):
    floor_and_block(scene)
    light = parts.add_light(scene, "Light", kind, 300.0, (0.8, -0.6, 1.8), shadow_soft_size=0.5).data
    if hasattr(light, "use_soft_falloff"):
        light.use_soft_falloff = False


@variants(values={"hard_edge": (0.0, 0.0), "blend": (0.5, 0.0), "full_blend": (1.0, 0.0), "soft": (0.3, 0.4)}, bounces=0)
def spot(scene, value):
    blend, radius = value
    floor_and_block(scene)
    parts.add_light(scene, "Light", "SPOT", 500.0, (0.8, -1.2, 3.5), spot_size=0.9, spot_blend=blend, shadow_soft_size=radius)


@case(bounces=0)
def spot_wide(scene):
    floor_and_block(scene)
    parts.add_light(
        scene, "Light", "SPOT", 300.0, (0.8, -1.2, 2.5), spot_size=math.radians(175), spot_blend=0.2, shadow_soft_size=0.1
    )


@variants(values={"hard": 0.0, "soft": (0.6, {"quick": True}), "wide": 1.5}, bounces=0)
def sun(scene, angle):
    floor_and_block(scene)
    parts.add_light(scene, "Light", "SUN", 3.0, (1.5, -1, 2.5), angle=angle)


@variants(
    values={
        "square": ("SQUARE", 1.2, 1.0),
        "rectangle": (("RECTANGLE", 2.0, 0.5), {"quick": True}),
        "disk": ("DISK", 1.2, 1.0),
        "ellipse": ("ELLIPSE", 2.0, 0.7),
    },
    bounces=0,
)
def area(scene, value):
    shape, x, y = value
    floor_and_block(scene)
    parts.add_light(scene, "Light", "AREA", 150.0, (1.2, -0.8, 2.2), shape=shape, size=x, size_y=y)


@variants(values={"square": ("SQUARE", 60, 80.0), "disk": ("DISK", 60, 80.0), "narrow": ("SQUARE", 5, 120.0)}, bounces=0)
def area_spread(scene, value):
    shape, degrees, lens = value
    floor_and_block(scene)
    camera(scene, lens=lens)
    parts.add_light(scene, "Light", "AREA", 100.0, (0.6, -0.6, 2.2), shape=shape, size=1.0, spread=math.radians(degrees))


@case(bounces=0)
def area_seen(scene):
    """The lamps themselves, seen by the camera from front and back."""
    floor(scene)
    parts.add_light(scene, "Front", "AREA", 20.0, (-1, 0, 1), (-1, -5, 2), shape="DISK", size=1.0)
    parts.add_light(scene, "Back", "AREA", 20.0, (1, 0, 1), (1, 5, 1), size=1.0)
    parts.add_light(scene, "Ball", "POINT", 20.0, (0, 0.4, 1.6), shadow_soft_size=0.3)
    sky(scene)
    camera(scene)


@case(bounces=0)
def area_scaled(scene):
    """The object's scale changes the lamp's size."""
    floor_and_block(scene)
    light = parts.add_light(scene, "Light", "AREA", 150.0, (1.2, -0.8, 2.2), shape="ELLIPSE", size=1.0, size_y=1.0)
    light.scale = (2.0, 0.5, 3.0)


@case(bounces=0)
def point_scaled(scene):
    floor_and_block(scene)
    parts.add_light(scene, "Light", "POINT", 150.0, (1.2, -0.8, 2.2), shadow_soft_size=0.2).scale = (2.0, 2.0, 2.0)


@case(bounces=0)
def spot_scaled(scene):
    """A non-uniform scale makes the cone elliptic."""
    floor_and_block(scene)
    light = parts.add_light(scene, "Light", "SPOT", 500.0, (0.8, -1.2, 3.5), spot_size=0.8, shadow_soft_size=0.0)
    light.scale = (2.0, 1.0, 1.0)


@case(bounces=1)
def lamp_in_mirror(scene):
    """Lamps in a mirror; the light that the mirror reflects to the floor is noisy and excluded."""
    floor(scene)
    mirror = shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0)
    parts.place(scene, "Mirror", parts.plane_mesh("Mirror", 3.0), mirror, (0, 1.2, 1.2), rotation=(1.3, 0, 0))
    parts.add_light(scene, "Area", "AREA", 60.0, (-0.8, -1, 2.2), (0, 1, 1), size=1.2)
    parts.add_light(scene, "Ball", "POINT", 60.0, (0.9, -0.8, 1.8), shadow_soft_size=0.5)
    sky(scene, strength=1.0)
    camera(scene, (0, -4, 1.6), (0, 0, 1))


@case(bounces=1)
def many_lamps(scene):
    floor_and_block(scene)
    for index in range(12):
        turn = 2 * math.pi * index / 12
        color = (0.5 + 0.5 * math.cos(turn), 0.5, 0.5 + 0.5 * math.sin(turn))
        place = (2.2 * math.cos(turn), 2.2 * math.sin(turn), 0.8 + 0.1 * index)
        parts.add_light(scene, f"Light {index}", "POINT", 10.0 + 5 * index, place, color=color, shadow_soft_size=0.1)
