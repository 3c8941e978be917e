"""`lancer render FILE`: renders a snapshot or a bug report to OpenEXR or PNG, on this machine or by a scheduler's workers.

Exit codes: 0, 1 if the render or the writing failed, 2 if the file or an option is wrong, so that another try is useless.
"""

import argparse
import contextlib
import os
import signal
import sys

from ..bindings import bug_report
from ..bindings.abi import LancerError
from ..bindings.npz import SnapshotError
from . import picture_file
from .exit_codes import DONE, FAILED, WRONG_USE
from .pool import PoolError
from .progress_bar import ProgressBar
from .render_snapshot import adjusted, render, report


def add_parser(subparsers):
    """Add the command to an ArgumentParser's subparsers; its namespace has run, a function of it that returns the exit code."""
    parser = subparsers.add_parser(
        "render",
        help="render a snapshot or a bug report to a picture",
        description="Renders a snapshot (.npz) or a bug report (.zip) with its own settings, without Blender.",
    )
    parser.add_argument("scene", metavar="FILE", help="the snapshot or bug report")
    files = "NAME.exr: all passes, linear; NAME.png: the picture, for a screen; default: FILE's name with .exr"
    parser.add_argument("-o", "--output", metavar="PICTURE", help=files)
    parser.add_argument("--samples", type=_count, help="per pixel; no target error or time limit then ends the render")
    parser.add_argument("--target", type=_percent, metavar="PERCENT", help="error at which the render ends")
    parser.add_argument("--time-limit", type=float, metavar="SECONDS", help="time after which the render ends")
    parser.add_argument("--threads", type=_count, help="on this machine; default: the setting of the scene")
    where = "of a Dask scheduler, as tcp://host:8786, or local: processes of this machine"
    parser.add_argument("--scheduler", metavar="ADDRESS", help=where)
    parser.add_argument("--workers", type=_count, default=2, help="number of processes of `--scheduler local`")
    parser.add_argument("--half", action="store_true", help="colours with 16 bits in OpenEXR files")
    parser.set_defaults(run=run)
    return parser


def run(arguments):
    """Render to a file and write a report to stdout; return the exit code, after one sentence on stderr if it is not 0.

    Ctrl-C ends the render with the samples that are there, and a second one without a picture.
    """
    output = arguments.output or os.path.splitext(os.path.basename(arguments.scene))[0] + ".exr"
    what = picture_file.fault(output)
    if what:
        return _end(what, WRONG_USE)
    try:
        snapshot, facts = bug_report.load(arguments.scene)
    except FileNotFoundError:
        return _end(f"{arguments.scene}: there is no such file", WRONG_USE)
    except (OSError, SnapshotError) as error:
        return _end(error, WRONG_USE)
    bar = ProgressBar()
    try:
        # Learn before a long render that its picture cannot be written.
        picture_file.library()
        snapshot = adjusted(snapshot, arguments.samples, arguments.threads, arguments.target, arguments.time_limit)
        with interruptible() as poll, _pool(arguments, bar, poll) as pool:
            rendered = render(snapshot, tell=bar, pool=pool, poll=poll)
        bar.close()
        rendered.save(output, arguments.half)
    except (LancerError, PoolError, OSError) as error:
        return _end(error, FAILED, bar)
    except MemoryError:
        return _end("there is not enough memory for this scene", FAILED, bar)
    except KeyboardInterrupt:
        return _end("interrupted", FAILED, bar)
    for line in (*report(snapshot, facts, rendered), output):
        sys.stdout.write(line + "\n")
    return DONE


@contextlib.contextmanager
def interruptible():
    """Context of a function that returns whether Ctrl-C was pressed once."""
    pressed = []

    def note(*_):
        if pressed:
            raise KeyboardInterrupt
        pressed.append(True)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield lambda: bool(pressed)
    finally:
        signal.signal(signal.SIGINT, before)


@contextlib.contextmanager
def _pool(arguments, bar, poll):
    """Context of the pool that the arguments name; None: this process renders."""
    if arguments.scheduler is None:
        yield None
        return
    try:
        from .dask_pool import DaskPool
        from .dask_worker import local_cluster
    except ImportError as error:
        raise PoolError(f"Dask is missing ({error}): pip install 'lancer[farm]', or distributed") from None
    local = arguments.scheduler == "local"
    with local_cluster(arguments.workers) if local else contextlib.nullcontext(arguments.scheduler) as place:
        pool = DaskPool(place, poll)
        try:
            bar(0.0, f"the dashboard is at {pool.dashboard}")
            yield pool
        finally:
            pool.close()


def _end(text, code, bar=None):
    if bar is not None:
        bar.close()
    sys.stderr.write(f"lancer: {text}\n")
    return code


def _percent(text):
    value = float(text)
    if not 0.0 < value < 100.0:
        raise argparse.ArgumentTypeError(f"{text} is no error between 0 and 100 percent")
    return value / 100.0


def _count(text):
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is no number from 1 on")
    return int(text)
