"""A job as one script of Slurm: `sh FILE [options of sbatch]` submits it, and its arrays run it.

The tasks of a step are an array; a step that needs another is submitted with afterok. Their exit codes are those of their
commands, and a step whose needs have failed is cancelled. Slurm's MaxArraySize limits the numbers, to 1000 unless configured.
"""

import shlex

from .frame_files import written
from .steps import CODE, OF_TASK, by_step, joined, values_of

_HEAD = """\
#!/bin/sh
#SBATCH --job-name={title}
#SBATCH --array={array}
# {title}: {count} tasks. Submit it with `sh FILE [options of sbatch]`.
# Exit code of a task: that of its command, 0 done, 1 the render failed, 2 wrong use.
if [ -z "${{SLURM_ARRAY_TASK_ID-}}" ]; then
  if [ -n "${{SLURM_JOB_ID-}}" ]; then
    echo "This script is for an array of tasks: submit it with sh" >&2
    exit 2
  fi
"""


def text(job, tasks):
    """Return the script of these tasks of a job."""
    steps = by_step(tasks)
    arrays = {step: written([task.number for task in its], "-") for step, its in steps.items()}
    parts = [_HEAD.format(title=job.title, array=next(iter(arrays.values())), count=len(tasks))]
    parts += [_submission(step, arrays) for step in steps]
    parts.append('  exit 0\nfi\n\ncase "$SLURM_ARRAY_TASK_ID" in\n')
    parts += [f"  {task.number}) step={task.step.name}{_values(task)} ;;\n" for task in tasks]
    parts.append('  *)\n    echo "No task of this job: $SLURM_ARRAY_TASK_ID" >&2\n    exit 2\n    ;;\nesac\n')
    parts += [f"{value.name}={shlex.quote(job.values()[value])}\n" for value in values_of(steps, CODE)]
    parts.append("case $step in\n")
    parts += [f"  {step.name}) exec {_command(step, job.values())} ;;\n" for step in steps]
    return "".join(parts) + "esac\n"


def _submission(step, arrays):
    """Return the lines that submit a step, and keep its number for those that need it."""
    ids = "".join(f":${{{one.name}_job%%;*}}" for one in arrays if one.name in step.needs)
    needs = f' --dependency="afterok{ids}" --kill-on-invalid-dep=yes' if ids else ""
    job = f"{step.name}_job"
    # With --wait, sbatch fails with its tasks and tells their number; without a number it has refused them.
    return (
        f'  {job}=$(sbatch --parsable --array={arrays[step]}{needs} "$@" "$0") || {{ [ "${job}" ] && exit 1 || exit 2; }}\n'
        f'  echo "{step.name}: job ${job}"\n'
    )


def _values(task):
    return "".join(f" {value.name}={shlex.quote(task.values[value])}" for value in values_of([task.step], OF_TASK))


def _command(step, values):
    def spelled(value):
        return f'"${value.name}"' if value.kind in (OF_TASK, CODE) else shlex.quote(values[value])

    return " ".join(joined(argument, spelled, shlex.quote) for argument in step.arguments)
