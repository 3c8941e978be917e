"""Nodes about the point where a ray meets a surface: coordinates, attributes, geometry."""

import bpy
import numpy as np
from mathutils import Euler

from ..bindings.enums import AttributeFlag, Coordinate, MappingType, NodeKind, ObjectFact, PathFact, Space, VectorOperation
from ..bindings.shading import NodeRef
from ..host.by_scene import identity
from .arithmetic import THIRDS, divide
from .attributes import ISLANDS, POINTINESS, RENDER_COLOR, attribute_name, tangents_name
from .instancer_places import place_name
from .maths import transformed
from .object_attributes import LAMPS_ARE_OBJECTS, PREFIXES
from .properties import view_layer_value

_RADIAL = {"X": 0, "Y": 1, "Z": 2}
ALONG_U = 3
# Flag of TANGENT for the world: its tangent is 0; since 5.2, a direction across the ray.
_TANGENT_OF_WORLD = 1 if bpy.app.version < (5, 2) else 2
# Names of attributes that Cycles computes itself.
_UNREAD = {"N", "generated_transform", "tangent", "tangent_sign"}
if bpy.app.version < (4, 5):
    _UNREAD |= {"Ng", "undisplaced"}
_TANGENTS = (".tangent", ".tangent_sign")
# Option of VECTOR_TRANSFORM.
NORMALS = 2
_LAMPS_HAVE_UV = bpy.app.version >= (4, 0)
# Before 4.5 a bump does not see how the normal of texture coordinates changes.
_NORMAL_FLAGS = int(bpy.app.version < (4, 5))

_TEXTURE_COORDINATES = {
    "Generated": Coordinate.GENERATED,
    "Normal": Coordinate.NORMAL,
    "UV": Coordinate.UV,
    "Object": Coordinate.OBJECT,
    "Camera": Coordinate.CAMERA,
    "Window": Coordinate.WINDOW,
    "Reflection": Coordinate.REFLECTION,
}
_GEOMETRY = {
    "Position": Coordinate.POSITION,
    "Normal": Coordinate.SHADING_NORMAL,
    "True Normal": Coordinate.TRUE_NORMAL,
    "Incoming": Coordinate.INCOMING,
    "Parametric": Coordinate.PARAMETRIC,
    "Backfacing": Coordinate.BACKFACING,
}
_COMPUTED = {"Pointiness": POINTINESS, "Random Per Island": ISLANDS}
_OBJECT_FACTS = {
    "Location": ObjectFact.LOCATION,
    "Color": ObjectFact.COLOR,
    "Alpha": ObjectFact.COLOR,
    "Object Index": ObjectFact.INDEX,
    "Random": ObjectFact.RANDOM,
}
_PATH_FACTS = {
    "Is Camera Ray": PathFact.IS_CAMERA,
    "Is Shadow Ray": PathFact.IS_SHADOW,
    "Is Diffuse Ray": PathFact.IS_DIFFUSE,
    "Is Glossy Ray": PathFact.IS_GLOSSY,
    "Is Singular Ray": PathFact.IS_SINGULAR,
    "Is Reflection Ray": PathFact.IS_REFLECTION,
    "Is Transmission Ray": PathFact.IS_TRANSMISSION,
    "Is Volume Scatter Ray": PathFact.IS_VOLUME,
    "Ray Length": PathFact.LENGTH,
    "Ray Depth": PathFact.DEPTH,
    "Diffuse Depth": PathFact.DIFFUSE_DEPTH,
    "Glossy Depth": PathFact.GLOSSY_DEPTH,
    "Transparent Depth": PathFact.TRANSPARENT_DEPTH,
    "Transmission Depth": PathFact.TRANSMISSION_DEPTH,
    "Portal Depth": PathFact.PORTAL_DEPTH,
}


def spaces(start, end):
    """Return the flags of VECTOR_TRANSFORM from one Space to another."""
    return start | end << 2


def coordinate(graph, which, name=""):
    if graph.is_of_lamp:
        return _of_lamp(graph, which, name)
    if which == Coordinate.GENERATED:
        graph.attributes.add("generated")
    if which == Coordinate.UV and name:
        graph.attributes.add(attribute_name(name))
    return graph.emit(NodeKind.COORDINATE, option=which, name=attribute_name(name))


def _of_lamp(graph, which, name):
    """Return a coordinate at a point of a lamp, which before 4.5 is no object, and before 4.0 has no UV map."""
    if which in (Coordinate.GENERATED, Coordinate.OBJECT):
        which = Coordinate.OBJECT if LAMPS_ARE_OBJECTS else Coordinate.POSITION
    elif which == Coordinate.UV:
        if name or not _LAMPS_HAVE_UV:
            return 0.0, 0.0, 0.0
        which = Coordinate.PARAMETRIC
    elif which == Coordinate.REFLECTION and not LAMPS_ARE_OBJECTS:
        which = Coordinate.INCOMING
    elif which == Coordinate.CAMERA and not LAMPS_ARE_OBJECTS:
        place = graph.emit(NodeKind.COORDINATE, option=Coordinate.POSITION)
        return graph.emit(NodeKind.VECTOR_TRANSFORM, place, option=1, flags=spaces(Space.WORLD, Space.CAMERA))
    return graph.emit(NodeKind.COORDINATE, option=which)


