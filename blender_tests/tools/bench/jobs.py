"""The benchmark's own measuring processes: inside Blender's module, and with another renderer."""

import json
import sys
from pathlib import Path

from tools.harness import workers
from tools.harness.places import BUILD, ROOT

OUTPUT = BUILD / "bench"
# Where other revisions have their worker.
_EARLIER = ("tools/bench/worker.py", "bench/worker.py", "bench_worker.py")


def in_blender(task, root=ROOT, **arguments):
    """root: the tree that is measured; one of another revision has its own worker."""
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
    # LuxCore's own allocator must be there before any other library has allocated, or it aborts.
    found = sorted(Path(sys.prefix).glob("lib/python*/site-packages/pyluxcore.libs/libtbbmalloc_proxy*"))
    return {"LD_PRELOAD": str(found[0])} if found else {}
