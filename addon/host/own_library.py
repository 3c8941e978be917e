"""The library from the wheel that this extension carries, where Blender's own copy of the wheel is missing.

Blender unpacks each wheel once for all extensions of a user and compares names and versions only. Its copy is missing after
Update All of other extensions (4.2 to 5.0), after an update whose old library was in use (Windows), and for another build of
the same version.
"""

import contextlib
import os
import tempfile
import zipfile

import bpy

from ..bindings import library_file

_ADDON = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def unpacked(name):
    """Return the path of the library's file in the extension's folder for users, unpacked if necessary; None if impossible."""
    inner = f"{library_file.WHEEL_FOLDER}/{name}".replace(os.sep, "/")
    with contextlib.suppress(OSError, ValueError, zipfile.BadZipFile):
        wheels = [entry.path for entry in os.scandir(os.path.join(_ADDON, "wheels")) if entry.name.endswith(".whl")]
        # Raises ValueError if this is no extension.
        folder = bpy.utils.extension_path_user(__package__.rpartition(".")[0], path="lib", create=True)
        if not folder:
            return None
        path = os.path.join(folder, name)
        if os.path.isfile(path):
            return path
        for wheel in wheels:
            with zipfile.ZipFile(wheel) as archive:
                if inner in archive.namelist():
                    _write(folder, name, archive.read(inner))
                    return path
    return None


def _write(folder, name, data):
    """Write the file under a temporary name, as other Blenders may do the same now, and remove those of other builds."""
    with tempfile.NamedTemporaryFile(dir=folder, suffix=".part", delete=False) as file:
        file.write(data)
    os.replace(file.name, os.path.join(folder, name))
    for entry in os.scandir(folder):
        if entry.name != name and not entry.name.endswith(".part"):
            # Windows keeps a file that is in use.
            with contextlib.suppress(OSError):
                os.remove(entry.path)


def register():
    library_file.providers.append(unpacked)


def unregister():
    library_file.providers.remove(unpacked)
