"""The Principled BSDF as a record: the inputs of each Blender version under their newest names."""

import bpy

from ..bindings import snapshot
from ..bindings.enums import LobeKind, Rules
from ..bindings.shading import NodeRef
from ..bindings.structs import PARAMETERS, Principled
from .arithmetic import is_constant
from .distributions import read_distribution
from .films import read_film
from .old_ranges import tell_range
from .sockets import DIFFUSE_OPTION, PRINCIPLED, RULES, SMALLEST_IOR
from .subsurface import read_below

_WHITE = (1.0, 1.0, 1.0)
# Layers whose other inputs are read only if the layer's weight is not 0.
_LAYERS = ("coat", "sheen", "anisotropic")
# Weights that the core accepts beyond 1 and Blender clamps to 0 to 1.
_SHARES = ("coat", "sheen")
_UNCLAMPED = ("metallic", "roughness", "anisotropic")
# Read with the parts that they belong to.
_APART = ("base_color", "emission", "film_thickness", "film_ior", "thin_wall", "wall_scattering", "wall_forward")


def read_principled(surface, site, weight):
    graph = surface.graph

    def number(name, default, low=float("-inf"), high=float("inf")):
        return graph.parameter(site, PRINCIPLED[name], default, low=low, high=high)

    # Alpha weighs the surface; the rest of the light passes straight through.
    alpha = graph.clamped(number("alpha", 1.0, 0.0, 1.0))
    surface.transmit(graph.multiply(graph.subtract(1.0, alpha), weight))
    weight = graph.multiply(weight, alpha)
    if is_constant(weight, 0.0):
        return
    values = read_film(surface, site)
    thin_wall = values["thin_wall"] = number("thin_wall", 0.0)
    for name, (kind, default) in PARAMETERS[Principled].items():
        layer, _, part = name.partition("_")
        if name in _APART or name.startswith("subsurface") or (part and layer in _LAYERS and is_constant(values[layer], 0.0)):
            continue
        if name in ("specular_tint", "sheen_tint"):
            values[name] = _tint(surface, site, name)
        elif kind == "color":
            values[name] = surface.color(site, PRINCIPLED[name], default)
        elif kind == "direction":
            values[name] = surface.normal(site, PRINCIPLED[name])
        elif kind == "share" or name in _SHARES:
            values[name] = number(name, default, 0.0, 1.0)
            if name in _UNCLAMPED:
                tell_range(graph, site, PRINCIPLED[name][0], values[name])
        elif kind == "amount":
            values[name] = number(name, default, 0.0)
        elif kind == "turns":
            values[name] = number(name, default)
        else:
            values[name] = number(name, default, SMALLEST_IOR)
    values["base_color"] = surface.color(site, PRINCIPLED["base_color"])
    if isinstance(thin_wall, NodeRef) or is_constant(thin_wall, 0.0):
        values.update(read_below(surface, site))
    if not is_constant(thin_wall, 0.0):
        values["wall_scattering"] = number("subsurface", 0.0, 0.0, 1.0)
        anisotropy = number("subsurface_anisotropy", 0.0)
        values["wall_forward"] = graph.clamped(graph.multiply(0.5, graph.add(1.0, anisotropy)))
    if RULES == Rules.BLENDER_3 and not is_constant(values["coat"], 0.0):
        # Cycles 3 weighs the base by a probability of the coat that differs from its sampler's.
        graph.tell(site, "Clearcoat leaves the base its light, which is brighter under a sky than in Cycles 3")
    emission = _emission(surface, site)
    if _is_bare(values):
        surface.emit(graph.multiply(emission, weight))
    else:
        values["emission"] = emission
    record = snapshot.Principled(
        rules=RULES,
        distribution=read_distribution(graph, site),
        option=DIFFUSE_OPTION,
        **values,
    )
    surface.add(
        LobeKind.PRINCIPLED,
        weight,
        principled=record,
        normal=surface.normal(site),
        tangent=surface.tangent(site, values["anisotropic"]),
    )


def _tint(surface, site, name):
    """Return a tint: a colour from 4.0 on; before, a share of the base colour, in the first channel."""
    if RULES != Rules.BLENDER_3:
        return surface.color(site, PRINCIPLED[name], _WHITE)
    share = surface.graph.parameter(site, PRINCIPLED[name], 0.0, low=0.0, high=1.0)
    return share if isinstance(share, NodeRef) else (share, 0.0, 0.0)


def _emission(surface, site):
    graph = surface.graph
    strength = graph.parameter(site, PRINCIPLED["emission_strength"], 1.0)
    # Cycles 5.0 ignores a constant negative strength; older and newer versions remove light, as Emission does.
    ignored = not isinstance(strength, NodeRef) and strength < 0.0 and (5, 0) <= bpy.app.version < (5, 1)
    if is_constant(strength, 0.0) or ignored:
        return (0.0, 0.0, 0.0)
    color = surface.color(site, PRINCIPLED["emission_color"], (0.0, 0.0, 0.0))
    surface.estimate(color, strength)
    return graph.multiply(color, strength)


def _is_bare(values):
    """Whether no coat or sheen covers the emission, which is then the material's own. In Blender 3 nothing covers it."""
    return RULES == Rules.BLENDER_3 or is_constant(values["coat"], 0.0) and is_constant(values["sheen"], 0.0)
