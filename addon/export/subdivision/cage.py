"""Blender's meshes as cages of subdivision: faces, creases, and how UV maps are joined at vertices."""

import bpy
import numpy as np

from ..arrays import built_in, corner_vertices, read
from ..edges import edge_ends
from .catmull_clark import ENDLESS, Cage
from .non_manifold import odd_corners

# Since 4.5 Cycles refines the cage three times; what is sharper than that counts as smooth from there, but for full creases.
# Before, it refines by the length of edges in the picture, at most ten times, and full creases are no exception.
_THREE_LEVELS = bpy.app.version >= (4, 5)
_LEVELS, _MOST_LEVELS = 3, 10
# The most refinements before patches are made: the patch at a sharp vertex then has 1 / 2^5 of a face's side.
_FINEST = 5
# Which corners of a UV map stay sharp, by the modifier's choice; LINEAR maps are not smoothed at all.
_SHARP_CORNERS = {"PRESERVE_CORNERS", "PRESERVE_CORNERS_AND_JUNCTIONS", "PRESERVE_CORNERS_JUNCTIONS_AND_CONCAVE"}
_SHARP_JUNCTIONS = _SHARP_CORNERS - {"PRESERVE_CORNERS"}


def read_cage(mesh, positions, adaptive, rate):
    """Return the Cage of a mesh. positions: (vertices, 3); rate: the Rate by which it is divided."""
    starts = np.append(read(mesh.polygons, "loop_start", np.int32, 1), len(mesh.loops)).astype(np.int64)
    corners = corner_vertices(mesh).astype(np.int64)
    creases, sharpness, vertices = np.zeros((0, 2), np.int64), np.zeros(0), np.zeros(len(positions))
    if adaptive.creased:
        of_edges = _creases(mesh, "crease_edge", "EDGE", mesh.edges, "crease", len(mesh.edges))
        sharp = np.flatnonzero(of_edges > 0.0)
        creases, sharpness = edge_ends(mesh)[sharp].astype(np.int64), ENDLESS * of_edges[sharp]
        # Before 4.0 the creases of vertices are layers of their own.
        layer = mesh.vertex_creases[0].data if bpy.app.version < (4, 0) and mesh.vertex_creases else ()
        vertices = ENDLESS * _creases(mesh, "crease_vert", "POINT", layer, "value", len(positions))
    cage = Cage(positions.astype(float), corners, starts, creases, sharpness, vertices)
    cage = _with_sharp_vertices(cage, adaptive)
    levels = _LEVELS if _THREE_LEVELS else _levels(cage, rate)
    sharpness = (_limited(values, levels) for values in (cage.crease_sharpness, cage.vertex_sharpness))
    return Cage(cage.values, cage.corners, cage.starts, cage.creases, *sharpness)


def patch_levels(cage, rate):
    """Return the refinements before patches are made. A sharp vertex is the blunter the fewer there are."""
    return _LEVELS if _THREE_LEVELS else min(_levels(cage, rate), _FINEST)


def _creases(mesh, name, domain, old, field, count):
    """Return the creases of edges or vertices, 0 to 1. old: where Blender before 4.0 keeps them."""
    data = built_in(mesh, name, domain)
    if data is not None:
        return read(data, "value", np.float32, 1).astype(float)
    if len(old) and field in old[0].bl_rna.properties:
        return read(old, field, np.float32, 1).astype(float)
    return np.zeros(count)


def _with_sharp_vertices(cage, adaptive):
    """Return the cage with vertices of two edges as sharp as both, and with the corners that stay in their places.

    Those are the corners of boundaries, where wanted, and those of faces that form no single sheet.
    """
    edges, count = cage.edges, len(cage.values)
    ends = edges.ends.reshape(-1)
    two = np.bincount(ends, minlength=count) == 2
    both = np.full(count, np.inf)
    np.minimum.at(both, ends, np.repeat(edges.creases, 2))
    sharpness = np.where(two, np.minimum(cage.vertex_sharpness + both, ENDLESS), cage.vertex_sharpness)
    if adaptive.sharp_corners:
        sharpness[np.bincount(cage.corners, minlength=count) == 1] = np.inf
    sharpness[odd_corners(cage, edges)] = np.inf
    return Cage(cage.values, cage.corners, cage.starts, cage.creases, cage.crease_sharpness, sharpness)


def _levels(cage, rate):
    """Return the refinements after which the longest edge is about as long as the rate."""
    ends = cage.edges.ends
    start, end = (rate.points(cage.values[ends[:, side]]) for side in (0, 1))
    longest = rate.lengths(start, end)[1].max(initial=1.0)
    return min(int(np.log2(longest) + 1.0), _MOST_LEVELS)


def _limited(sharpness, levels):
    limited = np.minimum(sharpness, levels)
    return np.where(sharpness >= ENDLESS, np.inf, limited) if _THREE_LEVELS else limited


def uv_cage(cage, uvs, rule):
    """Return the cage of a UV map, whose vertices are split where it has a seam. uvs: (corners, 2); rule: its uv_smooth."""
    # Equal places have equal bits; adding 0 turns -0 into 0.
    bits = (np.ascontiguousarray(uvs, np.float32) + np.float32(0.0)).view(np.uint64).reshape(-1)
    places, numbers = np.unique(bits, return_inverse=True)
    _, first, corners = np.unique(cage.corners * len(places) + numbers, return_index=True, return_inverse=True)
    vertex = cage.corners[first]
    after = cage.neighbours()[0]
    edges = cage.edges
    sharp = np.flatnonzero(edges.sharpness[edges.of_corner] > 0.0)
    creases = np.stack([corners[sharp], corners[after[sharp]]], axis=1)
    sharpness = edges.sharpness[edges.of_corner[sharp]]
    split = Cage(uvs[first].astype(float), corners, cage.starts, creases, sharpness, cage.vertex_sharpness[vertex])
    sharpness = split.vertex_sharpness.copy()
    own = split.edges
    on_border = _at(own.ends[own.faces != 2], len(first))
    alone = np.bincount(corners, minlength=len(first)) == 1
    values = np.bincount(vertex, minlength=len(cage.values))[vertex]
    if rule == "PRESERVE_BOUNDARIES":
        sharpness[on_border] = np.inf
    if rule in _SHARP_CORNERS:
        sharpness[alone] = np.inf
    if rule in _SHARP_JUNCTIONS:
        sharpness[values > 2] = np.inf
    if rule == "PRESERVE_CORNERS_JUNCTIONS_AND_CONCAVE":
        # The other side of a corner, and the ends of seams inside the mesh.
        beside = _at(vertex[alone], len(cage.values))[vertex]
        inside = ~_at(edges.ends[edges.faces != 2], len(cage.values))[vertex]
        sharpness[(values == 2) & beside | (values == 1) & on_border & inside] = np.inf
    return Cage(split.values, corners, cage.starts, creases, split.crease_sharpness, sharpness)


def _at(numbers, count):
    """Return whether each of count is among the numbers."""
    found = np.zeros(count, bool)
    found[numbers.reshape(-1)] = True
    return found
