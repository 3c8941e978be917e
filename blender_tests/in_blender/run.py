"""Runs one case inside a Blender, the module or the program: ... run.py -- RESULT.json FILE FUNCTION [ARGUMENTS]."""

import importlib
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
result_path, where, name, *arguments = sys.argv[sys.argv.index("--") + 1 :]
sys.path[:0] = [os.path.dirname(os.path.dirname(HERE)), HERE]

import addon  # noqa: E402

addon.register()
result = getattr(importlib.import_module(where), name)(*arguments)
with open(result_path, "w", encoding="utf-8") as file:
    json.dump(result, file)
addon.unregister()
