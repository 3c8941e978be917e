"""Builds the zips that Blender installs from addon/, each for one platform, and the repository of the extensions.

An extension (4.2 and newer) carries the library in a wheel, as Blender's own platform demands; in a classic add-on (3.x) it is
a file.

    package.py                      for this machine, with the library in addon/lib, into build/
    package.py FOLDER PLATFORM...   with the libraries in FOLDER/PLATFORM/lib, into build/addons/; LANCER_ZIG: their compiler

build/addons is an extension repository: Blender installs from it and updates, from a web server or a shared folder. The same
files give the same bytes: entries are sorted and have no date."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import contents
import python_wheel

OLDEST_DATE = (1980, 1, 1, 0, 0, 0)
# Folders of the repository with what is no extension.
CLASSIC, WHEELS = "blender3", "wheels"


def manifest(version, tag, wheel):
    lines = (contents.ADDON / "blender_manifest.toml").read_text().splitlines()
    lines = [line for line in lines if not line.startswith("#")]
    place = lines.index('id = "lancer"') + 1
    made = [f'version = "{version}"', f'platforms = ["{tag}"]', f'wheels = ["./wheels/{wheel}"]']
    return "\n".join([*lines[:place], *made, *lines[place:], ""]).encode()


def common_files(library, notices):
    """Returns path inside the add-on -> its bytes, of what both kinds of zips have."""
    files = contents.addon_files() | {python_wheel.NAME_FILE: f"{library[0]}\n".encode()}
    files["LICENSE"] = (contents.ROOT / "LICENSE").read_bytes()
    return files | {f"licenses/{name}": data for name, data in notices.items()}


def write_zip(path, files):
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, OLDEST_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith((".so", ".dylib", ".dll")) else 0o644) << 16
            archive.writestr(entry, data)
    contents.told(path)


def packager(*arguments):
    """Runs Blender's own packager, which comes with the bpy module; ends the program if it refuses."""
    tools = sorted(Path(sys.prefix).glob("lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    if not tools:
        sys.exit("Blender's packager is not in the bpy module: zips cannot be validated.")
    result = subprocess.run([sys.executable, tools[0], *arguments], capture_output=True, text=True)
    if result.returncode or "WARNING" in result.stdout or "ERROR" in result.stdout:
        sys.exit(f"Blender's packager refuses {' '.join(map(str, arguments))}:\n{result.stdout}{result.stderr}")


def index(folder):
    """Makes the folder a repository of the extensions in it: index.json for Blender, index.html for browsers."""
    packager("server-generate", "--repo-dir", folder, "--html")
    contents.told(folder / "index.json")


def package(folder, version, tag, library, notices, wheel, classic):
    """Writes the two zips. wheel: its file name and bytes. classic: the folder of the classic zip."""
    for old in (*folder.glob(f"lancer-*-{tag}.zip"), *classic.glob(f"lancer-*-{tag}-blender3.zip")):
        old.unlink()
    files = common_files(library, notices)
    del files["blender_manifest.toml"]
    extension = folder / f"lancer-{version}-{tag}.zip"
    carried = {"blender_manifest.toml": manifest(version, tag, wheel[0]), f"wheels/{wheel[0]}": wheel[1]}
    write_zip(extension, files | carried)
    packager("validate", extension)
    files[f"lib/{library[0]}"] = library[1]
    write_zip(classic / f"lancer-{version}-{tag}-blender3.zip", {f"lancer/{name}": data for name, data in files.items()})


def package_this(version):
    tag = contents.this_platform()
    library, notices = contents.library_of(contents.ADDON / "lib", tag), contents.notices(tag, None)
    wheel = python_wheel.bytes_of(version, contents.this_wheel_tag(), library, notices)
    package(contents.BUILD, version, tag, library, notices, wheel, contents.BUILD)


def package_all(version, built, tags):
    folder = contents.BUILD / "addons"
    for tag in tags:
        library, notices = contents.library_of(Path(built) / tag / "lib", tag), contents.notices(tag, os.environ["LANCER_ZIG"])
        wheel = python_wheel.bytes_of(version, contents.wheel_tag(tag), library, notices)
        package(folder, version, tag, library, notices, wheel, folder / CLASSIC)
        (folder / WHEELS).mkdir(exist_ok=True)
        for old in (folder / WHEELS).glob(f"lancer-*-{contents.wheel_tag(tag)}.whl"):
            old.unlink()
        (folder / WHEELS / wheel[0]).write_bytes(wheel[1])
        contents.told(folder / WHEELS / wheel[0])
    index(folder)


def main(arguments):
    version = contents.read_version()
    if arguments:
        package_all(version, arguments[0], arguments[1:])
    else:
        package_this(version)


if __name__ == "__main__":
    main(sys.argv[1:])
