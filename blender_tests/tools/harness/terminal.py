"""The options of a run, and its output on the terminal."""

import argparse
import sys
import time
from fnmatch import fnmatchcase
from pathlib import Path

from .places import BUILD, ROOT, TABLES


def make_parser(text, *, quick, only="", threads=0, readme=False, output=""):
    """Return a parser with --quick and, if their arguments are given, --only, --threads, --readme, and --output in build/."""
    made = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("--quick", action="store_true", help=quick)
    if only:
        made.add_argument("--only", default="", help=only)
    if threads:
        made.add_argument("--threads", type=int, default=threads)
    if readme:
        made.add_argument("--readme", action="store_true", help=f"put the figures into {TABLES.relative_to(ROOT)}")
    if output:
        made.add_argument("--output", type=Path, default=BUILD / output)
    return made


def wanted(only, *names):
    """Return whether a name matches one of the comma-separated patterns, ignoring case; without patterns, all match."""
    patterns = [pattern.strip().lower() for pattern in only.split(",") if pattern.strip()]
    return not patterns or any(fnmatchcase(name.lower(), pattern) for name in names for pattern in patterns)


class Progress:
    """Prints lines with the seconds since the start, and on a terminal a line of progress that is overwritten."""

    def __init__(self, terminal=None):
        self.terminal = terminal or sys.stdout
        self.started = time.monotonic()
        self.moves = self.terminal.isatty()

    def show(self, text):
        """Show the progress."""
        if self.moves:
            self._write(f"\r\033[K{self._stamped(text)}")

    def __call__(self, text):
        """Print a result."""
        self._write(f"{chr(13) + chr(27) + '[K' if self.moves else ''}{self._stamped(text)}\n")

    def _stamped(self, text):
        return f"{time.monotonic() - self.started:7.1f}  {text}"

    def _write(self, text):
        self.terminal.write(text)
        self.terminal.flush()
