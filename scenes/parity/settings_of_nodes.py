"""Mix, Mix Color and Map Range in each of their settings, of values that vary and of constants, also outside their ranges."""

import bpy

from .boards import set_board, size_of, tile_mesh
from .catalogue import case, variants

_BLENDS = [item.identifier for item in bpy.types.ShaderNodeMixRGB.bl_rna.properties["blend_type"].enum_items]
_KINDS = ("varying", "constant")


def _colors(nodes):
    """Two colours between 0 and about 1.2, and a factor between about -0.7 and 1.7, over the tile."""
    place = nodes.add("ShaderNodeTexCoord").outputs["Generated"]
    noise = [nodes.add("ShaderNodeTexNoise", Vector=place, Scale=scale, Detail=0.0) for scale in (4.0, 7.0, 5.0)]
    dark = nodes.add("ShaderNodeVectorMath", noise[0].outputs["Color"], (0.3, 0.3, 0.3), props={"operation": "SUBTRACT"})
    wide = nodes.add("ShaderNodeVectorMath", dark.outputs[0], (2.0, 2.0, 2.0), props={"operation": "MULTIPLY"})
    factor = nodes.add("ShaderNodeMath", noise[2].outputs[0], 6.0, -2.5, props={"operation": "MULTIPLY_ADD"})
    return wide.outputs[0], noise[1].outputs["Color"], factor.outputs[0]


def _given(nodes, kind):
    return _colors(nodes) if kind == "varying" else ((0.9, 0.05, 0.4), (0.2, 0.7, 0.6), 1.3)


def _board(scene, tiles):
    """Shows values from -1 to 3 between 0 and 1."""

    def seen(value):
        def shown(nodes):
            quarter = (0.25, 0.25, 0.25)
            props = {"operation": "MULTIPLY_ADD"}
            return nodes.add("ShaderNodeVectorMath", value(nodes), quarter, quarter, props=props).outputs[0]

        return shown

    set_board(scene, [(tile_mesh(), seen(value)) for value in tiles])


def _socket(sockets, identifier):
    return next(socket for socket in sockets if socket.identifier == identifier)


def _mixed(kind, **props):
    def value(nodes):
        a, b, factor = _given(nodes, kind)
        node = nodes.add("ShaderNodeMix", props=props)
        end = {"RGBA": "Color", "VECTOR": "Vector", "FLOAT": "Float"}[props["data_type"]]
        varied = props["data_type"] == "VECTOR" and props.get("factor_mode") == "NON_UNIFORM"
        if end == "Float" and kind == "constant":
            a, b = a[0], b[0]
        if varied and kind == "constant":
            factor = (1.3, 0.4, -0.5)
        elif varied:
            factor = nodes.add("ShaderNodeCombineXYZ", factor, 0.4, a).outputs[0]
        for name, x in (("Factor_Vector" if varied else "Factor_Float", factor), (f"A_{end}", a), (f"B_{end}", b)):
            nodes.give(_socket(node.inputs, name), x)
        return _socket(node.outputs, f"Result_{end}")

    return value


def _mixed_rgb(kind, **props):
    def value(nodes):
        a, b, factor = _given(nodes, kind)
        return nodes.add("ShaderNodeMixRGB", factor, a, b, props=props).outputs[0]

    return value


_SWITCH = (False, True)
_MIXES = {
    "colors": [
        _mixed("varying", data_type="RGBA", blend_type=blend, clamp_factor=factor, clamp_result=result)
        for blend in _BLENDS for factor in _SWITCH for result in _SWITCH
    ],
    "constant_colors": [
        _mixed("constant", data_type="RGBA", blend_type=blend, clamp_factor=factor, clamp_result=result)
        for blend in _BLENDS for factor in _SWITCH for result in _SWITCH
    ],
    "numbers_and_vectors": [
        *(_mixed(kind, data_type="FLOAT", clamp_factor=clamp) for kind in _KINDS for clamp in _SWITCH),
        *(
            _mixed(kind, data_type="VECTOR", clamp_factor=clamp, factor_mode=mode)
            for kind in _KINDS for clamp in _SWITCH for mode in ("UNIFORM", "NON_UNIFORM")
        ),
    ],
    "old_colors": [
        _mixed_rgb(kind, blend_type=blend, use_clamp=clamp) for kind in _KINDS for blend in _BLENDS for clamp in _SWITCH
    ],
}  # fmt: skip


