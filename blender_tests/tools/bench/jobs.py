"""The benchmark's measuring processes: inside Blender's module, and with another renderer."""

import json
import sys
from pathlib import Path

from tools.harness import workers
from tools.harness.places import BUILD, ROOT

OUTPUT = BUILD / "bench"
# Places of the worker in other revisions.
_EARLIER = ("tools/bench/worker.py", "bench/worker.py", "bench_worker.py")


def in_blender(task, root=ROOT, **arguments):
    """Run a task of the worker. root: the tree that is measured; another revision has its own worker."""
    tests = root / "blender_tests"
    start = tests / "tools" / "start.py"
    if start.exists():
        worker = [start, "bench.worker"]
    else:
        worker = [next(tests / name for name in _EARLIER if (tests / name).exists())]
    return workers.run([sys.executable, *worker, task, json.dumps(arguments)], root)


def with_peer(task, module=None, limit=None, **arguments):
    if module is not None:
        arguments["module"] = module
    return workers.ask("bench.peer_worker", task, limit=limit, environment=_environment(module), **arguments)


def _environment(module):
    if module != "luxcore":
        return {}
    # LuxCore's allocator must be loaded before any other library allocates, or LuxCore aborts.
    found = sorted(Path(sys.prefix).glob("lib/python*/site-packages/pyluxcore.libs/libtbbmalloc_proxy*"))
    return {"LD_PRELOAD": str(found[0])} if found else {}
