"""Triangles of the pieces of patches: a regular grid inside, stitched to the vertices of the edges around."""

import functools
from dataclasses import dataclass

import numpy as np

from .edge_table import MOST_SEGMENTS
from .patches import FacePatches

# The pieces that are made at once.
_AT_ONCE = 1 << 12
_SQUARE = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
_TRIANGLE = _SQUARE[[0, 1, 3]]


@dataclass(frozen=True)
class Tessellation:
    """Triangles between points of patches. Each vertex has a point for each piece that shares it."""

    patches: np.ndarray  # (points,)
    uvs: np.ndarray  # (points, 2)
    vertices: np.ndarray  # the vertex of each point
    owners: np.ndarray  # a point of each vertex
    triangles: np.ndarray  # (triangles, 3), points


def tessellate(table, quads, triangles, cage, poll):
    """Return the Tessellation of the Pieces of split_patches() of a cage."""
    patches, uvs, vertices, faces = [], [], [], []
    count, of_faces = 0, FacePatches(None, cage)
    for pieces in (quads, triangles):
        segments = table.segments[pieces.edges]
        kinds, which = np.unique(segments, axis=0, return_inverse=True)
        order = np.argsort(which.reshape(-1), kind="stable")
        starts = np.searchsorted(which.reshape(-1)[order], np.arange(len(kinds) + 1))
        for kind, first, last in zip(kinds.tolist(), starts, starts[1:], strict=False):
            # Patterns of more segments are rare and large: make them anew.
            places, pattern = (_pattern if max(kind) > MOST_SEGMENTS else _kept_pattern)(tuple(kind))
            for start in range(first, last, _AT_ONCE):
                poll()
                group = pieces.take(order[start : min(start + _AT_ONCE, last)])
                own = _vertices(table, group, len(places))
                at = (_shape(places, len(kind)) @ group.uvs).reshape(-1, 2)
                at = of_faces.of_corners(np.repeat(group.patches, len(places)), np.clip(at, 0.0, 1.0))
                patches.append(at[0].astype(np.int32))
                uvs.append(at[1])
                vertices.append(own.astype(np.int32).reshape(-1))
                offsets = count + len(places) * np.arange(len(own))
                faces.append((offsets[:, None, None] + pattern).astype(np.int32).reshape(-1, 3))
                count += len(vertices[-1])
    patches, numbers = _joined(patches, ()), _joined(vertices, ())
    uvs, corners = _joined(uvs, (2,)), _joined(faces, (3,))
    # As in Cycles, the first face with a vertex decides its normal, which faces beside a crease do not share.
    owners = np.full(table.vertices, -1, np.int32)
    order = np.argsort(patches, kind="stable")[::-1]
    owners[numbers[order]] = order
    del order
    used = owners >= 0
    renumbered = np.cumsum(used, dtype=np.int32) - 1
    return Tessellation(
        patches=patches,
        uvs=uvs,
        vertices=renumbered[numbers],
        owners=owners[used],
        # The first triangle with a vertex decides by which side of a seam it is displaced: keep the order of faces.
        triangles=corners[np.argsort(patches[corners[:, 0]], kind="stable")],
    )


def _joined(parts, shape):
    """Return the rows of arrays of 32-bit numbers or coordinates, and empty the list, so that both are never in memory."""
    joined = np.concatenate(parts) if parts else np.zeros((0, *shape), np.int32)
    parts.clear()
    return joined


