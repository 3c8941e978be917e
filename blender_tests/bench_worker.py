"""bench_worker.py TASK ARGUMENTS: one measurement of the benchmark in a process of its own. Arguments and answer are JSON."""

import json
import os
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bpy  # noqa: E402

import addon  # noqa: E402
import scenes  # noqa: E402
from addon.bindings import abi  # noqa: E402
from addon.bindings.session import Scene, Session  # noqa: E402
from addon.export.scene import export_scene  # noqa: E402


def memory(field):
    """A figure of this process in bytes: VmRSS now, or VmHWM, the peak since reset_peak."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return 1024 * int(line.split()[1])
    raise KeyError(field)


def reset_peak():
    Path("/proc/self/clear_refs").write_text("5")


def set_up(name, threads, width=None, height=None, samples=None, bounces=12):
    """The named scene with settings that mean the same to Lancer and to Cycles: no clamp, no filter, no adaptive end."""
    scene = scenes.load(name)
    render = scene.render
    render.threads_mode = "FIXED"
    render.threads = threads
    render.resolution_x = width or render.resolution_x
    render.resolution_y = height or render.resolution_y
    scene.lancer.samples = samples = samples or scene.lancer.samples
    scene.lancer.max_bounces = bounces
    scene.lancer.pixel_filter = "BOX"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.pixel_filter_type = "BOX"
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max", "volume"):
        setattr(cycles, f"{kind}_bounces", bounces)
    return scene


def f12(engine, **settings):
    """The whole of F12 as the artist waits for it, and the peak of memory above the scene in Blender."""
    scene = set_up(**settings)
    scene.render.engine = engine
    bpy.context.view_layer.update()
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.png")
        reset_peak()
        before, start = memory("VmRSS"), time.perf_counter()
        bpy.ops.render.render(write_still=True)
        seconds = time.perf_counter() - start
        if not os.path.exists(scene.render.filepath):
            raise RuntimeError(f"{engine} wrote no picture")
    return {"seconds": seconds, "peak_bytes": memory("VmHWM") - before}


def prepare(**settings):
    """Export, upload and build, each by itself, and the bytes that they take on top of Blender's own."""
    set_up(**settings)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    reset_peak()
    before, start = memory("VmRSS"), time.perf_counter()
    snapshot, _ = export_scene(depsgraph)
    exported = time.perf_counter()
    with Scene.upload(snapshot):
        built = time.perf_counter()
        peak = memory("VmHWM") - before
        kept = memory("VmRSS") - before
    triangles = sum(len(mesh.triangles) for mesh in snapshot.meshes)
    return {
        "triangles": triangles,
        "instances": len(snapshot.instances),
        "export_seconds": exported - start,
        "build_seconds": built - exported,
        "peak_bytes": peak,
        "kept_bytes": kept,
        "peak_bytes_per_triangle": peak / triangles,
    }


def accelerators(kinds, **settings):
    """Rendering alone, once per accelerator, on the same snapshot."""
    set_up(**settings)
    snapshot, _ = export_scene(bpy.context.evaluated_depsgraph_get())
    result = {}
    for kind in kinds:
        with Scene(None) as scene:
            scene.fill(snapshot)
            scene.commit(abi.Accelerator[kind], settings["threads"])
            with Session(scene, snapshot.camera, snapshot.settings) as session:
                session.render_all(snapshot.settings.samples)
                statistics = session.statistics()
        result[kind] = {"seconds": statistics.render_seconds, "rays_per_second": statistics.rays_per_second}
    result["instruction_set"] = statistics.instruction_set
    return result


def versions():
    return {
        "blender": bpy.app.version_string,
        "lancer": ".".join(map(str, addon.bl_info["version"])),
        "python": sys.version.split()[0],
    }


TASKS = {task.__name__: task for task in (f12, prepare, accelerators, versions)}

if __name__ == "__main__":
    addon.register()
    try:
        answer = TASKS[sys.argv[1]](**json.loads(sys.argv[2]))
    finally:
        addon.unregister()
    sys.stdout.flush()
    print("\n" + json.dumps(answer))
