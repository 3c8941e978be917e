"""The memory of this machine."""

import ctypes
import os
import sys


class _MemoryStatus(ctypes.Structure):
    """MEMORYSTATUSEX of Windows."""

    _fields_ = [
        ("length", ctypes.c_uint32),
        ("load", ctypes.c_uint32),
        ("total", ctypes.c_uint64),
        ("left", ctypes.c_uint64),
        ("others", ctypes.c_uint64 * 5),
    ]


def machine_memory():
    """Return the bytes of physical memory."""
    if sys.platform != "win32":
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return _status().total


def memory_left():
    """Return the bytes that can be used without swapping; where the system does not tell them, all memory of the machine."""
    if sys.platform == "win32":
        return _status().left
    try:
        with open("/proc/meminfo", encoding="ascii") as file:
            return next(1024 * int(line.split()[1]) for line in file if line.startswith("MemAvailable"))
    except (OSError, StopIteration):
        return machine_memory()


def _status():
    status = _MemoryStatus(length=ctypes.sizeof(_MemoryStatus))
    ctypes.windll.kernel32.GlobalMemoryStatusEx(ctypes.byref(status))
    return status
