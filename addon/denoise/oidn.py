"""Blender's Open Image Denoise, found in the running process, with typed functions of versions 1 and 2.

Use the library that Blender has mapped, or the one beside Blender's TBB, so that no second TBB is loaded.
"""

import contextlib
import ctypes
import functools
import os
import re
import sys
from ctypes import c_bool, c_char_p, c_double, c_int, c_size_t, c_void_p

from ..bindings import elf
from ..bindings.abi import LancerError
from . import loaded_libraries

MISSING = "Open Image Denoise is missing: this Blender contains no library libOpenImageDenoise"
CPU = 1
FLOAT3 = 3
CANCELLED = 6

Monitor = ctypes.CFUNCTYPE(c_bool, c_void_p, c_double)

# File names on Linux, Windows and macOS.
_LIBRARY = re.compile(r"libOpenImageDenoise\.so(\.\d+)*|OpenImageDenoise\.dll|libOpenImageDenoise(\.\d+)*\.dylib")
_TBB = re.compile(r"libtbb\.so(\.\d+)*|tbb\d*\.dll|libtbb(\.\d+)*\.dylib")

_COMMON = {
    "oidnNewDevice": (c_void_p, (c_int,)),
    "oidnCommitDevice": (None, (c_void_p,)),
    "oidnReleaseDevice": (None, (c_void_p,)),
    "oidnGetDeviceError": (c_int, (c_void_p, ctypes.POINTER(c_char_p))),
    "oidnNewFilter": (c_void_p, (c_void_p, c_char_p)),
    "oidnSetSharedFilterImage": (None, (c_void_p, c_char_p, c_void_p, c_int, *(c_size_t,) * 5)),
    "oidnSetFilterProgressMonitorFunction": (None, (c_void_p, Monitor, c_void_p)),
    "oidnCommitFilter": (None, (c_void_p,)),
    "oidnExecuteFilter": (None, (c_void_p,)),
    "oidnReleaseFilter": (None, (c_void_p,)),
}
# Functions with different names from version 2 on, and before.
_RENAMED = {
    ("oidnSetDeviceBool", "oidnSetDevice1b"): (None, (c_void_p, c_char_p, c_bool)),
    ("oidnSetDeviceInt", "oidnSetDevice1i"): (None, (c_void_p, c_char_p, c_int)),
    ("oidnGetDeviceInt", "oidnGetDevice1i"): (c_int, (c_void_p, c_char_p)),
    ("oidnSetFilterBool", "oidnSetFilter1b"): (None, (c_void_p, c_char_p, c_bool)),
    ("oidnSetFilterInt", "oidnSetFilter1i"): (None, (c_void_p, c_char_p, c_int)),
}


def find(files=None):
    """Return the path of Blender's library, or None. files: paths of loaded libraries, by default the process's."""
    files = loaded_libraries.files() if files is None else files
    for path in files:
        if _LIBRARY.fullmatch(os.path.basename(path)) and os.path.isfile(path):
            return path
    for path in files:
        if _TBB.fullmatch(os.path.basename(path)):
            folder = os.path.dirname(path)
            with contextlib.suppress(OSError):
                # The highest major version; then the shortest name, which refers to the same file as the others.
                beside = [name for name in os.listdir(folder) if _LIBRARY.fullmatch(name)]
                for name in sorted(beside, key=lambda name: (-_major(name), len(name))):
                    return os.path.join(folder, name)
    return None


def load(path=None):
    """Return the library with typed functions; raise LancerError if it is missing. path: a file instead of Blender's own."""
    if path is not None:
        return _load(os.path.abspath(os.fspath(path)))
    found = find()
    # Some builds of Blender link the library statically.
    if found is None and not _has_symbols(None):
        raise LancerError(MISSING)
    return _load(found)


def fault(library, device):
    """Return (code, text) of the error since the last call; code 0 is no error."""
    text = c_char_p()
    code = library.oidnGetDeviceError(device, ctypes.byref(text))
    return code, (text.value or b"an error without a name").decode("utf-8", "replace")


def _major(name):
    numbers = re.findall(r"\d+", name)
    return int(numbers[0]) if numbers else 0


def _has_symbols(path):
    try:
        return hasattr(ctypes.CDLL(path), "oidnNewDevice")
    except (OSError, TypeError):
        return False


@functools.cache
def _load(path):
    """Load the library; path None is the program itself."""
    where = path or "in the program"
    try:
        what = elf.fault(path) if path and sys.platform.startswith("linux") else None
        if what:
            raise LancerError(f"Open Image Denoise {what} ({where})")
        library = ctypes.CDLL(path)
    except OSError as error:
        raise LancerError(f"Open Image Denoise cannot be loaded ({error})") from None
    names = {name: (name,) for name in _COMMON} | {names[0]: names for names in _RENAMED}
    kinds = _COMMON | {names[0]: kind for names, kind in _RENAMED.items()}
    for name, spellings in names.items():
        function = next((getattr(library, spelling) for spelling in spellings if hasattr(library, spelling)), None)
        if function is None:
            raise LancerError(f"Open Image Denoise has no function {name} ({where})")
        function.restype, function.argtypes = kinds[name]
        setattr(library, name, function)
    return library
