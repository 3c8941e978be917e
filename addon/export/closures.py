"""Readers of shader nodes: each adds the lobes, emission, transmittance or holdout of its node to a Surface."""

import bpy

from ..bindings.enums import Distribution, LobeKind
from ..messages.severity import Severity
from .arithmetic import is_constant
from .course_models import read_group
from .distributions import read_distribution
from .films import read_film
from .hair import read_hair, read_principled_hair
from .principled import read_principled
from .sockets import DIFFUSE_OPTION, SMALLEST_IOR
from .subsurface import read_subsurface

_NONE = (0.0, 0.0, 0.0)  # a direction: straight on


def _diffuse(surface, site, weight):
    roughness = surface.share(site, ("Roughness",))
    kind = LobeKind.LAMBERT if is_constant(roughness, 0.0) else LobeKind.DIFFUSE
    surface.add(kind, weight, surface.color(site), roughness=roughness, normal=surface.normal(site), option=DIFFUSE_OPTION)


def _roughness(surface, site, default):
    """Return the roughness; 0 for the distribution Sharp, whose socket Cycles ignores."""
    return 0.0 if getattr(site.node, "distribution", "") == "SHARP" else surface.share(site, ("Roughness",), default)


def _stretch(surface, site):
    graph = surface.graph
    anisotropy = graph.parameter(site, ("Anisotropy",), 0.0, low=-1.0, high=1.0)
    stretched = not is_constant(anisotropy, 0.0)
    return {
        "anisotropy": anisotropy,
        "rotation": graph.parameter(site, ("Rotation",), 0.0) if stretched else 0.0,
        "tangent": surface.tangent(site, anisotropy),
    }


def _glossy(surface, site, weight):
    color, roughness, normal = surface.color(site), _roughness(surface, site, 0.5), surface.normal(site)
    stretch = _stretch(surface, site)
    surface.add(
        LobeKind.GLOSSY,
        weight,
        color,
        roughness=roughness,
        normal=normal,
        distribution=read_distribution(surface.graph, site, roughness, stretch["anisotropy"]),
        **stretch,
    )


def _glass(surface, site, weight):
    surface.add(
        LobeKind.REFRACTION if site.node.type == "BSDF_REFRACTION" else LobeKind.GLASS,
        weight,
        surface.color(site, default=(1.0, 1.0, 1.0)),
        roughness=_roughness(surface, site, 0.0),
        ior=surface.graph.parameter(site, ("IOR",), 1.5, low=SMALLEST_IOR),
        normal=surface.normal(site),
        distribution=read_distribution(surface.graph, site),
        **read_film(surface, site),
    )


# The option of CONDUCTOR; before 5.0 Cycles approximates the Fresnel equations of metals.
_F82, _PHYSICAL = 0, 1 if bpy.app.version >= (5, 0) else 2


def _metallic(surface, site, weight):
    physical = site.node.fresnel_type == "PHYSICAL_CONDUCTOR"
    if physical:
        color, edge = (surface.graph.parameter(site, (name,), 1.0, kind="color") for name in ("IOR", "Extinction"))
    else:
        color, edge = (surface.color(site, (name,)) for name in ("Base Color", "Edge Tint"))
    surface.add(
        LobeKind.CONDUCTOR,
        weight,
        color,
        edge=edge,
        option=_PHYSICAL if physical else _F82,
        roughness=_roughness(surface, site, 0.5),
        normal=surface.normal(site),
        distribution=read_distribution(surface.graph, site),
        **_stretch(surface, site),
        **read_film(surface, site),
    )


def _sheen(surface, site, weight):
    is_velvet = site.node.type == "BSDF_VELVET" or site.node.distribution == "ASHIKHMIN"
    surface.add(
        LobeKind.SHEEN,
        weight,
        surface.color(site),
        roughness=surface.share(site, ("Roughness", "Sigma"), 0.5),
        normal=surface.normal(site),
        distribution=Distribution.BECKMANN if is_velvet else Distribution.GGX,
    )


