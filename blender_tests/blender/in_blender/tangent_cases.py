"""Compare the exporter's tangents with Blender's tangents of the same triangles."""

import bmesh
import bpy
import numpy as np
import stage

from addon.export.attributes import tangents_name
from addon.export.mesh import export_mesh


def _finish(work, name, uv):
    """Return a smooth mesh of the bmesh; uv(place) is its UV map."""
    layer = work.loops.layers.uv.new("Map")
    for face in work.faces:
        face.smooth = True
        for loop in face.loops:
            loop[layer].uv = uv(loop.vert.co)
    mesh = bpy.data.meshes.new(name)
    work.to_mesh(mesh)
    mesh.uv_layers[0].active_render = True
    return mesh


def _barrel(uv):
    """Return a barrel of twelve sides between two faces of twelve corners."""
    work = bmesh.new()
    bmesh.ops.create_cone(work, cap_ends=True, segments=12, radius1=1.0, radius2=0.8, depth=2.0)
    return _finish(work, "barrel", uv)


def _waves(uv):
    """Return a hilly ground of triangles."""
    work = bmesh.new()
    bmesh.ops.create_grid(work, x_segments=12, y_segments=9, size=1.0)
    for vertex in work.verts:
        vertex.co.z = 0.2 * np.sin(5.0 * vertex.co.x) * np.cos(4.0 * vertex.co.y)
    bmesh.ops.triangulate(work, faces=work.faces[:])
    return _finish(work, "waves", uv)


def _ours(mesh):
    data = export_mesh(mesh, mesh.name, lambda: None, frozenset({tangents_name("")}))
    return data.attributes[0].values, data


def _theirs(mesh):
    mesh.calc_tangents(uvmap="Map")
    values = [(*loop.tangent, loop.bitangent_sign) for loop in mesh.loops]
    return np.array(values)


def _triangles(data, uvs):
    """Return a Blender mesh of the exported triangles."""
    mesh = bpy.data.meshes.new("cut")
    mesh.from_pydata([tuple(map(float, p)) for p in data.positions], [], data.triangles.tolist())
    mesh.uv_layers.new(name="Map")
    mesh.uv_layers[0].data.foreach_set("uv", np.ascontiguousarray(uvs, np.float32).ravel())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    return mesh


def compare():
    """Return the largest differences of components and signs for four UV maps: plain, mirrored, on a barrel, a single point."""
    stage.empty()
    maps = {
        "plain": lambda place: (place.x + 0.1 * place.y, place.y - 0.3 * place.x),
        "mirrored": lambda place: (abs(place.x), place.y),
    }
    result = {}
    for name, uv in maps.items():
        mesh = _waves(uv)
        ours, _ = _ours(mesh)
        theirs = _theirs(mesh)
        result[name] = [float(np.abs(ours[:, :3] - theirs[:, :3]).max()), int((ours[:, 3] != theirs[:, 3]).sum())]
        result[name] += [int((ours[:, 3] < 0).sum()), len(ours)]
    barrel = _barrel(lambda place: (place.x + 0.1 * place.y, place.z - 0.3 * place.y))
    ours, data = _ours(barrel)
    # The triangulated barrel has other vertex normals, so both tangents are computed on the triangulated mesh.
    cut = _triangles(data, data.uvs)
    again, _ = _ours(cut)
    theirs = _theirs(cut)
    result["barrel"] = [float(np.abs(again[:, :3] - theirs[:, :3]).max()), int((again[:, 3] != theirs[:, 3]).sum())]
    result["barrel"] += [int((ours[:, 3] < 0).sum()), len(ours)]
    normals = data.normals[data.triangles].reshape(-1, 3) if data.normals.ndim == 2 else data.normals.reshape(-1, 3)
    result["upright"] = float(np.abs((ours[:, :3] * normals).sum(axis=1)).max())
    result["without map"] = _without()
    return result


def _without():
    """Return the tangents, theirs and ours, of triangles whose UV map is a single point."""
    mesh = _waves(lambda place: (0.5, 0.5))
    ours, _ = _ours(mesh)
    theirs = _theirs(mesh)
    return [np.unique(ours, axis=0).tolist(), np.unique(theirs, axis=0).tolist()]