@variants(
    values={
        name: (tiles, {"size": size_of(len(tiles)), "quick": name == "numbers_and_vectors"}) for name, tiles in _MIXES.items()
    },
    bounces=0,
)
def mix_settings(scene, tiles):
    """All data types, blend types, factor modes and clamps, with factors outside 0 to 1."""
    _board(scene, tiles)


# Ranges, from and to, and steps.
_RANGES = {
    "plain": (0.2, 0.7, 0.1, 0.9, 4.0),
    "reversed": (0.7, 0.2, 0.9, 0.1, 4.0),
    "falling": (0.2, 0.7, 0.9, 0.1, 3.5),
    "empty": (0.4, 0.4, 0.2, 0.8, 4.0),
    "no steps": (0.2, 0.7, 0.1, 0.9, 0.0),
    "less steps": (0.2, 0.7, 0.1, 0.9, -2.0),
    "flat": (0.2, 0.7, 0.6, 0.6, 4.0),
}
_NAMES = ("From Min", "From Max", "To Min", "To Max", "Steps")
_VECTOR_NAMES = ("From_Min_FLOAT3", "From_Max_FLOAT3", "To_Min_FLOAT3", "To_Max_FLOAT3", "Steps_FLOAT3")


def _ranged(kind, spans, linked=False, **props):
    def value(nodes):
        color, other, _ = _colors(nodes)
        numbers = _RANGES[spans]
        node = nodes.add("ShaderNodeMapRange", props=props)
        is_vector = props["data_type"] == "FLOAT_VECTOR"
        given = color if kind == "varying" else (0.31, 0.55, 0.9) if is_vector else 0.31
        nodes.give(_socket(node.inputs, "Vector" if is_vector else "Value"), given)
        for name, x in zip(_VECTOR_NAMES if is_vector else _NAMES, numbers, strict=True):
            if name.startswith("Steps") and props["interpolation_type"] != "STEPPED":
                continue
            shifted = (x, x + 0.05, x) if is_vector and spans != "empty" else (x,) * 3
            if linked:
                moved = nodes.add("ShaderNodeVectorMath", other, shifted, props={"operation": "MULTIPLY"}).outputs[0]
            else:
                moved = shifted if is_vector else x
            nodes.give(_socket(node.inputs, name), moved)
        return next(socket for socket in node.outputs if socket.enabled)

    return value


_INTERPOLATIONS = ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP")


def _ranges(data_type):
    return [
        *(
            _ranged(kind, spans, data_type=data_type, interpolation_type=interpolation, clamp=clamp)
            for kind in _KINDS for spans in _RANGES for interpolation in _INTERPOLATIONS for clamp in _SWITCH
        ),
        *(
            _ranged("varying", "plain", True, data_type=data_type, interpolation_type=interpolation, clamp=clamp)
            for interpolation in _INTERPOLATIONS for clamp in _SWITCH
        ),
    ]  # fmt: skip


_RANGED = {"numbers": _ranges("FLOAT"), "vectors": _ranges("FLOAT_VECTOR")}


@variants(
    values={name: (tiles, {"size": size_of(len(tiles)), "quick": name == "numbers"}) for name, tiles in _RANGED.items()},
    bounces=0,
)
def map_range_settings(scene, tiles):
    """All data types, interpolations and clamps; ranges that fall, are reversed, empty, flat or linked; steps of any number."""
    _board(scene, tiles)


def _clamped(kind, bounds, mode):
    def value(nodes):
        color, other, factor = _colors(nodes)
        low, high = bounds if bounds is not None else (other, 0.6)
        return nodes.add(
            "ShaderNodeClamp", factor if kind == "varying" else 1.7, low, high, props={"clamp_type": mode}
        ).outputs[0]

    return value


_CLAMPS = [
    _clamped(kind, bounds, mode)
    for kind in _KINDS for bounds in ((0.2, 0.8), (0.8, 0.2), (0.5, 0.5), None) for mode in ("MINMAX", "RANGE")
]  # fmt: skip


@case(size=size_of(len(_CLAMPS)), bounces=0, quick=True)
def clamp_settings(scene):
    """Both types, with limits in order, out of order, equal and linked."""
    _board(scene, _CLAMPS)


# ---- nodes of constants, which Blender 5 evaluates before Cycles reads them ----

