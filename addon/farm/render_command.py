"""`lancer render FILE`: renders a snapshot or a bug report to OpenEXR or PNG.

Exit codes: 0, 1 if the render or the writing failed, 2 if the file or an option is wrong, so that another try is useless.
"""

import argparse
import os
import sys

from ..bindings import bug_report
from ..bindings.abi import LancerError
from ..bindings.npz import SnapshotError
from . import picture_file
from .progress_bar import ProgressBar
from .render_snapshot import adjusted, render, report

FAILED, WRONG_USE = 1, 2


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
    parser.add_argument("--threads", type=_count, help="default: the setting of the scene")
    parser.add_argument("--half", action="store_true", help="colours with 16 bits in OpenEXR files")
    parser.set_defaults(run=run)
    return parser


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="lancer", description="Renders scenes of Lancer without Blender.")
    add_parser(parser.add_subparsers(required=True, metavar="COMMAND"))
    told = parser.parse_args(arguments)
    return told.run(told)


def run(arguments):
    """Render to a file and write a report to stdout; return the exit code, after one sentence on stderr if it is not 0."""
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
        snapshot = adjusted(snapshot, arguments.samples, arguments.threads)
        rendered = render(snapshot, tell=bar)
        bar.close()
        rendered.save(output, arguments.half)
    except (LancerError, OSError) as error:
        return _end(error, FAILED, bar)
    except MemoryError:
        return _end("there is not enough memory for this scene", FAILED, bar)
    except KeyboardInterrupt:
        return _end("interrupted", FAILED, bar)
    for line in (*report(snapshot, facts, rendered), output):
        sys.stdout.write(line + "\n")
    return 0


def _end(text, code, bar=None):
    if bar is not None:
        bar.close()
    sys.stderr.write(f"lancer: {text}\n")
    return code


def _count(text):
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is no number from 1 on")
    return int(text)