def _shape(places, sides):
    """Return (places, sides), the weights of the corners at places of the unit square or triangle."""
    u, v = places.T
    if sides == 3:
        return np.stack([1.0 - u - v, u, v], axis=1)
    return np.stack([(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v], axis=1)


def _vertices(table, pieces, places):
    """Return (pieces, places), the vertices on the edges and new ones for the places inside."""
    columns = []
    for side in range(pieces.edges.shape[1]):
        numbers, reverse = pieces.edges[:, side], pieces.reverse[:, side]
        ends, inner, segments = table.ends[numbers], table.inner[numbers], table.segments[numbers]
        columns.append(np.where(reverse, ends[:, 1], ends[:, 0]))
        for step in range(1, int(segments[0])):
            columns.append(inner + np.where(reverse, segments - step, step) - 1)
    inside = places - len(columns)
    first = table.vertices
    table.vertices += inside * len(pieces.patches)
    new = first + np.arange(inside * len(pieces.patches)).reshape(len(pieces.patches), inside)
    return np.concatenate([np.stack(columns, axis=1), new], axis=1)


@functools.cache
def _kept_pattern(segments):
    return _pattern(segments)


def _pattern(segments):
    """Return the places, (n, 2), of vertices along the edges and inside, and triangles between them."""
    corners = _SQUARE if len(segments) == 4 else _TRIANGLE
    firsts = np.cumsum((0, *segments))
    edges = [list(range(first, last + 1)) for first, last in zip(firsts, firsts[1:], strict=False)]
    edges[-1][-1] = 0
    around = [
        start + (end - start) * (np.arange(count) / count)[:, None]
        for start, end, count in zip(corners, np.roll(corners, -1, axis=0), segments, strict=True)
    ]
    inside, triangles = (_square if len(segments) == 4 else _triangle)(segments, edges, np.concatenate(around))
    return np.concatenate([*around, inside]), np.asarray(triangles, np.int64)


def _square(segments, edges, around):
    """Return the places inside and the triangles. around: the places on the edges."""
    across, up = (max(segments[side], segments[side + 2]) for side in (0, 1))
    if up == 1:
        return around[:0], _between(edges[2][::-1], edges[0], around)
    if across == 1:
        return around[:0], _between(edges[3][::-1], edges[1], around)
    i, j = np.meshgrid(np.arange(1, across), np.arange(1, up))
    inside = np.stack([i.reshape(-1) / across, j.reshape(-1) / up], axis=1)
    grid = len(around) + np.arange(len(inside)).reshape(i.shape)
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    found = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    sides = (grid[0], grid[:, -1], grid[-1, ::-1], grid[::-1, 0])
    return inside, _with_seams(found, sides, edges, np.concatenate([around, inside]))


def _triangle(segments, edges, around):
    """Return the places inside and the triangles. around: the places on the edges."""
    most = max(segments)
    corners = [edge[0] for edge in edges]
    if most == 1:
        return around[:0], [tuple(corners)]
    if most == 2:
        return around[:0], _of_halves(segments, edges, corners)
    rows, columns = np.tril_indices(most - 1)
    inside = 1.0 / (most + 1) * np.stack([1 + columns, 1 + rows - columns], axis=1)
    # The place of a row and a column.
    grid = np.full((most - 1, most - 1), -1)
    grid[rows, columns] = len(around) + np.arange(len(rows))
    a, b, c, d = grid[:-1, :-1], grid[1:, 1:], grid[1:, :-1], grid[:-1, 1:]
    found = np.concatenate([np.stack([a, b, c], axis=-1)[a >= 0], np.stack([a, d, b], axis=-1)[d >= 0]])
    sides = (grid.diagonal(), grid[-1, ::-1], grid[::-1, 0])
    return inside, _with_seams(found, sides, edges, np.concatenate([around, inside]))


def _with_seams(found, sides, edges, places):
    """Return the triangles found inside and those between the sides of the inside and the edges."""
    return np.concatenate([found, *(_between(side.tolist(), edge, places) for side, edge in zip(sides, edges, strict=True))])


def _of_halves(segments, edges, corners):
    """Of a triangle whose edges have one segment or two."""
    halved = [side for side in range(3) if segments[side] == 2]
    if len(halved) == 3:
        a, b, c = (edge[1] for edge in edges)
        return [(corners[0], a, c), (corners[1], b, a), (corners[2], c, b), (a, b, c)]
    # Begin with the halved edge that the other halved edge follows, if there are two.
    side = 2 if halved == [0, 2] else halved[0]
    start, end, apex = (corners[(side + step) % 3] for step in range(3))
    middle = edges[side][1]
    if len(halved) == 1:
        return [(start, middle, apex), (middle, end, apex)]
    other = edges[(side + 1) % 3][1]
    return [(start, middle, apex), (middle, end, other), (middle, other, apex)]


def _between(left, right, places):
    """Return triangles between two rows of vertices, along the shorter diagonals.

    The diagonals are those of the unit square, so that all pieces of a kind share a pattern. Cycles takes the shorter ones on
    the surface, which differ where a piece is strongly bent or skewed.
    """
    found, i, j = [], 0, 0
    while i < len(left) - 1 or j < len(right) - 1:
        if j == len(right) - 1:
            step_left = True
        elif i == len(left) - 1:
            step_left = False
        else:
            to_right = places[left[i]] - places[right[j + 1]]
            to_left = places[right[j]] - places[left[i + 1]]
            step_left = not to_right @ to_right < to_left @ to_left
        found.append((left[i], right[j], left[i + 1] if step_left else right[j + 1]))
        i, j = (i + 1, j) if step_left else (i, j + 1)
    return found
