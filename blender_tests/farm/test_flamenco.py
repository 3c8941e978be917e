"""A job as a job type of Flamenco, run by Node against a stand-in for what Flamenco Manager gives to scripts.

The stand-in has the documented functions alone, refuses what they do not take, and counts its calls. Flamenco itself does not
take part.
"""

import json
import re
import shutil
import subprocess
from collections import Counter

import pytest
from farm_programs import Programs

from addon.farm import flamenco
from addon.farm.job import BLENDER

# A script of Flamenco is strict. Tasks are copied when they are added: what is changed later is lost.
MANAGER = """\
const fs = require("fs"), vm = require("vm");
const calls = {}, tasks = [];
let made = 0;
function count(name) { calls[name] = (calls[name] || 0) + 1; }
function check(right, what) { if (!right) throw new Error(what); }
class Command {
  constructor(name, parameters) { this.name = name; this.parameters = parameters; }
}
class Task {
  constructor(name, type) { Object.assign(this, { name, type, commands: [], needs: [], id: ++made }); }
  addCommand(command) { count("addCommand"); check(command instanceof Command, "no command"); this.commands.push(command); }
  addDependency(task) { count("addDependency"); check(task instanceof Task, "no task"); this.needs.push(task.id); }
}
const author = {
  Task(name, type) { count("Task"); check(name && type, "no name or type"); return new Task(name, type); },
  Command(name, of) { count("Command"); check(name && of, "no name or parameters"); return new Command(name, of); },
};
function explode(text) {
  const frames = new Set();
  for (const piece of text.replaceAll("..", "-").split(",")) {
    const [first, last] = piece.split("-").map((number) => parseInt(number.trim()));
    for (let frame = first; frame <= (last === undefined ? first : last); frame++) frames.add(frame);
  }
  return [...frames].sort((a, b) => a - b);
}
function merge(frames) {
  const runs = [];
  for (const frame of frames) {
    if (runs.length && frame === runs.at(-1)[1] + 1) runs.at(-1)[1] = frame; else runs.push([frame, frame]);
  }
  return runs.map(([a, b]) => b === a ? `${a}` : b === a + 1 ? `${a},${b}` : `${a}-${b}`).join(",");
}
function frameChunker(text, size) {
  count("frameChunker");
  check(typeof text === "string" && size >= 1, "frameChunker(frames, size)");
  const frames = explode(text), chunks = [];
  for (let at = 0; at < frames.length; at += size) chunks.push(merge(frames.slice(at, at + size)));
  return chunks;
}
const [script, changed] = process.argv.slice(2);
const context = vm.createContext({ author, frameChunker, print() {} });
vm.runInContext('"use strict";' + fs.readFileSync(script, "utf8"), context);
const type = vm.runInContext("JOB_TYPE", context);
const settings = Object.fromEntries(type.settings.map((setting) => [setting.key, setting.default]));
context.job = {
  settings: { ...settings, ...JSON.parse(changed) },
  addTask(task) { count("addTask"); tasks.push({ ...task, commands: [...task.commands], needs: [...task.needs] }); },
};
vm.runInContext("compileJob(job)", context);
process.stdout.write(JSON.stringify({ type, calls, tasks }));
"""
TYPES = {"string", "int32", "float", "bool"}
SUBTYPES = {"file_path", "dir_path", "file_name", "hashed_file_path"}


@pytest.fixture
def programs(tmp_path):
    return Programs(tmp_path)


@pytest.fixture
def compiled(tmp_path):
    """Return compiled(job, tasks=None, **settings): what the job type has told Flamenco."""
    node = shutil.which("node")
    assert node, "Node is missing: apt-get install nodejs"

    def run(job, tasks=None, **settings):
        for name, text in (("manager.js", MANAGER), ("job.js", flamenco.text(job, job.tasks() if tasks is None else tasks))):
            (tmp_path / name).write_text(text)
        command = [node, tmp_path / "manager.js", tmp_path / "job.js", json.dumps(settings)]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run


