"""One description of a job for many machines: frames of a .blend file, or one still split by samples.

job = load("job.json")    # or Frames(...), Still(...): both are checked
for task in job.tasks():
    task.arguments, task.files, task.needs

Each form of a job (openjd.py, slurm.py, flamenco.py, lines.py) is made of its steps and tasks, and adds no command of its own.
Exit codes of commands and forms: 0 done, 1 a render failed, 2 wrong use.
"""

import dataclasses
import json
import os
from dataclasses import dataclass, field

from .frame_files import absolute, is_numbered, numbered, read_frames, split, title, written
from .in_blender import CHECK, PREPARE, TAKEN
from .steps import CODE, FOLDER, INPUT, OF_TASK, PROGRAM, Step, Task, Value

BLENDER = Value("blender", PROGRAM, "Command that starts Blender, with Lancer installed")
BLEND_FILE = Value("blend_file", INPUT, "File to render")
PICTURE_FOLDER = Value("picture_folder", FOLDER, "Folder of the pictures")
WHOLE_FILES = Value("whole_files", CODE, "Code by which Blender makes whole files or none")
FRAMES = Value("frames", OF_TASK, "Frames in Blender's notation")

PYTHON = Value("python", PROGRAM, "Command that starts a Python with Lancer")
SNAPSHOT = Value("snapshot", INPUT, "Snapshot of the scene")
PART_FOLDER = Value("part_folder", FOLDER, "Folder of the rendered parts")
PART = Value("part", OF_TASK, "Number of the part, and of all parts")
PART_FILE = Value("part_file", OF_TASK, "Name of the part's file")


class JobError(ValueError):
    """A description that cannot be a job; the text names the field and its value."""

    def __init__(self, name, value, reason):
        super().__init__(f"{name}: {value!r} {reason}")


def described(about, **how):
    return field(metadata={"about": about}, **how)


class Job:
    """What both kinds share. A kind adds steps(), values() of the whole job, and rows(step): (values, files) of each task."""

    def __post_init__(self):
        for item in dataclasses.fields(self):
            _check_type(item.name, item.type, getattr(self, item.name))
        self._check()

    def tasks(self):
        """Return all tasks, each behind those that it needs."""
        tasks, numbers = [], {}
        for step in self.steps():
            needs = tuple(number for name in step.needs for number in numbers[name])
            numbers[step.name] = []
            for values, files in self.rows(step):
                numbers[step.name].append(len(tasks) + 1)
                tasks.append(Task(len(tasks) + 1, step, {**self.values(), **values}, tuple(files), needs))
        return tasks

    def missing(self):
        """Return the tasks that have not made their files, and those that need one of them."""
        missing = {}
        for task in self.tasks():
            if not task.is_made or missing.keys() & set(task.needs):
                missing[task.number] = task
        return list(missing.values())

    def resolved(self, folder):
        """Return the job with absolute paths, which are relative to folder before; a program's name stays."""
        programs = {name: getattr(self, name) for name in self.programs}
        names = [*self.paths, *(name for name, value in programs.items() if split(value)[1] != value)]
        return dataclasses.replace(self, **{name: absolute(getattr(self, name), folder) for name in names})

    def save(self, path):
        text = json.dumps({"kind": self.kind, **dataclasses.asdict(self)}, indent=2)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text + "\n")


@dataclass(frozen=True)
class Frames(Job):
    """Frames of a .blend file."""

    file: str = described("the .blend file")
    frames: str = described("frames, as 1-100x2,120")
    pictures: str = described("files of the pictures, as renders/shot_####.png; // is the .blend file's folder")
    chunk: int = described("frames of a task", default=1)
    blender: str = described("command that starts Blender", default="blender")
    extra: tuple = described("arguments of Blender behind the file, such as -F PNG or --scene NAME", default=())

    kind = "frames"
    paths = ("file", "pictures")
    programs = ("blender",)

    def _check(self):
        try:
            read_frames(self.frames)
        except ValueError as error:
            raise JobError("frames", self.frames, str(error)) from None
        _check_numbered("pictures", self.pictures)
        if not os.path.splitext(self.pictures)[1]:
            raise JobError("pictures", self.pictures, "has no extension, such as .png")
        if set("{}") & set(self.pictures):
            raise JobError("pictures", self.pictures, "has braces, which Blender 5 replaces")
        for argument in self.extra:
            if argument in TAKEN:
                raise JobError("extra", argument, "is an argument that the job itself sets")

    @property
    def title(self):
        return title(self.file)

    @property
    def place(self):
        """Folder and name of the pictures."""
        inside = self.pictures.startswith("//")
        return split(split(self.file)[0] + self.pictures[1:] if inside else self.pictures)

    def steps(self):
        """`blender -b FILE -E LANCER -o OUT -x 1 -f N`, and the code that makes it fit for a farm."""
        picture = (PICTURE_FOLDER, "/" + self.place[1])
        command = (BLENDER, "-b", BLEND_FILE, *self.extra, "-E", "LANCER", "-o", picture, "-x", "1", "--python-exit-code", "1")
        code = ("--python-expr", WHOLE_FILES, "-f", FRAMES, "--python-expr", CHECK)
        return (Step("render", command + code, files_are_whole=True),)

    def values(self):
        return {BLENDER: self.blender, BLEND_FILE: self.file, PICTURE_FOLDER: self.place[0], WHOLE_FILES: PREPARE}

    def rows(self, step):
        frames = read_frames(self.frames)
        chunks = [frames[first : first + self.chunk] for first in range(0, len(frames), self.chunk)]
        pattern = "/".join(self.place)
        return [({FRAMES: written(chunk, "..")}, [numbered(pattern, frame) for frame in chunk]) for chunk in chunks]


