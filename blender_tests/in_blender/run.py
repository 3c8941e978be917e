"""Runs one case inside a Blender, the module or the program: ... run.py -- RESULT.json FILE FUNCTION [ARGUMENTS]."""

import importlib
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
result_path, where, name, *arguments = sys.argv[sys.argv.index("--") + 1 :]
# The add-on of this project, unless the case wants an installed one.
sys.path[:0] = [os.path.dirname(os.path.dirname(HERE)), HERE]
installed = os.environ.get("LANCER_TEST_INSTALLED")
if not installed:
    import addon

    addon.register()
result = getattr(importlib.import_module(where), name)(*arguments)
with open(result_path, "w", encoding="utf-8") as file:
    json.dump(result, file)
if not installed:
    addon.unregister()
