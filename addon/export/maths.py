"""Value and vector nodes: each reader takes (graph, site, output) and returns a value, or None if it is not supported."""

from mathutils import Euler, Matrix, Vector

from ..bindings.enums import MappingType, MathOperation, NodeKind, VectorOperation
from ..bindings.shading import NodeRef
from ..messages.severity import Severity
from . import cycles_folds
from .sockets import EVALUATES_CONSTANTS

_AXES = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}
# Operations on vectors that apply an operation on numbers to each channel.
_PER_CHANNEL = {name: MathOperation[name] for name in ("POWER", "ROUND", "SIGN", "WRAP")}
# Operations on vectors whose changes over a pixel Cycles follows to images with mipmaps, and the core does not.
_UNFOLLOWED = ("POWER", "REFRACT", "WRAP")


def _value(graph, site, output):
    return float(output.default_value)


def _bool(graph, site, output):
    return float(site.node.boolean)


def _integer(graph, site, output):
    return float(site.node.integer)


def _constant_vector(graph, site, output):
    return tuple(map(float, site.node.vector))


def _scene_time(graph, site, output):
    """Return the frame or its time in seconds: a property of the scene, and the same for all samples."""
    graph.reads_layer = graph.reads_time = True
    if graph.depsgraph is None:
        return 0.0
    scene = graph.depsgraph.scene_eval
    frame = scene.frame_current_final
    return frame if output.identifier == "Frame" else frame * scene.render.fps_base / scene.render.fps


def _math(graph, site, output):
    operation = MathOperation.__members__.get(site.node.operation)
    if operation is None:
        return None
    values = [graph.input(site, socket) for socket in site.node.inputs]
    kept = cycles_folds.of_math(operation, *values[:2])
    if kept is None:
        return graph.op(operation, *values, clamped=site.node.use_clamp)
    return graph.clamped(kept) if site.node.use_clamp else kept


def _vector_math(graph, site, output):
    name = site.node.operation
    a, b, c = (graph.input(site, socket) for socket in site.node.inputs[:3])
    scale = graph.input(site, site.node.inputs[3])
    if name in _UNFOLLOWED and graph.images is not None and graph.images.texture_cache is not None:
        text = f"images in the texture cache whose coordinates come from {name.title()} are sharper than in Cycles"
        graph.tell(site, text, "", Severity.HINT)
    if name in _PER_CHANNEL:
        return graph.combine(*(graph.op(_PER_CHANNEL[name], *(graph.component(v, i) for v in (a, b, c))) for i in range(3)))
    if name == "FACEFORWARD":
        dot = graph.vector_op(VectorOperation.DOT_PRODUCT, c, b)
        sign = graph.op(MathOperation.MULTIPLY_ADD, graph.op(MathOperation.LESS_THAN, dot, 0.0), 2.0, -1.0)
        return graph.vector_op(VectorOperation.SCALE, a, scale=sign)
    if name == "REFRACT":
        return _refract(graph, a, b, scale)
    operation = VectorOperation.__members__.get(name)
    if operation is None:
        return None
    kept = cycles_folds.of_vector_math(operation, a, b, scale)
    return graph.vector_op(operation, a, b, c, scale=scale) if kept is None else kept


def _refract(graph, incident, normal, eta):
    """Return eta i - (eta n.i + sqrt k) n with k = 1 - eta^2 (1 - (n.i)^2); 0 if k is negative."""
    m = MathOperation
    n = graph.vector_op(VectorOperation.NORMALIZE, normal)
    cosine = graph.vector_op(VectorOperation.DOT_PRODUCT, n, incident)
    sine2 = graph.op(m.SUBTRACT, 1.0, graph.op(m.MULTIPLY, cosine, cosine))
    k = graph.op(m.SUBTRACT, 1.0, graph.op(m.MULTIPLY, graph.op(m.MULTIPLY, eta, eta), sine2))
    along = graph.op(m.ADD, graph.op(m.MULTIPLY, eta, cosine), graph.op(m.SQRT, k))
    onward = graph.vector_op(VectorOperation.SCALE, incident, scale=eta)
    bent = graph.vector_op(VectorOperation.SUBTRACT, onward, graph.vector_op(VectorOperation.SCALE, n, scale=along))
    exists = graph.op(m.SUBTRACT, 1.0, graph.op(m.LESS_THAN, k, 0.0))
    return graph.vector_op(VectorOperation.SCALE, bent, scale=exists)


