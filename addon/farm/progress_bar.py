"""Progress of a long command in a terminal, or in a log."""

import sys
import time

_WIDTH = 30
# Seconds after which progress is worth a line.
_PATIENCE = 2.0


class ProgressBar:
    """Called with (fraction, text): rewrites one line of a terminal; elsewhere writes a line for every 10 %."""

    def __init__(self, stream=None, patience=_PATIENCE):
        self._stream = sys.stderr if stream is None else stream
        self._from = time.monotonic() + patience
        self._shown = 0  # characters of the line in the terminal
        self._tenth = -1

    def __call__(self, fraction, text):
        if time.monotonic() < self._from:
            return
        done = int(_WIDTH * min(1.0, fraction) + 0.5)
        line = f"[{'#' * done}{'.' * (_WIDTH - done)}] {100 * min(1.0, fraction):3.0f} %  {text}"
        if self._stream.isatty():
            self._stream.write("\r" + line.ljust(self._shown))
            self._shown = len(line)
        elif int(10 * fraction) > self._tenth:
            self._tenth = int(10 * fraction)
            self._stream.write(line + "\n")
        self._stream.flush()

    def close(self):
        """End the line, so that other text begins on a new one."""
        if self._shown:
            self._stream.write("\n")
            self._stream.flush()
            self._shown = 0
