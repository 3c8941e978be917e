"""Measurements in processes of their own: each prints its answer as JSON, or says why it has none."""

import json
import os
import subprocess
import sys

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
    """The answer of a task of a module of tools: of one that calls process.answer."""
    return run([sys.executable, START, module, task, json.dumps(arguments)], environment=environment, limit=limit)


def build(*command):
    """Runs a compiler, silent where it goes well."""
    result = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if result.returncode:
        raise Failed((result.stderr or result.stdout or f"{command[0]} failed").strip().splitlines()[-1][:300])
