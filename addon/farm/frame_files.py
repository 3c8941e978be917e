"""Numbers of frames as text, and the files that numbers are in."""

import os
import re
from pathlib import PureWindowsPath

# The last frame that Blender has. It counts negative numbers of -f from the end.
LAST = 1048574
_RANGE = re.compile(r"([0-9]+)(?:-([0-9]+)(?:x([0-9]+))?)?")


def read_frames(text):
    """Return the sorted numbers of "1-100x2,120"; raise ValueError with the reason."""
    frames = set()
    for piece in text.split(","):
        found = _RANGE.fullmatch(piece.strip())
        if not found:
            raise ValueError(f"has {piece!r}, which is neither 7 nor 1-9 nor 1-9x2")
        first, last, step = int(found[1]), int(found[2] or found[1]), int(found[3] or 1)
        if not first <= last <= LAST or step < 1:
            raise ValueError(f"has {piece!r}: frames must rise from 0 to {LAST} at most, by steps from 1 on")
        frames.update(range(first, last + 1, step))
    return sorted(frames)


def written(numbers, dash):
    """Return sorted numbers as "1-4,7,8", with another dash such as Blender's ".."."""
    runs = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    # Two neighbours are no range, as in Flamenco, whose chunks must be the same.
    return ",".join(f"{a}{dash}{b}" if b > a + 1 else ",".join(map(str, range(a, b + 1))) for a, b in runs)


def is_numbered(pattern):
    """Whether the pattern's name has one place for a number, as shot_####.png."""
    folder, name = split(pattern)
    return len(re.findall("#+", name)) == 1 and "#" not in folder


def numbered(pattern, number):
    return re.sub("#+", lambda place: str(number).zfill(len(place[0])), pattern)


def split(path):
    """Return folder and name of a path of any system, so that folder/name is the path."""
    place = max(path.rfind("/"), path.rfind("\\"))
    # A path must not begin with two slashes, which Blender takes for the .blend file's folder.
    return ("." if place < 0 else path[:place] or "/.", path[place + 1 :])


def absolute(path, folder):
    """Return a path below folder, unless it is absolute on any system or relative to a .blend file."""
    return path if PureWindowsPath(path).is_absolute() or path.startswith("//") else os.path.abspath(os.path.join(folder, path))


def title(path):
    """Return the name of a path without its extension, fit for the name of a job everywhere."""
    return re.sub(r"[^\w.-]+", "_", os.path.splitext(split(path)[1])[0], flags=re.ASCII)[:60] or "job"
