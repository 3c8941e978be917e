"""Builds a wheel: the package `lancer` with the rooms that need no Blender, and one platform's library.

    python_wheel.py    for this machine, with the library in addon/lib, into build/

package.py builds those of all platforms. The same files give the same bytes: entries are sorted and have one date."""

import os
import sys
import tempfile
import tomllib
from pathlib import Path

import contents
from wheel.wheelfile import WheelFile

# In dependence order; the package has no other code but INIT.
ROOMS = ("bindings", "messages", "measure", "farm")
EXTRAS = ("farm", "pictures")
NAME_FILE = "lib/library.txt"
# The oldest date that a zip can hold: wheel writes it into each entry.
OLDEST_DATE = "315532800"
INIT = '''"""Lancer without Blender: renders snapshots and bug reports of the render engine.

    rendered = lancer.render("report.zip", samples=64)
    rendered.picture, rendered.passes["Depth"], rendered.statistics["error"]
    rendered.save("picture.exr")

A Session gives control of single ranges of samples. INSTALL.md of the farm has more."""

from .bindings.abi import LancerError, Pass
from .bindings.npz import SnapshotError
from .bindings.session import Session
from .bindings.snapshot import SceneSnapshot
from .farm.render_snapshot import Rendered, load, render

VERSION = "{version}"

__all__ = ["VERSION", "LancerError", "Pass", "Rendered", "SceneSnapshot", "Session", "SnapshotError", "load", "render"]
'''


def project():
    return tomllib.loads((contents.ROOT / "pyproject.toml").read_text())["project"]


def metadata(version, licenses):
    """Returns the METADATA file."""
    told = project()
    lines = [
        ("Metadata-Version", "2.4"),
        ("Name", told["name"]),
        ("Version", version),
        ("Summary", told["description"]),
        ("License-Expression", told["license"]["text"]),
        *(("License-File", name) for name in licenses),
        ("Requires-Python", told["requires-python"]),
        *(("Requires-Dist", line) for line in told["dependencies"]),
    ]
    for extra in EXTRAS:
        lines.append(("Provides-Extra", extra))
        lines += [("Requires-Dist", f'{line}; extra == "{extra}"') for line in told["optional-dependencies"][extra]]
    return "".join(f"{name}: {value}\n" for name, value in lines).encode()


def files_of(version, library, notices):
    """Returns (path inside the wheel -> bytes of the package, file name -> bytes of its licences).

    library: its marked name and bytes. notices: file name -> bytes."""
    name, data = library
    files = contents.addon_files(ROOMS)
    files |= {"__init__.py": INIT.format(version=version).encode(), f"lib/{name}": data, NAME_FILE: f"{name}\n".encode()}
    licenses = {"LICENSE": (contents.ROOT / "LICENSE").read_bytes()} | notices
    return {f"lancer/{path}": content for path, content in files.items()}, licenses


def write(folder, version, tag, files, licenses):
    """Writes the wheel and returns its path. tag: the platform's name in a wheel's file name."""
    os.environ["SOURCE_DATE_EPOCH"] = OLDEST_DATE
    info = f"lancer-{version}.dist-info"
    described = {
        "METADATA": metadata(version, licenses),
        "WHEEL": f"Wheel-Version: 1.0\nGenerator: lancer\nRoot-Is-Purelib: false\nTag: py3-none-{tag}\n".encode(),
        "entry_points.txt": b"[console_scripts]\nlancer = lancer.farm.__main__:main\n",
    } | {f"licenses/{name}": content for name, content in licenses.items()}
    path = Path(folder) / f"lancer-{version}-py3-none-{tag}.whl"
    with WheelFile(path, "w") as archive:
        for name, content in [*sorted(files.items()), *sorted((f"{info}/{key}", value) for key, value in described.items())]:
            archive.writestr(name, content)
    return path


def bytes_of(version, tag, library, notices):
    """Returns (file name, bytes) of the wheel."""
    with tempfile.TemporaryDirectory() as folder:
        path = write(folder, version, tag, *files_of(version, library, notices))
        return path.name, path.read_bytes()


def main():
    version, platform = contents.read_version(), contents.this_platform()
    library = contents.library_of(contents.ADDON / "lib", platform)
    for old in contents.BUILD.glob("lancer-*.whl"):
        old.unlink()
    name, data = bytes_of(version, contents.this_wheel_tag(), library, contents.notices(platform, None))
    path = contents.BUILD / name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(data)
    contents.told(path)


if __name__ == "__main__":
    sys.exit(main())
