"""Blender's watts as the quantities of lancer.h: radiant intensity, irradiance, radiance."""

import math
from typing import NamedTuple

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.enums import AreaShape, Falloff, LightKind, Ray
from ..bindings.parameters import only_read
from ..bindings.shading import NodeRef
from ..messages.severity import Severity
from .catchers import is_catcher
from .graph import NodeGraph
from .images import NoPictures
from .lamp_transforms import area_of, axes_of, cone_stretch, describe_shear, is_flattened, shines_all_around
from .shader_cache import Sources
from .surface import emission_of
from .visibility import object_hidden_from

_DEEPEST = 1024  # Blender's largest number of bounces, which stands for no limit
_KINDS = {"POINT": LightKind.POINT, "SPOT": LightKind.SPOT, "SUN": LightKind.SUN, "AREA": LightKind.AREA}


class LampNodes(NamedTuple):
    """What the nodes of a lamp give: the factor of its light, with the nodes that it refers to."""

    strength: object = (1.0, 1.0, 1.0)
    nodes: tuple = ()
    sources: Sources = Sources()


def export_lamp_nodes(thing, messages, images, depsgraph=None, value=None):
    """Return the LampNodes of a lamp. value: as NodeGraph.lamp_value."""
    light = thing.data
    if light.node_tree is None or (bpy.app.version < (5, 2) and not light.use_nodes):
        return LampNodes()
    graph = NodeGraph(f"light '{thing.name}'", messages, images, depsgraph, unknown="white")
    graph.is_of_lamp, graph.lamp_value = True, value
    emission = emission_of(graph, graph.tree_of(light), "OUTPUT_LIGHT")
    # Nodes of which no output is left cost nothing.
    nodes, emission = only_read(graph.nodes, emission)
    return LampNodes(emission, nodes, graph.sources)


def export_light(thing, matrix_world, messages, depsgraph=None, hidden=None, shine=None):
    """Return the light of an object; None, with a message, if it cannot shine. hidden: Ray bits instead of the object's own.

    shine: the LampNodes; None reads them without images.
    """
    light = thing.data
    who = f"light '{thing.name}'"
    matrix = np.array(matrix_world, float)
    if not np.isfinite(matrix).all():
        messages.add(f"{who}: its transform is not finite, it is left out", severity=Severity.LEFT_OUT)
        return None
    if light.type == "AREA" and getattr(getattr(light, "cycles", None), "is_portal", False):
        return _export_portal(thing, light, matrix, who, messages)
    _check(thing, light, who, messages)
    kind = _KINDS[light.type]
    radius = messages.number(getattr(light, "shadow_soft_size", 0.0), who, "radius", 0.0, 0.0)
    sun_angle = messages.number(getattr(light, "angle", 0.0), who, "angle", 0.0, 0.0, math.pi)
    shape, size = AreaShape.RECTANGLE, (1.0, 1.0)
    if shines_all_around(kind, matrix, radius, depsgraph):
        messages.add(f"{who}: its transform flattens it, as in Cycles it shines to all sides", severity=Severity.HINT)
        kind = LightKind.POINT
    if kind == LightKind.AREA:
        shape, size = _area(light, matrix, who, messages)
    elif kind == LightKind.SPOT:
        size = cone_stretch(matrix)
    area = area_of(matrix, shape, size)
    if kind == LightKind.AREA and not area > 0.0:
        messages.add(f"{who}: its area is zero, it is left out", severity=Severity.LEFT_OUT)
        return None
    if is_flattened(kind, matrix, depsgraph):
        if kind == LightKind.SUN and sun_angle > 0.0 and bpy.app.version >= (5, 0):
            messages.add(f"{who}: its transform flattens it, Cycles shows a sun of arbitrary direction, here it gives no light")
            return None
        messages.add(f"{who}: its transform flattens it, as in Cycles it gives no light", severity=Severity.HINT)
        return None
    if text := describe_shear(kind, matrix, depsgraph):
        messages.add(f"{who}: {text}")
    _check_layers(kind, radius, who, messages, depsgraph)
    if shine is None:
        shine = export_lamp_nodes(thing, messages, NoPictures(), depsgraph)
    varies = isinstance(shine.strength, NodeRef)
    factor = (1.0, 1.0, 1.0) if varies else shine.strength
    watts = _watts_to_emission(light, kind, radius, sun_angle, area)
    own = light.lancer
    separate = own.use_separate_colors
    return snapshot.Light(
        name=thing.name,
        matrix=axes_of(kind, matrix, varies),
        kind=kind,
        emission=tuple(watts * c * f for c, f in zip(_power(light, who, messages), factor, strict=True)),
        strength=shine.strength if varies else 1.0,
        nodes=shine.nodes,
        radius=radius if kind in (LightKind.POINT, LightKind.SPOT) else 0.0,
        soft_falloff=getattr(light, "use_soft_falloff", True),
        spot_angle=messages.number(getattr(light, "spot_size", math.pi), who, "spot size", 0.785, 1e-3, math.pi),
        spot_blend=messages.number(getattr(light, "spot_blend", 0.0), who, "spot blend", 0.15, 0.0, 1.0),
        spot_cosine=bpy.app.version < (4, 0),
        sun_angle=sun_angle if kind == LightKind.SUN else 0.0,
        sun_flat=bpy.app.version < (4, 0),
        size=size,
        shape=shape,
        spread=messages.number(getattr(light, "spread", math.pi), who, "spread", math.pi, 0.0, math.pi),
        hidden_from=(object_hidden_from(thing) if hidden is None else hidden) & ~int(Ray.SHADOW),
        no_shadow=not _casts_shadow(light),
        no_catchers=not is_catcher(thing),
        lit_surfaces=lit_surfaces(light),
        falloff=Falloff[own.falloff],
        falloff_radius=messages.number(own.radius, who, "falloff radius", 10.0, 1e-12),
        ambient_color=_ambient(own, who, messages),
        diffuse_color=messages.color(own.diffuse_color, who, "diffuse colour", 1.0) if separate else (1.0, 1.0, 1.0),
        specular_color=messages.color(own.specular_color, who, "specular colour", 1.0) if separate else (1.0, 1.0, 1.0),
    )


