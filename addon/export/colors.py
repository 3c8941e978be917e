"""Colour nodes: each reader takes (graph, site, output) and returns a value, or None if the node is not supported."""

import functools
import math

from mathutils import Color

from ..bindings.enums import ColorModel, MathOperation, MixMode, NodeKind, VectorOperation
from ..bindings.shading import NodeRef
from . import cycles_folds
from .arithmetic import clamp, each, is_constant, triple
from .curves import constant_of_ramp, needs_table, ramp_by_table

_MODELS = {"HSV": (ColorModel.TO_HSV, ColorModel.FROM_HSV), "HSL": (ColorModel.TO_HSL, ColorModel.FROM_HSL)}
_COLDEST, _HOTTEST = 800.0, 12000.0  # kelvin; temperatures are clamped to this range
# Rec. 709 colours of black bodies as polynomials, constants first, in the logarithm of the temperature mapped to -1 (coldest)
# to 1 (hottest). Fitted to Blender's colours; the error is at most 8e-4 of the larger of 1 and the channel.
_GLOW = (
    (1.72398, 0.85585, 0.29827), (-1.90935, 0.45323, 1.12889), (1.51980, -0.52949, 0.72547), (-0.61215, 0.23330, -0.47111),
    (0.02951, 0.04540, -0.38149), (0.23415, -0.09815, 0.22852), (-0.19899, 0.02570, 0.10929), (-0.00728, 0.01068, -0.06209),
    (0.04678, -0.00206, -0.00932),
)  # fmt: skip


def _rgb(graph, site, output):
    return tuple(float(c) for c in output.default_value[:3])


def _mixed(graph, mode, factor, a, b, clamp_factor, clamp_result):
    """Return a mix of colours; a and b return theirs when called, so that the colour that is not seen is not read."""
    mode = MixMode.__members__.get(mode)
    if mode is None:
        return None
    if clamp_factor and not isinstance(factor, NodeRef):
        factor = clamp(factor)
    if not clamp_result and cycles_folds.first_of_mix(mode, factor):
        return a()
    if not clamp_result and mode == MixMode.MIX and is_constant(factor, 1.0):
        return b()
    a, b = a(), b()
    kept = None if clamp_result else cycles_folds.of_mix(mode, factor, a, b)
    if kept is not None:
        return kept
    return graph.emit(NodeKind.MIX, factor, a, b, option=mode, flags=int(clamp_factor) + 2 * int(clamp_result))


def _mix_rgb(graph, site, output):
    factor, *colors = (functools.partial(graph.input, site, socket) for socket in site.node.inputs[:3])
    return _mixed(graph, site.node.blend_type, factor(), *colors, True, site.node.use_clamp)


def _mix(graph, site, output):
    node = site.node
    if node.data_type == "RGBA":
        factor, *colors = (functools.partial(graph.value, site, name) for name in ("Factor_Float", "A_Color", "B_Color"))
        return _mixed(graph, node.blend_type, factor(), *colors, node.clamp_factor, node.clamp_result)
    if node.data_type not in ("FLOAT", "VECTOR"):
        return None
    suffix = "_Float" if node.data_type == "FLOAT" else "_Vector"
    varied = node.data_type == "VECTOR" and node.factor_mode == "NON_UNIFORM"
    factor = graph.value(site, "Factor_Vector" if varied else "Factor_Float")
    if node.clamp_factor and not isinstance(factor, NodeRef):
        factor = each(clamp, factor) if isinstance(factor, tuple) else clamp(factor)
    if not varied and is_constant(factor, 0.0):
        return graph.value(site, "A" + suffix)
    if not varied and is_constant(factor, 1.0):
        return graph.value(site, "B" + suffix)
    a, b = graph.value(site, "A" + suffix), graph.value(site, "B" + suffix)
    if not varied and isinstance(a, NodeRef) and a == b:
        return a
    m, v = MathOperation, VectorOperation
    if node.data_type == "FLOAT":
        factor = graph.op(m.ADD, factor, 0.0, clamped=True) if node.clamp_factor else factor
        return graph.op(m.MULTIPLY_ADD, factor, graph.op(m.SUBTRACT, b, a), a)
    factor = factor if isinstance(factor, (NodeRef, tuple)) else (factor,) * 3
    if node.clamp_factor:
        factor = graph.vector_op(v.MAXIMUM, graph.vector_op(v.MINIMUM, factor, (1.0,) * 3), (0.0,) * 3)
    return graph.vector_op(v.MULTIPLY_ADD, factor, graph.vector_op(v.SUBTRACT, b, a), a)


def _gamma(graph, site, output):
    return graph.emit(NodeKind.GAMMA, *(graph.input(site, socket) for socket in site.node.inputs[:2]))


def _invert(graph, site, output):
    factor, color = (graph.input(site, socket) for socket in site.node.inputs[:2])
    return color if is_constant(factor, 0.0) else graph.emit(NodeKind.INVERT, factor, color)


def _grey(graph, site, output):
    return graph.grey(graph.input(site, site.node.inputs[0]))


