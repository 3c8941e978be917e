"""start.py bench.worker TASK JSON: one measurement inside Blender's Python module; the answer is JSON."""

import os
import sys
import time

import bpy
import numpy as np
from blender.in_blender import memory_now
from mathutils import Vector

import addon
import scenes
from addon.bindings import abi
from addon.bindings.session import Scene, Session
from addon.export.scene import export_scene
from tools.harness import denoising, workers
from tools.harness.f12 import press_f12, registered


def set_up(name, threads, width=None, height=None, samples=None, bounces=12, seed=0):
    """Return the named scene with the settings of make_alike."""
    scene = scenes.load(name)
    scene.render.resolution_x = width or scene.render.resolution_x
    scene.render.resolution_y = height or scene.render.resolution_y
    make_alike(scene, threads, bounces)
    set_samples(scene, samples or scene.lancer.samples, seed)
    return scene


def make_alike(scene, threads, bounces=12):
    """Give Lancer and Cycles equivalent settings: box filter, no adaptive sampling, no clamping in Cycles."""
    render = scene.render
    render.threads_mode = "FIXED"
    render.threads = threads
    render.use_compositing = render.use_sequencer = False
    scene.lancer.quality, scene.lancer.target_error, scene.lancer.time_limit = "CUSTOM", 0.0, 0.0
    scene.lancer.use_denoising = False
    scene.lancer.max_bounces = bounces
    scene.lancer.pixel_filter = "BOX"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.pixel_filter_type = "BOX"
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max", "volume"):
        setattr(cycles, f"{kind}_bounces", bounces)


def set_samples(scene, samples, seed):
    scene.lancer.samples = scene.cycles.samples = samples
    scene.lancer.seed = scene.cycles.seed = seed


def f12(engine, **settings):
    """Return the whole time of F12, the time without sampling, and the peak of memory above that of Blender with the scene."""
    scene = set_up(**settings)
    scene.render.engine = engine
    bpy.context.view_layer.update()
    workers.reset_peak()
    before = workers.memory("VmRSS")
    found = press_f12(scene)
    return {"seconds": found.wall, "setup_seconds": found.wall - found.seconds, "peak_bytes": found.peak - before}


def first_shown(**settings):
    """Return the seconds from F12 until the first picture is in the render result, which Blender then shows."""
    scene = set_up(**settings)
    scene.render.engine = "LANCER"
    bpy.context.view_layer.update()
    fill, filled = addon.engine.passes.fill, []

    def timed_fill(*arguments):
        fill(*arguments)
        filled.append(time.perf_counter())

    addon.engine.passes.fill = timed_fill
    start = time.perf_counter()
    bpy.ops.render.render()
    addon.engine.passes.fill = fill
    return {"seconds": filled[0] - start}


def render(engine, name, threads, width, height, samples, seed, bounces=12, picture=None, first_look=True):
    """Press F12 with one sample, then with all; the engine's own clock, which starts at the first ray, gives the rate."""
    scene = set_up(name, threads, width, height, samples, bounces)
    scene.render.engine = engine
    bpy.context.view_layer.update()
    workers.reset_peak()
    before, result = workers.memory("VmRSS"), {"samples": samples * width * height}
    if first_look:
        set_samples(scene, 1, 0)
        first = press_f12(scene)
        result |= {"first_pixel_seconds": first.wall, "setup_seconds": first.wall - first.seconds}
    set_samples(scene, samples, seed)
    rendered = press_f12(scene)
    result |= {"render_seconds": rendered.seconds, "clock": "the engine's own clock"}
    result["peak_bytes"] = rendered.peak - before
    if picture:
        np.save(picture, rendered.picture[..., :3])
    if engine == "LANCER":
        statistics = addon.engine.last_statistics[scene.name]
        result["rays"] = {kind: statistics[f"{kind}_rays"] for kind in ("camera", "bounce", "shadow")}
        result["statistics"] = statistics
    return result


def _turn_camera(scene):
    """A camera goes through the scene."""
    place = scene.camera.location.copy()

    def show(number):
        scene.camera.location = place + Vector((0.01 * number, 0.02 * number, 0.0))

    return show


def _bend_head(scene):
    """A head of 251 904 triangles bends: all its vertices move."""
    thing = next(thing for thing in scene.objects if thing.type == "MESH")
    bend = thing.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method = "BEND"

    def show(number):
        bend.angle = 0.05 * number

    return show


def _move_instances(scene):
    """All instances move, each along its own way."""
    things = [thing for thing in scene.objects if thing.data and thing.data.name.startswith("Monkey")]
    places = [thing.location.copy() for thing in things]

    def show(number):
        for index, (thing, place) in enumerate(zip(things, places, strict=True)):
            thing.location = place + Vector((0.01 * number * (index % 7 - 3), 0.01 * number * (index % 5 - 2), 0.0))

    return show


