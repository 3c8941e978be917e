"""Compare the projection of a 3D view with Blender's own, and its picture with F12's through the same camera."""

import math

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Quaternion, Vector
from viewport_stage import View, build, finished, shown, until

from addon.bindings.session import Session
from addon.export.scene import export_scene
from addon.export.view import export_view
from addon.messages.messages import Messages

POINTS = [Vector(point) for point in ((0.3, 0.2, 0.1), (-0.8, 0.5, 0.4), (0.9, -0.7, 0.6), (0.1, 0.9, -0.3))]


def _raster(view, point):
    """Return the pixel of the region at which a View's camera shows a point, by the definitions of lancer.h."""
    camera = view.camera
    local = np.linalg.inv(np.vstack([camera.matrix, [0, 0, 0, 1]])) @ (*point, 1.0)
    x, y = local[:2] / -local[2] if camera.kind == 0 else local[:2]
    left, right, bottom, top = camera.window
    rectangle = view.rectangle
    return (
        rectangle.x + (x - left) / (right - left) * rectangle.width,
        rectangle.y + (y - bottom) / (top - bottom) * rectangle.height,
    )


def _free(view):
    view.data.view_perspective = "PERSP"


def _turned(view):
    view.data.view_rotation = Quaternion((0.3, 1.0, 0.2), 0.9)
    view.data.view_distance = 6.0


def _orthographic(view):
    view.data.view_perspective = "ORTHO"


def _lens(view):
    view.data.view_perspective = "PERSP"
    view.space.lens = 85.0


def _border(view):
    view.space.use_render_border = True
    view.space.render_border_min_x, view.space.render_border_max_x = 0.2, 0.7
    view.space.render_border_min_y, view.space.render_border_max_y = 0.3, 0.9


def _camera(view):
    view.space.use_render_border = False
    view.data.view_perspective = "CAMERA"


def _zoomed(view):
    view.data.view_camera_zoom = 40.0
    view.data.view_camera_offset = (0.1, -0.05)


def _shifted(view):
    data = bpy.context.scene.camera.data
    data.shift_x, data.shift_y, data.sensor_fit = 0.2, -0.1, "VERTICAL"


def _portrait(view):
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.pixel_aspect_y = 90, 200, 1.5


def _camera_border(view):
    render = bpy.context.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.1, 0.6


def _camera_orthographic(view):
    bpy.context.scene.camera.data.type = "ORTHO"


VIEWS = (
    _free, _turned, _orthographic, _lens, _border, _camera, _zoomed, _shifted, _portrait, _camera_border, _camera_orthographic,
)  # fmt: skip


def places(folder):
    """Return {view: largest distance in pixels of our projections of four points from Blender's, rectangle, whole region}."""
    scene = build()
    view = View()
    result = {}
    for change in VIEWS:
        change(view)
        yield 0.3
        depsgraph = bpy.context.evaluated_depsgraph_get()
        got = export_view(view.region, view.data, view.space, depsgraph, Messages())
        far = 0.0
        for point in POINTS:
            theirs = location_3d_to_region_2d(view.region, view.data, point)
            far = max(far, math.dist(theirs, _raster(got, point)))
        result[change.__name__.strip("_")] = far, *got.rectangle, view.region.width, view.region.height
    assert scene.camera is not None
    return result


def _panoramic(view):
    data = bpy.context.scene.camera.data
    data.type = "PANO"
    (data if hasattr(data, "panorama_type") else data.cycles).panorama_type = "EQUIRECTANGULAR"


def _blurred(view):
    dof = bpy.context.scene.camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 3.0, 0.2


def alike(folder):
    """Return {camera: mean difference of 8 x 8 blocks between the view's picture and F12's, relative to F12's mean}."""
    scene = build(samples=16)
    view = View()
    view.render()
    scene.render.use_border = True
    result = {}
    for change in (_camera, _shifted, _blurred, _panoramic, _camera_orthographic):
        change(view)
        view.area.tag_redraw()
        yield 0.3
        if not (yield from until(finished)):
            return {"late": change.__name__}
        picture = shown().painter.picture
        rectangle = picture.wanted.view.rectangle
        depsgraph = bpy.context.evaluated_depsgraph_get()
        whole, _ = export_scene(depsgraph)
        size = {"width": rectangle.width, "height": rectangle.height}
        region = {"region_width": rectangle.width, "region_height": rectangle.height, "x": 0, "y": 0}
        camera = whole.camera.replaced(**size, **region)
        with Session.upload(whole.replaced(camera=camera)) as session:
            session.render_all(16)
            theirs = _blocks(session.read())
        result[change.__name__.strip("_")] = float(np.abs(_blocks(picture.image) - theirs).mean() / theirs.mean())
    return result


def _blocks(image):
    height, width = (side // 8 * 8 for side in image.shape[:2])
    return image[:height, :width, :3].reshape(height // 8, 8, width // 8, 8, 3).mean(axis=(1, 3))
