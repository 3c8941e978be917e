"""A camera for files that have none: it frames all rendered objects."""

import math

import bpy
import numpy as np
from mathutils import Matrix, Vector

# From the front, a little from the right and from above, as a product is photographed.
_FROM = Vector((0.45, -1.0, 0.5)).normalized()
_MARGIN = 1.1


def find_camera(scene, layer):
    """Give a scene without a camera one. Return the change in words, or an empty text."""
    if scene.camera is not None:
        return ""
    found = next((thing for thing in scene.objects if thing.type == "CAMERA"), None)
    if found is not None:
        scene.camera = found
        return f"no camera was chosen, '{found.name}' is used"
    middle, radius = _sphere(layer)
    data = bpy.data.cameras.new("Framing all")
    angle = min(data.angle_x, data.angle_y)
    distance = _MARGIN * radius / math.sin(0.5 * angle)
    data.clip_start, data.clip_end = max(1e-3, 0.01 * distance), 100.0 * distance
    thing = bpy.data.objects.new("Framing all", data)
    scene.collection.objects.link(thing)
    turn = (-_FROM).to_track_quat("-Z", "Y").to_matrix().to_4x4()
    thing.matrix_world = Matrix.Translation(middle + distance * _FROM) @ turn
    scene.camera = thing
    return "it has no camera, one that frames all is used"


def _sphere(layer):
    """Return (middle, radius) of a sphere about the bounding boxes of all rendered objects; (0, 1) if there are none."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    corners = []
    for entry in depsgraph.object_instances:
        thing = entry.object
        if (
            thing.type in {"MESH", "CURVE", "SURFACE", "FONT", "META", "VOLUME", "POINTCLOUD", "CURVES"}
            and not thing.hide_render
        ):
            corners += [tuple(entry.matrix_world @ Vector(corner)) for corner in thing.bound_box]
    points = np.array(corners, float).reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return Vector((0.0, 0.0, 0.0)), 1.0
    low, high = points.min(axis=0), points.max(axis=0)
    return Vector(0.5 * (low + high)), max(1e-3, 0.5 * float(np.linalg.norm(high - low)))
