"""Motion blur: the export of keys, and the scene's own frame."""

import dataclasses
import os
import tempfile

import bpy
import exr
import numpy as np
import stage

from addon.bindings.abi import LancerError
from addon.bindings.session import Cancelled
from addon.engine import render_engine as engine
from addon.export.shutter import opening_of

SIZE = 24


def slide(thing, path="location", first=(-1.0, 0.0, 0.5), last=(1.0, 0.0, 0.5)):
    for frame, value in ((0, first), (4, last)):
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)
    straighten(thing)


def straighten(thing):
    """Let an object move at constant speed from key to key."""
    action = thing.id_data.animation_data.action
    curves = action.fcurves if bpy.app.version < (4, 4) else action.layers[0].strips[0].channelbags[0].fcurves
    for curve in curves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def _room(frame=2):
    scene = stage.empty(SIZE, SIZE, 8)
    stage.plane(material=stage.shader(Color=(0.6, 0.6, 0.6)))
    thing = stage.cube(0.8, stage.shader("ShaderNodeEmission"))
    slide(thing)
    stage.camera((0, -6, 2))
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    scene.frame_set(frame)
    return scene, thing


def _frame(scene):
    return scene.frame_current, scene.frame_subframe


class Watch:
    """Notes the frames that the export sets and the snapshots that it makes; may fail or cancel at a time."""

    def __init__(self, at=None, error=None):
        self.frames, self.snapshots, self._at, self._error = [], [], at, error

    def __enter__(self):
        self._kept = engine.export_picture

        def export(depsgraph, options, frame_set, poll=None):
            def watched(frame, subframe):
                self.frames.append(round(frame + subframe, 4))
                frame_set(frame, subframe)
                if self._error is not None and len(self.frames) == self._at:
                    raise self._error

            found = self._kept(depsgraph, options, watched, poll)
            # The render empties its own as it goes.
            self.snapshots.append(dataclasses.replace(found[0]))
            return found

        engine.export_picture = export
        return self

    def __exit__(self, *_):
        engine.export_picture = self._kept


def frames():
    """Return the frames that are set, and the scene's own frame after pictures of each position, a failure, and an Esc."""
    result = {}
    for position in ("CENTER", "START", "END"):
        scene, _ = _room()
        owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
        owner.motion_blur_position = position
        with Watch() as watch:
            bpy.ops.render.render()
        result[position] = watch.frames, _frame(scene)
    for name, error in (("failed", LancerError("no more")), ("cancelled", Cancelled())):
        scene, _ = _room()
        with Watch(1, error) as watch:
            try:
                bpy.ops.render.render()
            except RuntimeError as raised:
                result[f"{name} text"] = str(raised)
        result[name] = watch.frames, _frame(scene)
    return result


def animation():
    """Return the frames that are set for each frame of an animation, and whether its pictures are those of single renders."""
    scene, _ = _room(1)
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = os.path.join(tempfile.mkdtemp(), "frame")
    with Watch() as watch:
        bpy.ops.render.render(animation=True)
    together = [(s.instances, s.meshes, s.motion) for s in watch.snapshots]
    alone = []
    for frame in (1, 2, 3):
        scene, _ = _room(frame)
        with Watch() as single:
            bpy.ops.render.render()
        alone.append(single.snapshots[0])
    same = [
        np.array_equal(a[0].motions[0].matrices, b.instances.motions[0].matrices) and a[2] == b.motion
        for a, b in zip(together, alone, strict=True)
    ]
    return {"frames": watch.frames, "same": same}


