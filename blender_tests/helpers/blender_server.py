"""A Blender that runs cases one after another, each from factory settings."""

import json
import os
import select
import subprocess
import sys
from pathlib import Path

RUN = str(Path(__file__).resolve().parents[1] / "blender" / "in_blender" / "run.py")
# Seconds after which a case is taken to hang: three times the longest case on a machine with a busy loop on each processor.
LONGEST = 300


class BlenderServer:
    """program: Blender's path; None is the bpy module of this Python. output: the file for all that no case says."""

    def __init__(self, program, environment, output):
        self.environment, self.output = environment, output
        read, write = os.pipe()
        command = [sys.executable, RUN] if program is None else [
            program, "-b", "--factory-startup", "--python-exit-code", "3", "-P", RUN
        ]  # fmt: skip
        with open(output, "ab") as said:
            self.process = subprocess.Popen(
                [*command, "--", str(write)],
                stdin=subprocess.PIPE,
                stdout=said,
                stderr=said,
                env=environment,
                cwd=os.path.dirname(output),
                pass_fds=[write],
            )
        os.close(write)
        self.answers = os.fdopen(read, "rb")

    def run(self, **request):
        """The exit code of a case. A process that ends or hangs meanwhile is closed, and its own code returned."""
        try:
            self.process.stdin.write(json.dumps(request).encode() + b"\n")
            self.process.stdin.flush()
        except OSError:
            return self.close()
        ready, _, _ = select.select([self.answers], [], [], LONGEST)
        line = self.answers.readline() if ready else b""
        if ready and line:
            return int(line)
        if not ready:
            self.process.kill()
        return self.close() or 1

    def close(self):
        """Ends the process and returns its exit code; -9 where it had to be killed."""
        if self.process.stdin and not self.process.stdin.closed:
            try:
                self.process.stdin.close()
            except OSError:
                pass
        try:
            self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
        self.answers.close()
        return self.process.wait()

    @property
    def is_open(self):
        return not self.answers.closed