def _texture_coordinate(graph, site, output):
    node = site.node
    which = _TEXTURE_COORDINATES.get(output.identifier)
    if which is None:
        return None
    if node.from_instancer and which in (Coordinate.GENERATED, Coordinate.UV):
        return _on_instancer(graph, which)
    if which == Coordinate.NORMAL:
        if isinstance(graph.normal, NodeRef):
            return graph.emit(NodeKind.DISPLACEMENT, 1.0, 0.0, 1.0, graph.normal)
        return graph.emit(NodeKind.COORDINATE, option=which, flags=_NORMAL_FLAGS)
    if which == Coordinate.REFLECTION and isinstance(graph.normal, NodeRef):
        incoming = coordinate(graph, Coordinate.INCOMING)
        v = VectorOperation
        return graph.vector_op(v.REFLECT, graph.vector_op(v.SCALE, incoming, scale=-1.0), graph.normal)
    if which != Coordinate.OBJECT or node.object is None:
        return coordinate(graph, which)
    graph.objects.add(identity(node.object))
    thing = node.object if graph.depsgraph is None else node.object.evaluated_get(graph.depsgraph)
    matrix = np.array(thing.matrix_world, float)
    if not np.isfinite(matrix).all() or np.linalg.det(matrix[:3, :3]) == 0.0:
        graph.tell(site, f"object '{node.object.name}' has no usable transform, the object's own coordinates are used")
        return coordinate(graph, which)
    inverse = np.linalg.inv(matrix)[:3]
    return graph.emit(NodeKind.COORDINATE, option=which, flags=1, matrix=inverse.ravel())


def _uv_map(graph, site, output):
    if site.node.from_instancer:
        return _on_instancer(graph, Coordinate.UV)
    return coordinate(graph, Coordinate.UV, site.node.uv_map)


def _on_instancer(graph, which):
    name = place_name(which)
    if graph.is_of_world:
        return 0.0, 0.0, 0.0
    if graph.is_of_lamp:
        return (0.0, 0.0, 0.0) if graph.lamp_value is None else tuple(graph.lamp_value(name)[:3])
    return graph.emit(NodeKind.OBJECT_INFO, option=ObjectFact.ATTRIBUTE, name=name)


def named_value(graph, name, flags=0):
    # Cycles gives this name to Generated coordinates, even if the mesh has an attribute of that name.
    if name == "generated":
        return coordinate(graph, Coordinate.GENERATED)
    if name in (ISLANDS, POINTINESS):
        graph.attributes.add(name)
        return graph.emit(NodeKind.ATTRIBUTE, name=name, flags=int(flags))
    if name:
        graph.attributes.add(attribute_name(name))
    return graph.emit(NodeKind.ATTRIBUTE, name=attribute_name(name), flags=int(flags))


def _attribute(graph, site, output):
    node = site.node
    name, is_alpha = node.attribute_name, output.identifier == "Alpha"
    if node.attribute_type != "GEOMETRY":
        return _property(graph, node, output)
    if not name:
        return 1.0 if is_alpha else 0.0 if output.identifier == "Fac" else (0.0, 0.0, 0.0)
    if name in _UNREAD or name.endswith(_TANGENTS):
        return None
    if is_alpha:
        if name == "vertex_color":
            return _render_alpha(graph, AttributeFlag.OPAQUE)
        # The world has no attributes: Cycles 5.2 takes the mean of a direction for its alpha.
        if name == "generated" and graph.is_of_world and bpy.app.version >= (5, 2):
            return graph.vector_op(VectorOperation.DOT_PRODUCT, coordinate(graph, Coordinate.GENERATED), THIRDS)
        return (
            1.0 if name in ("uv", "generated") else graph.emit(NodeKind.ALPHA, named_value(graph, name, AttributeFlag.OPAQUE))
        )
    is_number = output.identifier == "Fac"
    if name == "uv":
        value = coordinate(graph, Coordinate.UV)
        return graph.component(value, 0) if is_number else value
    value = named_value(graph, "" if name == "vertex_color" else name, AttributeFlag.FIRST if is_number else 0)
    return graph.vector_op(VectorOperation.DOT_PRODUCT, value, THIRDS) if is_number else value


def _property(graph, node, output):
    """Return a property of an object, an instancer or the view layer. The last, and all of a lamp, are constants."""
    kind, name = node.attribute_type, node.attribute_name
    found = None
    if kind == "VIEW_LAYER":
        graph.reads_layer = True
        found = (0.0,) * 4 if graph.depsgraph is None else view_layer_value(graph.depsgraph, name)
    elif graph.lamp_value is not None:
        found = graph.lamp_value(PREFIXES[kind] + name)
    if found is not None:
        value, alpha = found[:3], found[3]
    else:
        value = graph.emit(NodeKind.OBJECT_INFO, option=ObjectFact.ATTRIBUTE, name=PREFIXES[kind] + name)
        alpha = graph.emit(NodeKind.ALPHA, value)
    if output.identifier == "Alpha":
        return alpha
    return graph.vector_op(VectorOperation.DOT_PRODUCT, value, THIRDS) if output.identifier == "Fac" else value


