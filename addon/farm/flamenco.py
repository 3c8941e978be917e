"""A job as a job type of Flamenco 3: a script for the folder `scripts` of Flamenco Manager.

Values of the job are the defaults of the job type's settings. Flamenco splits the frames into chunks, and starts Blender by
its variables {blender} and {blenderArgs}; Flamenco's add-on sets the file. The parts of a still are a list in the script.
"""

import json

from .frame_files import read_frames, written
from .job import BLEND_FILE, BLENDER, FRAMES
from .steps import CODE, FOLDER, INPUT, OF_TASK, PROGRAM, by_step, joined, values_of

_HEAD = """\
// {title}, for the folder `scripts` of Flamenco Manager.
const JOB_TYPE = {{
  label: {label},
  settings: [
{settings}  ],
}};
{codes}
function compileJob(job) {{
  const settings = job.settings;
"""

_RENDER = """\
  for (const chunk of frameChunker(settings.frames, settings.chunk)) {{
    const frames = chunk.replaceAll("-", "..");
    const task = author.Task({name} + chunk, "blender");
    task.addCommand(author.Command("blender-render", {{
      exe: "{{blender}}",
      exeArgs: "{{blenderArgs}}",
      argsBefore: [{before}],
      blendfile: {file},
      args: [{behind}],
    }}));
    job.addTask(task);
  }}
"""

_EXEC = """\
  const {step} = [
{rows}  ].map((row) => {{
    const task = author.Task({name}, "misc");
    task.addCommand(author.Command("exec", {{
      exe: {exe},
      args: [{arguments}],
    }}));
{needs}    job.addTask(task);
    return task;
  }});
"""


def text(job, tasks):
    """Return the script of these tasks of a job."""
    steps, values = by_step(tasks), job.values()
    settings = "".join(f"    {json.dumps(setting)},\n" for setting in _settings(job, steps, values))
    codes = "".join(f"const {_written(value)} = {json.dumps(values[value])};\n" for value in values_of(steps, CODE))
    parts = [_HEAD.format(title=job.title, label=json.dumps(f"Lancer {job.title}"), settings=settings, codes=codes)]
    parts += [_render(step) if _has_frames(step) else _exec(step, its, steps) for step, its in steps.items()]
    return "".join(parts) + "}\n"


def _has_frames(step):
    return FRAMES in values_of([step], OF_TASK)


def _settings(job, steps, values):
    for value in values_of(steps, INPUT, FOLDER, PROGRAM):
        subtype = {"subtype": "dir_path"} if value.kind == FOLDER else {}
        visible = {"visible": "web"} if value == BLEND_FILE else {}
        if value != BLENDER:
            yield _setting(_key(value), "string", values[value], value.about, **subtype, **visible)
    for its in (its for step, its in steps.items() if _has_frames(step)):
        frames = read_frames(",".join(task.values[FRAMES] for task in its).replace("..", "-"))
        yield _setting("frames", "string", written(frames, "-"), "Frames, as 1-10, 20")
        yield _setting("chunk", "int32", job.chunk, "Frames of a task", propargs={"min": 1})


def _setting(key, kind, default, about, **more):
    return {"key": key, "type": kind, "required": True, "default": default, "description": about, **more}


def _render(step):
    """Return the lines that make tasks of blender-render, whose command is exe, argsBefore, blendfile, args."""
    name, place = json.dumps(step.name + " "), step.arguments.index(BLEND_FILE)
    before, behind = _list(step.arguments[1:place]), _list(step.arguments[place + 1 :])
    return _RENDER.format(name=name, before=before, file=_written(BLEND_FILE), behind=behind)


def _exec(step, tasks, steps):
    """Return the lines that make tasks of exec, one for each row of values."""
    values = values_of([step], OF_TASK)
    rows = "".join(f"    {json.dumps({_key(value): task.values[value] for value in values})},\n" for task in tasks)
    name = " + ".join([json.dumps(step.name), *(f'" " + {_written(value)}' for value in values[:1])])
    exe, *arguments = step.arguments
    needed = [one.name for one in steps if one.name in step.needs]
    needs = "".join(f"    {other}.forEach((other) => task.addDependency(other));\n" for other in needed)
    return _EXEC.format(step=step.name, rows=rows, name=name, exe=_expression(exe), arguments=_list(arguments), needs=needs)


def _list(arguments):
    return ", ".join(map(_expression, arguments))


def _expression(argument):
    return joined(argument, _written, json.dumps, " + ")


def _written(value):
    """Return the script's expression of a value."""
    if value.kind == CODE:
        return value.name.upper()
    return value.name if value == FRAMES else ("row." if value.kind == OF_TASK else "settings.") + _key(value)


def _key(value):
    # Flamenco's add-on fills the setting of this name with the file that it has sent.
    return "blendfile" if value == BLEND_FILE else value.name
