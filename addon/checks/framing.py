"""Share of the picture that surfaces cover, without occlusion."""

import numpy as np

from ..bindings.enums import CameraKind

LEAST_SHARE = 1e-3  # of the picture; findings with less are not reported, or only as hints
_RAYS = 64  # along each side of the picture
_MOST_TRIANGLES = 4


def share_of_plane(camera, point, normal, low, high):
    """Return the share of the picture, 0 to 1, that shows the part of a plane inside a box; 1 for panoramas."""
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
    # A ray parallel to the plane has no hit: its distance is not finite and compares as false.
    distances = ((point - origins) @ normal) / (directions @ normal)
    places = origins + distances[:, :, None] * directions
    return float(((distances > 0.0) & ((places >= low) & (places <= high)).all(axis=2)).mean())


def share_of_triangles(camera, corners):
    """Return the share of the picture that triangles, (n, 3, 3) in world space, cover, estimated by the largest ones."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    largest = np.argsort(-np.linalg.norm(normals, axis=1))[:_MOST_TRIANGLES]
    margin = 2.0**-20 * np.abs(corners[largest]).max(initial=0.0)
    shares = (
        share_of_plane(camera, corners[i, 0], normals[i], corners[i].min(axis=0) - margin, corners[i].max(axis=0) + margin)
        for i in largest
    )
    return min(1.0, sum(shares))
