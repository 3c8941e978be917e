"""What this process holds: of the system, and of what the C library has given out."""

import ctypes
import os


class _Mallinfo2(ctypes.Structure):
    _names = "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost"
    _fields_ = [(name, ctypes.c_size_t) for name in _names.split()]


def held():
    """Bytes: resident, and given out by malloc. Free memory goes back to the system first, so that it does not count."""
    library = ctypes.CDLL(None)
    library.malloc_trim(0)
    library.mallinfo2.restype = _Mallinfo2
    info = library.mallinfo2()
    with open("/proc/self/statm", encoding="ascii") as file:
        pages = int(file.read().split()[1])
    return {"resident": pages * os.sysconf("SC_PAGE_SIZE"), "given": info.uordblks + info.hblkhd}
