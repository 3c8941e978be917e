"""Subsurface scattering, of its own node and of Principled: methods, radii and colours as the running Blender means them."""

import bpy

from ..bindings.enums import LobeKind, SubsurfaceMethod
from .arithmetic import is_constant
from .sockets import PRINCIPLED, SMALLEST_IOR

_IS_OLD = bpy.app.version < (4, 0)
# From 5.2 on, Random Walk takes radii as mean free paths. Before 4.0, Random Walk kept the visible blur, as Skin does later.
_METHODS = {
    "BURLEY": SubsurfaceMethod.BURLEY,
    "RANDOM_WALK_FIXED_RADIUS": SubsurfaceMethod.RANDOM_WALK_LEGACY,
    "RANDOM_WALK_LEGACY": SubsurfaceMethod.RANDOM_WALK_LEGACY,
    "RANDOM_WALK_SKIN": SubsurfaceMethod.SKIN,
    "RANDOM_WALK": SubsurfaceMethod.SKIN
    if _IS_OLD
    else SubsurfaceMethod.RANDOM_WALK_LEGACY
    if bpy.app.version < (5, 2)
    else SubsurfaceMethod.RANDOM_WALK,
}
# Cycles 4.0 to 4.3 takes radii below a quarter of a pixel as none.
_QUARTER_PIXEL = 4 if (4, 0) <= bpy.app.version < (4, 4) else 0


def _option(method):
    return _METHODS[method] | _QUARTER_PIXEL


def read_subsurface(surface, site, weight):
    graph = surface.graph
    surface.add(
        LobeKind.SUBSURFACE,
        weight,
        surface.color(site),
        edge=_radius(graph, site, ("Radius",), graph.parameter(site, ("Scale",), 1.0)),
        ior=graph.parameter(site, ("IOR",), 1.4, low=SMALLEST_IOR),
        roughness=surface.share(site, ("Roughness",), 1.0),
        anisotropy=graph.parameter(site, ("Anisotropy",), 0.0, low=-1.0, high=1.0),
        normal=surface.normal(site),
        option=_option(site.node.falloff),
    )


def read_below(surface, site):
    """Return the inputs of Principled that tell of light below the surface; {} where it has none."""
    graph = surface.graph
    share = surface.share(site, PRINCIPLED["subsurface"])
    # Before 4.0 the share scales the radius; from then on an input does, and without radius the surface is diffuse.
    scale = 1.0 if _IS_OLD else graph.parameter(site, ("Subsurface Scale",), 0.05)
    if is_constant(share, 0.0) or is_constant(scale, 0.0):
        return {}
    values = {
        "subsurface": share,
        "subsurface_radius": _radius(graph, site, ("Subsurface Radius",), scale),
        "subsurface_ior": graph.parameter(site, ("Subsurface IOR",), 1.4, low=SMALLEST_IOR),
        "subsurface_anisotropy": graph.parameter(site, PRINCIPLED["subsurface_anisotropy"], 0.0),
        "subsurface_option": _option(site.node.subsurface_method),
    }
    if _IS_OLD:
        values["subsurface_color"] = surface.color(site, ("Subsurface Color",))
    return values


def _radius(graph, site, names, scale):
    """Return the radii of red, green and blue, scaled; negative ones are none."""
    radius = graph.multiply(graph.parameter(site, names, (1.0, 1.0, 1.0), kind="vector"), scale)
    return radius if not isinstance(radius, tuple) else tuple(max(length, 0.0) for length in radius)
