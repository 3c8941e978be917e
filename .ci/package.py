"""Builds the zips that Blender installs from addon/, each with one platform's library only.

For each platform there is an extension (4.2 and newer) and a classic add-on (3.x).

    package.py                      for this machine, with the library in addon/lib, into build/
    package.py FOLDER PLATFORM...   with the libraries in FOLDER/PLATFORM/lib, into build/addons/; LANCER_ZIG: their compiler

The same files give the same bytes: entries are sorted and have no date."""

import ast
import hashlib
import os
import platform
import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ADDON = ROOT / "addon"
BUILD = ROOT / "build"
OLDEST_DATE = (1980, 1, 1, 0, 0, 0)
LIBRARIES = {"linux": "liblancer.so", "windows": "lancer.dll", "macos": "liblancer.dylib"}
GLM_NOTICE = Path("/usr/share/doc/libglm-dev/copyright")
# Licence notices of the C++ and C libraries that zig links into the library, by their path in zig's package.
ZIG_NOTICES = {
    "libc++": "libcxx/LICENSE.TXT",
    "libc++abi": "libcxxabi/LICENSE.TXT",
    "libunwind": "libunwind/LICENSE.TXT",
    "compiler-rt": "../LICENSE",
}
SYSTEM_NOTICES = {"linux": {"glibc": "libc/glibc/LICENSES"}, "windows": {"mingw-w64": "libc/mingw/COPYING"}, "macos": {}}


def read_version():
    """Returns the release from bl_info, without importing the add-on, as Blender 3.x reads it."""
    for node in ast.parse((ADDON / "__init__.py").read_text()).body:
        if isinstance(node, ast.Assign) and any(getattr(target, "id", None) == "bl_info" for target in node.targets):
            return ".".join(map(str, ast.literal_eval(node.value)["version"]))
    sys.exit("addon/__init__.py has no bl_info, which Blender 3.x needs to install a zip.")


def this_platform():
    machine = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64"}.get(platform.machine().lower(), platform.machine())
    return f"linux-{machine}"


def manifest(version, tag):
    lines = [line for line in (ADDON / "blender_manifest.toml").read_text().splitlines() if not line.startswith("#")]
    place = lines.index('id = "lancer"') + 1
    return "\n".join([*lines[:place], f'version = "{version}"', f'platforms = ["{tag}"]', *lines[place:], ""]).encode()


def marked(library):
    """Returns the library's name with a hash of its content, so that an update of the add-on loads the new library."""
    return f"{library.stem}-{hashlib.sha256(library.read_bytes()).hexdigest()[:12]}{library.suffix}"


def notices(tag, zig):
    """Returns name in the zip -> file: the notices that the licences of the linked parts require."""
    found = {"GLM": GLM_NOTICE}
    if zig:
        sources = Path(zig).resolve().parent / "lib"
        system = SYSTEM_NOTICES[tag.split("-")[0]]
        found |= {name: sources / place for name, place in (ZIG_NOTICES | system).items()}
        missing = [str(path) for path in found.values() if not path.is_file()]
        if missing:
            sys.exit("Licence notices are missing: " + ", ".join(missing))
    return {f"licenses/{name}.txt": path for name, path in found.items() if path.is_file()}


def list_files(version, tag, library, zig):
    """Returns path inside the add-on -> its bytes."""
    if not library.is_file():
        sys.exit(f"{library} is missing: build it first.")
    files = {
        path.relative_to(ADDON).as_posix(): path.read_bytes()
        for path in ADDON.rglob("*")
        if path.is_file() and path.parent.name not in ("__pycache__", "lib") and path.suffix != ".md" and path.name[0] != "."
    }
    files["blender_manifest.toml"] = manifest(version, tag)
    files[f"lib/{marked(library)}"] = library.read_bytes()
    files["LICENSE"] = (ROOT / "LICENSE").read_bytes()
    return files | {name: path.read_bytes() for name, path in notices(tag, zig).items()}


def write_zip(path, files):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, OLDEST_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith((".so", ".dylib", ".dll")) else 0o644) << 16
            archive.writestr(entry, data)
    print(f"{path.relative_to(ROOT)}  {path.stat().st_size / 1e6:.1f} MB", flush=True)


def validate(path):
    """Validates the zip with Blender's own packager, which comes with the bpy module."""
    tools = sorted(Path(sys.prefix).glob("lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    if not tools:
        sys.exit("Blender's packager is not in the bpy module: the zip could not be validated.")
    result = subprocess.run([sys.executable, tools[0], "validate", path], capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"Blender refuses {path.name}:\n{result.stdout}{result.stderr}")


def package(folder, version, tag, library, zig=None):
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob(f"lancer-*-{tag}*.zip"):
        old.unlink()
    files = list_files(version, tag, library, zig)
    extension = folder / f"lancer-{version}-{tag}.zip"
    write_zip(extension, files)
    validate(extension)
    del files["blender_manifest.toml"]
    write_zip(folder / f"lancer-{version}-{tag}-blender3.zip", {f"lancer/{name}": data for name, data in files.items()})


def main(arguments):
    version = read_version()
    if not arguments:
        package(BUILD, version, this_platform(), ADDON / "lib" / LIBRARIES["linux"])
        return
    built, *tags = arguments
    for tag in tags:
        library = Path(built) / tag / "lib" / LIBRARIES[tag.split("-")[0]]
        package(BUILD / "addons", version, tag, library, os.environ["LANCER_ZIG"])


if __name__ == "__main__":
    main(sys.argv[1:])
