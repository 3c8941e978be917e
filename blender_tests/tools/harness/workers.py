"""Measurements in their own processes: the caller, and the worker, which prints its answer as JSON in its last line."""

import json
import os
import subprocess
import sys
from pathlib import Path

from .places import ROOT, TOOLS

START = TOOLS / "start.py"
# Seconds after which a measurement counts as failed: some renderers take hours for some scenes.
LONGEST = 900.0


class Failed(Exception):
    """A measurement failed; the text is its last line."""


def run(command, root=ROOT, environment=None, limit=None):
    """Return the JSON that a measuring process prints as its last line; raises Failed. limit: seconds, by default LONGEST."""
    settings = {"cwd": root, "capture_output": True, "text": True, "env": {**os.environ, **(environment or {})}}
    try:
        result = subprocess.run([str(word) for word in command], timeout=limit or LONGEST, **settings)
    except subprocess.TimeoutExpired as late:
        raise Failed(f"not done after {late.timeout:.0f} s") from None
    lines = result.stdout.strip().splitlines()
    if result.returncode or not lines:
        said = (result.stderr.strip() or result.stdout.strip() or f"exit code {result.returncode}").splitlines()
        raise Failed(said[-1][:300])
    return json.loads(lines[-1])


def ask(module, task, /, limit=None, environment=None, **arguments):
    """Return the answer of a task of a module of tools that calls answer(); raises Failed."""
    return run([sys.executable, START, module, task, json.dumps(arguments)], environment=environment, limit=limit)


def build(*command):
    """Run a compiler; raises Failed with the last line of its errors."""
    result = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if result.returncode:
        raise Failed((result.stderr or result.stdout or f"{command[0]} failed").strip().splitlines()[-1][:300])


def memory(field):
    """Return a figure of this process in bytes: VmRSS now, or VmHWM, the peak since reset_peak."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return 1024 * int(line.split()[1])
    raise KeyError(field)


def reset_peak():
    Path("/proc/self/clear_refs").write_text("5")


def answer(*tasks):
    """Run the task that the command line names with its JSON, and print its result as JSON in the last line."""
    by_name = {task.__name__: task for task in tasks}
    result = by_name[sys.argv[1]](**json.loads(sys.argv[2]))
    sys.stdout.flush()
    print("\n" + json.dumps(result), flush=True)


def leave():
    """End the process at once: some libraries abort when Python unloads them."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