def _vertex_color(graph, site, output):
    name = site.node.layer_name
    # A name that Cycles computes an attribute for hides a mesh's own one, and is no colour.
    if name in (ISLANDS, POINTINESS):
        return 0.0 if output.identifier == "Alpha" else (0.0, 0.0, 0.0)
    if output.identifier != "Alpha":
        return named_value(graph, name)
    return graph.emit(NodeKind.ALPHA, named_value(graph, name)) if name else _render_alpha(graph)


def _render_alpha(graph, flags=0):
    """Return the alpha of the rendered colours, a separate attribute: the core keeps a mesh's own colours without alpha."""
    graph.attributes.add(RENDER_COLOR)
    return graph.emit(NodeKind.ALPHA, graph.emit(NodeKind.ATTRIBUTE, name=RENDER_COLOR, flags=int(flags)))


def _geometry(graph, site, output):
    name = output.identifier
    if name == "Tangent":
        return default_tangent(graph)
    if name == "Normal" and isinstance(graph.normal, NodeRef):
        return graph.normal
    which = _GEOMETRY.get(name)
    return graph.component(named_value(graph, _COMPUTED[name]), 0) if which is None else coordinate(graph, which)


def default_tangent(graph):
    """Return the tangent around the object's z axis, Cycles' default for anisotropic surfaces."""
    if graph.is_of_lamp:
        return 0.0, 0.0, 0.0
    graph.attributes.add("generated")
    return graph.emit(NodeKind.TANGENT, graph.normal, option=_RADIAL["Z"], flags=_TANGENT_OF_WORLD)


def _tangent(graph, site, output):
    node = site.node
    if graph.is_of_lamp:
        return 0.0, 0.0, 0.0
    if node.direction_type == "RADIAL":
        graph.attributes.add("generated")
        return graph.emit(NodeKind.TANGENT, graph.normal, option=_RADIAL[node.axis])
    want_tangents(graph, node.uv_map)
    return graph.emit(NodeKind.TANGENT, graph.normal, option=ALONG_U, name=attribute_name(node.uv_map))


def want_tangents(graph, uv_map):
    graph.attributes.add(tangents_name(uv_map))
    if uv_map:
        graph.attributes.add(attribute_name(uv_map))


def _mapping(graph, site, output):
    kind = MappingType[site.node.vector_type]
    vector, angles, scale = (graph.value(site, name) for name in ("Vector", "Rotation", "Scale"))
    moves = kind in (MappingType.POINT, MappingType.TEXTURE)
    location = graph.value(site, "Location") if moves else (0.0, 0.0, 0.0)
    if kind == MappingType.NORMAL or any(isinstance(value, NodeRef) for value in (location, angles, scale)):
        return graph.emit(NodeKind.MAPPING, vector, location, angles, scale, option=kind)
    return transformed(graph, vector, mapping_matrix(kind, location, angles, scale))


def mapping_matrix(kind, location, angles, scale):
    """Return the rows of the 3 x 4 matrix of a Mapping node; division by a scale of 0 gives 0, as in Cycles."""
    rows = Euler(angles).to_matrix()
    if kind != MappingType.TEXTURE:
        return [(*(row[k] * scale[k] for k in range(3)), location[i]) for i, row in enumerate(rows)]
    linear = [[divide(rows[k][i], scale[i]) for k in range(3)] for i in range(3)]
    return [(*row, -sum(x * y for x, y in zip(row, location, strict=True))) for row in linear]


def _object_info(graph, site, output):
    if output.identifier == "Material Index":
        return float(graph.material_index)
    if graph.lamp_value is not None:
        found = graph.lamp_value(output.identifier)
        return found[:3] if output.type in ("VECTOR", "RGBA") else found[3] if output.identifier == "Alpha" else found[0]
    value = graph.emit(NodeKind.OBJECT_INFO, option=_OBJECT_FACTS[output.identifier])
    return graph.emit(NodeKind.ALPHA, value) if output.identifier == "Alpha" else value


def _light_path(graph, site, output):
    return graph.emit(NodeKind.LIGHT_PATH, option=_PATH_FACTS[output.identifier])


READERS = {
    "ATTRIBUTE": _attribute,
    "LIGHT_PATH": _light_path,
    "MAPPING": _mapping,
    "NEW_GEOMETRY": _geometry,
    "OBJECT_INFO": _object_info,
    "TANGENT": _tangent,
    "TEX_COORD": _texture_coordinate,
    "UVMAP": _uv_map,
    "VERTEX_COLOR": _vertex_color,
}
