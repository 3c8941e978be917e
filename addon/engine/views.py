"""The views of a picture: one, or with stereoscopy one for each eye or camera."""

from typing import NamedTuple

import numpy as np

from ..export.camera import Eye, export_camera


class View(NamedTuple):
    name: str  # as Blender's result has it; "" without stereoscopy
    camera: object  # the snapshot.Camera


def views(engine, depsgraph, camera, messages):
    """Return the Views of a picture in Blender's order. camera: the snapshot.Camera of a picture without stereoscopy."""
    if not depsgraph.scene.render.use_multiview:
        return (View("", camera),)
    names = [view.name for view in engine.get_result().views] or _names(depsgraph.scene)
    return tuple(View(name, _camera(engine, name, depsgraph, messages)) for name in names)


def _names(scene):
    """Return the names of the views that a scene renders: two eyes, or those that are on."""
    if scene.render.views_format == "STEREO_3D":
        return [view.name for view in scene.render.stereo_views if view.use]
    return [view.name for view in scene.render.views if view.use]


def _camera(engine, name, depsgraph, messages):
    # Blender tells the camera, its place and its shift of the view that is active.
    engine.active_view_set(name)
    camera = engine.camera_override or depsgraph.scene.camera
    is_spherical = engine.use_spherical_stereo(camera)
    eye = Eye(
        {"left": -0.5, "right": 0.5}.get(name, 0.0) if is_spherical else 0.0,
        np.array(engine.camera_model_matrix(camera, use_spherical_stereo=is_spherical), float).reshape(4, 4),
        engine.camera_shift_x(camera, use_spherical_stereo=is_spherical),
    )
    return export_camera(camera, depsgraph, messages, eye)
