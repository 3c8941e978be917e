"""The pass Vector in Blender: its values, what the export reads for it, and the scene's own frame."""

import os
import tempfile

import bpy
import exr
import numpy as np
import stage
from motion_cases import Watch, slide, straighten

from addon.engine import render_engine as engine

_SIZE = 16, 8


def _above():
    """Return (scene, thing, camera): a square that fills the view from above, two pixels to a unit."""
    scene = stage.empty(*_SIZE, 4)
    thing = stage.plane(20.0, stage.shader("ShaderNodeEmission"))
    eye = stage.camera((0, 0, 5), (0, 0, 0), type="ORTHO", ortho_scale=8.0)
    eye.rotation_euler = (0, 0, 0)
    scene.view_layers[0].use_pass_vector = True
    return scene, thing, eye


def _render(scene, frame=2):
    """Return {pass: picture, bottom row first}, and the messages."""
    scene.frame_set(frame)
    path = os.path.join(tempfile.mkdtemp(), "picture.exr")
    exr.write_settings(scene, path)
    bpy.ops.render.render(write_still=True)
    passes = {name: picture[::-1].astype(np.float64) for name, picture in exr.read(path).items()}
    return passes, [line for line in engine.last_messages.get(scene.name, ()) if "Vector" in line]


def _span(picture):
    """Return the least and the largest value of each channel."""
    return picture.min(axis=(0, 1)).round(4).tolist(), picture.max(axis=(0, 1)).round(4).tolist()


def values():
    """Return the vectors of what slides by half a unit and a quarter per frame, of a camera that does, and of both."""
    result = {}
    for moves in ("thing", "camera", "both", "nothing"):
        scene, thing, eye = _above()
        if moves in ("thing", "both"):
            slide(thing, first=(-1.0, 0.5, 0.0), last=(1.0, -0.5, 0.0))
        if moves in ("camera", "both"):
            slide(eye, first=(-1.0, 0.5, 5.0), last=(1.0, -0.5, 5.0))
        result[moves] = _span(_render(scene)[0]["Vector"])
    # Faster after frame 2 than before.
    scene, thing, _ = _above()
    for frame, x in ((0, 0.0), (2, 1.0), (3, 3.0)):
        thing.location.x = x
        thing.keyframe_insert("location", frame=frame)
    straighten(thing)
    result["bent way"] = _span(_render(scene)[0]["Vector"])
    return result


def blurred():
    """Return the span of the pass and the messages with motion blur of scene and view layer."""
    result = {}
    for name, scene_blurs, layer_blurs in (("both", True, True), ("scene", True, False), ("layer", False, True)):
        scene, thing, _ = _above()
        slide(thing, first=(-1.0, 0.0, 0.0), last=(1.0, 0.0, 0.0))
        scene.render.use_motion_blur, scene.view_layers[0].use_motion_blur = scene_blurs, layer_blurs
        passes, told = _render(scene)
        result[name] = _span(passes["Vector"]), told
    return result


def frames():
    """Return the frames that are set, and the scene's own afterwards, with and without the pass and for a subframe."""
    result = {}
    for name, wanted, frame, subframe in (("asked", True, 2, 0.0), ("subframe", True, 2, 0.25), ("not asked", False, 2, 0.0)):
        scene, thing, _ = _above()
        slide(thing)
        scene.view_layers[0].use_pass_vector = wanted
        scene.frame_set(frame, subframe=subframe)
        with Watch() as watch:
            bpy.ops.render.render()
        result[name] = watch.frames, [scene.frame_current, round(scene.frame_subframe, 4)]
    return result


