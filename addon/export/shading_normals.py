"""Shading normals as in each version of Cycles; they can differ from Blender's own.

A flat face has the normals of its triangles. It has the normal of the whole face if the mesh has a sharp edge or custom normals
anywhere, and from 5.1 on also if the mesh has smooth faces. Up to 5.0 Cycles stores one normal per vertex, after it has split
vertices at sharp edges and around flat faces: corners that stay joined share the normal of the last of them.
"""

import bpy
import numpy as np

from .arrays import at_corners, built_in, corner_vertices, gather, read, triangle_faces

_KEEPS_CORNERS = bpy.app.version >= (5, 1)


def shading_normals(mesh, positions, triangles, corners, poll):
    """Return normals: None if all triangles are flat, (vertices, 3) if all are smooth, else (triangles, 3, 3).

    corners: Blender's corners, (triangles, 3); None if every face is a triangle. triangles: vertices, (triangles, 3).
    """
    if not hasattr(mesh, "normals_domain"):
        if not mesh.use_auto_smooth:
            flat = ~read(mesh.polygons, "use_smooth", bool, 1)
            return _of_vertices(mesh, flat, positions, triangles, corners, poll)
        mesh.calc_normals_split()
        normals = at_corners(read(mesh.loops, "normal", np.float32, 3), corners, poll)
        mesh.free_normals_split()
        return normals
    if mesh.normals_domain == "CORNER" and (_KEEPS_CORNERS or mesh.has_custom_normals or _any(mesh, "sharp_edge", "EDGE")):
        normals = read(mesh.corner_normals, "vector", np.float32, 3)
        poll()
        if not _KEEPS_CORNERS:
            normals = _last_of_vertices(mesh, normals, corners, poll)
        return at_corners(normals, corners, poll)
    data = built_in(mesh, "sharp_face", "FACE")
    if data is not None:
        return _of_vertices(mesh, read(data, "value", bool, 1), positions, triangles, corners, poll)
    return None if mesh.normals_domain == "FACE" else read(mesh.vertex_normals, "vector", np.float32, 3)


def _any(mesh, name, domain):
    data = built_in(mesh, name, domain)
    return data is not None and bool(read(data, "value", bool, 1).any())


def _of_vertices(mesh, flat, positions, triangles, corners, poll):
    """Return the normals of vertices, replaced by the triangles' normals on flat faces; None if all faces are flat."""
    if flat.all():
        return None
    normals = read(mesh.vertex_normals, "vector", np.float32, 3)
    if not flat.any():
        return normals
    normals = gather(normals, triangles, poll)
    rows = np.flatnonzero(flat if corners is None else flat[triangle_faces(mesh)])
    poll()
    places = positions[triangles[rows]].astype(float)
    across = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    lengths = np.linalg.norm(across, axis=1, keepdims=True)
    normals[rows] = (across / np.where(lengths > 0.0, lengths, 1.0))[:, None]
    return normals


def _last_of_vertices(mesh, normals, corners, poll):
    """Return normals, (corners of Blender's faces, 3); corners that share a vertex in Cycles get the last one's normal."""
    vertices = corner_vertices(mesh)
    one = np.zeros((len(mesh.vertices), 3), np.float32)
    one[vertices] = normals
    doubtful = np.zeros(len(one), bool)
    doubtful[vertices[(normals != one[vertices]).any(axis=1)]] = True
    if not doubtful.any():
        return normals
    poll()
    edges, following, preceding = _around_faces(mesh, len(vertices))
    split = _split_edges(mesh, edges)
    parted = np.zeros(len(one), bool)
    ends = split[edges]
    parted[vertices[ends]] = parted[vertices[following[ends]]] = True
    poll()
    if not _has_free_normals(mesh):
        # At split vertices Blender's normals already differ exactly where Cycles splits, except at edges of more than two
        # faces or of two faces with opposite orientation.
        odd = _odd_edges(edges, vertices < vertices[following])
        touched = np.zeros(len(one), bool)
        ends = odd[edges]
        touched[vertices[ends]] = touched[vertices[following[ends]]] = True
        doubtful &= touched | ~parted
    chosen = np.flatnonzero(doubtful[vertices])
    if len(chosen) == 0:
        return normals
    at = vertices[chosen].astype(np.int64)
    poll()
    groups = _connected(at, edges[chosen], edges[preceding[chosen]], split, parted[at])
    poll()
    return _share_last(normals, chosen, groups, corners)


def _around_faces(mesh, count):
    """Return for each corner: the edge to the next corner of its face, the next corner, and the one before."""
    data = built_in(mesh, ".corner_edge", "CORNER")
    edges = read(mesh.loops, "edge_index", np.int32, 1) if data is None else read(data, "value", np.int32, 1)
    starts, counts = (read(mesh.polygons, name, np.int32, 1) for name in ("loop_start", "loop_total"))
    following, preceding = np.arange(1, count + 1), np.arange(-1, count - 1)
    following[starts + counts - 1], preceding[starts] = starts, starts + counts - 1
    return edges, following, preceding


def _split_edges(mesh, edges):
    data, flat = built_in(mesh, "sharp_edge", "EDGE"), built_in(mesh, "sharp_face", "FACE")
    split = np.zeros(len(mesh.edges), bool) if data is None else read(data, "value", bool, 1)
    if flat is not None:
        split[edges[np.repeat(read(flat, "value", bool, 1), read(mesh.polygons, "loop_total", np.int32, 1))]] = True
    return split


def _has_free_normals(mesh):
    """Whether custom normals are free vectors per corner, instead of offsets from Blender's normals that neighbours share."""
    custom = mesh.attributes.get("custom_normal")
    return custom is not None and custom.data_type == "FLOAT_VECTOR"


def _odd_edges(edges, upwards):
    counts = np.bincount(edges)
    return (counts > 2) | ((counts == 2) & (np.bincount(edges, upwards) != 1.0))


def _connected(vertices, edges, other_edges, split, parted):
    """Return a group number for each corner: corners of a vertex that unsplit edges connect, or that is not split at all."""
    count = len(vertices)
    own = np.arange(count)
    keys = []
    for ends in (edges, other_edges):
        # A split edge connects no corners: use a key of the corner's own.
        key = np.where(split[ends], -1 - own, vertices * (len(split) + 1) + ends + 1)
        keys.append(np.where(parted, key, vertices * (len(split) + 1)))
    _, keys = np.unique(np.concatenate(keys), return_inverse=True)
    first, second = keys.reshape(2, count)
    groups = own
    while True:
        least = np.full(2 * count, count)
        np.minimum.at(least, first, groups)
        np.minimum.at(least, second, groups)
        smaller = np.minimum(least[first], least[second])
        if (smaller == groups).all():
            return groups
        groups = smaller


def _share_last(normals, chosen, groups, corners):
    """Return normals in which each chosen corner has the normal of the corner of its group that triangles list last."""
    named = np.arange(len(normals)) if corners is None else corners.ravel()
    order = np.zeros(len(normals), np.int64)
    order[named] = np.arange(len(named))
    last = np.zeros(len(chosen), np.int64)
    np.maximum.at(last, groups, order[chosen])
    result = normals.copy()
    result[chosen] = normals[named[last[groups]]]
    return result