@dataclass(frozen=True)
class Still(Job):
    """One still, whose samples are rendered in parts that are merged at the end."""

    snapshot: str = described("snapshot of the scene")
    samples: int = described("samples of the picture")
    parts: int = described("parts that the samples are split into")
    part_files: str = described("files of the parts, as parts/part-##.lancer")
    picture: str = described("file of the merged picture")
    python: str = described("command that starts Python", default="python3")
    module: str = described("Python module that renders parts and merges them", default="lancer.farm")

    kind = "still"
    paths = ("snapshot", "part_files", "picture")
    programs = ("python",)

    def _check(self):
        if self.parts > self.samples:
            raise JobError("parts", self.parts, f"is more than the {self.samples} samples")
        _check_numbered("part_files", self.part_files)

    @property
    def title(self):
        return title(self.picture)

    def steps(self):
        module = (PYTHON, "-m", self.module)
        part = ("part", SNAPSHOT, "--samples", str(self.samples), "--part", PART, "--output", (PART_FOLDER, "/", PART_FILE))
        files = ((PART_FOLDER, "/" + name) for name in self._names())
        merge = ("merge", *files, "--output", (PICTURE_FOLDER, "/" + split(self.picture)[1]))
        return (Step("part", module + part), Step("merge", module + merge, needs=("part",)))

    def values(self):
        folders = {PART_FOLDER: split(self.part_files)[0], PICTURE_FOLDER: split(self.picture)[0]}
        return {PYTHON: self.python, SNAPSHOT: self.snapshot, **folders}

    def rows(self, step):
        if step.name == "merge":
            return [({}, ["/".join(split(self.picture))])]
        folder = split(self.part_files)[0]
        named = enumerate(self._names(), 1)
        return [({PART: f"{number}/{self.parts}", PART_FILE: name}, [f"{folder}/{name}"]) for number, name in named]

    def _names(self):
        return [numbered(split(self.part_files)[1], number) for number in range(1, self.parts + 1)]


KINDS = {kind.kind: kind for kind in (Frames, Still)}


def load(path):
    """Return the job of a JSON file; raise JobError or OSError."""
    with open(path, encoding="utf-8") as file:
        try:
            fields = json.load(file)
        except ValueError as error:
            raise JobError("job", os.fspath(path), f"is no JSON: {error}") from None
    if not isinstance(fields, dict):
        raise JobError("job", os.fspath(path), "holds no JSON object")
    return of_fields(fields)


def of_fields(fields):
    """Return the job that a dict of its kind and its fields describes."""
    kind = fields.get("kind")
    if kind not in tuple(KINDS):
        raise JobError("kind", kind, "is neither " + " nor ".join(KINDS))
    known = {item.name: item for item in dataclasses.fields(KINDS[kind])}
    for name, value in fields.items():
        if name not in known and name != "kind":
            raise JobError(name, value, f"belongs to no job of {kind}")
    for name, item in known.items():
        if name not in fields and item.default is dataclasses.MISSING:
            raise JobError(name, None, f"is no value: {item.metadata['about']}")
    given = {name: value for name, value in fields.items() if name != "kind"}
    return KINDS[kind](**{name: tuple(value) if isinstance(value, list) else value for name, value in given.items()})


def _check_type(name, kind, value):
    if kind is int:
        if type(value) is not int or value < 1:
            raise JobError(name, value, "is no whole number from 1 on")
        return
    if not isinstance(value, kind):
        raise JobError(name, value, "is no list of texts" if kind is tuple else "is no text")
    for text in value if kind is tuple else (value,):
        if not isinstance(text, str) or not text:
            raise JobError(name, value, "has no text where one is required")
        if not text.isprintable():
            raise JobError(name, value, "has characters that cannot be printed")


def _check_numbered(name, pattern):
    if not is_numbered(pattern):
        raise JobError(name, pattern, "has not one place for a number, such as ####, in the file's name")
