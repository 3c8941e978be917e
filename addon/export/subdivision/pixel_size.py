"""The size of a pixel at points of the scene, by which Cycles measures edges: grown outside the picture."""

import numpy as np

from ...bindings.enums import CameraKind


def pixel_size(camera, offscreen_scale):
    """Return a function of points, (n, 3), in the world that returns the size of a pixel there.

    camera: the snapshot.Camera of the whole picture. offscreen_scale: how fast pixels grow outside the picture; 1: not at all.
    """
    axes, eye = camera.matrix[:, :3], camera.matrix[:, 3]
    # Rows are right, up and forward.
    inward = np.array((1.0, 1.0, -1.0))[:, None] * axes.T
    measure = _MEASURES.get(camera.kind, _panoramic)
    size, far = measure(camera)
    growth = max(0.0, offscreen_scale - 1.0)

    def sizes(points):
        places = (points - eye) @ inward.T
        return size(places) + growth * far(places) if growth else size(places)

    return sizes


def _steps(camera):
    left, right, bottom, top = camera.window
    return (right - left) / camera.width, (top - bottom) / camera.height


def _perspective(camera):
    left, right, bottom, top = camera.window
    ahead = np.array((0.5 * (left + right), 0.5 * (bottom + top), 1.0))
    x, y = _steps(camera)
    beside = ahead + ((x, 0.0, 0.0) if x < y else (0.0, y, 0.0))
    forward = ahead / np.linalg.norm(ahead)
    turn = beside / np.linalg.norm(beside) - forward
    angle = np.linalg.norm(turn - (turn @ forward) * forward)
    # Outward normals of the four sides of the pyramid of view, and the directions along the sides away from the eye.
    normals = np.array(((1.0, 0.0, -right), (0.0, 1.0, -top), (-1.0, 0.0, left), (0.0, -1.0, bottom)))
    along = np.array(((right, 0.0, 1.0), (0.0, top, 1.0), (left, 0.0, 1.0), (0.0, bottom, 1.0)))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)

    def size(places):
        return angle * np.linalg.norm(places, axis=1)

    def far(places):
        """Return the size of a pixel at the distance to the pyramid of view, as Cycles estimates it."""
        outside = places @ normals.T
        beyond, ahead_of_edge = outside > 0.0, places @ along.T >= 0.0
        eye = np.linalg.norm(places, axis=1)
        distance = np.where(beyond & ahead_of_edge, outside, 0.0).max(axis=1)
        behind = (beyond & ~ahead_of_edge).any(axis=1)
        distance = np.where(behind, np.where(distance > 0.0, np.minimum(distance, eye), eye), distance)
        return angle * np.where(beyond.all(axis=1), eye, distance)

    return size, far


def _orthographic(camera):
    left, right, bottom, top = camera.window
    pixel = min(_steps(camera))
    # Cycles divides the distance by half the diagonal of the picture's first corner.
    half = np.sqrt(0.5 * (right * right + top * top))

    def size(places):
        return np.full(len(places), pixel)

    def far(places):
        nearest = np.clip(places, (left, bottom, 0.0), (right, top, np.inf))
        return pixel * np.linalg.norm(places - nearest, axis=1) / half if half > 0.0 else np.zeros(len(places))

    return size, far


def _panoramic(camera):
    """Take the pixels at the centre of the picture; Cycles' panoramas have no larger ones outside."""
    angle = _central_angle(camera)

    def size(places):
        return angle * np.linalg.norm(places, axis=1)

    return size, lambda places: np.zeros(len(places))


def _central_angle(camera):
    """Return the angle in radians that a pixel at the centre of a panorama sees, the mean of its two sides."""
    numbers, width, height = camera.panorama, camera.width, camera.height
    if camera.kind == CameraKind.EQUIRECTANGULAR:
        return 0.5 * (abs(numbers[3] - numbers[2]) / width + abs(numbers[1] - numbers[0]) / height)
    if camera.kind == CameraKind.FISHEYE_EQUISOLID:
        lens, _, across, up = numbers[:4]
        return 0.5 * (across / width + up / height) / max(lens, 1e-6)
    if camera.kind == CameraKind.CYLINDRICAL:
        return 0.5 * (abs(numbers[1] - numbers[0]) / width + abs(numbers[3] - numbers[2]) / height)
    if camera.kind == CameraKind.MIRROR_BALL:
        # The ball shows all directions; at its centre the direction turns by four times the step over the radius.
        return 2.0 * (1.0 / width + 1.0 / height) * 2.0
    return 0.5 * numbers[0] * (1.0 / width + 1.0 / height)


_MEASURES = {CameraKind.PERSPECTIVE: _perspective, CameraKind.ORTHOGRAPHIC: _orthographic}
