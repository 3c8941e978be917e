"""Inside a real window: the memory that a 3D view of a million faces takes, and that a second view of the scene adds.

blender --factory-startup -p 0 0 1280 800 -P window_shared.py -- ANSWER.json ENGINE THREADS
"""

import os
import sys

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.dirname(HERE))), HERE]

import memory_now  # noqa: E402
import window_watch  # noqa: E402

from scenes import parts  # noqa: E402

ANSWER, ENGINE, THREADS = sys.argv[sys.argv.index("--") + 1 :]
SETTLING = 6.0  # seconds


def views():
    return [area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == "VIEW_3D"]


def measure():
    grey = parts.principled("Grey", base_color=(0.5, 0.5, 0.5), roughness=0.5, ior=1.5)
    for x in (-4.0, 4.0):
        parts.place(scene, "Head", parts.monkey_mesh("Monkey", 5), grey, location=(x, 0, 1))
    parts.set_world(scene, (0.5, 0.5, 0.5), 1.0)
    scene.render.engine = ENGINE
    scene.lancer.preview_samples = 1
    (area,) = views()
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield SETTLING
    held = [memory_now.held()["given"]]
    for area in views():
        area.spaces.active.shading.type = "RENDERED"
        yield SETTLING
        held.append(memory_now.held()["given"])
    return {"first": held[1] - held[0], "second": held[2] - held[1]}


scene = window_watch.start(ENGINE, THREADS)
window_watch.run(measure, ANSWER)
