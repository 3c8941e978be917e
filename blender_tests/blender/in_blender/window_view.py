"""Inside a real window: the delay until a 3D view in Rendered shading shows a change, and its pictures while it turns.

blender --factory-startup -p 0 0 960 540 -P window_view.py -- ANSWER.json ENGINE THREADS

A small part of the framebuffer is read back right after each drawing, in the same way for every engine.
"""

import json
import os
import sys
import time

import bpy
import cycles
import gpu
import numpy as np
from mathutils import Quaternion

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.dirname(HERE))), HERE]

import addon  # noqa: E402
from addon.viewport import viewport  # noqa: E402
from scenes import spheres  # noqa: E402

ANSWER, ENGINE, THREADS = sys.argv[sys.argv.index("--") + 1 :]
PART = 32
SETTLING, RESTING, TURNING = 4.0, 1.5, 4.0  # seconds
TIMES = 5
STEP = 0.02  # radians by which the view turns in each round of Blender's loop
# A change is shown once the part is brighter or darker by this factor: noise is below it, the changes made are above.
FACTOR = 1.5

seen = []  # (time, mean of the part, a key that differs between pictures)


def view():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return window, area, next(region for region in area.regions if region.type == "WINDOW")


def watch(engine):
    """Read back each drawing of an engine's class."""
    plain = engine.view_draw

    def view_draw(self, context, depsgraph):
        plain(self, context, depsgraph)
        place = context.region.width // 2 - PART // 2, context.region.height // 2 - PART // 2
        part = gpu.state.active_framebuffer_get().read_color(*place, PART, PART, 4, 0, "FLOAT")
        values = np.array(part.to_list(), np.float32)[:, :, :3]
        seen.append((time.monotonic(), float(values.mean()), hash(values.tobytes())))

    engine.view_draw = view_draw


def delay(change):
    """Return the seconds from a change until it is shown; a generator, as all functions here that wait."""
    before = seen[-1][1]
    started = time.monotonic()
    change()
    while True:
        yield 0.002
        at, mean, _ = seen[-1]
        if at > started and not before / FACTOR < mean < before * FACTOR:
            return at - started


def measure():
    window, area, region = view()
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.screen.screen_full_area(use_hide_panels=True)
    yield 1.0
    window, area, region = view()
    space = area.spaces.active
    space.overlay.show_overlays = space.show_gizmo = False
    space.show_region_header = space.show_region_tool_header = False
    data = space.region_3d
    data.view_perspective, data.view_distance = "PERSP", 12.0
    down = Quaternion((1, 0, 0), 0.9)
    data.view_rotation = down
    yield 0.5
    scene.render.engine = ENGINE
    space.shading.type = "RENDERED"
    yield SETTLING
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND").inputs["Strength"]
    edits, moves = [], []
    for number in range(TIMES):
        edits.append((yield from delay(lambda value=(20.0, 0.2)[number % 2]: setattr(background, "default_value", value))))
        yield RESTING
    # A bright sky above, a dim floor below.
    background.default_value = 20.0
    for item in scene.objects:
        item.hide_viewport = item.type == "LIGHT"
    yield RESTING
    for number in range(TIMES):
        turned = (Quaternion((1, 0, 0), 1.8), down)[number % 2]
        moves.append((yield from delay(lambda turned=turned: setattr(data, "view_rotation", turned))))
        yield RESTING
    data.view_rotation = down
    yield RESTING
    first, sizes, started = len(seen), [], time.monotonic()
    while time.monotonic() - started < TURNING:
        data.view_rotation = Quaternion((0, 0, 1), STEP) @ data.view_rotation
        sizes += [each.painter.picture.size for each in viewport._open]
        yield 0.016
    pictures = len({key for *_, key in seen[first:]})
    return {
        "edits": edits,
        "moves": moves,
        "pictures_per_second": pictures / (time.monotonic() - started),
        "pixel_size": float(np.median(sizes)) if sizes else None,
        "region": [region.width, region.height],
    }


def step():
    try:
        return next(steps)
    except StopIteration as over:
        with open(ANSWER, "w", encoding="utf-8") as file:
            json.dump(over.value, file)
        addon.unregister()
        # Exit without waiting for Cycles' thread.
        os._exit(0)


addon.register()
bpy.ops.wm.read_factory_settings(use_empty=True)
addon.unregister()
addon.register()
watch(addon.engine.render_engine.LancerRenderEngine if ENGINE == "LANCER" else cycles.CyclesRender)
scene = bpy.context.scene
spheres.build_balls(scene)
scene.render.threads_mode, scene.render.threads = "FIXED", int(THREADS)
scene.cycles.use_preview_denoising = scene.cycles.use_preview_adaptive_sampling = False
bpy.context.preferences.view.show_splash = False
steps = measure()
bpy.app.timers.register(step, first_interval=2.0)
