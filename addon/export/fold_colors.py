"""Colours in other terms, and the modes in which two of them are mixed, as Blender's nodes define them."""

import math

from ..bindings.enums import MixMode
from .arithmetic import clamp, divide, each, fraction, mix, scalar, triple


def to_hsv(color):
    r, g, b = color
    high, low = max(color), min(color)
    span = high - low
    saturation = divide(span, high)
    if saturation == 0.0:
        return 0.0, 0.0, high
    if r == high:
        hue = (g - b) / span
    elif g == high:
        hue = 2.0 + (b - r) / span
    else:
        hue = 4.0 + (r - g) / span
    return fraction(hue / 6.0), saturation, high


def from_hsv(hsv):
    h, s, v = hsv
    if s == 0.0:
        return v, v, v
    sixth = 6.0 * (0.0 if h == 1.0 else h)
    index = math.floor(sixth)
    f = sixth - index
    p, q, t = v * (1.0 - s), v * (1.0 - s * f), v * (1.0 - s * (1.0 - f))
    return ((v, t, p), (q, v, p), (p, v, t), (p, q, v), (t, p, v))[index] if 0 <= index < 5 else (v, p, q)


def to_hsl(color):
    high, low = max(color), min(color)
    light = min(0.5 * (high + low), 1.0)
    if high == low:
        return 0.0, 0.0, light
    span = high - low
    return to_hsv(color)[0], divide(span, 2.0 - high - low if light > 0.5 else high + low), light


def from_hsl(hsl):
    h, s, light = hsl
    full = (abs(6.0 * h - 3.0) - 1.0, 2.0 - abs(6.0 * h - 2.0), 2.0 - abs(6.0 * h - 4.0))
    chroma = (1.0 - abs(2.0 * light - 1.0)) * s
    return tuple((clamp(x) - 0.5) * chroma + light for x in full)


def _overlay(t, a, b):
    if a < 0.5:
        return a * (1.0 - t + 2.0 * t * b)
    return 1.0 - (1.0 - t + 2.0 * t * (1.0 - b)) * (1.0 - a)


def _dodge(t, a, b):
    rest = 1.0 - t * b
    if a == 0.0:
        return 0.0
    return 1.0 if rest <= 0.0 else min(a / rest, 1.0)


def _burn(t, a, b):
    rest = 1.0 - t + t * b
    return 0.0 if rest <= 0.0 else clamp(1.0 - (1.0 - a) / rest)


def _soft_light(t, a, b):
    screen = 1.0 - (1.0 - b) * (1.0 - a)
    return mix(t, a, (1.0 - a) * b * a + a * screen)


_MIX_CHANNELS = {
    MixMode.MIX: mix,
    MixMode.DARKEN: lambda t, a, b: mix(t, a, min(a, b)),
    MixMode.MULTIPLY: lambda t, a, b: mix(t, a, a * b),
    MixMode.BURN: _burn,
    MixMode.LIGHTEN: lambda t, a, b: mix(t, a, max(a, b)),
    MixMode.SCREEN: lambda t, a, b: 1.0 - (1.0 - t + t * (1.0 - b)) * (1.0 - a),
    MixMode.DODGE: _dodge,
    MixMode.ADD: lambda t, a, b: a + t * b,
    MixMode.OVERLAY: _overlay,
    MixMode.SOFT_LIGHT: _soft_light,
    MixMode.LINEAR_LIGHT: lambda t, a, b: a + t * (2.0 * b - 1.0),
    MixMode.DIFFERENCE: lambda t, a, b: mix(t, a, abs(a - b)),
    MixMode.EXCLUSION: lambda t, a, b: max(mix(t, a, a + b - 2.0 * a * b), 0.0),
    MixMode.SUBTRACT: lambda t, a, b: a - t * b,
    MixMode.DIVIDE: lambda t, a, b: mix(t, a, a / b) if b != 0.0 else a,
}


def _mix_hsv(mode, t, a, b):
    """The modes that take hue, saturation or value of the second colour."""
    first, second = to_hsv(a), to_hsv(b)
    if mode == MixMode.SATURATION:
        return from_hsv((first[0], mix(t, first[1], second[1]), first[2])) if first[1] != 0.0 else a
    if mode == MixMode.VALUE:
        return from_hsv((first[0], first[1], mix(t, first[2], second[2])))
    if second[1] == 0.0:
        return a
    turned = (second[0], first[1] if mode == MixMode.HUE else second[1], first[2])
    return each(lambda x, y: mix(t, x, y), a, from_hsv(turned))


def fold_mix(node, inputs):
    factor, a, b = scalar(inputs[0]), triple(inputs[1]), triple(inputs[2])
    if node.flags & 1:
        factor = clamp(factor)
    if node.option in _MIX_CHANNELS:
        result = each(_MIX_CHANNELS[node.option], factor, a, b)
    else:
        result = _mix_hsv(node.option, factor, a, b)
    return each(clamp, result, 0.0, 1.0) if node.flags & 2 else result
