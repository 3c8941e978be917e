"""The views of a picture: one, or with stereoscopy one for each eye or camera."""

import dataclasses
from typing import NamedTuple

import numpy as np

from ..export.camera import Eye, export_camera
from ..export.vectors import camera_in_frames
from ..messages.messages import Messages


class View(NamedTuple):
    name: str  # as Blender's result has it; "" without stereoscopy
    camera: object  # the snapshot.Camera
    keys: tuple = ()  # of a moving camera: snapshot.Cameras while the shutter is open, see snapshot.Motion

    def shown(self, snapshot):
        """Return a SceneSnapshot through the camera of this view."""
        motion = snapshot.motion and dataclasses.replace(snapshot.motion, keys=self.keys)
        return snapshot.replaced(camera=self.camera, motion=motion)


class Sight:
    """The cameras of a picture with several views, for an export that reads them at other times, too."""

    def __init__(self, engine, depsgraph):
        self._engine, self._depsgraph = engine, depsgraph
        # As in Cycles, a marker of another frame changes no camera.
        self._owners = _owners(engine, depsgraph)
        self.owners = tuple(self._owners.values())
        self.frames = ()  # for the pass Vector: of each view the snapshot.Cameras one frame before and one after
        self.keys = ()  # with motion blur: of each view those at the keys, none where it stands still

    def cameras(self, messages=None):
        """Return the snapshot.Camera of each view as the depsgraph is evaluated."""
        messages = Messages() if messages is None else messages
        return [_camera(self._engine, name, self._depsgraph, owner, messages) for name, owner in self._owners.items()]

    def views(self, messages):
        """Return the Views in Blender's order, once the export has ended."""
        cameras = self.cameras(messages)
        if self.frames:
            around = zip(cameras, self.frames, self.owners, strict=True)
            cameras = [camera_in_frames(now, frames, owner, messages) for now, frames, owner in around]
        return tuple(map(View, self._owners, cameras, self.keys or ((),) * len(cameras)))


def sight_of(engine, depsgraph):
    """Return the Sight of a picture; None without stereoscopy."""
    return Sight(engine, depsgraph) if depsgraph.scene.render.use_multiview else None


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
