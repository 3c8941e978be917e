"""A 3D view that fills a real window, its drawings, and the delay until a change is seen in them.

A small part of the framebuffer is read back right after each drawing, in the same way for every engine.
"""

import json
import os
import time

import bpy
import cycles
import gpu
import numpy as np
from mathutils import Quaternion

import addon
from addon.viewport.viewport import Viewport

PART = 32
# A change is shown once the part is brighter or darker by this factor: noise is below it, the changes made are above.
FACTOR = 1.5
TURN = 0.003  # seconds that are more than Blender takes from an update to the drawing after it
DOWN = Quaternion((1, 0, 0), 0.9)

seen = []  # (time, mean of the part, a key that differs between pictures)
held = []  # (start, end) of each call of the add-on, during which Blender's main loop stands


def start(engine, threads):
    """Register the add-on, open an empty file and watch an engine: LANCER or CYCLES. Return the scene."""
    addon.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon.unregister()
    addon.register()
    _watch(engine)
    scene = bpy.context.scene
    scene.render.threads_mode, scene.render.threads = "FIXED", int(threads)
    scene.cycles.use_preview_denoising = scene.cycles.use_preview_adaptive_sampling = False
    bpy.context.preferences.view.show_splash = False
    return scene


def _watch(engine):
    """Read back each drawing of an engine."""
    watched = addon.engine.render_engine.LancerRenderEngine if engine == "LANCER" else cycles.CyclesRender
    for name in ("update", "draw", "step"):
        setattr(Viewport, name, _timed(getattr(Viewport, name)))
    plain = watched.view_draw

    def view_draw(self, context, depsgraph):
        plain(self, context, depsgraph)
        place = context.region.width // 2 - PART // 2, context.region.height // 2 - PART // 2
        part = gpu.state.active_framebuffer_get().read_color(*place, PART, PART, 4, 0, "FLOAT")
        values = np.array(part.to_list(), np.float32)[:, :, :3]
        seen.append((time.monotonic(), float(values.mean()), hash(values.tobytes())))

    watched.view_draw = view_draw


def _timed(call):
    def timed(*arguments):
        start = time.monotonic()
        try:
            return call(*arguments)
        finally:
            held.append((start, time.monotonic()))

    return timed


def longest_hold(since):
    """Return the longest seconds since a time for which the add-on has held Blender's main loop between two of its turns.

    An update and the drawing after it are one hold. 0.0 for Cycles, whose calls are not timed.
    """
    longest = 0.0
    begun = ended = None
    for start, end in held:
        if start < since:
            continue
        if begun is None or start - ended > TURN:
            begun = start
        ended = max(end, ended or end)
        longest = max(longest, ended - begun)
    return longest


def open_view(scene, engine, distance, settling):
    """Let a view that looks down fill the window, in Rendered shading; a generator that returns (region, space)."""
    window, area, region = _view()
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.screen.screen_full_area(use_hide_panels=True)
    yield 1.0
    window, area, region = _view()
    space = area.spaces.active
    space.overlay.show_overlays = space.show_gizmo = False
    space.show_region_header = space.show_region_tool_header = False
    data = space.region_3d
    data.view_perspective, data.view_distance = "PERSP", distance
    data.view_rotation = DOWN
    yield 0.5
    scene.render.engine = engine
    space.shading.type = "RENDERED"
    yield settling
    return region, space


def _view():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return window, area, next(region for region in area.regions if region.type == "WINDOW")


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


def run(measure, answer):
    """Run a generator that yields seconds to wait; write the result as JSON and end Blender."""
    steps = measure()

    def step():
        try:
            return next(steps)
        except StopIteration as over:
            with open(answer, "w", encoding="utf-8") as file:
                json.dump(over.value, file)
            addon.unregister()
            # Exit without waiting for Cycles' thread.
            os._exit(0)

    bpy.app.timers.register(step, first_interval=2.0)
