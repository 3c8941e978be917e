"""The Point Density of Blender before 5.0: a cube of voxels around the points of a mesh or of a particle system.

Surfaces show it before Blender 4.0; from then on Cycles computes it in volumes alone.
"""

import bpy
import numpy as np

from ..bindings.enums import Coordinate, Interpolation, NodeKind, Space
from ..host.by_scene import identity
from ..host.machine_memory import machine_memory
from ..messages.severity import Severity
from .coordinates import coordinate, spaces
from .maths import transformed

_IS_FOR_VOLUMES = bpy.app.version >= (4, 0)
# The core's largest image has as many rows as a cube of this side.
_LARGEST_SIDE = 1024
# Blender returns the four numbers of a voxel as objects of Python, each with its place in a tuple.
_BYTES_OF_VOXEL = 4 * 32
_OF_PANELS = np.zeros((1, 1, 4), np.float32)


class _Unread(Exception):
    """A node whose voxels are all 0, with the reason."""

    def __init__(self, reason, severity=Severity.HINT):
        super().__init__(reason)
        self.severity = severity


def _point_density(graph, site, output):
    is_number = output.identifier == "Density"
    try:
        value = _value(graph, site)
    except _Unread as error:
        graph.tell(site, f"{error}, 0 is used", "", error.severity)
        return 0.0 if is_number else (0.0, 0.0, 0.0)
    return graph.emit(NodeKind.ALPHA, value) if is_number else value


def _value(graph, site):
    if _IS_FOR_VOLUMES:
        raise _Unread("is for volumes alone in this Blender")
    if graph.is_of_world or graph.is_of_lamp:
        raise _Unread("is for meshes alone; Cycles' value in a world or a light is random", Severity.DIFFERENT)
    voxels, low, high = _cube(graph, site.node)
    place = _in_object(graph, site) if site.node.space == "OBJECT" else _in_bounds(graph, site, low, high)
    option = Interpolation[site.node.interpolation.upper()]
    return graph.emit(NodeKind.VOXELS, place, option=option, image=graph.grid(voxels), image_count=1)


def _cube(graph, node):
    """Return the voxels of a node, (n * n, n, 4), and two opposite corners of their cube in the space of its object."""
    if graph.depsgraph is None:
        return _OF_PANELS, (0.0,) * 3, (1.0,) * 3
    _check(node, graph.depsgraph.mode == "RENDER")
    graph.reads_time = graph.reads_time or node.point_source == "PARTICLE_SYSTEM"
    side = node.resolution
    try:
        # As Cycles does. The last call frees what the first has made.
        node.cache_point_density(depsgraph=graph.depsgraph)
        low, high = node.calc_point_density_minmax(depsgraph=graph.depsgraph)
        values = node.calc_point_density(depsgraph=graph.depsgraph)
        voxels = np.array(values, np.float32).reshape(side * side, side, 4)
    except (MemoryError, RuntimeError, ValueError) as error:
        raise _Unread(f"object '{node.object.name}' gives no voxels: {error}", Severity.WRONG) from None
    if not all(a < b for a, b in zip(low, high, strict=True)):
        raise _Unread(f"the points of object '{node.object.name}' have no extent")
    return voxels, low, high


def _check(node, is_render):
    """Raise _Unread for a node without points, of which Blender returns what the memory holds, and for a cube too large."""
    thing, side = node.object, node.resolution
    if thing is None:
        raise _Unread("has no object")
    if node.point_source == "OBJECT":
        if thing.type != "MESH" or not thing.data.vertices:
            raise _Unread(f"object '{thing.name}' has no vertices")
    elif not _shown(thing, node.particle_system, is_render):
        raise _Unread(f"object '{thing.name}' shows no such particle system")
    if side > _LARGEST_SIDE or _BYTES_OF_VOXEL * side**3 > machine_memory() / 2:
        raise _Unread(f"object '{thing.name}': a resolution of {side} needs more memory than there is", Severity.WRONG)


def _shown(thing, system, is_render):
    """Whether a particle system is there and switched on."""
    shows = "show_render" if is_render else "show_viewport"
    return system is not None and any(
        getattr(modifier, shows)
        for modifier in thing.modifiers
        if modifier.type == "PARTICLE_SYSTEM" and modifier.particle_system == system
    )


def _in_object(graph, site):
    """Return the place in the space of the object that is seen; beside a volume, in its texture space."""
    vector = graph.linked(site, ("Vector",), None)
    if vector is None and graph.has_volume:
        return coordinate(graph, Coordinate.GENERATED)
    if graph.has_volume:
        graph.tell(site, "a linked place is not brought into the texture space of an object with a volume")
    return graph.emit(NodeKind.VECTOR_TRANSFORM, _place(graph, vector), flags=spaces(Space.WORLD, Space.OBJECT))


def _in_bounds(graph, site, low, high):
    """Return the place in the bounds of the points, in the space of their object."""
    inverse = np.eye(3, 4)
    if graph.depsgraph is not None:
        graph.objects.add(identity(site.node.object))
        matrix = np.array(site.node.object.matrix_world, float)
        if not np.isfinite(matrix).all() or np.linalg.det(matrix[:3, :3]) == 0.0:
            raise _Unread(f"object '{site.node.object.name}' has no usable transform", Severity.WRONG)
        inverse = np.linalg.inv(matrix)[:3]
    low, size = np.array(low), np.subtract(high, low)
    rows = (inverse - np.pad(low[:, None], ((0, 0), (3, 0)))) / size[:, None]
    return transformed(graph, _place(graph, graph.linked(site, ("Vector",), None)), rows)


def _place(graph, vector):
    return coordinate(graph, Coordinate.POSITION) if vector is None else vector


READERS = {"TEX_POINTDENSITY": _point_density}
