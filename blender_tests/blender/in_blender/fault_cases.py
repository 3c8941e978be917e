"""The add-on between files, scenes and view layers: its measurements, its caches, registration and unregistration."""

import os
import sys
import threading

import bpy
import numpy as np
import stage
from addon_cases import _traces

_FREE = 10**6  # more samples than any time limit of these cases allows


def as_rendered():
    """Return the snapshot that is measured, the one that F12 exports, and whether the measurement left anything behind."""
    import addon
    from addon.engine import render_export

    scene = stage.room(width=16, height=12, samples=1)
    layered = bpy.data.objects["Cube"].modifiers.new("Subdivision", "SUBSURF")
    layered.levels, layered.render_levels = 0, 2
    stage.ball(0.3, segments=8).hide_render = True
    stage.ball(0.4, segments=16).hide_viewport = True
    other = scene.view_layers.new("Other")
    other.layer_collection.exclude = True
    scene.render.use_border, scene.render.border_max_x = True, 0.5
    scene.render.use_compositing = scene.render.use_persistent_data = True
    calls, exported = [], []
    for name in ("render_init", "render_pre", "render_complete"):
        getattr(bpy.app.handlers, name).append(lambda *_, name=name: calls.append(name))
    export_scene = addon.engine.render_engine.export_picture

    def kept(*arguments):
        snapshot, messages = export_scene(*arguments)
        # The library removes the meshes from it later.
        exported.append((_meshes(snapshot), snapshot, messages))
        return snapshot, messages

    addon.engine.render_engine.export_picture = kept
    picture = bpy.data.images.load(stage.write_exr(scene))
    addon.engine.render_engine.export_picture = export_scene
    before, done = _picture_of("before"), list(calls)
    users = {thing.name: thing.users for thing in (*bpy.data.objects, *bpy.data.collections, *bpy.data.materials)}
    statistics = dict(addon.engine.last_statistics)
    found = render_export.export(bpy.context)
    after = {thing.name: thing.users for thing in (*bpy.data.objects, *bpy.data.collections, *bpy.data.materials)}
    meshes, snapshot, messages = exported[0]
    for name in ("render_init", "render_pre", "render_complete"):
        getattr(bpy.app.handlers, name).pop()
    return {
        "meshes": [_meshes(found.snapshot), meshes],
        "settings": found.snapshot.settings == snapshot.settings,
        "camera": bool(np.array_equal(found.snapshot.camera.matrix, snapshot.camera.matrix)),
        "region": [found.snapshot.camera.region_width, snapshot.camera.region_width],
        "messages": [found.messages.lines(), messages.lines()],
        "scenes": [item.name for item in bpy.data.scenes],
        "users": [name for name in users if users[name] != after.get(name)],
        "calls": [done, calls],
        "picture": bool(np.array_equal(before, _picture_of("after"))),
        "statistics": statistics == dict(addon.engine.last_statistics),
        "size": list(picture.size),
    }


def _meshes(snapshot):
    return sorted((mesh.name, len(mesh.triangles)) for mesh in snapshot.meshes)


def _picture_of(name):
    """Return the pixels of the last render, from a saved file."""
    path = os.path.join(os.getcwd(), f"{name}.exr")
    bpy.data.images["Render Result"].save_render(path)
    image = bpy.data.images.load(path)
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels


def without_camera():
    """Return the error of a measurement without a camera, and whether it left anything behind."""
    from addon.bindings.abi import LancerError
    from addon.engine import render_export

    scene = stage.room()
    scene.camera = None
    try:
        render_export.export(bpy.context)
        text = ""
    except LancerError as error:
        text = str(error)
    offered = [getattr(bpy.ops.lancer, name).poll() for name in ("measure_quality", "measure_features", "check_scene")]
    return {"error": text, "scenes": len(bpy.data.scenes), "offered": offered}


def layers():
    """Return the statistics of two view layers, of the scene after it is renamed, and after another scene takes its name."""
    from addon.engine import render_engine as engine

    scene = stage.room(width=16, height=12, samples=2)
    first = bpy.context.view_layer.name
    scene.view_layers.new("Other").samples = 3
    bpy.ops.render.render()
    numbers = engine.last_statistics[scene.name]
    result = {
        "layers": {name: layer["samples"] for name, layer in numbers["layers"].items()},
        "first": first,
        "last": numbers["samples"],
        "by scene": engine.last_statistics[scene] is numbers,
        "names": list(engine.last_statistics),
    }
    name, scene.name = scene.name, "Renamed"
    result["old name"] = name in engine.last_statistics
    result["new name"] = "Renamed" in engine.last_statistics
    other = bpy.data.scenes.new(name)
    result["another scene"] = name in engine.last_statistics
    bpy.data.scenes.remove(other)
    scene.name = name
    bpy.data.scenes.new("Left")
    bpy.data.scenes.remove(scene)
    result["gone"] = [list(engine.last_statistics), len(engine.last_statistics), name in engine.last_statistics]
    return result


