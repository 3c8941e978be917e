"""Corners, normals and areas of triangles, in the single precision of Blender's meshes."""

import numpy as np


def corners(mesh, faces=slice(None)):
    """Return the corners of triangles as three (n, 3) arrays."""
    triangles = mesh.triangles[faces]
    return tuple(np.take(mesh.positions, triangles[:, column], axis=0) for column in range(3))


def crossed(a, b, c):
    """Return normals, (n, 3), with twice the area as length. Three times as fast as np.cross."""
    u, v = b - a, c - a
    return np.stack(
        (
            u[:, 1] * v[:, 2] - u[:, 2] * v[:, 1],
            u[:, 2] * v[:, 0] - u[:, 0] * v[:, 2],
            u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0],
        ),
        axis=1,
    )


def dots(u, v):
    return np.einsum("ij,ij->i", u, v)


def lengths(vectors):
    return np.sqrt(dots(vectors, vectors))


def middle(mesh, face):
    """Return the centre of a triangle in double precision."""
    return mesh.positions[mesh.triangles[face]].astype(float).mean(axis=0)
