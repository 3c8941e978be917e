"""The camera of a snapshot in the parameters of the other renderers."""

import math
from dataclasses import dataclass

import numpy as np

from addon.bindings.enums import CameraKind

from . import Cannot


@dataclass(frozen=True)
class View:
    """A pinhole camera: its place, three unit vectors, and the window at distance 1 as left, right, bottom, top."""

    origin: np.ndarray
    right: np.ndarray
    up: np.ndarray
    forward: np.ndarray
    window: tuple
    width: int
    height: int

    @property
    def horizontal_angle(self):
        """Return the horizontal angle of view in degrees; the window must be symmetric about the axis."""
        return 2.0 * math.degrees(math.atan(self.window[1]))

    def direction(self, x, y):
        """Return the direction, not normalised, through a point of the picture; x and y are 0 at the lower left corner, and 1
        at the upper right one.
        """
        left, right, bottom, top = self.window
        return self.forward + (left + x * (right - left)) * self.right + (bottom + y * (top - bottom)) * self.up


def read_view(camera):
    if camera.kind != CameraKind.PERSPECTIVE:
        raise Cannot(f"the camera is {CameraKind(camera.kind).name.lower()}")
    if camera.lens_radius > 0.0:
        raise Cannot("the camera has depth of field")
    if (camera.x, camera.y, camera.region_width, camera.region_height) != (0, 0, camera.width, camera.height):
        raise Cannot("a part of the picture is asked for")
    left, right, bottom, top = camera.window
    if abs(left + right) > 1e-6 * (right - left) or abs(bottom + top) > 1e-6 * (top - bottom):
        raise Cannot("the camera is shifted")
    # The renderers assume square pixels, so the window must have the picture's aspect ratio.
    if abs((right - left) * camera.height - (top - bottom) * camera.width) > 1e-5 * (right - left) * camera.height:
        raise Cannot("pixels are not square")
    matrix = camera.matrix
    window = (-right, right, -top, top)
    return View(matrix[:, 3], matrix[:, 0], matrix[:, 1], -matrix[:, 2], window, camera.width, camera.height)
