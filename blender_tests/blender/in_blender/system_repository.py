"""Inside a Blender whose system repository has Lancer: enable it and render. ... system_repository.py -- RESULT.json"""

import json
import os
import sys

import bpy

sys.path.append(os.path.dirname(os.path.abspath(__file__)))

from installed import render  # noqa: E402

# Root may write compiled files into the repository, and Blender's program ignores Python's variables.
sys.dont_write_bytecode = True
RESULT = sys.argv[-1]
MODULE = "bl_ext.system.lancer"

bpy.ops.preferences.addon_enable(module=MODULE)
with open(RESULT, "w", encoding="utf-8") as out:
    json.dump({"folder": os.path.dirname(sys.modules[MODULE].__file__), **render(MODULE, os.path.dirname(RESULT))}, out)
