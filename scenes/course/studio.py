"""Snapshots and pictures shared by the chapters: small scenes made here, and scenes of this folder exported from Blender."""

import tempfile
from pathlib import Path

import numpy as np
import tiny_scenes
from tiny_scenes import look_at, move, rgb

from addon.bindings.abi import Integrator, LightKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Light, SceneSnapshot

# A picture of one sample through the middle of each pixel has no noise.
SINGLE = 2e-6
SINGLE_WHY = "a dozen products in single precision, 6e-8 each"
EYE = np.array((3.0, 0.0, 4.0))
LAMP = np.array((-1.0, 2.0, 2.0))


def render(shot, which=Pass.COMBINED, **settings):
    """Returns a pass of a snapshot, (height, width, channels), row 0 the lowest, rendered by all threads."""
    return tiny_scenes.render(tiny_scenes.with_settings(shot, **{"threads": 0, **settings}), which)


def classic(things, materials, lights=(), meshes=(), world=0.0, camera=None, **settings):
    """Returns a snapshot for the recursive ray tracer: one sample in the middle of each pixel."""
    settings = {"integrator": Integrator.CLASSIC, "samples": 1, "max_bounces": 10, **settings}
    return tiny_scenes.scene(things, materials, lights, meshes, world, camera or parallel(), **settings)


def parallel(eye=EYE, target=(0.0, 0.0, 0.0), width=4.0, pixels=16):
    """Returns an orthographic camera."""
    return tiny_scenes.pencil(tuple(eye), tuple(target), width, pixels)


def perspective(eye, target, pixels=160, window=0.4):
    return Camera(matrix=look_at(eye, target), width=pixels, height=pixels, window=(-window, window, -window, window))


def lamp(position=LAMP, intensity=9.0, **fields):
    return Light("lamp", move(*position), LightKind.POINT, emission=rgb(intensity), **fields)


def seen_on_plane(shot):
    """Returns the points of z = 0 in the middles of the pixels, (height, width, 3), and the unit vectors to the camera."""
    height, width = shot.camera.height, shot.camera.width
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    with Session.upload(shot) as session:
        origins, directions = session.probe_camera(np.stack([x.ravel(), y.ravel()], axis=1))
    points = origins - directions * (origins[:, 2:] / directions[:, 2:])
    back = -directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return points.reshape(height, width, 3), back.reshape(height, width, 3)


def from_blender(name, width, height, prepare=None):
    """Returns a scene of this folder as Blender's exporter gives it to F12; prepare(scene) may change the scene before.

    Saving and loading converts the add-on's own classes to those of the small scenes."""
    import bpy

    import scenes
    from addon.export.scene import export_scene

    scene = scenes.load(name)
    scene.render.engine = "LANCER"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    if prepare is not None:
        prepare(scene)
    shot, _ = export_scene(bpy.context.evaluated_depsgraph_get())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.npz"
        shot.save(path)
        return SceneSnapshot.load(path)


def beside(*pictures):
    """Returns pictures of one height in a row."""
    return np.concatenate([np.asarray(picture)[..., :3] for picture in pictures], axis=1)
