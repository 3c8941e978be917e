"""Curves of colours, vectors and numbers as tables with Cycles' resolution. Readers take (graph, site, output)."""

import bpy
import numpy as np

from ..bindings.enums import MixMode, NodeKind
from ..bindings.shading import NodeRef
from .arithmetic import clamp, mix
from .sockets import EVALUATES_CONSTANTS

_STEPS = 256
# Number of values: before 4.0, the number of steps; since then one more, so that the last value is at the end of the last step.
_VALUES = _STEPS + int(bpy.app.version >= (4, 0))
_EXTRAPOLATES, _STEPPED = 1, 2
_OF_NUMBER = 1
_ROUNDING = 1e-4  # of positions, in steps of the table: single precision keeps 2e-5


def _ready(mapping):
    mapping.initialize()
    return mapping


def _ends(curves):
    """Return the interval over which the curves have points, which the table covers."""
    return min(curve.points[0].location[0] for curve in curves), max(curve.points[-1].location[0] for curve in curves)


def _curved(graph, mapping, functions, curves, factor, value):
    """Emit a table of functions[i](x) in channel i over the interval of curves."""
    low, high = _ends(curves)
    places = low + np.arange(_VALUES) / (_VALUES - 1) * (high - low)
    table = np.array([[function(x) for function in functions] for x in places.tolist()], np.float32)
    flags = _EXTRAPOLATES if mapping.extend == "EXTRAPOLATED" else 0
    return graph.emit(
        NodeKind.CURVES, factor, value, image=graph.table(table), image_count=1, flags=flags, matrix=(low, high, *(0.0,) * 10)
    )


def _rgb(graph, site, output):
    factor, color = (graph.input(site, socket) for socket in site.node.inputs[:2])
    mapping = _ready(site.node.mapping)
    *channels, combined = mapping.curves[:4]
    functions = [lambda x, c=c: mapping.evaluate(c, mapping.evaluate(combined, x)) for c in channels]
    if isinstance(color, NodeRef):
        return _curved(graph, mapping, functions, mapping.curves[:4], factor, color)
    curved = tuple(float(function(x)) for function, x in zip(functions, color, strict=True))
    return graph.emit(NodeKind.MIX, factor, color, curved, option=MixMode.MIX)


def _vector(graph, site, output):
    factor, vector = (graph.value(site, number) for number in (0, 1))
    mapping = _ready(site.node.mapping)
    functions = [lambda x, c=c: mapping.evaluate(c, x) for c in mapping.curves[:3]]
    if isinstance(vector, NodeRef) or isinstance(factor, NodeRef):
        return _curved(graph, mapping, functions, mapping.curves[:3], factor, vector)
    return tuple(mix(factor, x, float(function(x))) for function, x in zip(functions, vector, strict=True))


def _number(graph, site, output):
    factor, value = (graph.value(site, number) for number in (0, 1))
    mapping = _ready(site.node.mapping)

    def function(x):
        return mapping.evaluate(mapping.curves[0], x)

    if isinstance(value, NodeRef) or isinstance(factor, NodeRef):
        return _curved(graph, mapping, [function], mapping.curves[:1], factor, value)
    curved = float(function(value))
    if EVALUATES_CONSTANTS and mapping.use_clip:
        curved = clamp(curved, mapping.clip_min_y, mapping.clip_max_y)
    return mix(factor, value, curved)


def needs_table(ramp):
    """Whether Cycles' table of a ramp differs from lines or steps between its stops, which may lie between values."""
    if ramp.color_mode != "RGB" or ramp.interpolation not in ("LINEAR", "CONSTANT"):
        return True
    places = np.array([stop.position for stop in ramp.elements]) * (_VALUES - 1)
    return bool(np.abs(places - np.round(places)).max() > _ROUNDING)


def ramp_by_table(graph, ramp, factor, is_alpha):
    """Return a colour ramp of any interpolation and colour mode at a factor that varies."""
    places = (np.arange(_VALUES) / (_VALUES - 1)).tolist()
    table = np.array([tuple(ramp.evaluate(x)) for x in places], np.float32)
    flags = _STEPPED if ramp.interpolation == "CONSTANT" else 0
    matrix = (0.0, 1.0, *(0.0,) * 10)
    value = graph.emit(
        NodeKind.CURVES, 1.0, factor, option=_OF_NUMBER, image=graph.table(table), image_count=1, flags=flags, matrix=matrix
    )
    return graph.emit(NodeKind.ALPHA, value) if is_alpha else value


def constant_of_ramp(ramp, place):
    """Return the colour and alpha of a ramp at a constant place: before 5.0 by Cycles' table."""
    if EVALUATES_CONSTANTS:
        return tuple(ramp.evaluate(place))
    last = _VALUES - 1
    number = min(int(place * last), last)
    first = tuple(ramp.evaluate(number / last))
    if ramp.interpolation == "CONSTANT" or number == last:
        return first
    second = ramp.evaluate((number + 1) / last)
    return tuple(mix(place * last - number, x, y) for x, y in zip(first, second, strict=True))


READERS = {"CURVE_FLOAT": _number, "CURVE_RGB": _rgb, "CURVE_VEC": _vector}