def commands(found, blender=None):
    """Return the command line of each task, as a worker of Flamenco makes it of the command's parameters."""
    lines = []
    for task in found["tasks"]:
        (command,) = task["commands"]
        of = command["parameters"]
        if command["name"] == "blender-render":
            assert (of["exe"], of["exeArgs"], task["type"]) == ("{blender}", "{blenderArgs}", "blender")
            lines.append([blender, *of["argsBefore"], of["blendfile"], *of["args"]])
        else:
            assert (command["name"], task["type"]) == ("exec", "misc")
            lines.append([of["exe"], *of["args"]])
    return lines


def test_frames_become_tasks_of_blender(programs, compiled):
    job = programs.frames(frames="1-7x2,8,20,30-35", chunk=3)
    found = compiled(job)
    assert found["calls"] == {"frameChunker": 1, "Task": 4, "Command": 4, "addCommand": 4, "addTask": 4}
    assert commands(found, job.blender) == [task.arguments for task in job.tasks()]


def test_a_still_becomes_parts_and_a_merge_that_needs_them(programs, compiled):
    job = programs.still()
    found = compiled(job)
    assert found["calls"] == {"Task": 4, "Command": 4, "addCommand": 4, "addDependency": 3, "addTask": 4}
    assert commands(found) == [task.arguments for task in job.tasks()]
    *parts, merge = found["tasks"]
    assert merge["needs"] == [part["id"] for part in parts]
    assert not any(part["needs"] for part in parts)
    assert max(Counter(task["name"] for task in found["tasks"]).values()) == 1


def test_settings_replace_the_values_of_the_job(programs, compiled):
    found = compiled(programs.frames(), blendfile="/there/b.blend", picture_folder="/there", frames="3-5", chunk=3)
    there = programs.frames(file="/there/b.blend", pictures="/there/f_####.png", frames="3-5", chunk=3)
    assert commands(found, there.blender) == [task.arguments for task in there.tasks()]
    found = compiled(programs.still(), snapshot="/there/b.npz", part_folder="/there", picture_folder="/here", python="py")
    there = programs.still(snapshot="/there/b.npz", part_files="/there/p-##.npz", picture="/here/picture.exr", python="py")
    assert commands(found) == [task.arguments for task in there.tasks()]


@pytest.mark.parametrize("kind", ["frames", "still"])
def test_settings_are_those_that_flamenco_knows(programs, compiled, kind):
    """Types of Flamenco's interface, a default for each, and Blender by the variable of the farm alone."""
    job = getattr(programs, kind)()
    found = compiled(job)["type"]
    assert found["label"] == f"Lancer {job.title}"
    for setting in found["settings"]:
        assert re.fullmatch("[a-z_]+", setting["key"]) and setting["description"] and "default" in setting
        assert setting["type"] in TYPES and setting.get("subtype", "dir_path") in SUBTYPES
        assert type(setting["default"]) is {"string": str, "int32": int}[setting["type"]]
    keys = [setting["key"] for setting in found["settings"]]
    assert len(set(keys)) == len(keys) and BLENDER.name not in keys
    assert ("blendfile" in keys) == (kind == "frames")


def test_only_what_is_missing(programs, compiled):
    job = programs.frames()
    found = compiled(job, job.tasks()[1:])
    assert commands(found, job.blender) == [task.arguments for task in job.tasks()[1:]]
    still = programs.still()
    found = compiled(still, still.tasks()[2:])
    assert commands(found) == [task.arguments for task in still.tasks()[2:]]
    assert found["calls"]["addDependency"] == 1
    found = compiled(still, still.tasks()[3:])
    assert "addDependency" not in found["calls"] and found["calls"]["addTask"] == 1


def test_no_argument_has_a_variable_of_flamenco(programs, compiled):
    """Flamenco replaces {name} in every parameter."""
    for argument in (argument for line in commands(compiled(programs.frames()), "blender") for argument in line):
        assert not re.search(r"\{\w+\}", argument), argument
