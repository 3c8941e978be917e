"""Runs of hours: the line that tells how far they are, and results that are kept where one is broken off."""

import json
import sys
import time


class Line:
    """One line that moves on a terminal; in a log a line for each scene."""

    def __init__(self):
        self.started = time.monotonic()
        self.moves = sys.stdout.isatty()

    def show(self, text):
        if self.moves:
            print(f"\r\033[K{time.monotonic() - self.started:7.1f}  {text}", end="", flush=True)

    def end(self, text):
        print(f"{chr(13) + chr(27) + '[K' if self.moves else ''}{time.monotonic() - self.started:7.1f}  {text}", flush=True)


def kept(path, key, measure):
    """What measure() gives, or gave in an earlier run with the same key."""
    if path.exists():
        found = json.loads(path.read_text())
        if found["key"] == key:
            return found["result"]
    result = measure()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"key": key, "result": result}))
    return result
