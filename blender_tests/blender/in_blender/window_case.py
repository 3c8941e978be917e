"""Inside a real window: a scene that takes minutes, and a clock that shows whether Blender still responds.

The program starts it: blender --factory-startup -P window_case.py -- FOLDER [pictures | panels | edit]. It writes events to
FOLDER/log.txt, a line each: seconds, word. With pictures and with edit it builds their scenes instead, and renders them again
by a script once a file named compare exists; with panels it also logs what panels draw.
"""

import os
import sys
import time

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.dirname(HERE))), HERE]

import stage  # noqa: E402
import window_edit  # noqa: E402
import window_panels  # noqa: E402
import window_pictures  # noqa: E402

import addon  # noqa: E402
from addon.host import main_thread  # noqa: E402

serves = False
FOLDER, *KIND = sys.argv[sys.argv.index("--") + 1 :]
LOG = open(os.path.join(FOLDER, "log.txt"), "w", encoding="utf-8", buffering=1)


def say(word):
    LOG.write(f"{time.time():.4f} {word}\n")


def told(word):
    """Return whether the test has put a file of that name into the folder, and remove the file."""
    path = os.path.join(FOLDER, word)
    if not os.path.exists(path):
        return False
    os.remove(path)
    return True


def measure():
    """Measure as the button of the panel does."""
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        say(next(iter(bpy.ops.lancer.measure_features("INVOKE_DEFAULT", seconds=600.0))).lower())


def tell_of_timer():
    """Log when the timer that serves renders is registered or removed."""
    global serves
    now = bpy.app.timers.is_registered(main_thread._tick)
    if now != serves:
        serves = now
        say("serves" if now else "rests")


def tick():
    say("tick")
    tell_of_timer()
    if told("measure"):
        measure()
    if told("measuring?"):
        scene = bpy.context.scene.name
        measured = "measured" if scene in addon.engine.last_costs else "nothing"
        say("measuring" if scene in addon.operators.measuring.running else measured)
    if told("measure quality"):
        say(window_panels.measure())
    if told("check"):
        say(window_panels.check(say))
    if told("listed?"):
        say("listed" if bpy.context.scene in addon.operators.check_scene.last_findings else "unlisted")
    for engine in ("CYCLES", "LANCER"):
        if told(engine):
            bpy.context.scene.render.engine = engine
            say(f"engine-{engine}")
    if told("off"):
        addon.unregister()
        say("off")
    if told("on"):
        addon.register()
        bpy.context.scene.render.engine = "LANCER"
        say("on")
    if told("switch"):
        say(window_panels.switch())
    if told("load"):
        say(window_panels.load(FOLDER))
    if told("compare"):
        (window_edit if KIND == ["edit"] else window_pictures).compare(FOLDER)
        say("compared")
    if told("quit"):
        addon.unregister()
        bpy.ops.wm.quit_blender()
    return 0.05


def prepare():
    """Register the clock; a timer calls this when the window has opened."""
    bpy.app.timers.register(tick, persistent=True)
    if KIND == ["panels"]:
        window_panels.watch(say)
    if KIND == ["edit"]:
        window_edit.edit()
    say("ready")


def build():
    scene = bpy.context.scene
    stage.plane(material=stage.shader(Color=(0.6, 0.6, 0.6)))
    stage.cube(material=stage.shader("ShaderNodeEmission", Strength=8.0), location=(-1, 0, 0.8))
    stage.ball(0.8, stage.shader(Color=(0.9, 0.3, 0.2)), location=(1, 0, 0.8))
    stage.sky((0.1, 0.15, 0.2))
    stage.camera()
    scene.render.engine = "LANCER"
    scene.render.resolution_x, scene.render.resolution_y = 480, 360
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.lancer.quality = "CUSTOM"
    scene.lancer.samples = 100000


addon.register()
for item in list(bpy.data.objects):
    bpy.data.objects.remove(item)
if KIND == ["pictures"]:
    window_pictures.build(FOLDER)
    window_pictures.watch(say)
elif KIND == ["edit"]:
    window_edit.build()
else:
    build()
for name in ("render_init", "render_pre", "render_post", "render_cancel", "render_complete"):
    getattr(bpy.app.handlers, name).append(lambda *_, word=name: say(word))
bpy.context.preferences.view.show_splash = False
bpy.context.preferences.view.render_display_type = "WINDOW"
bpy.app.timers.register(prepare, first_interval=2.0)
