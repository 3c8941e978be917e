"""The views of a picture: one, or with stereoscopy one for each eye or camera."""

from typing import NamedTuple

import numpy as np

from ..export.camera import Eye, export_camera
from ..export.vectors import camera_in_frames
from ..messages.messages import Messages


class View(NamedTuple):
    name: str  # as Blender's result has it; "" without stereoscopy
    camera: object  # the snapshot.Camera


def views(engine, depsgraph, camera, messages, frames=()):
    """Return the Views of a picture in Blender's order. camera: the snapshot.Camera of a picture without stereoscopy.

    frames: of each view the snapshot.Cameras one frame before and one after, from an export with look().
    """
    if not depsgraph.scene.render.use_multiview:
        return (View("", camera),)
    owners = _owners(engine, depsgraph)
    cameras = _cameras(engine, depsgraph, owners, messages)
    if frames:
        cameras = [
            camera_in_frames(now, around, owner, messages)
            for now, around, owner in zip(cameras, frames, owners.values(), strict=True)
        ]
    return tuple(map(View, owners, cameras))


def look(engine, depsgraph, shutter, frames):
    """Return the fields of ExportOptions that make an export for vectors read the cameras of all views into the list frames."""
    if not depsgraph.scene.render.use_multiview or shutter is None or shutter.blurs:
        return {}
    # As in Cycles, a marker of another frame changes no camera.
    owners = _owners(engine, depsgraph)
    return {"views": lambda: _cameras(engine, depsgraph, owners, Messages()), "on_views": frames.extend}


def _owners(engine, depsgraph):
    """Return {name: camera object} of the views: those of the result, else two eyes, or those that are on."""
    scene = depsgraph.scene
    names = [view.name for view in engine.get_result().views]
    if not names:
        views = scene.render.stereo_views if scene.render.views_format == "STEREO_3D" else scene.render.views
        names = [view.name for view in views if view.use]
    owners = {}
    for name in names:
        engine.active_view_set(name)
        owners[name] = engine.camera_override or scene.camera
    return owners


def _cameras(engine, depsgraph, owners, messages):
    """Return the snapshot.Camera of each view as the depsgraph is evaluated."""
    return [_camera(engine, name, depsgraph, owner, messages) for name, owner in owners.items()]


def _camera(engine, name, depsgraph, camera, messages):
    # Blender tells the place and the shift of the view that is active.
    engine.active_view_set(name)
    is_spherical = engine.use_spherical_stereo(camera)
    eye = Eye(
        {"left": -0.5, "right": 0.5}.get(name, 0.0) if is_spherical else 0.0,
        np.array(engine.camera_model_matrix(camera, use_spherical_stereo=is_spherical), float).reshape(4, 4),
        engine.camera_shift_x(camera, use_spherical_stereo=is_spherical),
    )
    return export_camera(camera, depsgraph, messages, eye)
