"""Simplify's culling of objects out of sight, by camera and by distance, as in Cycles: no ray meets a culled object.

An object is culled if each of its own switches says so, of those that the scene switches on. Lamps are never culled, and
nothing is for panoramas and for several views.
"""

import numpy as np

from ..bindings.enums import CameraKind, Ray

# Bits of an object's switches.
_CAMERA, _DISTANCE = 1, 2
# The rays that do not meet a culled object: all.
EVERY_RAY = int(sum(Ray))


class Culling:
    def __init__(self, scene, camera):
        """camera: the snapshot.Camera of the picture."""
        self._camera = camera
        self._switches = 0
        cycles = getattr(scene, "cycles", None)
        is_flat = camera.kind in (CameraKind.PERSPECTIVE, CameraKind.ORTHOGRAPHIC)
        if cycles is None or not scene.render.use_simplify or not is_flat or scene.render.use_multiview:
            return
        self._margin, self._distance = cycles.camera_cull_margin, cycles.distance_cull_margin
        if cycles.use_camera_cull:
            self._switches |= _CAMERA
        if cycles.use_distance_cull and self._distance != 0.0:
            self._switches |= _DISTANCE

    def __bool__(self):
        return self._switches != 0

    def switches(self, owner):
        """Return the switches of an object that the scene lets act; 0 for most."""
        cycles = getattr(owner, "cycles", None)
        if not self._switches or cycles is None:
            return 0
        own = _CAMERA * cycles.use_camera_cull | _DISTANCE * cycles.use_distance_cull
        return own & self._switches

    def culled(self, switches, boxes, matrices):
        """Return which objects are culled: their switches (n,), boxes in object space (n, 8, 3) and matrices (n, 3, 4)."""
        corners = boxes @ matrices[:, :, :3].transpose(0, 2, 1) + matrices[:, None, :, 3]
        result = switches != 0
        for switch, out_of_sight in ((_CAMERA, self._beside), (_DISTANCE, self._beyond)):
            asked = (switches & switch) != 0
            result[asked] &= out_of_sight(corners[asked])
        return result

    def _beside(self, corners):
        """Whether boxes lie beside the picture, or behind the near clipping plane."""
        camera, margin = self._camera, self._margin
        left, right, bottom, top = camera.window
        local = (corners - camera.matrix[:, 3]) @ camera.matrix[:, :3]
        depth, near, far = -local[..., 2], camera.clip_start, camera.clip_end
        if camera.kind == CameraKind.PERSPECTIVE:
            clip = (depth - near) * far / (far - near)
            with np.errstate(divide="ignore", invalid="ignore"):
                places = local[..., :2] / depth[..., None]
        else:
            clip = (depth - near) / (far - near)
            places = local[..., :2]
        places = (places - (left, bottom)) / (right - left, top - bottom)
        # Cycles mirrors places behind the near clipping plane.
        places = np.where(clip[..., None] < 0.0, 1.0 - places, places)
        low, high = places.min(axis=1), places.max(axis=1)
        is_behind = (clip < -margin).all(axis=1)
        return is_behind | (low >= 1.0 + margin).any(axis=1) | (high <= -margin).any(axis=1)

    def _beyond(self, corners):
        eye = self._camera.matrix[:, 3]
        nearest = np.clip(eye, corners.min(axis=1), corners.max(axis=1))
        return ((nearest - eye) ** 2).sum(axis=1) > self._distance**2
