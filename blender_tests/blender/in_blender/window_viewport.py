"""Inside a real window: run a case with a 3D view in Rendered shading.

    blender --factory-startup -P window_viewport.py -- FOLDER CASE [ARGUMENT...]

runs the case of that name in one of viewport_*.py, a generator that yields the seconds until it continues, writes its result to
FOLDER/result.json, and quits Blender.
"""

import json
import os
import sys
import traceback

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.dirname(HERE))), HERE]

import viewport_costs  # noqa: E402
import viewport_endings  # noqa: E402
import viewport_places  # noqa: E402
import viewport_shown  # noqa: E402
import viewport_stage  # noqa: E402

import addon  # noqa: E402

FOLDER, CASE, *ARGUMENTS = sys.argv[sys.argv.index("--") + 1 :]
_STARTING = 1.0  # seconds until the window is there


def end(result):
    with open(os.path.join(FOLDER, "result.json"), "w", encoding="utf-8") as file:
        json.dump(result, file)

    def leave():
        if result.get("quits", True):
            addon.unregister()
        bpy.ops.wm.quit_blender()

    viewport_stage.by_hand(leave)


def step():
    try:
        return next(steps)
    except StopIteration as over:
        end(over.value)
    except Exception:
        end({"error": traceback.format_exc()})
    return None


addon.register()
bpy.context.preferences.view.show_splash = False
bpy.context.preferences.filepaths.use_auto_save_temporary_files = False
case = next(
    getattr(place, CASE)
    for place in (viewport_places, viewport_shown, viewport_costs, viewport_endings)
    if hasattr(place, CASE)
)
steps = case(FOLDER, *ARGUMENTS)
bpy.app.timers.register(step, first_interval=_STARTING, persistent=True)
