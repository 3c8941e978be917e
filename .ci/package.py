"""The two zips that Blender installs, made of addon/ as it stands: an extension (4.2 and newer) and a classic add-on (3.x).

The same files give the same bytes: entries are sorted and carry no date of their own.
"""

import ast
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ADDON = ROOT / "addon"
BUILD = ROOT / "build"
OLDEST_DATE = (1980, 1, 1, 0, 0, 0)


def read_version():
    """The release, which four files must name alike."""
    versions = {
        "addon/blender_manifest.toml": tomllib.loads((ADDON / "blender_manifest.toml").read_text())["version"],
        "pyproject.toml": tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"],
        "core/CMakeLists.txt": re.search(r"project\(lancer VERSION ([\d.]+)", (ROOT / "core/CMakeLists.txt").read_text())[1],
        "addon/__init__.py": ".".join(str(part) for part in read_bl_info()["version"]),
    }
    if len(set(versions.values())) != 1:
        sys.exit("The release differs from file to file: " + ", ".join(f"{name} says {v}" for name, v in versions.items()))
    return versions["pyproject.toml"]


def read_bl_info():
    for node in ast.parse((ADDON / "__init__.py").read_text()).body:
        if isinstance(node, ast.Assign) and any(getattr(target, "id", None) == "bl_info" for target in node.targets):
            return ast.literal_eval(node.value)
    sys.exit("addon/__init__.py has no bl_info, which Blender 3.x needs to install a zip.")


def list_files():
    """Path inside the add-on -> file."""
    files = {
        path.relative_to(ADDON).as_posix(): path
        for path in ADDON.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and not path.name.startswith(".")
    }
    if "lib/liblancer.so" not in files:
        sys.exit("addon/lib/liblancer.so is missing: run `make` first.")
    return {**files, "LICENSE": ROOT / "LICENSE"}


def write_zip(path, files):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, file in sorted(files.items()):
            entry = zipfile.ZipInfo(name, OLDEST_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            archive.writestr(entry, file.read_bytes())
    print(f"{path.relative_to(ROOT)}  {path.stat().st_size / 1e6:.1f} MB")


def validate(path):
    """Ask Blender's own packager, which comes with the bpy module."""
    tools = sorted(Path(sys.prefix).glob("lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    if not tools:
        sys.exit("Blender's packager is not in the bpy module: the zip could not be validated.")
    result = subprocess.run([sys.executable, tools[0], "validate", path], capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"Blender refuses {path.name}:\n{result.stdout}{result.stderr}")


def main():
    version = read_version()
    files = list_files()
    BUILD.mkdir(exist_ok=True)
    extension = BUILD / f"lancer-{version}.zip"
    write_zip(extension, files)
    validate(extension)
    classic = {f"lancer/{name}": file for name, file in files.items() if name != "blender_manifest.toml"}
    write_zip(BUILD / f"lancer-{version}-blender3.zip", classic)


if __name__ == "__main__":
    main()
