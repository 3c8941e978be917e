"""A job as a job template of OpenJD, revision 2023-09: what AWS Deadline Cloud and its workers take.

Programs, files and folders are parameters, so that a farm can replace them and map their paths. OpenJD takes as the default of
a path only one below the template's folder: another must be given with the job.
"""

import json
import os

from .frame_files import written
from .job import JobError
from .steps import CODE, FOLDER, INPUT, OF_TASK, PROGRAM, by_step, joined, values_of

_TYPES = {
    PROGRAM: {"type": "STRING"},
    INPUT: {"type": "PATH", "objectType": "FILE", "dataFlow": "IN"},
    FOLDER: {"type": "PATH", "objectType": "DIRECTORY", "dataFlow": "OUT"},
}
# The most values that a list of OpenJD may have.
_MOST = 1024


def text(job, tasks, folder):
    """Return the template of these tasks of a job, for a file in folder."""
    steps, values = by_step(tasks), job.values()
    template = {
        "specificationVersion": "jobtemplate-2023-09",
        "name": job.title,
        "parameterDefinitions": [_parameter(value, values[value], folder) for value in values_of(steps, *_TYPES)],
        "steps": [_step(step, its, values, [one.name for one in steps]) for step, its in steps.items()],
    }
    return json.dumps(template, indent=2) + "\n"


def _parameter(value, default, folder):
    parameter = {"name": _name(value), **_TYPES[value.kind], "description": f"{value.about}: {default}"}
    if value.kind != PROGRAM:
        default = os.path.relpath(default, folder)
        if default.startswith(os.pardir):
            return parameter
    return {**parameter, "default": default}


def _step(step, tasks, values, names):
    command, *arguments = _arguments(step, values)
    made = {"name": step.name}
    needs = [{"dependsOn": name} for name in step.needs if name in names]
    if needs:
        made["dependencies"] = needs
    varied = values_of([step], OF_TASK)
    if varied:
        ranges = [_range(value, [task.values[value] for task in tasks]) for value in varied]
        made["parameterSpace"] = {"taskParameterDefinitions": ranges}
    if len(varied) > 1:
        # A task has the values of one row, and not every combination is a task.
        made["parameterSpace"]["combination"] = f"({', '.join(map(_name, varied))})"
    return {**made, "script": {"actions": {"onRun": {"command": command, "args": arguments}}}}


def _range(value, texts):
    """Return the values that a parameter takes, task by task."""
    if all(text.isdecimal() for text in texts):
        return {"name": _name(value), "type": "INT", "range": written(sorted(map(int, texts)), "-")}
    if len(texts) > _MOST:
        raise JobError(
            value.name, len(texts), f"values are more than the {_MOST} of an OpenJD list; frames one by one have no limit"
        )
    return {"name": _name(value), "type": "STRING", "range": [_constant(text) for text in texts]}


def _arguments(step, values):
    """Return the step's command, with references to parameters."""

    def reference(value):
        if value.kind == CODE:
            return _constant(values[value])
        return "{{" + ("Task.Param." if value.kind == OF_TASK else "Param.") + _name(value) + "}}"

    return [joined(argument, reference, _constant) for argument in step.arguments]


def _constant(text):
    """Return a text that OpenJD leaves as it is."""
    if "{{" in text:
        raise JobError("argument", text, "has {{, which begins a reference of OpenJD")
    return text


def _name(value):
    return value.name.title().replace("_", "")