def _clamp(graph, site, output):
    value, low, high = (graph.input(site, socket) for socket in site.node.inputs[:3])
    if site.node.clamp_type == "RANGE":
        return _in_range(graph, value, low, high)
    return graph.emit(NodeKind.CLAMP, value, low, high)


def _map_range(graph, site, output):
    node = site.node
    if getattr(node, "data_type", "FLOAT") == "FLOAT":
        names = ("Value", "From Min", "From Max", "To Min", "To Max", "Steps")
        values = [graph.value(site, name) if name != "Steps" or node.interpolation_type == "STEPPED" else 4.0 for name in names]
        if _is_evaluated(values):
            return _mapped(graph, node, values, True)
        _, start, end, *to, _ = values
        if not isinstance(start, NodeRef) and start == end:
            return _in_range(graph, 0.0, *to) if node.clamp else 0.0
        result = _mapped(graph, node, values)
        if not isinstance(start, NodeRef) and not isinstance(end, NodeRef):
            return result
        # Cycles gives 0 where the range is empty.
        m = MathOperation
        differs = graph.op(m.ADD, graph.op(m.LESS_THAN, start, end), graph.op(m.GREATER_THAN, start, end))
        result = graph.op(m.MULTIPLY, result, differs)
        return _in_range(graph, result, *to) if node.clamp else result
    names = ("Vector", "From_Min_FLOAT3", "From_Max_FLOAT3", "To_Min_FLOAT3", "To_Max_FLOAT3", "Steps_FLOAT3")
    values = [
        graph.value(site, name) if name != names[-1] or node.interpolation_type == "STEPPED" else (4.0,) * 3 for name in names
    ]
    evaluated = _is_evaluated(values)
    channels = ([graph.component(value, i) for value in values] for i in range(3))
    return graph.combine(*(_mapped(graph, node, numbers, evaluated) for numbers in channels))


def _is_evaluated(values):
    """Whether Blender evaluates a node of these inputs, before Cycles reads it."""
    return EVALUATES_CONSTANTS and not any(isinstance(value, NodeRef) for value in values)


def _mapped(graph, node, values, evaluated=False):
    """Return a mapped number. evaluated: by Blender, which also divides by a negative number of steps."""
    m = MathOperation
    value, from_low, from_high, to_low, to_high, steps = values
    kind = node.interpolation_type
    t = graph.op(m.DIVIDE, graph.op(m.SUBTRACT, value, from_low), graph.op(m.SUBTRACT, from_high, from_low))
    if kind == "STEPPED":
        reached = graph.op(m.FLOOR, graph.op(m.MULTIPLY, t, graph.op(m.ADD, steps, 1.0)))
        t = graph.op(m.DIVIDE, reached, steps)
        if not evaluated:
            t = graph.op(m.MULTIPLY, t, graph.op(m.GREATER_THAN, steps, 0.0))
    elif kind in ("SMOOTHSTEP", "SMOOTHERSTEP"):
        t = _smooth_step(graph, graph.emit(NodeKind.CLAMP, t, 0.0, 1.0), kind == "SMOOTHERSTEP")
    result = graph.op(m.MULTIPLY_ADD, t, graph.op(m.SUBTRACT, to_high, to_low), to_low)
    return _in_range(graph, result, to_low, to_high) if node.clamp and kind in ("LINEAR", "STEPPED") else result


def _in_range(graph, value, first, last):
    """Clamp a number between two limits in any order."""
    low, high = graph.op(MathOperation.MINIMUM, first, last), graph.op(MathOperation.MAXIMUM, first, last)
    return graph.emit(NodeKind.CLAMP, value, low, high)


def _smooth_step(graph, t, twice=False):
    """Return t^2 (3 - 2 t), or if twice t^3 (t (6 t - 15) + 10), for t between 0 and 1."""
    m = MathOperation
    square = graph.op(m.MULTIPLY, t, t)
    if not twice:
        return graph.op(m.MULTIPLY, square, graph.op(m.MULTIPLY_ADD, t, -2.0, 3.0))
    inner = graph.op(m.MULTIPLY_ADD, t, graph.op(m.MULTIPLY_ADD, t, 6.0, -15.0), 10.0)
    return graph.op(m.MULTIPLY, graph.op(m.MULTIPLY, square, t), inner)


