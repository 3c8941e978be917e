"""Records of meshes and attributes as Blender's data; values come of seeds, so that a scene is short in print."""

import bmesh
import bpy
import numpy as np

from scenes import parts


def _heap(name):
    """A closed surface of random points."""
    bm = bmesh.new()
    for point in np.random.default_rng(1).normal(size=(14, 3)):
        bm.verts.new(point / np.linalg.norm(point) * 0.9)
    hull = bmesh.ops.convex_hull(bm, input=bm.verts)
    bmesh.ops.delete(bm, geom=hull["geom_interior"], context="VERTS")
    mesh = bpy.data.meshes.new(name)
    bm.to_mesh(mesh)
    bm.free()
    return mesh


def _grid(name):
    """Squares that are no planes."""
    places = np.linspace(-0.9, 0.9, 5)
    points = [(x, y, 0.3 * np.sin(3.0 * x) * np.cos(2.0 * y)) for y in places for x in places]
    faces = [(5 * j + i, 5 * j + i + 1, 5 * j + i + 6, 5 * j + i + 5) for j in range(4) for i in range(4)]
    return parts.mesh_from_points(name, points, faces)


def _fine(profile):
    """A surface around the z axis, whose parts share no normals: of each (radius, height), (radius, height)."""

    def make(name):
        parts_ = [_turned(*ends) for ends in profile]
        points = [point for part, _ in parts_ for point in part]
        faces, start = [], 0
        for part, part_faces in parts_:
            faces += [[start + corner for corner in face] for face in part_faces]
            start += len(part)
        return parts.mesh_from_points(name, points, faces)

    return make


def _turned(low, high, segments=96):
    """(Points, faces) between two circles around the z axis; a tip has a point, and so a normal, for each face."""
    turns = 2.0 * np.pi * np.arange(segments) / segments
    ring = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    points = [(*(radius * xy), z) for radius, z in (low, high) for xy in ring]
    corners = [(i, (i + 1) % segments, segments + (i + 1) % segments, segments + i) for i in range(segments)]
    if not low[0]:
        return points, [(a, c, d) for a, _, c, d in corners]
    return points, [(a, b, d) for a, b, _, d in corners] if not high[0] else corners


_SHAPES = {
    "fine ball": lambda name: parts.sphere_mesh(name, 128, 64, 0.9),
    "fine cone": _fine((((0.8, -0.7), (0.0, 0.7)), ((0.0, -0.7), (0.8, -0.7)))),
    "fine cylinder": _fine((((0.7, -0.6), (0.7, 0.6)), ((0.0, -0.6), (0.7, -0.6)), ((0.7, 0.6), (0.0, 0.6)))),
    "vast plane": lambda name: parts.plane_mesh(name, 2000.0),
    "ball": lambda name: parts.sphere_mesh(name, 16, 8, 0.9),
    "cube": lambda name: parts.cube_mesh(name, 1.3),
    "plane": lambda name: parts.plane_mesh(name, 1.5),
    "grid": _grid,
    "cone": lambda name: parts.cone_mesh(name, 0.8, 0.3, 1.4, 12),
    "torus": lambda name: parts.torus_mesh(name, 0.7, 0.28, 16, 8),
    "heap": _heap,
    "monkey": lambda name: parts.monkey_mesh(name, 0),
}


def build_mesh(name, fields, find):
    mesh = _SHAPES[fields["shape"]](name)
    for material in fields.get("materials", []):
        mesh.materials.append(find(material))
    if len(fields.get("materials", [])) > 1:
        mesh.polygons.foreach_set("material_index", np.arange(len(mesh.polygons), dtype=np.int32) % len(fields["materials"]))
    smooth = {"yes": 1, "no": 0, "mixed": 2}[fields.get("smooth", "no")]
    flags = np.arange(len(mesh.polygons)) % 3 != 0 if smooth == 2 else np.full(len(mesh.polygons), smooth == 1)
    mesh.polygons.foreach_set("use_smooth", flags)
    for layer in list(mesh.uv_layers):
        mesh.uv_layers.remove(layer)
    for number, uv_map in enumerate(fields.get("uv_maps", [])):
        add_uvs(mesh, uv_map, number)
    if fields.get("active_uv_map", "") in mesh.uv_layers:
        mesh.uv_layers[fields["active_uv_map"]].active_render = True
    if "sharp_edges" in fields:
        chosen = np.random.default_rng(5).random(len(mesh.edges)) < fields["sharp_edges"]
        mesh.edges.foreach_set("use_edge_sharp", chosen)
        if bpy.app.version < (4, 1):
            mesh.use_auto_smooth, mesh.auto_smooth_angle = True, 3.1416
    if "custom_normals" in fields:
        _add_normals(mesh, fields["custom_normals"])
    mesh.update()
    return mesh


def add_uvs(mesh, name, number):
    """A map along two axes and, as no place is like another, bent."""
    layer = mesh.uv_layers.new(name=name)
    corners = np.zeros(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    places = np.zeros(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", places)
    x, y, z = places.reshape(-1, 3)[corners].T
    uvs = np.stack([0.5 + 0.45 * x + 0.3 * z, 0.4 + 0.4 * y - 0.25 * z], axis=1)
    if number:
        uvs = np.stack([1.3 * uvs[:, 1] - 0.2, 0.7 * uvs[:, 0] ** 2 + 0.1 * uvs[:, 1]], axis=1)
    layer.data.foreach_set("uv", uvs.astype(np.float32).ravel())


def _add_normals(mesh, lean):
    normals = np.zeros(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("normal", normals)
    normals = normals.reshape(-1, 3) + np.random.default_rng(8).uniform(-lean, lean, (len(mesh.vertices), 3))
    mesh.normals_split_custom_set_from_vertices((normals / np.linalg.norm(normals, axis=1, keepdims=True)).tolist())
    if bpy.app.version < (4, 1):
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, 3.1416


_TYPES = {
    "FLOAT": ("value", 1), "INT": ("value", 1), "INT8": ("value", 1), "BOOLEAN": ("value", 1), "FLOAT2": ("vector", 2),
    "FLOAT_VECTOR": ("vector", 3), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4), "FLOAT4": ("vector", 4),
    "QUATERNION": ("value", 4), "INT16_2D": ("value", 2), "INT32_2D": ("value", 2),
}  # fmt: skip


def build_attribute(mesh, name, fields):
    kind, domain = fields["type"], fields["domain"]
    if "COLOR" in kind and domain in ("POINT", "CORNER"):
        attribute = mesh.color_attributes.new(name, kind, domain)
    else:
        try:
            attribute = mesh.attributes.new(name, kind, domain)
        except TypeError:
            # A type that this Blender lacks.
            return
    field, width = _TYPES[kind]
    values = np.random.default_rng(fields["seed"]).random((len(attribute.data), width))
    if kind.startswith("INT"):
        values = np.floor(4.0 * values).astype(np.int32)
    elif kind == "BOOLEAN":
        values = values < 0.5
    elif kind == "QUATERNION":
        # Rotations are of unit length: Blender mixes no others.
        values = (values / np.linalg.norm(values, axis=1, keepdims=True)).astype(np.float32)
    else:
        values = values.astype(np.float32)
    attribute.data.foreach_set(field, values.ravel())
    mesh.update()
