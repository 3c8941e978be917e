"""Evaluated Blender meshes as arrays, by foreach_get, which copies whole arrays where Blender holds them so."""

import contextlib
import ctypes
from dataclasses import replace

import bpy
import numpy as np

from ..bindings.snapshot import MeshData
from .arrays import at_corners, built_in, corner_vertices, gather, read, triangle_faces
from .attributes import POLYGONS, read_attributes, read_uv_map, render_uv_map
from .shading_normals import shading_normals

_SAMPLE = 8


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
    vertices = corner_vertices(mesh)
    triangles = vertices.reshape(-1, 3) if corners is None else gather(vertices, corners, poll)
    poll()
    normals = shading_normals(mesh, positions, triangles, corners, poll)
    poll()
    uvs = _uvs(mesh, corners, poll)
    poll()
    colors = _colors(mesh, corners, triangles, poll)
    poll()
    slots = _material_slots(mesh, corners)
    faces = None if corners is None or not wanted else triangle_faces(mesh)
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
    data = built_in(mesh, "position", "POINT")
    if data is not None:
        return read(data, "vector", np.float32, 3)
    return read(mesh.vertices, "co", np.float32, 3).reshape(-1, 3)


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
    return read(triangles, "loops", np.int32, 3)


def _uvs(mesh, corners, poll):
    layer = render_uv_map(mesh)
    if layer is None:
        return None
    values = read_uv_map(layer)
    return at_corners(values, corners, poll) if len(values) else None


def color_attribute(mesh):
    """The one that is rendered; None where there is none."""
    if len(mesh.color_attributes) == 0:
        return None
    # Blender renders the one with the camera; files of old versions have none so marked.
    index = mesh.color_attributes.render_color_index
    return mesh.color_attributes[index if 0 <= index < len(mesh.color_attributes) else 0]


def _colors(mesh, corners, triangles, poll):
    attribute = color_attribute(mesh)
    if attribute is None:
        return None
    values = read(attribute.data, "color", np.float32, 4).reshape(-1, 4)[:, :3]
    if len(values) == 0:
        return None
    return gather(values, triangles, poll) if attribute.domain == "POINT" else at_corners(values, corners, poll)


def face_slots(mesh):
    """The material slot of each of Blender's faces; None where all have the first."""
    data = built_in(mesh, "material_index", "FACE")
    if data is not None:
        slots = read(data, "value", np.int32, 1)
    elif bpy.app.version >= (3, 5):
        # Newer Blenders leave the attribute out where every face has slot 0.
        return None
    else:
        slots = read(mesh.polygons, "material_index", np.int32, 1)
    return slots if slots.any() else None


def _material_slots(mesh, corners):
    slots = face_slots(mesh)
    if slots is None:
        return None
    if corners is not None:
        slots = slots[triangle_faces(mesh)]
    # Faces may point anywhere; the core takes the last slot for one beyond it.
    return np.clip(slots, 0, 0xFFFF).astype(np.uint16)
