"""The scene's camera: a rigid frame, a window, a lens."""

from typing import NamedTuple

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.abi import LancerError
from ..bindings.enums import CameraKind
from .panorama import panorama

NO_CAMERA = "scene '{}' has no camera: add one, or choose one in the scene properties"


def image_size(scene):
    """Return (width, height) of the full image in pixels, truncated as in Blender."""
    render = scene.render
    percentage = render.resolution_percentage
    return render.resolution_x * percentage // 100, render.resolution_y * percentage // 100


def border(scene, width, height):
    """Return (x, y, width, height) of the rendered region, computed in single precision and truncated as in Blender."""
    render = scene.render
    if not render.use_border:
        return 0, 0, width, height
    x0, x1 = (int(np.float32(edge) * np.float32(width)) for edge in (render.border_min_x, render.border_max_x))
    y0, y1 = (int(np.float32(edge) * np.float32(height)) for edge in (render.border_min_y, render.border_max_y))
    return x0, y0, x1 - x0, y1 - y0


class Eye(NamedTuple):
    """A view of a picture with stereoscopy, as Blender places it."""

    side: float  # of spherical stereo, in distances between the eyes to the right; else 0
    matrix: np.ndarray  # (4, 4), of the camera
    shift_x: float


def export_camera(camera, depsgraph, messages, eye=None):
    """Return the snapshot.Camera of a camera object; raise LancerError if it is None, no camera, or its image is empty.

    eye: the Eye of a view with stereoscopy.
    """
    scene = depsgraph.scene
    if camera is None:
        raise LancerError(NO_CAMERA.format(scene.name))
    if camera.type != "CAMERA":
        raise LancerError(f"object '{camera.name}' is the scene's camera but no camera: choose one in the scene properties")
    camera = camera.evaluated_get(depsgraph)
    width, height = image_size(scene)
    x, y, region_width, region_height = border(scene, width, height)
    if min(width, height, region_width, region_height) < 1:
        raise LancerError(f"the image has {region_width} x {region_height} pixels: raise the resolution or widen the border")
    fields = camera_fields(camera, depsgraph, messages)
    window = _window(camera, depsgraph, fields["kind"], width, height)
    if eye is not None:
        fields["matrix"] = rigid(eye.matrix, f"camera '{camera.name}'", messages)
        fields.update(_spherical(camera.data.stereo, eye.side))
        window = _shifted(window, camera.data, fields["kind"], eye, width, height, scene.render)
    return snapshot.Camera(
        width=width,
        height=height,
        x=x,
        y=y,
        region_width=region_width,
        region_height=region_height,
        window=window,
        **fields,
    )


def _spherical(stereo, side):
    """Return the fields of spherical stereo; none at the middle between the eyes."""
    if side == 0.0:
        return {}
    merges = stereo.use_pole_merge
    return {
        "eye_offset": side * stereo.interocular_distance,
        "convergence_distance": 0.0 if stereo.convergence_mode == "PARALLEL" else stereo.convergence_distance,
        "pole_merge_from": stereo.pole_merge_angle_from if merges else 0.0,
        "pole_merge_to": stereo.pole_merge_angle_to if merges else 0.0,
    }


def _shifted(window, data, kind, eye, width, height, render):
    """Return a window moved by the difference between an eye's shift and the camera's, whose unit is the side that fits."""
    left, right, bottom, top = window
    wide = width * render.pixel_aspect_x >= height * render.pixel_aspect_y
    fits_width = data.sensor_fit == "HORIZONTAL" or data.sensor_fit == "AUTO" and wide
    unit = right - left if fits_width else top - bottom
    if kind not in (CameraKind.PERSPECTIVE, CameraKind.ORTHOGRAPHIC):
        unit = 1.0
    moved = (eye.shift_x - data.shift_x) * unit
    return left + moved, right + moved, bottom, top


def camera_fields(camera, depsgraph, messages):
    """Return the fields of a snapshot.Camera that depend on the evaluated camera but not on the image size and window."""
    data = camera.data
    who = f"camera '{camera.name}'"
    kind, numbers = _projection(data, depsgraph.scene, who, messages)
    matrix = rigid(np.array(camera.matrix_world, float), who, messages)
    start = messages.number(data.clip_start, who, "clip start", 0.1, 0.0)
    lens_radius, focal_distance = _lens(data, kind, matrix, start, depsgraph, who, messages)
    dof = data.dof
    return {
        "matrix": matrix,
        "kind": kind,
        "clip_start": start,
        "clip_end": messages.number(data.clip_end, who, "clip end", 1000.0, start),
        "lens_radius": lens_radius,
        "focal_distance": focal_distance,
        "aperture_blades": dof.aperture_blades,
        "aperture_rotation": messages.number(dof.aperture_rotation, who, "aperture rotation", 0.0),
        "aperture_ratio": messages.number(dof.aperture_ratio, who, "aperture ratio", 1.0, 1e-3),
        "panorama": numbers,
    }


