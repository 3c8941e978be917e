"""Nodes about the ray and the object's parts: camera, edges, islands, particles. Readers take (graph, site, output)."""

import bpy

from ..bindings.enums import AttributeFlag, Coordinate, MathOperation, NodeKind, ObjectFact, PathFact, Space, VectorOperation
from .arithmetic import THIRDS
from .coordinates import NORMALS, coordinate, named_value, spaces
from .particles import PARTICLE, random_of_particle

_SPACES = {"WORLD": Space.WORLD, "OBJECT": Space.OBJECT, "CAMERA": Space.CAMERA}
_VECTORS = {"POINT": 0, "VECTOR": 1, "NORMAL": NORMALS}
# Blender 3 takes a normal as a vector, and normalises it after the transformation, also in place.
_NORMALS_ARE_VECTORS = bpy.app.version < (4, 0)
# The attributes that the outputs of Volume Info are.
_VOLUME = {"Color": "color", "Density": "density", "Flame": "flame", "Temperature": "temperature"}


def _camera(graph, site, output):
    place, v = coordinate(graph, Coordinate.FROM_CAMERA), VectorOperation
    if output.identifier == "View Vector":
        return graph.vector_op(v.NORMALIZE, place)
    return graph.component(place, 2) if output.identifier == "View Z Depth" else graph.vector_op(v.LENGTH, place)


def _transform(graph, site, output):
    node = site.node
    value = graph.value(site, 0)
    kind = _VECTORS[node.vector_type]
    is_turned = kind == NORMALS and _NORMALS_ARE_VECTORS
    start, end = (_lamp_space(graph, _SPACES[name]) for name in (node.convert_from, node.convert_to))
    if start != end:
        option = _VECTORS["VECTOR"] if is_turned else kind
        value = graph.emit(NodeKind.VECTOR_TRANSFORM, value, option=option, flags=spaces(start, end))
    return graph.vector_op(VectorOperation.NORMALIZE, value) if is_turned else value


def _lamp_space(graph, space):
    """Return the space that Cycles means: before 4.0 lamps have no space of their own."""
    return Space.WORLD if graph.is_of_lamp and bpy.app.version < (4, 0) and space == Space.OBJECT else space


def _wireframe(graph, site, output):
    return graph.emit(NodeKind.WIREFRAME, graph.parameter(site, ("Size",), 0.01), flags=int(site.node.use_pixel_size))


def _light_falloff(graph, site, output):
    """Return the strength times a power of the ray's length, which undoes the fall by the square of the distance."""
    m = MathOperation
    strength, smooth = (graph.parameter(site, (name,), 0.0) for name in ("Strength", "Smooth"))
    length = graph.emit(NodeKind.LIGHT_PATH, option=PathFact.LENGTH)
    square = graph.op(m.MULTIPLY, length, length)
    if output.identifier != "Quadratic":
        strength = graph.op(m.MULTIPLY, strength, length if output.identifier == "Linear" else square)
    if smooth == 0.0:
        return strength
    share = graph.op(m.DIVIDE, square, graph.op(m.ADD, graph.op(m.MAXIMUM, smooth, 0.0), square))
    return graph.op(m.MULTIPLY, strength, share)


def _nothing(graph, site, output):
    """Return 0: on a mesh the facts about strands and points are 0."""
    return (0.0, 0.0, 0.0) if output.type in ("VECTOR", "RGBA") else 0.0


def _volume(graph, site, output):
    """Return the attribute of that name, which Cycles reads on meshes, too."""
    is_number = output.type != "RGBA"
    value = named_value(graph, _VOLUME[output.identifier], AttributeFlag.FIRST if is_number else 0)
    return graph.vector_op(VectorOperation.DOT_PRODUCT, value, THIRDS) if is_number else value


def _particle(graph, site, output):
    if graph.is_of_world or graph.is_of_lamp:
        return random_of_particle() if output.identifier == "Random" else _nothing(graph, site, output)
    value = graph.emit(NodeKind.OBJECT_INFO, option=ObjectFact.ATTRIBUTE, name=PARTICLE + output.identifier)
    return value if output.type == "VECTOR" else graph.component(value, 0)


READERS = {
    "CAMERA": _camera,
    "HAIR_INFO": _nothing,
    "LIGHT_FALLOFF": _light_falloff,
    "PARTICLE_INFO": _particle,
    "POINT_INFO": _nothing,
    "VECT_TRANSFORM": _transform,
    "VOLUME_INFO": _volume,
    "WIREFRAME": _wireframe,
}
