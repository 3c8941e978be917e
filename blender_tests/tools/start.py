"""start.py MODULE ARGUMENTS: runs a module of tools, as bench.run, where it finds the project, helpers of tests and bindings.

Runs under a Python that has bpy, and inside Blender: blender -b --factory-startup -P start.py -- MODULE ARGUMENTS
"""

import runpy
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS), str(TESTS / "helpers")]
# `import bindings` is the add-on's own package, reached without the add-on's top; after all else, for what else is there.
sys.path.append(str(TESTS.parent / "addon"))

if __name__ == "__main__":
    module, *arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    sys.argv = [module, *arguments]
    runpy.run_module(f"tools.{module}", run_name="__main__")