def time_limit():
    """Return (shares of the limit, samples) of three view layers, the first of which takes a third of the time by itself."""
    from addon.engine import render_engine as engine
    from addon.engine.picture import Picture

    scene = stage.room(width=16, height=12, samples=_FREE)
    for name in ("B", "C"):
        scene.view_layers.new(name)
    scene.view_layers.new("Unused").use = False
    scene.lancer.time_limit = 0.6
    limits, limit = [], Picture.limit

    def told(picture, seconds):
        limits.append(limit(picture, seconds))
        return limits[-1]

    Picture.limit = told
    bpy.ops.render.render()
    Picture.limit = limit
    numbers = engine.last_statistics[scene.name]["layers"]
    return {"limits": limits, "samples": [layer["samples"] for layer in numbers.values()]}


def handlers():
    """Return whether changes of scenes are counted: at the start, with and without results, after another file is loaded."""
    from addon.operators import measuring

    def counts():
        return measuring._changed in bpy.app.handlers.depsgraph_update_post

    stage.room(width=16, height=12, samples=1)
    result = {"start": counts()}
    bpy.ops.lancer.check_scene()
    result["checked"] = counts()
    bpy.ops.lancer.measure_quality(seconds=0.2)
    result["measured"] = counts()
    bpy.ops.lancer.check_scene()
    result["checked again"] = counts()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    result["loaded"] = counts()
    return result


def refused():
    """Let Blender refuse each class in turn. Return what stays registered, and whether the next register succeeds."""
    import addon

    whole = _traces()
    addon.unregister()
    nothing = _traces()
    register, count = bpy.utils.register_class, 0
    left, errors = [], set()
    while True:
        refused = _Refusing(register, count)
        bpy.utils.register_class = refused
        try:
            addon.register()
            break
        except RuntimeError as error:
            errors.add(str(error))
            left += [count] if _traces() != nothing else []
            count += 1
        finally:
            bpy.utils.register_class = register
    return {"count": count, "left": left, "errors": sorted(errors), "whole": _traces() == whole}


class _Refusing:
    def __init__(self, register, number):
        self.register, self.left = register, number

    def __call__(self, cls):
        if self.left == 0:
            raise RuntimeError("this class is refused")
        self.left -= 1
        self.register(cls)


def stereo():
    """Return whether both eyes of a denoised picture are denoised."""
    from addon.denoise import oidn  # noqa: F401 - fails early where it cannot be had

    scene = stage.room(width=32, height=24, samples=2)
    scene.lancer.use_denoising = True
    scene.render.use_multiview = True
    seen = []
    from addon.engine import passes

    show = passes.show_denoised

    def watched(layer, denoised):
        image = denoised.image
        show(layer, denoised)
        for target in layer.passes:
            if target.name == "Combined":
                pixels = np.empty((len(target.rect), 4), np.float32)
                target.rect.foreach_get(pixels.ravel() if bpy.app.version >= (4, 0) else pixels)
                seen.append(float(np.abs(pixels - image.reshape(-1, 4)).max()))

    passes.show_denoised = watched
    bpy.ops.render.render()
    passes.show_denoised = show
    return {"differences": seen}


def priority():
    """Return the priorities of the threads of a session created as in a window, and that of this thread."""
    from addon.bindings.session import Session
    from addon.export.scene import export_scene
    from addon.host import priority

    stage.room(width=16, height=12, samples=1)
    snapshot, _ = export_scene(bpy.context.evaluated_depsgraph_get())
    before = {int(name) for name in os.listdir("/proc/self/task")}
    with priority._in_a_low_thread(lambda: Session.upload(snapshot)) as session:
        tasks = {int(name) for name in os.listdir("/proc/self/task")} - before
        found = [os.getpriority(os.PRIO_PROCESS, task) for task in tasks]
        rendered = session.render_all(1)
    here = os.getpriority(os.PRIO_PROCESS, threading.get_native_id())
    return {"here": here, "session": found, "rendered": rendered, "python": sys.version_info[:2]}
