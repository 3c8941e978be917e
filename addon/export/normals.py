"""Nodes about normals: normal maps, bump, displacement, Fresnel and Layer Weight."""

import bpy

from ..bindings.enums import AttributeFlag, Coordinate, MathOperation, NodeKind, Rules, VectorOperation
from ..bindings.shading import NodeRef
from .arithmetic import is_constant
from .attributes import attribute_name, tangents_name
from .coordinates import coordinate, want_tangents
from .sockets import RULES

_SPACES = {"TANGENT": 0, "OBJECT": 1, "WORLD": 2, "BLENDER_OBJECT": 3, "BLENDER_WORLD": 4}
_FRESNEL, _FACING = 0, 1
_INVERTED, _UNDISPLACED, _FLAT_BEFORE = 1, 2, 4  # flags of BUMP
# Flag of NORMAL_MAP: from Blender 5.2 on the interpolated normal is normalised first.
_UNIT_NORMAL = 1 if bpy.app.version >= (5, 2) else 0
_WHOLE_PIXEL = 1.0  # the filter width in versions whose Bump node has no input for it
_GRAZING = 1.0  # the result of Fresnel and Layer Weight at a right angle
_ORIGIN = (0.0, 0.0, 0.0)
_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_OBJECT, _WORLD = 0, 1  # the space of a displacement's length


def _normal_map(graph, site, output):
    node = site.node
    strength, color = graph.value(site, "Strength"), graph.value(site, "Color")
    space = _SPACES.get(node.space)
    if space is None:
        return None
    if getattr(node, "convention", "OPENGL") == "DIRECTX":
        color = graph.vector_op(VectorOperation.MULTIPLY_ADD, color, (1.0, -1.0, 1.0), (0.0, 1.0, 0.0))
    if space != _SPACES["TANGENT"]:
        return graph.emit(NodeKind.NORMAL_MAP, strength, color, graph.normal, option=space)
    want_tangents(graph, node.uv_map)
    if RULES != Rules.BLENDER_3 or is_constant(strength, 1.0):
        name = attribute_name(node.uv_map)
        return graph.emit(NodeKind.NORMAL_MAP, strength, color, graph.normal, option=space, name=name, flags=_UNIT_NORMAL)
    # Blender 3 interpolates linearly from the normal to the mapped one.
    v = VectorOperation
    mapped = graph.emit(NodeKind.NORMAL_MAP, 1.0, color, graph.normal, option=space, name=attribute_name(node.uv_map))
    plain = _as_value(graph, graph.normal)
    share = graph.op(MathOperation.MAXIMUM, strength, 0.0)
    way = graph.vector_op(v.SCALE, graph.vector_op(v.SUBTRACT, mapped, plain), scale=share)
    return graph.vector_op(v.NORMALIZE, graph.vector_op(v.ADD, plain, way))


def _bump(graph, site, output):
    normal = graph.linked(site, ("Normal",), graph.normal)
    if not graph.is_linked(site, ("Height",)):
        return _as_value(graph, normal)
    strength, distance = graph.value(site, "Strength"), graph.value(site, "Distance")
    width = graph.parameter(site, ("Filter Width",), _WHOLE_PIXEL)
    first, height = graph.height_nodes(lambda: graph.value(site, "Height"))
    return _as_value(graph, bump(graph, first, height, strength, distance, normal, width, site.node.invert))


def _as_value(graph, normal):
    """Return a normal as a vector for nodes that compute with it: the surface's own is no node's result."""
    return normal if isinstance(normal, NodeRef) else coordinate(graph, Coordinate.SHADING_NORMAL)


def bump(graph, first, height, strength, distance, normal, width, invert=False, undisplaced=False):
    """Return the normal bumped by a height; undisplaced evaluates the height on the surface before true displacement."""
    # An even height changes no normal but one after displacement, which becomes the one before.
    if not isinstance(height, NodeRef) and not undisplaced:
        return normal
    flags = (_INVERTED if invert else 0) | (_UNDISPLACED if undisplaced else 0)
    if undisplaced and bpy.app.version >= (5, 0):
        flags |= _FLAT_BEFORE
    return graph.emit(NodeKind.BUMP, strength, distance, height, normal, width, first=first, flags=flags)


def _fresnel(graph, site, output):
    normal = _against_view(graph, site)
    return _GRAZING if normal is None else graph.emit(NodeKind.FRESNEL, graph.value(site, "IOR"), normal)


