"""Catmull-Clark refinement of polygon meshes with creases, all faces at once.

The rules of semi-sharp creases are those of DeRose, Kass and Truong (1998), as OpenSubdiv applies them.
"""

import functools
from dataclasses import dataclass

import numpy as np

# The sharpness from which OpenSubdiv treats a crease as sharp at every level.
ENDLESS = 10.0


@dataclass(frozen=True)
class Cage:
    """A polygon mesh with values at its vertices: positions, or coordinates of a UV map.

    Face f has the corners starts[f] to starts[f + 1]. creases are pairs of vertices with their sharpness.
    """

    values: np.ndarray  # (vertices, channels), double
    corners: np.ndarray  # the vertex of each corner
    starts: np.ndarray  # (faces + 1,)
    creases: np.ndarray  # (n, 2)
    crease_sharpness: np.ndarray  # (n,)
    vertex_sharpness: np.ndarray  # (vertices,)

    @functools.cached_property
    def edges(self):
        return Edges(self, self.neighbours()[0])

    def neighbours(self):
        """Return the corners after and before each corner in its face, and the face of each corner."""
        sizes = np.diff(self.starts)
        faces = np.repeat(np.arange(len(sizes)), sizes)
        here = np.arange(len(self.corners))
        after, before = here + 1, here - 1
        after[self.starts[1:][sizes > 0] - 1] = self.starts[:-1][sizes > 0]
        before[self.starts[:-1][sizes > 0]] = self.starts[1:][sizes > 0] - 1
        return after, before, faces