_MATHS = [item.identifier for item in bpy.types.ShaderNodeMath.bl_rna.properties["operation"].enum_items]
_VECTOR_MATHS = [item.identifier for item in bpy.types.ShaderNodeVectorMath.bl_rna.properties["operation"].enum_items]
_NEED_POSITIVE = ("POWER", "MODULO")  # their results are not finite elsewhere
_TRIPLES = ((0.7, 0.3, 0.2), (-0.6, 0.0, 0.5), (1.4, -0.4, 0.0), (-0.8, 2.0, -0.3))


def _maths(values, **props):
    def value(nodes):
        result = nodes.add("ShaderNodeMath", *values, props=props)
        scale = 0.01 if props["operation"] == "DEGREES" else 1.0
        return nodes.add("ShaderNodeMath", result, scale, props={"operation": "MULTIPLY"}).outputs[0]

    return value


def _vector_maths(number, operation):
    def value(nodes):
        vectors = [_TRIPLES[(number + k) % len(_TRIPLES)] for k in range(3)]
        if operation in _NEED_POSITIVE:
            vectors = [tuple(abs(x) + 0.1 for x in vector) for vector in vectors]
        node = nodes.add("ShaderNodeVectorMath", props={"operation": operation})
        for socket, x in zip(node.inputs, (*vectors, _TRIPLES[number][1]), strict=True):
            nodes.give(socket, x)
        return next(socket for socket in node.outputs if socket.enabled)

    return value


def _of(kind, *inputs, output=0, props=None):
    def value(nodes):
        return nodes.add(kind, *inputs, props=props).outputs[output]

    return value


_COLORS = ((0.9, 0.05, 0.4), (0.3, 0.3, 0.3), (-0.2, 0.6, 1.5))
_TURNS = ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ")
_MAPPINGS = ("POINT", "TEXTURE", "VECTOR", "NORMAL")
_MODES = ("RGB", "HSV", "HSL")
_TURNED = {"Center": (0.1, 0.2, 0.3), "Axis": (0.3, -0.4, 0.8), "Angle": 0.7, "Rotation": (0.4, 1.1, -0.6)}


def _turned(mode, invert, **inputs):
    def value(nodes):
        node = nodes.add("ShaderNodeVectorRotate", props={"rotation_type": mode, "invert": invert})
        for socket in node.inputs:
            if socket.enabled and socket.name in inputs:
                nodes.give(socket, inputs[socket.name])
        return node.outputs[0]

    return value


def _mapped(mode, scale):
    def value(nodes):
        props = {"vector_type": mode}
        inputs = {"Vector": (0.5, -0.3, 0.8), "Rotation": (0.4, 1.1, -0.6), "Scale": scale}
        return nodes.add("ShaderNodeMapping", props=props, **inputs).outputs[0]

    return value


def _curved(kind, color, factor):
    def value(nodes):
        node = nodes.add(kind, factor, color)
        for number, curve in enumerate(node.mapping.curves):
            curve.points.new(0.4, 0.2 + 0.2 * number)
        node.mapping.update()
        return node.outputs[0]

    return value


def _ramped(mode, interpolation, place, output):
    def value(nodes):
        node = nodes.add("ShaderNodeValToRGB", place)
        ramp = node.color_ramp
        ramp.color_mode, ramp.interpolation = mode, interpolation
        for element, color in zip(ramp.elements, ((0.9, 0.2, 0.1, 0.5), (0.1, 0.3, 0.8, 1.0)), strict=True):
            element.color = color
        ramp.elements.new(0.6).color = (0.2, 0.9, 0.3, 0.2)
        return node.outputs[output]

    return value


