"""Runs one case inside a Blender, the module or the program: ... run.py -- RESULT.json FILE FUNCTION [ARGUMENTS]."""

import importlib
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
result_path, where, name, *arguments = sys.argv[sys.argv.index("--") + 1 :]
TESTS = os.path.dirname(os.path.dirname(HERE))
sys.path[:0] = [os.path.dirname(TESTS), HERE]
sys.path += [TESTS, os.path.join(TESTS, "helpers")]

from invalid_samples import watched  # noqa: E402

import addon  # noqa: E402
from addon.bindings.session import Session  # noqa: E402

addon.register()
case = getattr(importlib.import_module(where), name)
with watched(Session) as found:
    result = case(*arguments)
# No render of any case may drop a sample, unless the case says that it does.
if found and not getattr(case, "overflows", False):
    sys.exit(f"{where}.{name}: {found}")
with open(result_path, "w", encoding="utf-8") as file:
    json.dump(result, file)
addon.unregister()