class Edges:
    """The edges of a cage: their ends, the edge from each corner to the next, their number of faces, and how sharp they are.

    creases: the sharpness that the cage gives. is_odd: whether faces do not continue each other there, because there are more
    than two or because both run the same way.
    """

    def __init__(self, cage, after):
        vertices = len(cage.values)
        ends = np.stack([cage.corners, cage.corners[after]], axis=1).astype(np.int64)
        keys, self.of_corner = np.unique(_keys(ends, vertices), return_inverse=True)
        self.of_corner = self.of_corner.reshape(-1)
        self.ends = np.stack([keys // vertices, keys % vertices], axis=1) if len(keys) else np.zeros((0, 2), np.int64)
        self.faces = np.bincount(self.of_corner, minlength=len(keys))
        ahead = np.bincount(self.of_corner, ends[:, 0] < ends[:, 1], len(keys))
        self.is_odd = (self.faces > 2) | (self.faces == 2) & (ahead != 1.0)
        self.creases = np.zeros(len(keys))
        if len(cage.creases) and len(keys):
            wanted = _keys(cage.creases, vertices)
            found = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
            known = keys[found] == wanted
            self.creases[found[known]] = cage.crease_sharpness[known]
        self.sharpness = np.where((self.faces < 2) | self.is_odd | (self.creases >= ENDLESS), np.inf, self.creases)


def _keys(ends, vertices):
    low, high = ends.min(axis=1), ends.max(axis=1)
    return low.astype(np.int64) * vertices + high


def sums(indices, values, count):
    """Return (count, channels): the sum of the values with each index."""
    return np.stack([np.bincount(indices, channel, count) for channel in values.T], axis=1).astype(float)


class Joints:
    """How the edges that are sharper than a limit meet at each vertex."""

    def __init__(self, edges, vertex_sharpness, limit):
        count = len(vertex_sharpness)
        self.edges = np.flatnonzero(edges.sharpness > limit)
        self.ends = edges.ends[self.edges]
        number = np.bincount(self.ends.reshape(-1), minlength=count)
        self.corner = (vertex_sharpness > limit) | (number > 2)
        self.crease = ~self.corner & (number == 2)

    def across(self, values):
        """Return the sum of the other ends of the sharp edges at each vertex."""
        a, b = self.ends.T
        return sums(np.concatenate([a, b]), values[np.concatenate([b, a])], len(values))


def refine(cage, turned):
    """Return the Cage of one more level: a quad for each corner, with the corner's vertex first.

    turned: instead put the vertex of corner c of a quad at place c, so that all four have the quad's own directions.
    """
    _, before, faces = cage.neighbours()
    edges = cage.edges
    values, vertices = cage.values, len(cage.values)
    sizes = np.maximum(np.diff(cage.starts), 1)[:, None]
    centres = sums(faces, values[cage.corners], len(sizes)) / sizes
    middles = 0.5 * (values[edges.ends[:, 0]] + values[edges.ends[:, 1]])
    beside = sums(edges.of_corner, centres[faces], len(middles))
    sharp = np.clip(edges.sharpness, 0.0, 1.0)[:, None]
    on_edges = sharp * middles + (1.0 - sharp) * 0.25 * (2.0 * middles + beside)
    moved = _vertices(cage, edges, centres, faces)
    first_edge, first_face = vertices, vertices + len(middles)
    quads = np.stack(
        [cage.corners, first_edge + edges.of_corner, first_face + faces, first_edge + edges.of_corner[before]], axis=1
    )
    if turned:
        order = (np.arange(4) - np.arange(len(quads))[:, None] % 4) % 4
        quads = np.take_along_axis(quads, order, axis=1)
    creased = np.flatnonzero((edges.sharpness > 1.0) & (edges.faces == 2))
    middle = first_edge + creased
    left = np.maximum(cage.vertex_sharpness - 1.0, 0.0)
    return Cage(
        values=np.concatenate([moved, on_edges, centres]),
        corners=quads.reshape(-1),
        starts=np.arange(0, 4 * len(quads) + 1, 4),
        creases=np.concatenate([np.stack([edges.ends[creased, end], middle], axis=1) for end in (0, 1)]),
        crease_sharpness=np.tile(edges.sharpness[creased] - 1.0, 2),
        vertex_sharpness=np.concatenate([left, np.zeros(len(middles) + len(centres))]),
    )


def _vertices(cage, edges, centres, faces):
    """Return the vertices of a cage after one refinement."""
    values, count = cage.values, len(cage.values)
    a, b = edges.ends.T
    ends = np.concatenate([a, b])
    valence = np.bincount(ends, minlength=count)[:, None].astype(float)
    alone = valence[:, 0] == 0.0
    around = np.maximum(valence, 1.0)
    others = sums(ends, values[np.concatenate([b, a])], count) / around
    inside = sums(cage.corners, centres[faces], count) / np.maximum(np.bincount(cage.corners, minlength=count), 1)[:, None]
    smooth = (inside + others + (valence - 2.0) * values) / around
    smooth[alone] = values[alone]
    now = Joints(edges, cage.vertex_sharpness, 0.0)
    later = Joints(edges, cage.vertex_sharpness, 1.0)
    by_now, by_later = (_by_rule(joints, values, smooth) for joints in (now, later))
    return _weight_of_fading(edges, cage.vertex_sharpness) * (by_now - by_later) + by_later


def _by_rule(joints, values, smooth):
    result = smooth.copy()
    result[joints.corner] = values[joints.corner]
    if joints.crease.any():
        crease = joints.crease
        result[crease] = 0.75 * values[crease] + 0.125 * joints.across(values)[crease]
    return result


def _weight_of_fading(edges, vertex_sharpness):
    """Return (vertices, 1): the mean sharpness of what is sharp at a vertex in this level and no more in the next; else 1."""
    count = len(vertex_sharpness)
    fading = np.flatnonzero((edges.sharpness > 0.0) & (edges.sharpness <= 1.0))
    ends = edges.ends[fading].reshape(-1)
    total = np.bincount(ends, np.repeat(edges.sharpness[fading], 2), count).astype(float)
    number = np.bincount(ends, minlength=count)
    own = (vertex_sharpness > 0.0) & (vertex_sharpness <= 1.0)
    total[own] += vertex_sharpness[own]
    number[own] += 1
    return np.where(number > 0, total / np.maximum(number, 1), 1.0)[:, None]
