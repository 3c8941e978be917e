"""Hair shaders as Cycles shows them on meshes, where a triangle's own edges stand for the direction of fibres."""

import math

import bpy

from ..bindings.enums import Coordinate, LobeKind, MathOperation, NodeKind, Rules
from ..bindings.shading import NodeRef
from .arithmetic import triple
from .sockets import RULES, SMALLEST_IOR

_REFLECTION, _TRANSMISSION = 0, 1  # the option of HAIR
_CHIANG, _HUANG = 0, 1  # the option of HAIR_FIBRE
# Absorption of the pigments of human hair (d'Eon et al. 2011), per concentration.
_EUMELANIN, _PHEOMELANIN = (0.506, 0.841, 1.653), (0.343, 0.733, 1.924)
# The polynomial in the roughness around a fibre by which Chiang et al. 2016 turn a reflectance into an absorption.
_SCALE = (0.245, 5.574, -10.73, 2.532, -0.215, 5.969)
_DARKEST = 1e-30  # in place of black, which has no logarithm: it absorbs all light, too
_THINNEST = 1e-4  # Cycles' least value of 1 - melanin
# Before 4.2 Cycles computes Chiang's fibres as in Blender 3.
_CHIANG_RULES = Rules.BLENDER_3 if bpy.app.version < (4, 2) else RULES


def read_hair(surface, site, weight):
    graph = surface.graph
    tangent = graph.linked(site, ("Tangent",), None)
    surface.add(
        LobeKind.HAIR,
        weight,
        surface.color(site),
        roughness=surface.share(site, ("RoughnessU",), 0.1),
        roughness_across=surface.share(site, ("RoughnessV",), 1.0),
        # Without a tangent Cycles ignores the offset on meshes.
        offset=0.0 if tangent is None else graph.parameter(site, ("Offset",), 0.0),
        tangent=_edge(graph, Coordinate.EDGE_V) if tangent is None else tangent,
        option=_TRANSMISSION if site.node.component == "Transmission" else _REFLECTION,
    )


def _edge(graph, which):
    return graph.emit(NodeKind.COORDINATE, option=which)


def read_principled_hair(surface, site, weight):
    graph, m = surface.graph, MathOperation
    is_huang = getattr(site.node, "model", "CHIANG") == "HUANG"

    def number(name, default, low=-math.inf, high=math.inf):
        return graph.parameter(site, (name,), default, low=low, high=high)

    def spread(amount):
        """Return a factor about 1 by a random number; meshes have that of the socket alone."""
        return graph.op(m.MULTIPLY_ADD, graph.op(m.MULTIPLY_ADD, number("Random", 0.0), 2.0, -1.0), amount, 1.0)

    uneven = spread(number("Random Roughness", 0.0))
    along = graph.op(m.MULTIPLY, number("Roughness", 0.3), uneven)
    if is_huang:
        # One roughness, from which the colour follows, too.
        around, across = along, number("Aspect Ratio", 0.85, 0.0)
        parts = ("R lobe", "TT lobe", "TRT lobe")
        edge = _joined(graph, tuple(number(part, 1.0, 0.0) for part in parts))
    else:
        around = across = graph.op(m.MULTIPLY, number("Radial Roughness", 0.3), uneven)
        edge = _in_first(graph, graph.subtract(1.0, graph.clamped(number("Coat", 0.0, 0.0, 1.0))))
    surface.add(
        LobeKind.HAIR_FIBRE,
        weight,
        _absorption(graph, site, number, spread, around),
        rules=RULES if is_huang else _CHIANG_RULES,
        roughness=along,
        roughness_across=across,
        edge=edge,
        ior=number("IOR", 1.55, SMALLEST_IOR),
        offset=number("Offset", math.radians(2.0)),
        tangent=_edge(graph, Coordinate.EDGE_U),
        option=_HUANG if is_huang else _CHIANG,
    )


def _in_first(graph, value):
    return value if isinstance(value, NodeRef) else (value, 0.0, 0.0)


def _joined(graph, values):
    return graph.combine(*values) if any(isinstance(value, NodeRef) for value in values) else triple(values)


def _absorption(graph, site, number, spread, around):
    """Return the absorption of a fibre by the node's way to describe it."""
    m, way = MathOperation, site.node.parametrization
    if way == "ABSORPTION":
        return graph.parameter(site, ("Absorption Coefficient",), (0.245531, 0.52, 1.365), kind="color")
    if way == "COLOR":
        return _of_reflectance(graph, graph.parameter(site, ("Color",), (0.017513, 0.005763, 0.002059), kind="color"), around)
    share = graph.op(m.MULTIPLY, number("Melanin", 0.8), spread(graph.clamped(number("Random Color", 0.0, 0.0, 1.0))))
    clear = graph.op(m.MAXIMUM, graph.op(m.SUBTRACT, 1.0, share), _THINNEST)
    melanin = graph.op(m.MULTIPLY, graph.op(m.LOGARITHM, clear, math.e), -1.0)
    redness = number("Melanin Redness", 1.0)
    red = graph.op(m.MULTIPLY, melanin, redness)
    pigment = graph.add(graph.multiply(graph.op(m.SUBTRACT, melanin, red), _EUMELANIN), graph.multiply(red, _PHEOMELANIN))
    tint = graph.parameter(site, ("Tint",), (1.0, 1.0, 1.0), kind="color")
    return graph.add(pigment, _of_reflectance(graph, tint, around))


def _of_reflectance(graph, color, around):
    m = MathOperation
    scale = _SCALE[0]
    for coefficient in _SCALE[1:]:
        scale = graph.op(m.MULTIPLY_ADD, scale, around, coefficient)

    def channel(axis):
        value = graph.component(color, axis) if isinstance(color, NodeRef) else color[axis]
        root = graph.op(m.DIVIDE, graph.op(m.LOGARITHM, graph.op(m.MAXIMUM, value, _DARKEST), math.e), scale)
        return graph.op(m.MULTIPLY, root, root)

    return _joined(graph, tuple(map(channel, range(3))))
