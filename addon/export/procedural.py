"""Procedural textures: noise, Voronoi, gradients. Each reader takes (graph, site, output) and returns a value."""

import bpy

from ..bindings.enums import (
    Coordinate,
    GradientKind,
    MathOperation,
    NodeKind,
    NoiseFlag,
    NoiseKind,
    VoronoiFeature,
    VoronoiFlag,
    VoronoiMetric,
)
from ..bindings.shading import NodeRef
from .coordinates import coordinate
from .textures import legacy_mapping

# Rules of the running Blender's Cycles that differ between versions.
_SMOOTHEST = 1.0 if bpy.app.version < (4, 1) else float("inf")  # limit of the roughness of noise
REPEATS = bpy.app.version >= (4, 2)
_HASHES_INTEGERS = bpy.app.version >= (5, 0)
_MAPS_LINKS_ONLY = bpy.app.version >= (5, 0)  # the node's own mapping leaves constants as they are
_IS_BOUNDED = bpy.app.version < (4, 0)
_CONFUSES_LACUNARITY = (4, 0) <= bpy.app.version < (4, 3)  # a linked Smoothness is also used as the Lacunarity of Voronoi
_LEAST = 1e-5  # lower limit of the Musgrave Texture's dimension and lacunarity


def mapped_vector(graph, site):
    """Return a texture's coordinates, Generated without a link, through the mapping that the node itself stores."""
    vector = graph.linked(site, ("Vector",), None, evaluated=True)
    if vector is None:
        vector = coordinate(graph, Coordinate.GENERATED)
    if _MAPS_LINKS_ONLY and not isinstance(vector, NodeRef):
        return vector
    return legacy_mapping(graph, site, vector)


def noise_roughness(graph, site, name):
    """Return an input that is the roughness of noise, within the limits of the running Blender."""
    roughness = graph.parameter(site, (name,), 0.5)
    return roughness if _SMOOTHEST == float("inf") else graph.emit(NodeKind.CLAMP, roughness, 0.0, _SMOOTHEST)


def dimensions(name):
    """Return the flag bits of "1D" to "4D"."""
    return int(name[0]) - 1


def packed(graph, site, *wanted):
    """Combine up to three inputs of a node into one vector. wanted: (name, default if this Blender lacks the input)."""
    return graph.combine(*(graph.parameter(site, (name,), default) for name, default in (*wanted, ("", 0.0), ("", 0.0))[:3]))


def _noise(graph, site, output):
    node = site.node
    kind = NoiseKind[getattr(node, "noise_type", "FBM")]
    flags = dimensions(node.noise_dimensions)
    if getattr(node, "normalize", True):
        flags |= NoiseFlag.NORMALIZED
    if REPEATS:
        flags |= NoiseFlag.REPEATS
    # With colours the factor is the red channel.
    wants_color = node.outputs["Color"].is_linked
    if wants_color:
        flags |= NoiseFlag.COLOR
    roughness = noise_roughness(graph, site, "Roughness")
    value = graph.emit(
        NodeKind.NOISE,
        mapped_vector(graph, site),
        packed(graph, site, ("W", 0.0), ("Scale", 5.0), ("Distortion", 0.0)),
        graph.combine(graph.parameter(site, ("Detail",), 2.0), roughness, graph.parameter(site, ("Lacunarity",), 2.0)),
        packed(graph, site, ("Offset", 0.0), ("Gain", 1.0)),
        option=kind,
        flags=int(flags),
    )
    return graph.component(value, 0) if wants_color and output.identifier != "Color" else value


def _musgrave(graph, site, output):
    """Return the Musgrave Texture of Blender before 4.1: noise whose octaves decrease by a power of the lacunarity."""
    node, m = site.node, MathOperation
    lacunarity = graph.op(m.MAXIMUM, graph.parameter(site, ("Lacunarity",), 2.0), _LEAST)
    dimension = graph.op(m.MAXIMUM, graph.parameter(site, ("Dimension",), 2.0), _LEAST)
    roughness = graph.op(m.POWER, lacunarity, graph.op(m.MULTIPLY, dimension, -1.0))
    return graph.emit(
        NodeKind.NOISE,
        mapped_vector(graph, site),
        packed(graph, site, ("W", 0.0), ("Scale", 5.0)),
        graph.combine(graph.parameter(site, ("Detail",), 2.0), roughness, lacunarity),
        packed(graph, site, ("Offset", 0.0), ("Gain", 1.0)),
        option=NoiseKind[node.musgrave_type],
        flags=dimensions(node.musgrave_dimensions) | int(NoiseFlag.COUNTED),
    )


def _voronoi(graph, site, output):
    node = site.node
    feature = VoronoiFeature[node.feature]
    flags = dimensions(node.voronoi_dimensions) | VoronoiMetric[node.distance] << 2
    if getattr(node, "normalize", False):
        flags |= VoronoiFlag.NORMALIZED
    if _HASHES_INTEGERS:
        flags |= VoronoiFlag.INTEGERS
    if _IS_BOUNDED:
        flags |= VoronoiFlag.BOUNDED
    shown = output.identifier
    has_cells = feature not in (VoronoiFeature.DISTANCE_TO_EDGE, VoronoiFeature.N_SPHERE_RADIUS)
    if has_cells and shown in ("Position", "W"):
        flags |= VoronoiFlag.POSITION
    # With colours the distance is in the alpha channel.
    elif has_cells and (shown == "Color" or node.outputs["Color"].is_linked):
        flags |= VoronoiFlag.COLOR
    smoothness = graph.parameter(site, ("Smoothness",), 1.0)
    lacunarity = graph.parameter(site, ("Lacunarity",), 2.0)
    if _CONFUSES_LACUNARITY and isinstance(smoothness, NodeRef):
        lacunarity = smoothness
    elif _CONFUSES_LACUNARITY and isinstance(lacunarity, NodeRef):
        lacunarity = float(node.inputs["Lacunarity"].default_value)
    value = graph.emit(
        NodeKind.VORONOI,
        mapped_vector(graph, site),
        packed(graph, site, ("W", 0.0), ("Scale", 5.0), ("Randomness", 1.0)),
        graph.combine(graph.parameter(site, ("Detail",), 0.0), graph.parameter(site, ("Roughness",), 0.5), lacunarity),
        graph.combine(smoothness, graph.parameter(site, ("Exponent",), 0.5), 0.0),
        option=feature,
        flags=int(flags),
    )
    is_beside = shown == "W" or (shown == "Distance" and flags & VoronoiFlag.COLOR)
    return graph.emit(NodeKind.ALPHA, value) if has_cells and is_beside else value


def _gradient(graph, site, output):
    return graph.emit(NodeKind.GRADIENT, mapped_vector(graph, site), option=GradientKind[site.node.gradient_type])


READERS = {"TEX_GRADIENT": _gradient, "TEX_MUSGRAVE": _musgrave, "TEX_NOISE": _noise, "TEX_VORONOI": _voronoi}
