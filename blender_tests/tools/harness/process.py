"""What a measuring process does the same everywhere: its memory, its arguments, its answer."""

import json
import os
import sys
from pathlib import Path


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
