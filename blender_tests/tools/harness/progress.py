"""What a run tells on the terminal: what was measured, with the seconds since the start."""

import sys
import time


class Progress:
    """Lines that stay, and between them one that moves on a terminal and is left out of a log."""

    def __init__(self, terminal=None):
        self.terminal = terminal or sys.stdout
        self.started = time.monotonic()
        self.moves = self.terminal.isatty()

    def show(self, text):
        """What is going on."""
        if self.moves:
            self._write(f"\r\033[K{self._stamped(text)}")

    def __call__(self, text):
        """What was measured."""
        self._write(f"{chr(13) + chr(27) + '[K' if self.moves else ''}{self._stamped(text)}\n")

    def _stamped(self, text):
        return f"{time.monotonic() - self.started:7.1f}  {text}"

    def _write(self, text):
        self.terminal.write(text)
        self.terminal.flush()
