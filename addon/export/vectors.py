"""The pass Vector: where instances, vertices and cameras are one frame before the picture and one after.

The rules are those of Cycles: switches of motion blur do not count, but that of the camera, which then stands still. A zoom
counts since Blender 4.3; a shift, an orthographic scale and the settings of a panorama do not count.
"""

import dataclasses

import bpy
import numpy as np

from ..bindings.enums import CameraKind
from ..bindings.snapshot import InstanceVectors

# Relative times of the frames in a Shutter of vectors.
FRAMES = (-1.0, 1.0)
_ZOOMS = bpy.app.version >= (4, 3)
# In these versions Cycles projects the other frames of an orthographic camera as those of a perspective one.
_BENDS = (4, 3) <= bpy.app.version < (5, 2)


def instance_vectors(matrices, frames):
    """Return the InstanceVectors of instances, None if all stand still. matrices: (n, 3, 4); frames: those in both frames."""
    places = np.stack(frames, axis=1)
    rows = np.flatnonzero((places != matrices[:, None]).any(axis=(1, 2, 3)))
    return InstanceVectors(rows, places[rows]) if len(rows) else None


def mesh_in_frames(mesh, frames):
    """Return a MeshData with its vertices in both frames. frames: Shapes."""
    return dataclasses.replace(mesh, vector_positions=np.stack([shape.positions for shape in frames]))


def camera_in_frames(now, frames, owner, messages):
    """Return a snapshot.Camera with its places in both frames. frames: snapshot.Cameras; owner: the camera object."""
    turns = getattr(getattr(owner.original, "cycles", None), "use_motion_blur", True)
    matrices = [frame.matrix if turns else now.matrix for frame in frames]
    windows = [_zoomed(now, frame) for frame in frames]
    if all(np.array_equal(matrix, now.matrix) for matrix in matrices) and all(window == now.window for window in windows):
        return now
    if now.kind == CameraKind.ORTHOGRAPHIC and _BENDS:
        messages.add(
            f"camera '{owner.name}': moves, and Cycles of this Blender takes it for a perspective camera in the pass Vector; "
            "here the pass has its true motion"
        )
    return now.replaced(matrix_before=matrices[0], matrix_after=matrices[1], window_before=windows[0], window_after=windows[1])


def _zoomed(now, then):
    """Return the window of a camera with the field of view that it has at another time."""
    left, right, *_ = now.window
    ratio = (then.window[1] - then.window[0]) / (right - left)
    # Blender computes widths in single precision: a shift changes them by up to some 1e-7.
    if now.kind != CameraKind.PERSPECTIVE or not _ZOOMS or abs(ratio - 1.0) < 1e-6:
        return now.window
    return tuple(ratio * edge for edge in now.window)