# The scene of each kind of animation, and the function that returns how a frame is shown.
_ANIMATIONS = {
    "camera": ("daylight", _turn_camera),
    "character": ("head", _bend_head),
    "instances": ("instances", _move_instances),
}


def frames(engine, kind, threads, count=5):
    """Return the seconds of a frame beside its samples with Persistent Data: the median of all frames but the first."""
    name, animated = _ANIMATIONS[kind]
    scene = set_up(name, threads, 320, 180, 1)
    scene.render.engine = engine
    scene.render.use_persistent_data = True
    show, beside = animated(scene), []
    for number in range(count):
        show(number)
        bpy.context.view_layer.update()
        found = press_f12(scene)
        beside.append(found.wall - found.seconds)
    return {"first_seconds": beside[0], "seconds": float(np.median(beside[1:]))}


def steady(engine, threads, count=100):
    """Return the bytes that the second half of an animation adds to the first: a head deforms, and its colour changes."""
    scene = set_up("head", threads, 64, 36, 1)
    scene.render.engine = engine
    scene.render.use_persistent_data = True
    bend = _bend_head(scene)
    tree = next(thing for thing in scene.objects if thing.type == "MESH").active_material.node_tree
    color = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED").inputs["Base Color"]
    held = []
    for number in range(count):
        bend(number)
        color.default_value = (number / count, 0.5, 0.5, 1.0)
        bpy.context.view_layer.update()
        press_f12(scene)
        if number in (count // 2, count - 1):
            held.append(memory_now.held()["given"])
    return {"growth_bytes": held[1] - held[0]}


def denoised(engine, name, threads, width, height, counts, seed, folder):
    """Press F12 with denoising at each number of samples; write folder/COUNT.npy and return [(count, seconds)]."""
    scene = set_up(name, threads, width, height)
    denoising.denoise(scene)
    rendered = denoising.curve(scene, engine, counts, seed, set_samples)
    for count, _, picture in rendered:
        np.save(os.path.join(folder, f"{count}.npy"), picture)
    return [(count, seconds) for count, seconds, _ in rendered]


def snapshot(path, **settings):
    """Write the snapshot for renderers that do not run inside Blender."""
    set_up(**settings)
    start = time.perf_counter()
    exported, _ = export_scene(bpy.context.evaluated_depsgraph_get())
    seconds = time.perf_counter() - start
    exported.save(path)
    triangles = sum(
        len(exported.meshes[m].triangles)
        for m, k in zip(exported.instances.meshes, exported.instances.kinds, strict=True)
        if k == 0
    )
    return {
        "export_seconds": seconds,
        "triangles": triangles,
        "instances": len(exported.instances),
        "lights": len(exported.lights),
    }


def prepare(**settings):
    """Return the times of export, upload and build, and the bytes that they add to Blender's own."""
    set_up(**settings)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    workers.reset_peak()
    before, start = workers.memory("VmRSS"), time.perf_counter()
    exported_scene, _ = export_scene(depsgraph)
    exported = time.perf_counter()
    with Scene(None) as scene:
        scene.fill(exported_scene)
        filled = time.perf_counter()
        scene.commit(exported_scene.settings.accelerator, settings["threads"])
        built = time.perf_counter()
        peak = workers.memory("VmHWM") - before
        kept = workers.memory("VmRSS") - before
        with Session(scene, exported_scene.camera, exported_scene.settings) as session:
            statistics = session.statistics()
    triangles = sum(len(mesh.triangles) for mesh in exported_scene.meshes)
    return {
        "triangles": triangles,
        "instances": len(exported_scene.instances),
        "export_seconds": exported - start,
        "upload_seconds": filled - exported,
        "commit_seconds": built - filled,
        "build_seconds": built - exported,
        "total_seconds": built - start,
        "peak_bytes": peak,
        "kept_bytes": kept,
        "peak_bytes_per_triangle": peak / triangles,
        "held_bytes_per_triangle": (statistics.geometry_bytes + statistics.accelerator_bytes) / triangles,
    }


def accelerators(kinds, **settings):
    """Return the times of rendering alone, once per accelerator, on the same snapshot."""
    set_up(**settings)
    exported, _ = export_scene(bpy.context.evaluated_depsgraph_get())
    result = {}
    for kind in kinds:
        with Scene(None) as scene:
            scene.fill(exported)
            scene.commit(abi.Accelerator[kind], settings["threads"])
            with Session(scene, exported.camera, exported.settings) as session:
                session.render_all(exported.settings.samples)
                statistics = session.statistics()
        result[kind] = {"seconds": statistics.render_seconds, "rays_per_second": statistics.rays_per_second}
    result["instruction_set"] = statistics.instruction_set
    return result


def versions():
    return {
        "blender": bpy.app.version_string,
        "lancer": addon.VERSION,
        "python": sys.version.split()[0],
    }


TASKS = (f12, first_shown, frames, steady, render, denoised, snapshot, prepare, accelerators, versions)

if __name__ == "__main__":
    registered(lambda: workers.answer(*TASKS))
