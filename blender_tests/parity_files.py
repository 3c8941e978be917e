"""Files of scenes/parity one by one, without Blender: the package around them needs bpy."""

import importlib.util
import os

from conftest import ROOT


def load(name):
    spec = importlib.util.spec_from_file_location(f"parity_{name}", os.path.join(ROOT, "scenes", "parity", f"{name}.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
