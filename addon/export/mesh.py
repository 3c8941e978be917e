"""Evaluated Blender meshes as arrays, by foreach_get, which copies whole arrays where Blender holds them so."""

import contextlib
import ctypes
from dataclasses import replace

import bpy
import numpy as np

from ..bindings.snapshot import MeshData
from .attributes import POLYGONS, read_attributes, read_uv_map, render_uv_map

_TRIANGLES_AT_ONCE = 1 << 18
_SAMPLE = 8


def _read(collection, attribute, dtype, width):
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, width) if width > 1 else values


def _attribute(mesh, name, domain):
    """The data of a built-in attribute; None where this Blender keeps it elsewhere."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != domain or len(attribute.data) == 0:
        return None
    return attribute.data


@contextlib.contextmanager
def shown_mesh(thing, owner):
    """The mesh of an object that shows one; owner: the evaluated object that it is, or is an instance of.

    While its mesh is being edited an object has a wrapper of it, which looks empty until Blender makes a mesh of that. Cycles
    asks for one, too, for all objects of that mesh and their instances, but not for what Geometry Nodes made.
    """
    mesh = thing.data
    if not mesh.is_editmode or owner.data != mesh:
        yield mesh
        return
    try:
        yield owner.to_mesh()
    finally:
        owner.to_mesh_clear()


def export_mesh(mesh, name, poll, wanted=frozenset()):
    """The mesh with the normals that Blender shades with, its render UV map and colours, and the attributes that are wanted.

    wanted: names of further UV maps and attributes as attribute_name gives them, tangents_name's, "generated", POLYGONS. poll
    ends the export by an exception; one array of Blender's is the least that it can wait for.
    """
    positions = read_positions(mesh)
    poll()
    mesh.calc_loop_triangles()
    poll()
    count = len(mesh.loop_triangles)
    if count == 0:
        return MeshData(name=name, positions=positions)
    # Blender tessellates a triangle to itself and keeps the order of faces.
    if count == len(mesh.polygons) and len(mesh.loops) == 3 * count:
        corners = None
    else:
        corners = _triangle_corners(mesh, count)
        poll()
    vertices = _corner_vertices(mesh)
    triangles = vertices.reshape(-1, 3) if corners is None else _gather(vertices, corners, poll)
    poll()
    normals = _normals(mesh, corners, poll)
    poll()
    uvs = _uvs(mesh, corners, poll)
    poll()
    colors = _colors(mesh, corners, triangles, poll)
    poll()
    slots = _material_slots(mesh, corners)
    faces = None if corners is None or not wanted else _triangle_faces(mesh)
    data = MeshData(
        name=name,
        positions=positions,
        triangles=triangles.view(np.uint32),
        normals=normals,
        uvs=uvs,
        colors=colors,
        material_slots=slots,
        polygons=np.unique(faces, return_inverse=True)[1] if POLYGONS in wanted and faces is not None else None,
    )
    return replace(data, attributes=read_attributes(mesh, data, wanted, corners, faces, poll)) if wanted else data


def read_positions(mesh):
    data = _attribute(mesh, "position", "POINT")
    if data is not None:
        return _read(data, "vector", np.float32, 3)
    return _read(mesh.vertices, "co", np.float32, 3).reshape(-1, 3)


def _corner_vertices(mesh):
    data = _attribute(mesh, ".corner_vert", "CORNER")
    if data is not None:
        return _read(data, "value", np.int32, 1)
    return _read(mesh.loops, "vertex_index", np.int32, 1)


def _triangle_corners(mesh, count):
    """(count, 3): which corners of Blender's faces make the triangles. Use it up before anything changes the mesh.

    Blender has them in one array, but calls a function for each when asked by name. So look at the array itself, where its
    stride and a sample of its values are those that Blender tells.
    """
    triangles = mesh.loop_triangles
    first, last = triangles[0].as_pointer(), triangles[count - 1].as_pointer()
    # Blender 3 keeps the number of the face beside the three.
    width = 4 if bpy.app.version < (4, 1) else 3
    if count > 1 and last - first == 4 * width * (count - 1):
        view = np.ctypeslib.as_array((ctypes.c_int32 * (width * count)).from_address(first)).reshape(count, width)[:, :3]
        if all(view[i].tolist() == list(triangles[i].loops) for i in range(0, count, max(1, count // _SAMPLE))):
            return view
    return _read(triangles, "loops", np.int32, 3)


def _triangle_faces(mesh):
    """Of which face each triangle is a part."""
    if hasattr(mesh, "loop_triangle_polygons"):
        return _read(mesh.loop_triangle_polygons, "value", np.int32, 1)
    return _read(mesh.loop_triangles, "polygon_index", np.int32, 1)


def _gather(values, indices, poll):
    """values[indices], in parts short enough to be stopped between."""
    result = np.empty(indices.shape + values.shape[1:], values.dtype)
    for first in range(0, len(indices), _TRIANGLES_AT_ONCE):
        poll()
        part = slice(first, first + _TRIANGLES_AT_ONCE)
        # Clipping takes less time than looking for indices out of range, and there are none.
        np.take(values, indices[part], axis=0, out=result[part], mode="clip")
    return result


def _at_corners(values, corners, poll):
    return values.reshape(-1, 3, values.shape[1]) if corners is None else _gather(values, corners, poll)


def _normals(mesh, corners, poll):
    """None for flat faces, (vertices, 3) where all is smooth, else (triangles, 3, 3)."""
    if hasattr(mesh, "normals_domain"):
        domain = mesh.normals_domain
        if domain == "FACE":
            return None
        if domain == "POINT":
            return _read(mesh.vertex_normals, "vector", np.float32, 3)
        return _at_corners(_corner_normals(mesh), corners, poll)
    if not (mesh.has_custom_normals and mesh.use_auto_smooth):
        smooth = _read(mesh.polygons, "use_smooth", bool, 1)
        if not smooth.any():
            return None
        if smooth.all() and not mesh.use_auto_smooth:
            return _read(mesh.vertex_normals, "vector", np.float32, 3)
    mesh.calc_normals_split()
    normals = _at_corners(_read(mesh.loops, "normal", np.float32, 3), corners, poll)
    mesh.free_normals_split()
    return normals


def _corner_normals(mesh):
    """As Cycles has them: before 5.1 hard edges and custom normals split a vertex, but not a flat face beside a smooth one."""
    sharp = _attribute(mesh, "sharp_edge", "EDGE")
    if bpy.app.version >= (5, 1) or mesh.has_custom_normals or (sharp is not None and _read(sharp, "value", bool, 1).any()):
        return _read(mesh.corner_normals, "vector", np.float32, 3)
    normals = _read(mesh.vertex_normals, "vector", np.float32, 3)[_corner_vertices(mesh)]
    flat = np.repeat(~_read(mesh.polygons, "use_smooth", bool, 1), _read(mesh.polygons, "loop_total", np.int32, 1))
    normals[flat] = _read(mesh.corner_normals, "vector", np.float32, 3)[flat]
    return normals


def _uvs(mesh, corners, poll):
    layer = render_uv_map(mesh)
    if layer is None:
        return None
    values = read_uv_map(layer)
    return _at_corners(values, corners, poll) if len(values) else None


def _colors(mesh, corners, triangles, poll):
    if len(mesh.color_attributes) == 0:
        return None
    # Blender renders the one with the camera; files of old versions have none so marked.
    index = mesh.color_attributes.render_color_index
    attribute = mesh.color_attributes[index if 0 <= index < len(mesh.color_attributes) else 0]
    values = _read(attribute.data, "color", np.float32, 4).reshape(-1, 4)[:, :3]
    if len(values) == 0:
        return None
    return _gather(values, triangles, poll) if attribute.domain == "POINT" else _at_corners(values, corners, poll)


def _material_slots(mesh, corners):
    data = _attribute(mesh, "material_index", "FACE")
    if data is not None:
        slots = _read(data, "value", np.int32, 1)
    elif bpy.app.version >= (3, 5):
        # Newer Blenders leave the attribute out where every face has slot 0.
        return None
    else:
        slots = _read(mesh.polygons, "material_index", np.int32, 1)
    if not slots.any():
        return None
    if corners is not None:
        slots = slots[_triangle_faces(mesh)]
    # Faces may point anywhere; the core takes the last slot for one beyond it.
    return np.clip(slots, 0, 0xFFFF).astype(np.uint16)