def _export_portal(thing, light, matrix, who, messages):
    """Return the opening through which the sky is sampled; None, with a message, if it has no area."""
    shape, size = _area(light, matrix, who, messages)
    if not area_of(matrix, shape, size) > 0.0:
        messages.add(f"{who}: its area is zero, it is no portal", severity=Severity.HINT)
        return None
    axes = axes_of(LightKind.AREA, matrix, False)
    if shape == AreaShape.ELLIPSE:
        text = "is a round portal, which makes Cycles' picture darker near it; here portals change the noise alone"
        messages.add(f"{who}: {text}", "feature:round portals", Severity.HINT)
    fields = {"size": size, "shape": shape, "emission": (0.0, 0.0, 0.0), "opening": True}
    return snapshot.Light(name=thing.name, matrix=axes, kind=LightKind.AREA, **fields)


def _check_layers(kind, radius, who, messages, depsgraph):
    """Report that Cycles counts a lamp that a path meets as a transparent surface, where the first one ends the path."""
    if depsgraph is None or kind == LightKind.SUN or (kind != LightKind.AREA and radius == 0.0):
        return
    bounces = depsgraph.scene.lancer.transparent_bounces
    if bounces + (bpy.app.version < (5, 0)) <= 1:
        messages.add(
            f"{who}: with at most {bounces} transparent bounces Cycles ends paths at lamps, here they continue behind them; "
            "with 2 and more both engines continue",
            "feature:lamps that end paths",
        )


def _ambient(own, who, messages):
    if not own.use_ambient:
        return 0.0, 0.0, 0.0
    return messages.color(own.ambient_color, who, "ambient colour", 1.0) if own.use_separate_colors else (1.0, 1.0, 1.0)


def lit_surfaces(owner):
    """Return on how many surfaces of a path Cycles' limit of bounces lets a lamp or a world give light samples; 0 = on all."""
    limit = getattr(getattr(owner, "cycles", None), "max_bounces", _DEEPEST)
    return limit + 1 if limit < _DEEPEST else 0


def _casts_shadow(light):
    """Whether the light casts shadows: by Cycles' own switch in versions that have it, in which use_shadow is EEVEE's."""
    return getattr(getattr(light, "cycles", None), "cast_shadow", light.use_shadow)


def _power(light, who, messages):
    """Return watts per channel: the product of energy, colour, temperature and exposure."""
    energy = messages.number(light.energy, who, "power", 0.0)
    color = messages.color(light.color, who, "colour", 1.0)
    if getattr(light, "use_temperature", False):
        color = tuple(c * t for c, t in zip(color, light.temperature_color, strict=True))
    energy *= 2.0 ** messages.number(getattr(light, "exposure", 0.0), who, "exposure", 0.0)
    return tuple(energy * c for c in color)


def _watts_to_emission(light, kind, radius, sun_angle, area):
    """Return the factor from watts to W/sr (point, spot), W/m^2 (sun) or W/(m^2 sr) (area)."""
    normalize = getattr(light, "normalize", True)
    if kind == LightKind.SUN:
        if bpy.app.version < (4, 0):
            return _old_sun(sun_angle)
        return 1.0 if normalize or sun_angle == 0.0 else math.pi * math.sin(0.5 * sun_angle) ** 2
    if kind == LightKind.AREA:
        if not normalize:
            return 1.0 / math.pi
        return 1.0 / (math.pi * area) if bpy.app.version >= (4, 0) else 1.0 / (4.0 * area)
    if normalize:
        return 1.0 / (4.0 * math.pi)
    # The ball's radiance is P/pi over its cross-section pi r^2; Cycles gives a point without radius the cross-section 1.
    return radius**2 if radius > 0.0 else 1.0 / math.pi


def _old_sun(sun_angle):
    """Return the factor before 4.0, where the sun is a flat disk at distance 1 that loses its mean cosine."""
    tangent2 = math.tan(0.5 * min(sun_angle, math.radians(179.9))) ** 2
    return 2.0 / (math.sqrt(1.0 + tangent2) + 1.0)


def _area(light, matrix, who, messages):
    """Return the shape and the full side lengths in world space; the object's axes scale the sides."""
    x = messages.number(light.size, who, "size", 1.0, 0.0)
    y = messages.number(light.size_y, who, "size y", 1.0, 0.0) if light.shape in ("RECTANGLE", "ELLIPSE") else x
    shape = AreaShape.ELLIPSE if light.shape in ("DISK", "ELLIPSE") else AreaShape.RECTANGLE
    lengths = np.linalg.norm(matrix[:3, :2], axis=0)
    return shape, (x * float(lengths[0]), y * float(lengths[1]))


def _check(thing, light, who, messages):
    cycles = getattr(light, "cycles", None)
    if getattr(light, "use_custom_distance", False) and bpy.app.version < (4, 2):
        messages.add(f"{who}: custom distance has no effect, as in Cycles")
    if not getattr(cycles, "use_multiple_importance_sampling", True):
        messages.add(
            f"{who}: without multiple importance sampling Cycles hides it from mirrors and glass, here they show it",
            "feature:lamp without MIS",
        )
