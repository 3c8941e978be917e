"""`lancer render FILE`: renders a snapshot or a bug report to OpenEXR or PNG, on this machine or by a scheduler's workers.

Exit codes: 0, 1 if the render or the writing failed, 2 if the file or an option is wrong, so that another try is useless.
"""

import contextlib
import os
import signal
import sys

from . import picture_file
from .arguments import count, loaded, percent, seconds, threads
from .exit_codes import DONE, WrongUse
from .pool import NoAddress, PoolError
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
    parser.add_argument("--samples", type=count, help="per pixel; no target error or time limit then ends the render")
    parser.add_argument("--target", type=percent, metavar="PERCENT", help="error at which the render ends")
    parser.add_argument("--time-limit", type=seconds, metavar="SECONDS", help="time after which the render ends")
    parser.add_argument("--threads", type=threads, help="on this machine; default: the setting of the scene")
    where = "of a Dask scheduler, as tcp://host:8786, or local: processes of this machine"
    parser.add_argument("--scheduler", metavar="ADDRESS", help=where)
    parser.add_argument("--workers", type=count, default=2, help="number of processes of `--scheduler local`")
    parser.add_argument("--half", action="store_true", help="colours with 16 bits in OpenEXR files")
    parser.set_defaults(run=run)
    return parser


def run(arguments):
    """Render to a file, write a report to stdout and return the exit code; raise what main() turns into a sentence.

    Ctrl-C ends the render with the samples that are there, and a second one without a picture.
    """
    output = arguments.output or os.path.splitext(os.path.basename(arguments.scene))[0] + ".exr"
    # Learn before a long render that its picture cannot be written.
    what = picture_file.fault(output)
    if what:
        raise WrongUse(what)
    picture_file.library()
    snapshot, facts = loaded(arguments.scene)
    snapshot = adjusted(snapshot, arguments.samples, arguments.threads, arguments.target, arguments.time_limit)
    with contextlib.closing(ProgressBar()) as bar, interruptible() as poll, _pool(arguments, bar, poll) as pool:
        rendered = render(snapshot, tell=bar, pool=pool, poll=poll)
    rendered.save(output, arguments.half)
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
        try:
            pool = DaskPool(place, poll)
        except NoAddress as error:
            raise WrongUse(str(error)) from error
        try:
            bar(0.0, f"the dashboard is at {pool.dashboard}")
            yield pool
        finally:
            pool.close()
