"""Inside a real window: gaps between the ticks of a timer while F12 renders.

blender --factory-startup -P window_gaps.py -- ANSWER.json ENGINE SECONDS THREADS
"""

import json
import os
import sys
import time

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.dirname(HERE))), HERE]

import stage  # noqa: E402

import addon  # noqa: E402

ANSWER, ENGINE, SECONDS, THREADS = sys.argv[sys.argv.index("--") + 1 :]
INTERVAL = 0.01
# In the first seconds the window of the render opens, and both engines update the picture more often.
SETTLED = 2.0

ticks = []
begun = []


def tick():
    now = time.monotonic()
    if begun and now > begun[0] + SETTLED:
        ticks.append(now)
    if len(ticks) > 1 and now > begun[0] + SETTLED + float(SECONDS):
        answer()
        return None
    return INTERVAL


def answer():
    """Write the longest gap and the median gap, weighted by time: gaps up to the median make up half of the time."""
    gaps = sorted(b - a for a, b in zip(ticks, ticks[1:], strict=False))
    passed, half = 0.0, sum(gaps) / 2
    for gap in gaps:
        passed += gap
        if passed >= half:
            break
    with open(ANSWER, "w", encoding="utf-8") as file:
        json.dump({"longest": gaps[-1], "median": gap}, file)
    addon.unregister()
    # The render still runs; exit without waiting for it.
    os._exit(0)


def render():
    bpy.app.timers.register(tick)
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.render.render("INVOKE_DEFAULT")


addon.register()
for item in list(bpy.data.objects):
    bpy.data.objects.remove(item)
stage.plane(material=stage.shader(Color=(0.6, 0.6, 0.6)))
stage.ball(0.8, stage.shader(Color=(0.9, 0.3, 0.2)), location=(0, 0, 0.8))
stage.light()
stage.sky()
stage.camera()
scene = bpy.context.scene
scene.render.engine = ENGINE
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 960, 540, 100
scene.render.threads_mode, scene.render.threads = "FIXED", int(THREADS)
scene.lancer.quality, scene.lancer.samples = "CUSTOM", 1 << 24
scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = 1 << 24, False, False
bpy.app.handlers.render_pre.append(lambda *_: begun.append(time.monotonic()))
bpy.context.preferences.view.show_splash = False
bpy.context.preferences.view.render_display_type = "WINDOW"
# Some time later, when the window has opened.
bpy.app.timers.register(render, first_interval=3.0)
