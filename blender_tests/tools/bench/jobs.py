"""Starts measurements, each in a process of its own, and describes the machine."""

import hashlib
import json
import os
import platform
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
HERE = Path(__file__).resolve().parent
OUTPUT = ROOT / "build" / "bench"
# Seconds after which a measurement counts as failed: some peers take hours over some scenes.
LONGEST = 900.0


class Failed(Exception):
    """What a measurement said last."""


def run(command, root=ROOT, environment=None, limit=None):
    """The JSON that a measuring process prints as its last line; limit: seconds, LONGEST where not given."""
    settings = {"cwd": root, "capture_output": True, "text": True, "env": {**os.environ, **(environment or {})}}
    try:
        result = subprocess.run(command, timeout=limit or LONGEST, **settings)
    except subprocess.TimeoutExpired as late:
        raise Failed(f"not done after {late.timeout:.0f} s") from None
    lines = result.stdout.strip().splitlines()
    if result.returncode or not lines:
        said = (result.stderr.strip() or result.stdout.strip() or f"exit code {result.returncode}").splitlines()
        raise Failed(said[-1][:300])
    return json.loads(lines[-1])


def build(*command):
    """Runs a compiler, silent where it goes well."""
    result = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if result.returncode:
        raise Failed((result.stderr or result.stdout or f"{command[0]} failed").strip().splitlines()[-1][:300])


def in_blender(task, root=ROOT, **arguments):
    """root: the tree that is measured; one of another revision has its own worker."""
    places = [root / "blender_tests" / name for name in ("tools/bench/worker.py", "bench/worker.py", "bench_worker.py")]
    worker = next(path for path in places if path.exists())
    return run([sys.executable, str(worker), task, json.dumps(arguments)], root)


def with_peer(task, module=None, limit=None, **arguments):
    if module is not None:
        arguments["module"] = module
    command = [sys.executable, str(HERE / "peer_worker.py"), task, json.dumps(arguments)]
    return run(command, environment=_environment(module), limit=limit)


def _environment(module):
    if module != "luxcore":
        return {}
    # LuxCore's own allocator must be there before any other library has allocated, or it aborts.
    found = sorted(Path(sys.prefix).glob("lib/python*/site-packages/pyluxcore.libs/libtbbmalloc_proxy*"))
    return {"LD_PRELOAD": str(found[0])} if found else {}


def machine():
    facts = {
        "processor": platform.machine(),
        "processors": os.cpu_count(),
        "system": platform.system(),
    }
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            facts["processor"] = line.split(":", 1)[1].strip()
            break
    facts["memory_gib"] = round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30, 1)
    # What others have the machine do at the start falls on all figures.
    facts["load"] = round(os.getloadavg()[0], 2)
    return facts


def commit():
    """Of the tree, with a + where files differ from it."""
    name = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    changed = subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    return (name or "unknown") + ("+" if changed else "")


def digest_of_file(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]
