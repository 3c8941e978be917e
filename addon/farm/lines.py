"""A job as a shell script of plain command lines: one machine, no farm.

A line of frames does not start Blender if its pictures are there; one of a part starts, as only the command knows whether a
file belongs to the same picture.
"""

import shlex

from .steps import CODE, joined, values_of

_HEAD = """\
#!/bin/sh
# {title}: {count} tasks. Run it again, and it makes what is missing.
# Exit code: 0 all files are there, 1 a task failed, 2 wrong use.
if [ $# -ne 0 ]; then
  echo "usage: sh $0" >&2
  exit 2
fi
failed=0
"""


def text(job, tasks):
    """Return the script of these tasks of a job."""
    lines = [_HEAD.format(title=job.title, count=len(tasks))]
    codes = values_of([task.step for task in tasks], CODE)
    lines += [f"{value.name}={shlex.quote(job.values()[value])}\n" for value in codes]
    lines += [_line(task) for task in tasks]
    return "".join(lines) + "exit $failed\n"


def _line(task):
    parts = []
    if task.needs:
        parts.append("[ $failed -ne 0 ]")
    if task.step.files_are_whole:
        parts.append(" && ".join(f"[ -s {shlex.quote(file)} ]" for file in task.files))
    codes = values_of([task.step], CODE)
    words = (f'"${one.name}"' if one in codes else shlex.quote(joined(one, task.values.get)) for one in task.step.arguments)
    return " || ".join([*parts, " ".join(words), "failed=1"]) + "\n"