def _brightness(graph, site, output):
    color, bright, contrast = (graph.input(site, socket) for socket in site.node.inputs[:3])
    factor = graph.op(MathOperation.ADD, contrast, 1.0)
    offset = graph.op(MathOperation.MULTIPLY_ADD, contrast, -0.5, bright)
    scaled = graph.vector_op(VectorOperation.MULTIPLY_ADD, color, *(_spread(x) for x in (factor, offset)))
    return graph.vector_op(VectorOperation.MAXIMUM, scaled, (0.0,) * 3)


def _spread(value):
    return value if isinstance(value, NodeRef) else triple(value)


def _hue_saturation(graph, site, output):
    hue, saturation, value, factor, color = (graph.input(site, socket) for socket in site.node.inputs[:5])
    m = MathOperation
    h, s, v = _separated(graph, ColorModel.TO_HSV, color)
    h = graph.op(m.FRACT, graph.op(m.ADD, graph.op(m.ADD, h, hue), 0.5))
    s = graph.op(m.MULTIPLY, s, saturation, clamped=True)
    turned = graph.emit(NodeKind.COLOR_MODEL, graph.combine(h, s, graph.op(m.MULTIPLY, v, value)), option=ColorModel.FROM_HSV)
    result = graph.emit(NodeKind.MIX, factor, color, turned, option=MixMode.MIX)
    return graph.vector_op(VectorOperation.MAXIMUM, result, (0.0,) * 3)


def _separated(graph, model, color):
    converted = graph.emit(NodeKind.COLOR_MODEL, color, option=model)
    return [graph.component(converted, i) for i in range(3)]


def _combine_color(graph, site, output):
    mode = getattr(site.node, "mode", "HSV" if site.node.type == "COMBHSV" else "RGB")
    value = graph.combine(*(graph.input(site, socket) for socket in site.node.inputs[:3]))
    if mode == "RGB":
        return value
    return graph.emit(NodeKind.COLOR_MODEL, value, option=_MODELS[mode][1])


def _separate_color(graph, site, output):
    mode = getattr(site.node, "mode", "HSV" if site.node.type == "SEPHSV" else "RGB")
    index = list(site.node.outputs).index(output)
    color = graph.input(site, site.node.inputs[0])
    if mode == "RGB":
        return graph.component(color, index)
    return _separated(graph, _MODELS[mode][0], color)[index]


def _ramp(graph, site, output):
    """Mix in the stops one after the other: each segment starts at the stop where the one before ends."""
    node = site.node
    ramp = node.color_ramp
    factor = graph.input(site, node.inputs[0])
    is_alpha = output.identifier == "Alpha"
    if not isinstance(factor, NodeRef):
        color = constant_of_ramp(ramp, clamp(factor))
        return color[3] if is_alpha else color[:3]
    if needs_table(ramp):
        return ramp_by_table(graph, ramp, factor, is_alpha)
    stops = [(stop.position, (stop.color[3],) * 3 if is_alpha else tuple(stop.color[:3])) for stop in ramp.elements]
    m = MathOperation
    result = stops[0][1]
    for (start, _), (end, color) in zip(stops, stops[1:]):  # noqa: B905
        if ramp.interpolation == "CONSTANT" or end <= start:
            share = graph.op(m.SUBTRACT, 1.0, graph.op(m.LESS_THAN, factor, end))
        else:
            scale = 1.0 / (end - start)
            share = graph.op(m.MULTIPLY_ADD, factor, scale, -start * scale, clamped=True)
        result = graph.mix(share, result, color)
    return graph.component(result, 0) if is_alpha else result


def _blackbody(graph, site, output):
    m, v = MathOperation, VectorOperation
    kelvin = graph.emit(NodeKind.CLAMP, graph.input(site, site.node.inputs[0]), _COLDEST, _HOTTEST)
    scale = 2.0 / math.log(_HOTTEST / _COLDEST)
    place = graph.op(m.MULTIPLY_ADD, graph.op(m.LOGARITHM, kelvin, math.e), scale, -1.0 - scale * math.log(_COLDEST))
    *others, color = (tuple(Color(coefficients).from_rec709_linear_to_scene_linear()) for coefficients in _GLOW)
    for coefficients in reversed(others):
        color = graph.vector_op(v.MULTIPLY_ADD, color, _spread(place), coefficients)
    return graph.vector_op(v.MAXIMUM, color, (0.0,) * 3)


READERS = {
    "BLACKBODY": _blackbody,
    "BRIGHTCONTRAST": _brightness,
    "COMBHSV": _combine_color,
    "COMBINE_COLOR": _combine_color,
    "COMBRGB": _combine_color,
    "GAMMA": _gamma,
    "HUE_SAT": _hue_saturation,
    "INVERT": _invert,
    "MIX": _mix,
    "MIX_RGB": _mix_rgb,
    "RGB": _rgb,
    "RGBTOBW": _grey,
    "SEPARATE_COLOR": _separate_color,
    "SEPHSV": _separate_color,
    "SEPRGB": _separate_color,
    "VALTORGB": _ramp,
}
