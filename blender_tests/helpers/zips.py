"""Zips that Blender installs: those under test, and older copies of them to update from."""

import ast
import glob
import hashlib
import io
import os
import re
import subprocess
import sys
import zipfile

import blenders
from blenders import MODULE, ROOT

sys.path.append(os.path.join(ROOT, ".ci"))

import contents  # noqa: E402, F401 - for tests of what is packed
import package  # noqa: E402
import python_wheel  # noqa: E402

OLDER = (0, 0, 9)


def release():
    with open(os.path.join(ROOT, "addon", "__init__.py"), encoding="utf-8") as file:
        tree = ast.parse(file.read())
    return next(ast.literal_eval(node.value) for node in tree.body if isinstance(node, ast.Assign))["version"]


def dotted(version):
    return ".".join(map(str, version))


def has_extensions(which):
    """Whether this Blender is version 4.2 or newer."""
    if which == MODULE:
        return True
    said = subprocess.run([blenders.program(), "--version"], capture_output=True, text=True, check=True).stdout
    return tuple(map(int, re.search(r"Blender (\d+)\.(\d+)", said).groups())) >= (4, 2)


def newest_zip(which):
    """Return the newest zip for this machine and this Blender: of LANCER_TEST_ZIPS, or of `make addon`."""
    folder = os.environ.get("LANCER_TEST_ZIPS")
    if not folder:
        folder = os.path.join(ROOT, "build")
        blenders.zip_for_blender_3()
    found = glob.glob(os.path.join(folder, "lancer-*-linux-x64.zip"))
    if not has_extensions(which):
        found = [path for place in (folder, os.path.join(folder, package.CLASSIC)) for path in _classic(place)]
    return max(found, key=os.path.getmtime)


def _classic(folder):
    return glob.glob(os.path.join(folder, "lancer-*-linux-x64-blender3.zip"))


def older(path, folder):
    """Return a copy of the zip with an older version in add-on, wheel and library."""
    made = os.path.join(folder, os.path.basename(path).replace(dotted(release()), dotted(OLDER)))
    with zipfile.ZipFile(made, "w") as copy:
        for name, data in _older_files(_files(path), folder).items():
            copy.writestr(name, data)
    return made


def _files(archive):
    with zipfile.ZipFile(archive) as whole:
        return {name: whole.read(name) for name in whole.namelist()}


def _older_files(files, folder):
    """Return the files of a zip or wheel in an older version; the library gets the name that its content demands."""
    new, old = release(), OLDER
    made, name_file = {}, None
    for name, data in files.items():
        if name.endswith("blender_manifest.toml"):
            data = data.replace(dotted(new).encode(), dotted(old).encode())
        elif name in ("__init__.py", "lancer/__init__.py"):
            # Change the size: Python reuses the compiled file if size and time are equal.
            for form in (repr, dotted):
                data = data.replace(form(new).encode(), form(old).encode())
            data += b"\n"
        elif name.endswith(".whl"):
            name, data, name_file = _older_wheel(name, data, folder)
        elif "/liblancer-" in name:
            data = data.replace(dotted(new).encode() + b"\0", dotted(old).encode() + b"\0")
            library = f"liblancer-{hashlib.sha256(data).hexdigest()[:12]}.so"
            name, name_file = f"{os.path.dirname(name)}/{library}", f"{library}\n".encode()
        made[name] = data
    for name in made:
        if name.endswith(python_wheel.NAME_FILE):
            made[name] = name_file
    return made


def _older_wheel(name, data, folder):
    """Return its path in the add-on, its bytes, and the content of the file with the library's name."""
    inside = _files(io.BytesIO(data))
    files = _older_files({path: content for path, content in inside.items() if path.startswith("lancer/")}, folder)
    licenses = {path.rpartition("/")[2]: content for path, content in inside.items() if "/licenses/" in path}
    tag = name.removesuffix(".whl").rpartition("-")[2]
    made = python_wheel.write(folder, dotted(OLDER), tag, files, licenses)
    return f"wheels/{made.name}", made.read_bytes(), files[f"lancer/{python_wheel.NAME_FILE}"]
