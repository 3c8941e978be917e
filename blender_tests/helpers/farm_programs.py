"""Stand-ins for Blender and for Python with Lancer, which make the files of a task at once, note their arguments, or fail."""

import json
import os
import sys

from addon.farm.job import Frames, Still

_PROGRAM = """\
#!{python} -SE
import json, os, re, sys
arguments = sys.argv[1:]
with open({notes!r}, "a") as file:
    file.write(json.dumps(arguments) + "\\n")
def behind(name):
    return arguments[arguments.index(name) + 1]
if "merge" in arguments:
    what, files = "merge", [behind("--output")]
    parts = arguments[arguments.index("merge") + 1:arguments.index("--output")]
    text = "".join(open(part).read() for part in parts)
elif "part" in arguments:
    what = text = behind("--part")
    files = [behind("--output")]
else:
    what = text = behind("-f")
    runs = [piece.split("..") for piece in what.split(",")]
    frames = [frame for run in runs for frame in range(int(run[0]), int(run[-1]) + 1)]
    files = [re.sub("#+", lambda place: str(frame).zfill(len(place[0])), behind("-o")) for frame in frames]
if what in open({fails!r}).read().split():
    sys.exit(1)
for file in files:
    os.makedirs(os.path.dirname(file), exist_ok=True)
    open(file, "w").write(text + "\\n")
"""


class Programs:
    """Both programs in a folder whose name tests the quotes of every form."""

    def __init__(self, folder):
        self.folder = folder / "it's a folder"
        self.folder.mkdir()
        self._notes, self._fails = (str(folder / name) for name in ("notes.txt", "fails.txt"))
        self.program = self.folder / "program"
        self.program.write_text(_PROGRAM.format(python=sys.executable, notes=self._notes, fails=self._fails))
        self.program.chmod(0o755)
        self.fail()

    def fail(self, *tasks):
        """Let tasks fail, which are named by their frames or their part."""
        with open(self._fails, "w") as file:
            file.write("\n".join(tasks))

    def starts(self):
        """Return the arguments of all starts since the last call, sorted: tasks may run side by side."""
        if not os.path.exists(self._notes):
            return []
        with open(self._notes) as file:
            found = sorted(json.loads(line) for line in file)
        os.remove(self._notes)
        return found

    def frames(self, **changes):
        fields = {
            "file": str(self.folder / "a shot.blend"),
            "frames": "1-7x2,8,20",
            "pictures": str(self.folder / "pictures" / "f_####.png"),
            "chunk": 2,
            "blender": str(self.program),
        }
        return Frames(**{**fields, **changes})

    def still(self, **changes):
        fields = {
            "snapshot": str(self.folder / "scene.npz"),
            "samples": 64,
            "parts": 3,
            "part_files": str(self.folder / "parts" / "p-##.npz"),
            "picture": str(self.folder / "picture.exr"),
            "python": str(self.program),
        }
        return Still(**{**fields, **changes})


def commands(tasks):
    """Return the arguments behind the program of these tasks, as Programs.starts() does."""
    return sorted(task.arguments[1:] for task in tasks)
