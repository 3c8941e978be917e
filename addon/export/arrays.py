"""Arrays of Blender's meshes, read where the running Blender stores them, and their values at the corners of triangles."""

import ctypes

import numpy as np

_TRIANGLES_AT_ONCE = 1 << 18
_SAMPLE = 8


def read(collection, attribute, dtype, width):
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, width) if width > 1 else values


def look(collection, attribute, dtype, width):
    """Return the values of read(), as a view where Blender stores them in one plain array. The view ends when the mesh changes.

    The array counts as plain if its stride is the size of a value and a sample of its values equals those of Blender's API.
    """
    count, size = len(collection), np.dtype(dtype).itemsize * width
    if count < 2:
        return read(collection, attribute, dtype, width)
    first, last = collection[0].as_pointer(), collection[count - 1].as_pointer()
    if last - first != size * (count - 1):
        return read(collection, attribute, dtype, width)
    values = np.frombuffer((ctypes.c_char * (size * count)).from_address(first), dtype).reshape(count, width)
    for i in range(0, count, max(1, count // _SAMPLE)):
        told = getattr(collection[i], attribute)
        if values[i].tolist() != (list(told) if width > 1 else [told]):
            return read(collection, attribute, dtype, width)
    return values if width > 1 else values[:, 0]


def built_in(mesh, name, domain):
    """Return the data of a built-in attribute; None if this Blender keeps it elsewhere."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != domain or len(attribute.data) == 0:
        return None
    return attribute.data


def corner_vertices(mesh):
    data = built_in(mesh, ".corner_vert", "CORNER")
    if data is not None:
        return read(data, "value", np.int32, 1)
    return read(mesh.loops, "vertex_index", np.int32, 1)


def triangle_faces(mesh):
    """Return the index of each triangle's face."""
    if hasattr(mesh, "loop_triangle_polygons"):
        return read(mesh.loop_triangle_polygons, "value", np.int32, 1)
    return read(mesh.loop_triangles, "polygon_index", np.int32, 1)


def gather(values, indices, poll):
    """Return values[indices], calling poll between parts so that the user can stop the export."""
    result = np.empty(indices.shape + values.shape[1:], values.dtype)
    for first in range(0, len(indices), _TRIANGLES_AT_ONCE):
        poll()
        part = slice(first, first + _TRIANGLES_AT_ONCE)
        # All indices are in range; mode "clip" skips numpy's check for it.
        np.take(values, indices[part], axis=0, out=result[part], mode="clip")
    return result


def at_corners(values, corners, poll):
    return values.reshape(-1, 3, values.shape[1]) if corners is None else gather(values, corners, poll)