def _translucent(surface, site, weight):
    surface.add(LobeKind.TRANSLUCENT, weight, surface.color(site), normal=surface.normal(site))


def _transparent(surface, site, weight):
    surface.transmit(surface.graph.multiply(surface.color(site, default=(1.0, 1.0, 1.0)), weight))


def _emission(surface, site, weight):
    graph = surface.graph
    strength = graph.parameter(site, ("Strength",), 1.0)
    if is_constant(strength, 0.0):
        return
    color = surface.color(site)
    surface.estimate(color, strength)
    surface.emit(graph.multiply(color, graph.multiply(strength, weight)))


def _holdout(surface, site, weight):
    surface.holdout = surface.graph.add(surface.holdout, weight)


# The option of TOON.
_DIFFUSE_TOON, _GLOSSY_TOON = 0, 1


def _toon(surface, site, weight):
    smooth = surface.share(site, ("Smooth",), 0.0)
    if (4, 0) <= bpy.app.version < (4, 2) and not is_constant(smooth, 0.0):
        text = "its smooth edge fades as in Blender 4.2, which this version's Cycles shows of another brightness"
        surface.graph.tell(site, text, "feature:smooth toon of Cycles 4.0")
    surface.add(
        LobeKind.TOON,
        weight,
        surface.color(site),
        roughness=surface.share(site, ("Size",), 0.5),
        roughness_across=smooth,
        normal=surface.normal(site),
        option=_GLOSSY_TOON if site.node.component == "GLOSSY" else _DIFFUSE_TOON,
    )


def _portal(surface, site, weight):
    graph = surface.graph
    if graph.read_integrator() == "CLASSIC":
        graph.tell(site, "the integrator Classic lets its rays pass straight on", "feature:portals of Classic")
    # Cycles reads the position from a link alone; without one, light goes on where it is.
    position = graph.linked(site, ("Position",), None)
    surface.send_on(
        graph.multiply(surface.color(site, default=(1.0, 1.0, 1.0)), weight),
        position,
        graph.parameter(site, ("Direction",), _NONE, kind="vector"),
    )


def _volume(surface, site, weight):
    surface.graph.tell(
        site, f"{site.node.bl_label} is a volume and has no surface, nothing is shown", severity=Severity.LEFT_OUT
    )


def read_unknown(surface, site, weight):
    node = site.node
    surface.graph.tell(site, f"{node.bl_label} is not supported, a diffuse surface is used")
    socket = next((socket for socket in node.inputs if socket.type == "RGBA" and socket.enabled), None)
    color = (0.5, 0.5, 0.5) if socket is None else surface.color(site, (socket.identifier,))
    surface.add(LobeKind.LAMBERT, weight, color, normal=surface.normal(site))


CLOSURES = {
    "BACKGROUND": _emission,
    "BSDF_ANISOTROPIC": _glossy,
    "BSDF_DIFFUSE": _diffuse,
    "BSDF_GLASS": _glass,
    "BSDF_GLOSSY": _glossy,
    "BSDF_HAIR": read_hair,
    "BSDF_HAIR_PRINCIPLED": read_principled_hair,
    "BSDF_METALLIC": _metallic,
    "BSDF_PRINCIPLED": read_principled,
    "BSDF_RAY_PORTAL": _portal,
    "BSDF_REFRACTION": _glass,
    "BSDF_SHEEN": _sheen,
    "BSDF_TOON": _toon,
    "BSDF_TRANSLUCENT": _translucent,
    "BSDF_TRANSPARENT": _transparent,
    "BSDF_VELVET": _sheen,
    "CUSTOM GROUP": read_group,
    # The type of Diffuse BSDF in Blender 4.4 alone.
    "DIFFUSE_BSDF": _diffuse,
    "EMISSION": _emission,
    "GROUP": read_group,
    "HOLDOUT": _holdout,
    "PRINCIPLED_VOLUME": _volume,
    "SUBSURFACE_SCATTERING": read_subsurface,
    "VOLUME_ABSORPTION": _volume,
    "VOLUME_COEFFICIENTS": _volume,
    "VOLUME_SCATTER": _volume,
}
