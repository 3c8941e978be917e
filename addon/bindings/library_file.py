"""The library's file: in addon/lib, or in the package of the wheel that a Blender extension carries.

A packed add-on names the file of its own build, whose name has a hash of its content: a process that has loaded an older
library gets the new one, and neither an older wheel that Blender has left nor that of another installation is mistaken for it.
"""

import contextlib
import os
import sys

# In addon/lib, the name of the library's file; a source checkout has none.
NAME_FILE = "library.txt"
# The folder of the wheel's package below an entry of sys.path.
WHEEL_FOLDER = os.path.join("lancer", "lib")

_FILES = {"win32": ("lancer", ".dll"), "darwin": ("liblancer", ".dylib")}

# Functions with the library's name as argument that return a path, or None, if no folder has that file.
providers = []


def library_path():
    """Return the path of the library of this build; if it is missing, the path in addon/lib at which it would be.

    Without NAME_FILE it is the newest library in addon/lib, as the build writes it.
    """
    folder = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "lib")
    name = _named(folder)
    return _newest(folder) if name is None else _find(folder, name)


def _named(folder):
    with contextlib.suppress(OSError), open(os.path.join(folder, NAME_FILE), encoding="utf-8") as file:
        # Only a name: the file cannot point to other folders.
        return os.path.basename(file.read().strip()) or None
    return None


def _find(folder, name):
    # Relative entries depend on the current folder, from which no code should come.
    below = (os.path.join(entry, WHEEL_FOLDER) for entry in map(str, sys.path) if os.path.isabs(entry))
    for place in (folder, *below):
        if os.path.isfile(os.path.join(place, name)):
            return os.path.join(place, name)
    found = (path for path in (provide(name) for provide in providers) if path is not None)
    return next(found, os.path.join(folder, name))


def _newest(folder):
    stem, ending = _FILES.get(sys.platform, ("liblancer", ".so"))
    found = []
    with contextlib.suppress(OSError):
        found = [entry for entry in os.scandir(folder) if entry.name.startswith(stem) and entry.name.endswith(ending)]
    return max(found, key=lambda entry: entry.stat().st_mtime).path if found else os.path.join(folder, stem + ending)
