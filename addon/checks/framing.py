"""How much of the picture something takes, as far as nothing stands before it."""

import numpy as np

from ..bindings.enums import CameraKind

LEAST_SHARE = 1e-3  # of the picture, which is worth a line
_RAYS = 64  # along each side of the picture
_MOST_TRIANGLES = 16


def share_of_plane(camera, point, normal, low, high):
    """The share of the picture that shows what of a plane lies in a box: 0 to 1. Panoramas are taken to see all of it."""
    if camera.kind not in (CameraKind.PERSPECTIVE, CameraKind.ORTHOGRAPHIC):
        return 1.0
    left, right, bottom, top = camera.window
    middles = (np.arange(_RAYS) + 0.5) / _RAYS
    x, y = np.meshgrid(left + (right - left) * middles, bottom + (top - bottom) * middles)
    flat = np.zeros_like(x)
    turn, eye = camera.matrix[:, :3], camera.matrix[:, 3]
    if camera.kind == CameraKind.ORTHOGRAPHIC:
        origins, directions = eye + np.stack((x, y, flat), axis=2) @ turn.T, -turn[:, 2] + np.zeros((*x.shape, 3))
    else:
        origins, directions = eye, np.stack((x, y, flat - 1.0), axis=2) @ turn.T
    # No ray meets a plane that it runs along.
    distances = ((point - origins) @ normal) / (directions @ normal)
    places = origins + distances[:, :, None] * directions
    return float(((distances > 0.0) & ((places >= low) & (places <= high)).all(axis=2)).mean())


def share_of_triangles(camera, corners):
    """The same of triangles, (n, 3, 3) in the world: by the boxes of the largest."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    largest = np.argsort(-np.linalg.norm(normals, axis=1))[:_MOST_TRIANGLES]
    margin = 2.0**-20 * np.abs(corners[largest]).max(initial=0.0)
    shares = (
        share_of_plane(camera, corners[i, 0], normals[i], corners[i].min(axis=0) - margin, corners[i].max(axis=0) + margin)
        for i in largest
    )
    return min(1.0, sum(shares))
