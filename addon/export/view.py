"""The rendered part of a 3D view's region, and a camera for that part."""

from typing import NamedTuple

import numpy as np
from mathutils import Vector

from ..bindings import snapshot
from ..bindings.enums import CameraKind
from .camera import camera_fields, rigid, window_of


class Rectangle(NamedTuple):
    """A rectangle in pixels of the region, from its lower left corner."""

    x: int
    y: int
    width: int
    height: int

    def cut(self, other):
        x, y = max(self.x, other.x), max(self.y, other.y)
        right = min(self.x + self.width, other.x + other.width)
        top = min(self.y + self.height, other.y + other.height)
        return Rectangle(x, y, max(0, right - x), max(0, top - y))


class View(NamedTuple):
    rectangle: Rectangle
    camera: snapshot.Camera  # its image is the rectangle, with one pixel for each pixel of the region

    def coarser(self, size):
        """Return the camera with pixels of size x size pixels of the region."""
        width, height = (max(1, round(side / size)) for side in self.rectangle[2:])
        return self.camera.replaced(width=width, height=height, region_width=width, region_height=height)


def export_view(region, region_data, space, depsgraph, messages):
    """Return the View of a region; None if no pixel is to be rendered. region_data: a RegionView3D; space: its SpaceView3D."""
    whole = Rectangle(0, 0, region.width, region.height)
    thing = space.camera if region_data.view_perspective == "CAMERA" else None
    if thing is not None and thing.type == "CAMERA":
        return _through_camera(thing.evaluated_get(depsgraph), whole, region_data, depsgraph, messages)
    rectangle = _border(space, "render_border", whole, whole) if space.use_render_border else whole
    if min(rectangle[2:]) < 1:
        return None
    kind = CameraKind.PERSPECTIVE if region_data.is_perspective else CameraKind.ORTHOGRAPHIC
    matrix = rigid(np.array(region_data.view_matrix.inverted(), float), "view", messages)
    start, end = space.clip_start, space.clip_end
    if kind == CameraKind.ORTHOGRAPHIC:
        # Blender's orthographic view shows as much behind the viewpoint as in front of it.
        matrix[:, 3] += end * matrix[:, 2]
        start, end = 0.0, 2.0 * end
    window = _part(window_of(region_data.window_matrix, kind), whole, rectangle)
    size = {"width": rectangle.width, "height": rectangle.height}
    return View(rectangle, snapshot.Camera(matrix, kind, window=window, clip_start=start, clip_end=end, **size))


def _through_camera(thing, whole, region_data, depsgraph, messages):
    # Read the camera first: it raises an error for a camera whose transform has no frame.
    fields = camera_fields(thing, depsgraph, messages)
    kind = fields["kind"]
    render = depsgraph.scene.render
    frame = _frame(thing, whole, region_data, depsgraph.scene)
    rectangle = _border(render, "border", frame, whole) if render.use_border else whole
    if min(rectangle[2:]) < 1:
        return None
    if kind in (CameraKind.PERSPECTIVE, CameraKind.ORTHOGRAPHIC):
        # Blender's projection of the region includes the place of the camera's frame in it.
        window = _part(window_of(region_data.window_matrix, kind), whole, rectangle)
    else:
        x, y = thing.data.shift_x, thing.data.shift_y
        window = _part((x, 1.0 + x, y, 1.0 + y), frame, rectangle)
    return View(rectangle, snapshot.Camera(width=rectangle.width, height=rectangle.height, window=window, **fields))


def _part(window, whole, part):
    """Return the window of a part of the rectangle whole, of which window is given."""
    left, right, bottom, top = window
    x, y = (right - left) / whole.width, (top - bottom) / whole.height
    start = left + (part.x - whole.x) * x, bottom + (part.y - whole.y) * y
    return start[0], start[0] + part.width * x, start[1], start[1] + part.height * y


def _frame(thing, whole, region_data, scene):
    """Return the rectangle of the camera's frame, in fractions of pixels; it may extend beyond the region."""
    matrix = region_data.perspective_matrix @ thing.matrix_world.normalized()
    corners = [matrix @ Vector((*corner, 1.0)) for corner in thing.data.view_frame(scene=scene)]
    places = np.array([[corner.x / corner.w, corner.y / corner.w] for corner in corners])
    low, high = ((0.5 + 0.5 * places.min(axis=0)), (0.5 + 0.5 * places.max(axis=0)))
    size = np.array((whole.width, whole.height))
    return Rectangle(*(low * size).tolist(), *((high - low) * size).tolist())


def _border(owner, prefix, frame, whole):
    """Return the Rectangle of the region inside an owner's border, given in fractions of the frame."""
    left, right, bottom, top = (getattr(owner, f"{prefix}_{edge}") for edge in ("min_x", "max_x", "min_y", "max_y"))
    x, y = round(frame.x + left * frame.width), round(frame.y + bottom * frame.height)
    width = round(frame.x + right * frame.width) - x
    height = round(frame.y + top * frame.height) - y
    return Rectangle(x, y, max(0, width), max(0, height)).cut(whole)
