"""Measurements in processes of their own: who asks, and what answers, as JSON in the last line that it prints."""

import json
import os
import subprocess
import sys
from pathlib import Path

from .places import ROOT, TOOLS

START = TOOLS / "start.py"
# Seconds after which a measurement counts as failed: some peers take hours over some scenes.
LONGEST = 900.0


class Failed(Exception):
    """What a measurement said last."""


def run(command, root=ROOT, environment=None, limit=None):
    """The JSON that a measuring process prints as its last line; limit: seconds, LONGEST where not given."""
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
    """The answer of a task of a module of tools: of one that calls answer."""
    return run([sys.executable, START, module, task, json.dumps(arguments)], environment=environment, limit=limit)


def build(*command):
    """Runs a compiler, silent where it goes well."""
    result = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if result.returncode:
        raise Failed((result.stderr or result.stdout or f"{command[0]} failed").strip().splitlines()[-1][:300])


def memory(field):
    """A figure of this process in bytes: VmRSS now, or VmHWM, the peak since reset_peak."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return 1024 * int(line.split()[1])
    raise KeyError(field)


def reset_peak():
    Path("/proc/self/clear_refs").write_text("5")


def answer(*tasks):
    """Runs the task that the command line names with its JSON, and prints the JSON that it returns as the last line."""
    by_name = {task.__name__: task for task in tasks}
    result = by_name[sys.argv[1]](**json.loads(sys.argv[2]))
    sys.stdout.flush()
    print("\n" + json.dumps(result), flush=True)


def leave():
    """Ends the process at once: some libraries abort where Python takes them apart."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