def _layer_weight(graph, site, output):
    option = _FRESNEL if output.identifier == "Fresnel" else _FACING
    normal = _against_view(graph, site)
    return _GRAZING if normal is None else graph.emit(NodeKind.LAYER_WEIGHT, graph.value(site, "Blend"), normal, option=option)


def _against_view(graph, site):
    """Return the normal that is compared with the view; None if 0 is linked, which makes a right angle with any direction."""
    normal = graph.linked(site, ("Normal",), None)
    return graph.normal if normal is None else None if is_constant(normal, 0.0) else normal


def _displacement(graph, site, output):
    values = (graph.value(site, name) for name in ("Height", "Midlevel", "Scale"))
    normal = graph.linked(site, ("Normal",), _ORIGIN)
    return graph.emit(NodeKind.DISPLACEMENT, *values, normal, option=_WORLD if site.node.space == "WORLD" else _OBJECT)


def _vector_displacement(graph, site, output):
    vector, midlevel, scale = (graph.value(site, name) for name in ("Vector", "Midlevel", "Scale"))
    v = VectorOperation
    middle = graph.combine(midlevel, midlevel, midlevel)
    offset = graph.vector_op(v.SCALE, graph.vector_op(v.SUBTRACT, vector, middle), scale=scale)
    if site.node.space == "WORLD":
        return _to_object(graph, offset)
    return _from_tangents(graph, offset) if site.node.space == "TANGENT" else offset


def _to_object(graph, vector):
    """Return a displacement vector from world space in object space."""
    result = _ORIGIN
    for number, axis in enumerate(_AXES):
        height = graph.component(vector, number)
        along = graph.emit(NodeKind.DISPLACEMENT, height, 0.0, 1.0, axis, option=_WORLD)
        result = graph.add(result, along)
    return result


def _from_tangents(graph, vector):
    """Return a vector with components along tangent, normal and bitangent, in this order, in object space."""
    v = VectorOperation
    want_tangents(graph, "")
    tangent = graph.emit(NodeKind.ATTRIBUTE, name=tangents_name(""), flags=AttributeFlag.STILL)
    normal = graph.emit(NodeKind.DISPLACEMENT, 1.0, 0.0, 1.0, _ORIGIN, option=_OBJECT)
    turned = graph.vector_op(v.NORMALIZE, graph.vector_op(v.CROSS_PRODUCT, normal, tangent))
    bitangent = graph.vector_op(v.SCALE, turned, scale=graph.emit(NodeKind.ALPHA, tangent))
    result = _ORIGIN
    for number, axis in enumerate((tangent, normal, bitangent)):
        result = graph.add(result, graph.vector_op(v.SCALE, axis, scale=graph.component(vector, number)))
    return result


def displacement_height(graph, site, socket):
    """Return the distance along the normal by which the displacement linked to a socket moves the surface."""
    m, v = MathOperation, VectorOperation
    origin = graph.origin(site, socket)
    if origin.site is None:
        return 0.0
    node = origin.site.node
    if node.type == "DISPLACEMENT":
        height, midlevel, scale = (graph.value(origin.site, name) for name in ("Height", "Midlevel", "Scale"))
        height = graph.op(m.MULTIPLY, graph.op(m.SUBTRACT, height, midlevel), scale)
        return height if node.space == "WORLD" else graph.op(m.MULTIPLY, height, _stretch(graph))
    offset = graph.input(site, socket)
    if not isinstance(offset, NodeRef):
        return 0.0
    if node.type != "VECTOR_DISPLACEMENT":
        return graph.vector_op(v.DOT_PRODUCT, offset, coordinate(graph, Coordinate.SHADING_NORMAL))
    along = graph.emit(NodeKind.DISPLACEMENT, 1.0, 0.0, 1.0, _ORIGIN, option=_OBJECT)
    return graph.op(m.MULTIPLY, graph.vector_op(v.DOT_PRODUCT, offset, along), _stretch(graph))


def _stretch(graph):
    """Return the world-space length along the normal of a unit step along the object-space normal."""
    steps = (graph.emit(NodeKind.DISPLACEMENT, 1.0, 0.0, 1.0, _ORIGIN, option=option) for option in (_OBJECT, _WORLD))
    return graph.op(MathOperation.DIVIDE, 1.0, graph.vector_op(VectorOperation.DOT_PRODUCT, *steps))


READERS = {
    "BUMP": _bump,
    "DISPLACEMENT": _displacement,
    "FRESNEL": _fresnel,
    "LAYER_WEIGHT": _layer_weight,
    "NORMAL_MAP": _normal_map,
    "VECTOR_DISPLACEMENT": _vector_displacement,
}
