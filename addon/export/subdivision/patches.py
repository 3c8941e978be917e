"""Surfaces that can be evaluated anywhere: each corner of each face of a cage is a patch with coordinates u and v, 0 to 1.

u runs from the corner's vertex along the edge to the next corner, v along the edge to the corner before; both are 1 at the
centre of the face.
"""

import numpy as np

from .catmull_clark import sums
from .limit_patches import CHILDREN, unit


class LinearPatches:
    """Values of the corners of faces, interpolated over the faces as Cycles does: bilinear, towards the mean at the centre."""

    def __init__(self, values, cage, normals=None):
        """values: of each corner, (corners, channels); normals: of each corner, for normals()."""
        self._points = _corner_quads(values, cage)
        self._normals = None if normals is None else _corner_quads(normals, cage)

    def at(self, patches, uvs, poll):
        poll()
        return _bilinear(self._points, patches, uvs)

    def normals(self, patches, uvs, poll):
        poll()
        return unit(_bilinear(self._normals, patches, uvs))


class FacePatches:
    """A surface with further patches: patch corners + f is the whole of face f, a quad whose first corner is at (0, 0)."""

    def __init__(self, surface, cage):
        self._surface, self._starts, self._corners = surface, cage.starts, len(cage.corners)

    def is_corner(self, patches):
        return patches < self._corners

    def at(self, patches, uvs, poll):
        return self._surface.at(*self.of_corners(patches, uvs), poll)

    def of_corners(self, patches, uvs):
        """Return the points as patches of corners and their coordinates."""
        whole = np.flatnonzero(patches >= self._corners)
        patches, uvs = patches.copy(), uvs.copy()
        u, v = uvs[whole].T
        corner = CHILDREN[(v > 0.5).astype(int), (u > 0.5).astype(int)]
        patches[whole] = self._starts[patches[whole] - self._corners] + corner
        # From each corner, the directions to the next one and to the one before.
        ways = np.stack([u, v, 1.0 - u, 1.0 - v], axis=1)
        rows = np.arange(len(whole))
        uvs[whole, 0], uvs[whole, 1] = 2.0 * ways[rows, corner], 2.0 * ways[rows, (corner + 1) % 4]
        return patches, uvs


def _corner_quads(values, cage):
    """Return (4, corners, channels): at the corner, half way to the next, at the centre, half way to the one before."""
    after, before, faces = cage.neighbours()
    sizes = np.maximum(np.diff(cage.starts), 1)
    centres = sums(faces, values.astype(float), len(sizes)) / sizes[:, None]
    return np.stack([values, 0.5 * (values + values[after]), centres[faces], 0.5 * (values + values[before])])


def _bilinear(points, patches, uvs):
    u, v = uvs.T[..., None]
    a, b, c, d = points
    return (1.0 - v) * ((1.0 - u) * a[patches] + u * b[patches]) + v * ((1.0 - u) * d[patches] + u * c[patches])
