"""The command `frames`: write a described job for a farm, or tell what it has not made yet.

frames job.json --form slurm --output shot.sh
frames --file shot.blend --frames 1-100 --pictures //renders/shot_####.png --save job.json --form lines --output shot.sh
frames job.json --missing                          lists the missing files; exit code 1 if there are any
frames job.json --missing --form slurm --output rest.sh    only the tasks that have not made their files
"""

import argparse
import dataclasses
import os
import sys

from . import flamenco, lines, openjd, slurm
from .job import KINDS, load, of_fields
from .steps import is_made

FORMS = {
    "openjd": openjd.text,
    "slurm": lambda job, tasks, folder: slurm.text(job, tasks),
    "flamenco": lambda job, tasks, folder: flamenco.text(job, tasks),
    "lines": lambda job, tasks, folder: lines.text(job, tasks),
}


def add_parser(subparsers):
    """Add the command's parser, whose default `run` is the function to call."""
    parser = subparsers.add_parser(
        "frames",
        help="write a job of frames, or of a still in parts, for a farm",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("job", nargs="?", help="description, a JSON file; without it, the options below describe the job")
    parser.add_argument("--form", choices=FORMS, help="what to write")
    parser.add_argument("--output", metavar="FILE", help="file to write the form to")
    parser.add_argument("--save", metavar="FILE", help="file to write the description to")
    parser.add_argument("--missing", action="store_true", help="only what has not been made; alone: list its files")
    for name, kind in KINDS.items():
        group = parser.add_argument_group(f"a job of the kind {name}")
        for item in dataclasses.fields(kind):
            how = {"action": "append"} if item.type is tuple else {"type": item.type}
            option = "--" + item.name.replace("_", "-")
            group.add_argument(option, help=item.metadata["about"], metavar=item.name.upper(), **how)
    parser.set_defaults(run=run)
    return parser


def run(arguments):
    """Run the command and return its exit code: 0 done, 1 files are missing, 2 wrong use."""
    try:
        return _run(arguments)
    except (ValueError, OSError) as error:
        sys.stderr.write(f"{error}\n")
        return 2


def _run(arguments):
    if bool(arguments.form) != bool(arguments.output):
        raise ValueError("--form and --output go together")
    if not (arguments.form or arguments.save or arguments.missing):
        raise ValueError("Nothing to do: give --form with --output, --save, or --missing")
    job = _described(arguments)
    if arguments.save:
        job.save(arguments.save)
    tasks = job.missing() if arguments.missing else job.tasks()
    if arguments.form:
        return _write(arguments, job, tasks)
    if arguments.missing:
        sys.stdout.writelines(f"{file}\n" for task in tasks for file in task.files if not is_made(file))
        return 1 if tasks else 0
    return 0


def _described(arguments):
    """Return the job with absolute paths: a file's paths are relative to its folder, those of options to the current one."""
    given = {item.name: getattr(arguments, item.name) for kind in KINDS.values() for item in dataclasses.fields(kind)}
    given = {name: value for name, value in given.items() if value is not None}
    if not arguments.job:
        return of_fields({"kind": "still" if "snapshot" in given else "frames", **given}).resolved(os.getcwd())
    if given:
        raise ValueError(f"{arguments.job} describes the job: leave out " + ", ".join(given))
    return load(arguments.job).resolved(os.path.dirname(os.path.abspath(arguments.job)))


def _write(arguments, job, tasks):
    if not tasks:
        sys.stderr.write("Nothing is missing, and no file was written.\n")
        return 0
    folder = os.path.dirname(os.path.abspath(arguments.output))
    text = FORMS[arguments.form](job, tasks, folder)
    with open(arguments.output, "w", encoding="utf-8") as file:
        file.write(text)
    return 0
