"""Files that the library reads by memory mapping, and the limit of the memory that their pages take.

The kernel reads a page when the library first needs it. On Linux, pages beyond the limit are let go a quarter of the files at a
time; elsewhere, and below the limit, the kernel alone decides. A page that is needed again comes from the kernel's own cache
as long as there is free memory, else from the disk.
"""

import mmap
import os

_PARTS = 4


class MappedFile:
    """A file that is written from its beginning to its end, then mapped and not written again. limit: bytes in memory."""

    def __init__(self, file, limit):
        """file: open for writing and reading, empty; it is removed when its last user ends."""
        self._file, self._map = file, None
        self.size = 0
        self.limit = limit

    @property
    def is_mapped(self):
        return self._map is not None

    def write(self, array):
        """Append the bytes of a contiguous array; raise OSError if there is no room."""
        self._file.seek(self.size)
        self._file.write(array.data.cast("B"))
        self._file.flush()
        self.size += array.nbytes

    def memory(self):
        """Return the mapping of the whole file, which can only be read."""
        if self._map is None:
            self._map = mmap.mmap(self._file.fileno(), self.size, access=mmap.ACCESS_READ)
            # The mapping has a handle of its own.
            self._file.close()
            # Without this advice the kernel reads and maps the neighbours of each page.
            if hasattr(mmap, "MADV_RANDOM"):
                self._map.madvise(mmap.MADV_RANDOM)
        return self._map

    def let_go(self, part):
        """Let the pages of one of _PARTS equal parts go; the next access reads them again."""
        if self._map is not None:
            pages = -(-len(self._map) // mmap.PAGESIZE)
            first, end = (pages * edge // _PARTS * mmap.PAGESIZE for edge in (part, part + 1))
            if end > first:
                self._map.madvise(mmap.MADV_DONTNEED, first, min(end, len(self._map)) - first)


class MappedPages:
    """The files of one scene, whose pages it keeps under their limit."""

    def __init__(self):
        self._files = {}
        self._before = _bytes_of_files()  # the program's own code
        self._next = 0

    def add(self, file):
        self._files[id(file)] = file

    def keep_under(self):
        """Let pages go if those in memory exceed the limit. Any thread may read the files meanwhile."""
        if not self._files or self._before is None:
            return
        limit = max(file.limit for file in self._files.values())
        for _ in range(_PARTS):
            if _bytes_of_files() - self._before <= limit:
                return
            for file in self._files.values():
                file.let_go(self._next)
            self._next = (self._next + 1) % _PARTS


def _bytes_of_files():
    """Return the memory of all mapped files of this process; None if the system does not tell."""
    if not hasattr(mmap, "MADV_DONTNEED"):
        return None
    try:
        with open("/proc/self/statm", encoding="ascii") as told:
            return int(told.read().split()[2]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return None
