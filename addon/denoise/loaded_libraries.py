"""Paths of the shared libraries in the running process, in the order in which the system lists them."""

import ctypes
import os
import sys

_LONGEST_PATH = 32768


def files():
    if sys.platform == "win32":
        found = _on_windows()
    elif sys.platform == "darwin":
        found = _on_macos()
    else:
        found = on_linux()
    return list(dict.fromkeys(found))


def on_linux(maps="/proc/self/maps"):
    try:
        with open(maps, encoding="utf-8", errors="surrogateescape") as file:
            fields = [line.rstrip("\n").split(None, 5) for line in file]
    except OSError:
        return []
    return [row[5] for row in fields if len(row) == 6 and row[5].startswith("/")]


def _on_windows():
    kernel = ctypes.WinDLL("kernel32", use_last_error=True)
    handle, size = ctypes.c_void_p, ctypes.c_uint32
    kernel.GetCurrentProcess.restype = handle
    kernel.K32EnumProcessModules.argtypes = (handle, ctypes.POINTER(handle), size, ctypes.POINTER(size))
    kernel.GetModuleFileNameW.argtypes = (handle, ctypes.c_wchar_p, size)
    process, needed, room = kernel.GetCurrentProcess(), size(), 1024
    while True:
        modules = (handle * room)()
        if not kernel.K32EnumProcessModules(process, modules, ctypes.sizeof(modules), ctypes.byref(needed)):
            return []
        count = needed.value // ctypes.sizeof(handle)
        if count <= room:
            break
        room = count + 64
    path = ctypes.create_unicode_buffer(_LONGEST_PATH)
    return [path.value for module in modules[:count] if kernel.GetModuleFileNameW(module, path, _LONGEST_PATH)]


def _on_macos():
    system = ctypes.CDLL(None)
    system._dyld_get_image_name.restype = ctypes.c_char_p
    system._dyld_get_image_name.argtypes = (ctypes.c_uint32,)
    names = [system._dyld_get_image_name(number) for number in range(system._dyld_image_count())]
    return [os.fsdecode(name) for name in names if name]