def _combine(graph, site, output):
    return graph.combine(*(graph.input(site, socket) for socket in site.node.inputs[:3]))


def _separate(graph, site, output):
    return graph.component(graph.input(site, site.node.inputs[0]), list(site.node.outputs).index(output))


def _normal(graph, site, output):
    direction = tuple(Vector(site.node.outputs[0].default_value).normalized())
    if output.identifier == "Normal":
        return direction
    towards = graph.vector_op(VectorOperation.NORMALIZE, graph.input(site, site.node.inputs[0]))
    return graph.vector_op(VectorOperation.DOT_PRODUCT, direction, towards)


def _rotate(graph, site, output):
    node = site.node
    vector, center = graph.value(site, "Vector"), graph.value(site, "Center")
    if node.rotation_type == "EULER_XYZ":
        turn = (graph.value(site, "Rotation"),)
        rows = None if isinstance(turn[0], NodeRef) else Euler(turn[0]).to_matrix()
    else:
        angle = graph.value(site, "Angle")
        axis = graph.value(site, "Axis") if node.rotation_type == "AXIS_ANGLE" else _AXES[node.rotation_type[0]]
        turn = axis, graph.op(MathOperation.MULTIPLY, angle, -1.0) if node.invert else angle
        rows = None
        if not isinstance(angle, NodeRef) and not isinstance(axis, NodeRef):
            rows = Matrix.Rotation(angle, 3, axis) if any(axis) else Matrix.Identity(3)
    v = VectorOperation
    if rows is None or isinstance(center, NodeRef):
        arm = graph.vector_op(v.SUBTRACT, vector, center)
        turned = _turned(graph, arm, *turn) if len(turn) == 2 else _turned_by_angles(graph, arm, *turn, node.invert)
        return graph.vector_op(v.ADD, turned, center)
    if node.invert:
        rows.transpose()
    moved = [center[i] - sum(rows[i][k] * center[k] for k in range(3)) for i in range(3)]
    return transformed(graph, vector, [(*rows[i], moved[i]) for i in range(3)])


def _turned_by_angles(graph, vector, angles, invert):
    """Return a vector rotated around x, y and z, or back."""
    kind = MappingType.TEXTURE if invert else MappingType.POINT
    return graph.emit(NodeKind.MAPPING, vector, (0.0,) * 3, angles, (1.0,) * 3, option=kind)


def _turned(graph, vector, axis, angle):
    """Return v cos a + (k x v) sin a + k (k.v) (1 - cos a) of the unit axis k; v if the axis is 0."""
    m, v = MathOperation, VectorOperation
    length = graph.vector_op(v.LENGTH, axis)
    angle = graph.op(m.MULTIPLY, angle, graph.op(m.GREATER_THAN, length, 0.0))
    unit = graph.vector_op(v.NORMALIZE, axis)
    cosine = graph.op(m.COSINE, angle)
    along = graph.op(m.MULTIPLY, graph.vector_op(v.DOT_PRODUCT, unit, vector), graph.op(m.SUBTRACT, 1.0, cosine))
    across = graph.vector_op(v.SCALE, graph.vector_op(v.CROSS_PRODUCT, unit, vector), scale=graph.op(m.SINE, angle))
    kept = graph.vector_op(v.ADD, graph.vector_op(v.SCALE, vector, scale=cosine), across)
    return graph.vector_op(v.ADD, kept, graph.vector_op(v.SCALE, unit, scale=along))


def transformed(graph, vector, rows):
    """Return a 3 x 4 matrix, given by its rows, times a vector."""
    flat = [float(x) for row in rows for x in row]
    if flat == [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]:
        return vector
    if not isinstance(vector, NodeRef):
        return tuple(sum(row[k] * x for k, x in enumerate((*vector, 1.0))) for row in rows)
    return graph.emit(NodeKind.TRANSFORM, vector, matrix=flat)


READERS = {
    "CLAMP": _clamp,
    "COMBXYZ": _combine,
    "INPUT_BOOL": _bool,
    "INPUT_INT": _integer,
    "INPUT_SCENE_TIME": _scene_time,
    "INPUT_VECTOR": _constant_vector,
    "MAP_RANGE": _map_range,
    "MATH": _math,
    "NORMAL": _normal,
    "SEPXYZ": _separate,
    "VALUE": _value,
    "VECTOR_ROTATE": _rotate,
    "VECT_MATH": _vector_math,
}
