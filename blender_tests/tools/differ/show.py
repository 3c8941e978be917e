"""The verdict of scenes that `make differ` has kept: start.py differ.show FILE ...; also inside Blender, after --."""

import os
import sys
import tempfile
from pathlib import Path

from scenes.render import captured_output
from tools.harness.f12 import registered
from tools.parity.run import errors_in

from .judge import judge
from .record import from_python

_SAMPLES = 256


def main():
    with captured_output() as (terminal, _), errors_in(os.devnull), tempfile.TemporaryDirectory() as folder:
        for path in sys.argv[1:]:
            answer = judge(from_python(Path(path).read_text()), folder, _SAMPLES)
            terminal.write("\n  ".join([f"{path}: {answer['verdict']}: {answer['text']}", *answer["told"]]) + "\n")


if __name__ == "__main__":
    registered(main)
