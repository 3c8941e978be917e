"""Evaluated Blender meshes as arrays, read by foreach_get, which copies whole arrays if Blender stores them as such."""

import contextlib
import ctypes
from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np

from ..bindings.snapshot import MeshData
from .arrays import at_corners, built_in, corner_vertices, gather, read, triangle_faces
from .attributes import POLYGONS, color_attribute, read_attributes, read_uv_map, render_uv_map
from .edges import at_vertices
from .shading_normals import shading_normals

_SAMPLE = 2


@contextlib.contextmanager
def shown_mesh(thing, owner):
    """Yield the mesh of an object. owner: the evaluated object itself, or the one of which thing is an instance.

    In Edit Mode the evaluated mesh is a wrapper that looks empty; to_mesh() returns its faces. Like Cycles, call it for all
    objects with that mesh and their instances, but not for geometry made by Geometry Nodes.
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
    """Return the MeshData of a mesh: its shading normals, render UV map, colours and the wanted attributes.

    wanted: names from attribute_name() and tangents_name(), "generated", ISLANDS, POINTINESS, POLYGONS, RENDER_COLOR. poll is
    called between arrays and ends the export by an exception.
    """
    positions = read_positions(mesh)
    poll()
    mesh.calc_loop_triangles()
    poll()
    count = len(mesh.loop_triangles)
    if count == 0:
        return MeshData(name=name, positions=positions)
    # Blender's tessellation maps a triangle to itself and keeps the order of faces.
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


class Shape(NamedTuple):
    """The form of a mesh at one time: its normals as in MeshData."""

    positions: np.ndarray
    triangles: int
    normals: np.ndarray | None

    def like(self, other):
        """Whether both have the same vertices and faces, so that one may turn into the other."""
        same = self.positions.shape == other.positions.shape and self.triangles == other.triangles
        return same and np.shape(self.normals) == np.shape(other.normals)

    def fits(self, data):
        """Whether a MeshData has these vertices and faces."""
        return self.like(Shape(data.positions, len(data.triangles), data.normals))


def read_shape(mesh, poll):
    """Return the Shape of a mesh."""
    positions = read_positions(mesh)
    poll()
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return Shape(positions, 0, None)
    whole = count == len(mesh.polygons) and len(mesh.loops) == 3 * count
    corners = None if whole else _triangle_corners(mesh, count)
    vertices = corner_vertices(mesh)
    triangles = vertices.reshape(-1, 3) if corners is None else gather(vertices, corners, poll)
    return Shape(positions, count, shading_normals(mesh, positions, triangles, corners, poll))


def read_positions(mesh):
    data = built_in(mesh, "position", "POINT")
    if data is not None:
        return read(data, "vector", np.float32, 3)
    return read(mesh.vertices, "co", np.float32, 3).reshape(-1, 3)


def _triangle_corners(mesh, count):
    """Return (count, 3), the corners of Blender's faces that make the triangles, as a view that ends when the mesh changes.

    Blender stores them in one array, but foreach_get calls a function for each triangle. So use the array itself if its
    stride and a sample of its values equal those of Blender's API.
    """
    triangles = mesh.loop_triangles
    first, last = triangles[0].as_pointer(), triangles[count - 1].as_pointer()
    # Up to 4.0 the index of the face follows the three corners.
    width = 4 if bpy.app.version < (4, 1) else 3
    if count > 1 and last - first == 4 * width * (count - 1):
        view = np.ctypeslib.as_array((ctypes.c_int32 * (width * count)).from_address(first)).reshape(count, width)[:, :3]
        if all(view[i].tolist() == list(triangles[i].loops) for i in range(0, count, max(1, (count - 1) // _SAMPLE))):
            return view
    return read(triangles, "loops", np.int32, 3)


def _uvs(mesh, corners, poll):
    layer = render_uv_map(mesh)
    if layer is None:
        return None
    values = read_uv_map(layer)
    return at_corners(values, corners, poll) if len(values) else None


def _colors(mesh, corners, triangles, poll):
    attribute = color_attribute(mesh)
    if attribute is None:
        return None
    values = read(attribute.data, "color", np.float32, 4).reshape(-1, 4)
    if len(values) == 0:
        return None
    if attribute.domain == "FACE":
        faces = slice(None) if corners is None else triangle_faces(mesh)
        return np.repeat(values[faces, None, :3], 3, axis=1)
    if attribute.domain == "EDGE":
        values = at_vertices(mesh, attribute, values)
    values = values[:, :3]
    return at_corners(values, corners, poll) if attribute.domain == "CORNER" else gather(values, triangles, poll)


def face_slots(mesh):
    """Return the material slot of each of Blender's faces; None if all have the first."""
    data = built_in(mesh, "material_index", "FACE")
    if data is not None:
        slots = read(data, "value", np.int32, 1)
    elif bpy.app.version >= (3, 5):
        # Since 3.5 the attribute is missing if every face has slot 0.
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
    # Faces may have any slot index; the core uses the last slot for an index beyond it.
    return np.clip(slots, 0, 0xFFFF).astype(np.uint16)
