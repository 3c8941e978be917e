"""Memory of this process: resident, and allocated by its allocator."""

import ctypes
import os

# jemalloc's number for all arenas together.
_ALL_ARENAS = 4096


class _Mallinfo2(ctypes.Structure):
    _names = "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost"
    _fields_ = [(name, ctypes.c_size_t) for name in _names.split()]


def held():
    """Return the bytes that are resident, and allocated. Free memory is returned to the system first, so it does not count."""
    library = ctypes.CDLL(None)
    # Debian's Blender uses jemalloc, which the C library's statistics do not include.
    given = _given_by_jemalloc(library) if hasattr(library, "mallctl") else _given_by_c(library)
    with open("/proc/self/statm", encoding="ascii") as file:
        pages = int(file.read().split()[1])
    return {"resident": pages * os.sysconf("SC_PAGE_SIZE"), "given": given}


def _given_by_jemalloc(library):
    def control(name, old=None, old_size=None, new=None, new_size=0):
        failed = library.mallctl(name.encode(), old, old_size, new, ctypes.c_size_t(new_size))
        assert failed == 0, f"jemalloc refuses {name}: error {failed}"

    control(f"arena.{_ALL_ARENAS}.purge")
    # The statistics are those of the last epoch.
    epoch, given = ctypes.c_uint64(1), ctypes.c_size_t()
    control("epoch", new=ctypes.byref(epoch), new_size=ctypes.sizeof(epoch))
    control("stats.allocated", ctypes.byref(given), ctypes.byref(ctypes.c_size_t(ctypes.sizeof(given))))
    return given.value


def _given_by_c(library):
    library.malloc_trim(0)
    library.mallinfo2.restype = _Mallinfo2
    info = library.mallinfo2()
    return info.uordblks + info.hblkhd
