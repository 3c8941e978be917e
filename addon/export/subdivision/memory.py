"""The memory that is left on this machine, and the triangles that fit into it."""

import ctypes
import os

# The bytes of a triangle while it is made, copied into the library and sorted there: 50 in each of two copies, 100 of the
# points from which it is made, and 100 of the accelerator.
BYTES_OF_TRIANGLE = 300
_IF_UNKNOWN = 4 << 30


def most_triangles():
    return memory_left() // BYTES_OF_TRIANGLE


def memory_left():
    """Return the bytes that can be used without swapping; where the system does not tell them, all memory of the machine."""
    try:
        with open("/proc/meminfo", encoding="ascii") as file:
            return next(1024 * int(line.split()[1]) for line in file if line.startswith("MemAvailable"))
    except (OSError, StopIteration):
        pass
    if hasattr(ctypes, "windll"):
        # The record MEMORYSTATUSEX: its size and the load, then seven sizes, of which the second is the memory left.
        record = (ctypes.c_uint64 * 8)(64)
        return record[2] if ctypes.windll.kernel32.GlobalMemoryStatusEx(record) else _IF_UNKNOWN
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return _IF_UNKNOWN