def keys():
    """Return what the export finds of objects with several kinds of motion."""
    scene, thing, eye = _above()
    stage.cube(0.5, stage.shader(), location=(0, 2, 0)).name = "Still"
    off = stage.cube(0.5, stage.shader())
    off.name = "Switched off"
    slide(off, first=(-1.0, 0.0, 0.5), last=(1.0, 0.0, 0.5))
    off.cycles.use_motion_blur = off.cycles.use_deform_motion = False
    exact = stage.ball(0.5, stage.shader())
    exact.lancer.shape = "SPHERE"
    slide(exact, first=(0.0, -1.0, 0.5), last=(0.0, 1.0, 0.5))
    bent = stage.cube(0.5, stage.shader(), location=(2, 2, 0))
    bent.data.name = "Bent"
    bent.cycles.use_deform_motion = False
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
    flat = stage.cube(0.5, stage.shader(), location=(4, 2, 0))
    flat.name = "Turns over"
    slide(flat, "scale", (-1.0, 1.0, 1.0), (3.0, 1.0, 1.0))
    result = {}
    for name, on in (("on", True), ("off", False)):
        slide(eye, first=(-1.0, 0.0, 5.0), last=(1.0, 0.0, 5.0))
        eye.cycles.use_motion_blur = on
        scene.frame_set(2)
        with Watch() as watch:
            bpy.ops.render.render()
        snapshot = watch.snapshots[0]
        camera = snapshot.camera
        result[f"camera {name}"] = [matrix[:, 3].tolist() for matrix in (camera.matrix_before, camera.matrix_after)]
    names = snapshot.instances.names
    name_of = [names[number] for number in snapshot.instances.name_indices]
    vectors = snapshot.instances.vectors
    moving = {
        name_of[number]: (matrices[1] - matrices[0])[:, 3].round(5).tolist()
        for number, matrices in zip(vectors.instances, vectors.matrices, strict=True)
    }
    shapes = [mesh.name for mesh in snapshot.meshes if mesh.vector_positions is not None]
    blur = [bool(snapshot.instances.motions), snapshot.motion is None]
    blur.append(any(mesh.moved_positions is not None for mesh in snapshot.meshes))
    return {"moving": moving, "shapes": shapes, "blur": blur, "lines": list(engine.last_messages[scene]), **result}


def bits():
    """Return the names of passes whose bits the pass Vector changes, of a scene where everything moves."""
    pictures = []
    for wanted in (False, True):
        scene = stage.room(width=32, height=24, samples=8)
        cube, eye = bpy.data.objects["Cube"], scene.camera
        slide(cube)
        slide(eye, first=(-1.0, -6.0, 2.8), last=(1.0, -6.0, 3.2))
        cube.shape_key_add(name="Basis")
        key = cube.shape_key_add(name="Bent")
        key.data[0].co.x += 1.0
        for frame, value in ((0, 0.0), (4, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        layer = scene.view_layers[0]
        layer.use_pass_vector = wanted
        layer.use_pass_normal = layer.use_pass_diffuse_direct = True
        pictures.append(_render(scene)[0])
    without, with_vectors = pictures
    changed = [name for name, picture in without.items() if not np.array_equal(picture, with_vectors[name])]
    return {"changed": changed, "more": sorted(set(with_vectors) - set(without)), "seen": _span(with_vectors["Vector"])}


def layers():
    """Return the vectors of two view layers that show different objects, in a frame alone and in an animation."""
    result = {}
    for name in ("alone", "animation"):
        scene, first, _ = _above()
        second = stage.plane(20.0, stage.shader("ShaderNodeEmission"))
        for thing, way in ((first, 1.0), (second, 3.0)):
            slide(thing, first=(-way, 0.0, 0.0), last=(way, 0.0, 0.0))
            collection = bpy.data.collections.new(thing.name)
            scene.collection.children.link(collection)
            scene.collection.objects.unlink(thing)
            collection.objects.link(thing)
        other = scene.view_layers.new("Other")
        other.use_pass_vector = True
        scene.view_layers[0].layer_collection.children[1].exclude = True
        other.layer_collection.children[0].exclude = True
        folder = tempfile.mkdtemp()
        exr.write_settings(scene, os.path.join(folder, "picture.exr"))
        if name == "alone":
            scene.frame_set(2)
            bpy.ops.render.render(write_still=True)
            path = os.path.join(folder, "picture.exr")
        else:
            scene.frame_start, scene.frame_end = 1, 2
            scene.render.filepath = os.path.join(folder, "picture")
            bpy.ops.render.render(animation=True)
            path = os.path.join(folder, "picture0002.exr")
        result[name] = [_span(exr.read(path, layer.name)["Vector"]) for layer in scene.view_layers]
    return result