def keys():
    """Return what the export finds of objects with several kinds of motion."""
    scene, thing = _room()
    thing.cycles.motion_steps = 2
    still = stage.cube(0.5, stage.shader(), location=(0, 2, 0))
    still.name = "Still"
    off = stage.cube(0.5, stage.shader(), location=(0, 3, 0))
    slide(off)
    off.cycles.use_motion_blur = False
    exact = stage.ball(0.5, stage.shader())
    exact.lancer.shape = "SPHERE"
    slide(exact)
    bent = stage.cube(0.5, stage.shader(), location=(2, 2, 0))
    bent.shape_key_add(name="Basis")
    key = bent.shape_key_add(name="Bent")
    key.data[0].co.x += 1.0
    for frame, value in ((0, 0.0), (4, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    grows = stage.cube(0.5, stage.shader(), location=(3, 2, 0))
    grows.data.name = "Grows"
    array = grows.modifiers.new("Array", "ARRAY")
    for frame, count in ((2, 1), (3, 3)):
        array.count = count
        array.keyframe_insert("count", frame=frame)
    turns_over = stage.cube(0.5, stage.shader(), location=(4, 2, 0))
    turns_over.name = "Turns over"
    slide(turns_over, "scale", (-1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
    for name, sides in (("Leans", (1.0, -0.5, 1.0)), ("Leans unmirrored", (1.0, 0.5, 1.0))):
        leans = stage.cube(0.5, stage.shader(), location=(5, 2, 0), rotation=(0.0, 0.0, 0.5))
        leans.name, leans.parent = name, stage.link(f"{name} parent", None)
        leans.parent.scale = sides
        slide(leans)
    stage.light().name = "Still lamp"
    lamp = stage.light(location=(1, 1, 3))
    lamp.name = "Lantern"
    slide(lamp)
    stage.sky()
    strength = scene.world.node_tree.nodes["Background"].inputs["Strength"]
    strength.keyframe_insert("default_value", frame=1)
    scene.frame_set(2)
    with Watch() as watch:
        bpy.ops.render.render()
    snapshot = watch.snapshots[0]
    names = snapshot.instances.names
    name_of = [names[number] for number in snapshot.instances.name_indices]
    moving = {
        name_of[number]: (matrices.shape[0], (matrices[-1] - matrices[0])[:, 3].round(5).tolist())
        for motions in snapshot.instances.motions
        for number, matrices in zip(motions.instances, motions.matrices, strict=True)
    }
    shapes = {mesh.name: len(mesh.moved_positions) for mesh in snapshot.meshes if mesh.moved_positions is not None}
    return {"moving": moving, "shapes": shapes, "camera": len(snapshot.motion.keys), "lines": list(engine.last_messages[scene])}


def instances():
    """Return the way of each instance whose order changes within the shutter: particles, of which one dies and one is born."""
    scene, thing = _room()
    thing.hide_render = True
    source = stage.plane(1.0)
    source.modifiers.new("Rain", "PARTICLE_SYSTEM")
    settings = source.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 6, 1, 2, 1.2
    settings.render_type, settings.instance_object = "OBJECT", thing
    settings.physics_type, settings.normal_factor = "NEWTON", 1.0
    settings.effector_weights.gravity = 0.0
    for frame in range(1, 4):
        scene.frame_set(frame)
    scene.frame_set(2)
    with Watch() as watch:
        bpy.ops.render.render()
    ways = [
        (matrices[1:, :, 3] - matrices[:-1, :, 3]).round(3).tolist()
        for motions in watch.snapshots[0].instances.motions
        for matrices in motions.matrices
    ]
    return {"ways": ways, "count": len(watch.snapshots[0].instances)}


def shutters():
    """Return whether a shutter open for no time gives the bits of the sharp picture, and what one of a million frames gives."""
    scene, thing = _room()

    def picture():
        path = os.path.join(tempfile.mkdtemp(), "picture.exr")
        exr.write_settings(scene, path)
        bpy.ops.render.render(write_still=True)
        return exr.read(path)["Combined"]

    blurred = picture()
    scene.render.motion_blur_shutter = 0.0
    closed = picture()
    scene.render.motion_blur_shutter = 1e6
    long = picture()
    frame = _frame(scene)
    scene.render.use_motion_blur = False
    sharp = picture()
    thing.hide_render = True
    return {
        "closed": closed.tobytes() == sharp.tobytes(),
        "blurred": blurred.tobytes() == sharp.tobytes(),
        "finite": bool(np.isfinite(long).all()),
        "long": float(long[..., :3].mean()),
        "ends": [float(sharp[..., :3].mean()), float(picture()[..., :3].mean())],
        "frame": frame,
    }


def curve():
    """Return the ends of the times that an even curve gives, and the mean time of a rising one."""
    even = opening_of(np.ones(256))
    times = np.linspace(0.0, 1.0, len(even))
    rising = opening_of(np.linspace(0.0, 1.0, 256))
    return {
        "even": (float(times[even > 0].min()), float(times[even > 0].max()), float(even[even > 0].min())),
        "rising": float((rising * times).sum() / rising.sum()),
        "closed": opening_of(np.zeros(256)).tolist(),
    }
