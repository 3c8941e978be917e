"""start.py MODULE ARGUMENTS: run a module of tools, such as bench.run, with the project, test helpers and bindings on its path.

Runs under a Python that has bpy, and inside Blender: blender -b --factory-startup -P start.py -- MODULE ARGUMENTS
"""

import runpy
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS), str(TESTS / "helpers")]
# `import bindings` imports the add-on's package without the add-on. The folder comes last, since it has other packages, too.
sys.path.append(str(TESTS.parent / "addon"))

if __name__ == "__main__":
    module, *arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    sys.argv = [module, *arguments]
    runpy.run_module(f"tools.{module}", run_name="__main__")