_CONSTANTS = {
    "maths": [_maths(triple, operation=name) for name in _MATHS for triple in _TRIPLES]
    + [_maths(triple, operation="ADD", use_clamp=True) for triple in _TRIPLES],
    "vector_maths": [_vector_maths(number, name) for name in _VECTOR_MATHS for number in range(4)],
    "colors": [
        tile
        for color in _COLORS
        for tile in (
            _of("ShaderNodeGamma", color, 2.2),
            _of("ShaderNodeGamma", color, 0.4),
            _of("ShaderNodeInvert", 0.7, color),
            _of("ShaderNodeInvert", 1.6, color),
            _of("ShaderNodeBrightContrast", color, 0.2, 0.6),
            _of("ShaderNodeBrightContrast", color, -0.7, -0.3),
            _of("ShaderNodeHueSaturation", 0.8, 1.7, 0.8, 0.9, color),
            _of("ShaderNodeHueSaturation", 0.1, 0.4, 1.8, 1.4, color),
            _of("ShaderNodeRGBToBW", color),
            *(_of("ShaderNodeSeparateColor", color, output=k, props={"mode": mode}) for mode in _MODES for k in range(3)),
            *(_of("ShaderNodeCombineColor", *color, props={"mode": mode}) for mode in _MODES),
        )
    ],
    "vectors": [
        *(_turned(mode, invert, Vector=(0.5, -0.3, 0.8), **_TURNED) for mode in _TURNS for invert in _SWITCH),
        _turned("AXIS_ANGLE", False, Vector=(0.5, -0.3, 0.8), **{**_TURNED, "Axis": (0.0, 0.0, 0.0)}),
        *(
            _mapped(mode, scale)
            for mode in _MAPPINGS for scale in ((1.5, 0.7, -1.2), (0.0, 1.0, 0.5))
        ),
        *(_of("ShaderNodeNormal", (0.5, -0.3, 0.8), output=k) for k in range(2)),
    ],
    "curves": [
        *(_curved("ShaderNodeRGBCurve", color, fac) for color in _COLORS for fac in (1.0, 0.6, 1.4)),
        *(_curved("ShaderNodeVectorCurve", color, fac) for color in _COLORS for fac in (1.0, 0.6, 1.4)),
        *(_curved("ShaderNodeFloatCurve", x, fac) for x in (-0.3, 0.5, 1.4) for fac in (1.0, 0.6, 1.4)),
        *(
            _ramped(mode, interpolation, place, output)
            for mode in _MODES for interpolation in ("LINEAR", "EASE", "CONSTANT", "B_SPLINE", "CARDINAL")
            for place in (-0.2, 0.37, 0.6, 0.85) for output in range(2)
        ),
    ],
    "blackbody": [_of("ShaderNodeBlackbody", t) for t in (-10.0, 500.0, 1500.0, 3300.0, 6500.0, 20000.0)],
}  # fmt: skip


def _curved_colors(kind, factor):
    """Curves of colours that vary, by a factor that varies if it is None."""

    def value(nodes):
        color, _, varying = _colors(nodes)
        return _curved(kind, color, varying if factor is None else factor)(nodes)

    return value


def _turned_by(mode, invert, *linked):
    """A rotation whose inputs of these names vary, and whose vector does if there are none."""

    def value(nodes):
        color, other, factor = _colors(nodes)
        given = {"Center": color, "Axis": other, "Angle": factor, "Rotation": color}
        inputs = {name: given[name] if name in linked else x for name, x in _TURNED.items()}
        return _turned(mode, invert, Vector=(0.5, -0.3, 0.8) if linked else color, **inputs)(nodes)

    return value


def _zero_axis(nodes):
    zero = nodes.add("ShaderNodeVectorMath", _colors(nodes)[0], (0.0, 0.0, 0.0), props={"operation": "MULTIPLY"})
    return _turned("AXIS_ANGLE", False, Vector=(0.5, -0.3, 0.8), **{**_TURNED, "Axis": zero})(nodes)


_LINKED = {mode: ("Angle", "Center") for mode in _TURNS[1:4]}
_LINKED |= {"AXIS_ANGLE": ("Angle", "Axis", "Center"), "EULER_XYZ": ("Rotation", "Center")}
_ROTATIONS = [
    *(_turned_by(mode, invert, name) for mode in _TURNS for invert in _SWITCH for name in _LINKED[mode]),
    *(_turned_by(mode, invert, *names) for mode in _TURNS for invert in _SWITCH for names in (_LINKED[mode], ())),
    _zero_axis,
]


@case(size=size_of(len(_ROTATIONS)), bounces=0, quick=True)
def varying_rotations(scene):
    """Vector Rotate of each type with inputs that vary, one at a time and together, and an axis of 0."""
    _board(scene, _ROTATIONS)


_VARYING = [
    _curved_colors(f"ShaderNode{kind}Curve", factor) for kind in ("RGB", "Vector", "Float") for factor in (1.0, 0.6, 1.4, None)
]


@case(size=size_of(len(_VARYING)), bounces=0, quick=True)
def varying_curves(scene):
    """Curves of colours, vectors and numbers that vary, also beyond the curves, with factors beyond 0 to 1."""
    _board(scene, _VARYING)


@variants(
    values={name: (tiles, {"size": size_of(len(tiles)), "quick": name == "curves"}) for name, tiles in _CONSTANTS.items()},
    bounces=0,
)
def constant(scene, tiles):
    """Nodes of constants: every operation of Math and Vector Math, colours, rotations, curves and ramps."""
    _board(scene, tiles)