def _projection(data, scene, who, messages):
    """Return (kind, parameters of the panorama)."""
    if data.type == "PANO":
        render, (width, height) = scene.render, image_size(scene)
        aspect = width * render.pixel_aspect_x / (height * render.pixel_aspect_y)
        return panorama(data, aspect, who, messages)
    if data.type not in ("PERSP", "ORTHO"):
        messages.add(
            f"{who}: type {data.type} is not supported, a perspective camera is used", f"feature:{data.type.lower()} camera"
        )
    return CameraKind.ORTHOGRAPHIC if data.type == "ORTHO" else CameraKind.PERSPECTIVE, (0.0,) * 8


def _window(camera, depsgraph, kind, width, height):
    """Return left, right, bottom, top from Blender's projection matrix, which includes sensor fit, shift and pixel aspect."""
    if kind not in (CameraKind.PERSPECTIVE, CameraKind.ORTHOGRAPHIC):
        x, y = camera.data.shift_x, camera.data.shift_y
        return x, 1.0 + x, y, 1.0 + y
    render = depsgraph.scene.render
    p = camera.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    if camera.data.type not in ("PERSP", "ORTHO"):
        # Blender has no projection matrix for a panoramic camera: its perspective stand-in uses the same lens and sensor.
        half = 0.5 * camera.data.sensor_width / max(camera.data.lens, 1e-6)
        aspect = height * render.pixel_aspect_y / (width * render.pixel_aspect_x)
        return -half, half, -half * aspect, half * aspect
    return window_of(p, kind)


def window_of(p, kind):
    """Return left, right, bottom, top of the window of a projection matrix."""
    if kind == CameraKind.PERSPECTIVE:
        return tuple((sign + p[axis][2]) / p[axis][axis] for axis in (0, 1) for sign in (-1.0, 1.0))
    return tuple((sign - p[axis][3]) / p[axis][axis] for axis in (0, 1) for sign in (-1.0, 1.0))


def rigid(matrix, who, messages):
    """Return the (3, 4) frame of a camera matrix without scale and shear, exactly orthogonal, mirrored if the matrix is.

    Raise LancerError if the matrix is not finite or its axes do not span space.
    """
    if not np.isfinite(matrix).all():
        raise LancerError(f"{who}: its transform is not finite")
    columns = matrix[:3, :3].T
    lengths = np.linalg.norm(columns, axis=1)
    if not lengths.all():
        raise LancerError(f"{who}: its scale is zero along an axis")
    x, y, z = columns / lengths[:, None]
    # Keep the view direction; shear is the part of x and y along z and along each other.
    upright = y - z * (y @ z)
    length = np.linalg.norm(upright)
    if not length > 0.0:
        raise LancerError(f"{who}: its axes lie in one plane")
    # Rounding to single precision leaves dot products of about 1e-7 per matrix product; parents without shear stay below 1e-5.
    if max(abs(x @ y), abs(x @ z), abs(y @ z)) > 1e-5:
        messages.add(f"{who}: shear is not supported, its view direction is kept", "feature:sheared camera")
    y = upright / length
    right = np.cross(y, z)
    result = np.empty((3, 4))
    result[:, 0] = right if right @ x >= 0.0 else -right
    result[:, 1], result[:, 2], result[:, 3] = y, z, matrix[:3, 3]
    return result


def _lens(data, kind, matrix, clip_start, depsgraph, who, messages):
    """Return aperture radius and focal distance; radius 0 without depth of field."""
    dof = data.dof
    if not dof.use_dof:
        return 0.0, 1.0
    fstop = messages.number(dof.aperture_fstop, who, "f-stop", 2.8, 1e-5)
    radius = 0.5 / fstop if kind == CameraKind.ORTHOGRAPHIC else 0.5e-3 * data.lens / fstop
    distance = dof.focus_distance
    if dof.focus_object is not None:
        focus = dof.focus_object.evaluated_get(depsgraph)
        target = focus.matrix_world
        bone = focus.pose.bones.get(dof.focus_subtarget) if focus.type == "ARMATURE" and dof.focus_subtarget else None
        if bone is not None:
            target = target @ bone.matrix
        distance = abs(float(matrix[:, 2] @ (matrix[:, 3] - np.array(target.translation, float))))
    if not distance > 0.0:
        messages.add(f"{who}: its focus distance is {distance:g}, everything is kept sharp")
        return 0.0, 1.0
    if kind == CameraKind.ORTHOGRAPHIC and bpy.app.version < (4, 0):
        # Before 4.0 Cycles puts the lens on the near clipping plane. At the camera, the same cone of rays is wider and its
        # focus more distant.
        return radius * (distance + clip_start) / distance, distance + clip_start
    return radius, distance
