"""What zips and wheels are made of: the release, the library under its marked name, licence notices, files of the add-on."""

import ast
import hashlib
import os
import platform
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ADDON = ROOT / "addon"
BUILD = ROOT / "build"
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


def wheel_tag(tag):
    """Returns a platform's name in a wheel's file name, for the libraries of `make addons`."""
    system, machine = tag.split("-")
    if system == "linux":
        return "manylinux_2_28_" + {"x64": "x86_64", "arm64": "aarch64"}[machine]
    return {"windows-x64": "win_amd64", "macos-arm64": "macosx_11_0_arm64", "macos-x64": "macosx_11_0_x86_64"}[tag]


def this_wheel_tag():
    """Returns that name for the library in addon/lib, which this machine's compiler has built for this C library or newer."""
    major, minor = os.confstr("CS_GNU_LIBC_VERSION").split()[1].split(".")[:2]
    return f"manylinux_{major}_{minor}_{platform.machine()}"


def library_of(folder, tag):
    """Returns (marked name, bytes) of a platform's library. The mark is a hash of its content."""
    library = Path(folder) / LIBRARIES[tag.split("-")[0]]
    if not library.is_file():
        sys.exit(f"{library} is missing: build it first.")
    data = library.read_bytes()
    return f"{library.stem}-{hashlib.sha256(data).hexdigest()[:12]}{library.suffix}", data


def addon_files(rooms=None):
    """Returns path inside the add-on -> its bytes, of all rooms or of those named, without libraries."""
    return {
        path.relative_to(ADDON).as_posix(): path.read_bytes()
        for folder in ([ADDON] if rooms is None else [ADDON / room for room in rooms])
        for path in folder.rglob("*")
        if path.is_file() and path.parent.name not in ("__pycache__", "lib") and path.suffix != ".md" and path.name[0] != "."
    }


def notices(tag, zig):
    """Returns file name -> bytes of the notices that the licences of the linked parts require."""
    found = {"GLM": GLM_NOTICE}
    if zig:
        sources = Path(zig).resolve().parent / "lib"
        system = SYSTEM_NOTICES[tag.split("-")[0]]
        found |= {name: sources / place for name, place in (ZIG_NOTICES | system).items()}
        missing = [str(path) for path in found.values() if not path.is_file()]
        if missing:
            sys.exit("Licence notices are missing: " + ", ".join(missing))
    return {f"{name}.txt": path.read_bytes() for name, path in found.items() if path.is_file()}


def told(path):
    """Prints a finished file with its size."""
    print(f"{path.relative_to(ROOT) if path.is_relative_to(ROOT) else path}  {path.stat().st_size / 1e6:.1f} MB", flush=True)
