"""Arguments that several commands share: numbers, scenes, and places of files that are to be written."""

import argparse
import math
import os

from ..bindings import bug_report
from ..bindings.npz import SnapshotError
from .exit_codes import WrongUse

# The largest numbers that the library takes: samples of a pixel, and threads.
_MOST_SAMPLES, _MOST_THREADS = 1 << 31, 1024


def count(text, most=_MOST_SAMPLES):
    """Return a whole number from 1 on."""
    if not (text.isascii() and text.isdigit() and 1 <= int(text) <= most):
        raise argparse.ArgumentTypeError(f"{text} is no number from 1 to {most}")
    return int(text)


def threads(text):
    """Return a number of threads; 0: one per processor."""
    return 0 if text == "0" else count(text, _MOST_THREADS)


def seconds(text):
    """Return a time above 0."""
    value = float(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is no time above 0")
    return value


def percent(text):
    """Return a share between 0 and 1, of percents."""
    value = float(text)
    if not 0.0 < value < 100.0:
        raise argparse.ArgumentTypeError(f"{text} is no error between 0 and 100 percent")
    return value / 100.0


def loaded(path):
    """Return (SceneSnapshot, facts) of a snapshot or bug report."""
    try:
        return bug_report.load(path)
    except FileNotFoundError:
        raise WrongUse(f"{path}: there is no such file") from None
    except (OSError, SnapshotError) as error:
        raise WrongUse(str(error)) from error


def require_folder(path):
    """Learn before the work that its file has no place."""
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder):
        raise WrongUse(f"{folder}: there is no such folder")
