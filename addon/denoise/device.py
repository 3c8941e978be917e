"""Filters of Open Image Denoise on the processor, run in a thread of its own while the caller polls."""

import os
import threading

from ..bindings.abi import LancerError
from ..bindings.session import Cancelled
from . import oidn
from .plan import FAST, HIGH

_STEP = 0.05
# Memory limit of the library: it filters large pictures in tiles, which takes 5 % longer and gives the same picture.
_MEMORY_MB = 512
# First versions with a choice of networks, and with the fastest one, as numbers of the library.
_WITH_QUALITY, _WITH_FAST = 20000, 20300


class Device:
    """A device of the library; leaving the with statement releases it.

    filters: number of calls of run(), each of which counts equally in the progress that tell(fraction) receives. run() raises
    Cancelled if poll returns True, LancerError if the library fails.
    """

    def __init__(self, library, filters, threads=0, poll=None, tell=None):
        self._library, self._poll, self._tell = library, poll, tell
        self._filters, self._done = filters, 0
        self.memory = Memory()
        self._device = library.oidnNewDevice(oidn.CPU)
        if not self._device:
            raise LancerError(f"Open Image Denoise: {oidn.fault(library, None)[1]}")
        # Without affinity: pinned threads would compete with Blender's threads on the same processors.
        library.oidnSetDeviceBool(self._device, b"setAffinity", False)
        if threads > 0:
            library.oidnSetDeviceInt(self._device, b"numThreads", threads)
        library.oidnCommitDevice(self._device)
        self.version = library.oidnGetDeviceInt(self._device, b"version")

    def __enter__(self):
        try:
            self._check()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self._library.oidnReleaseDevice(self._device)

    def run(self, inputs, output, quality=HIGH, **switches):
        """Run a filter with inputs, (height, width, 3) float32 by their names in the library, and write output."""
        library = self._library
        stop, fraction = threading.Event(), [0.0]

        @oidn.Monitor
        def monitor(_, value):
            fraction[0] = value
            return not stop.is_set()

        handle = library.oidnNewFilter(self._device, b"RT")
        self._check()
        try:
            for name, array in (*inputs.items(), ("output", output)):
                height, width, channels = array.shape
                layout = width, height, 0, 4 * channels, 4 * channels * width
                library.oidnSetSharedFilterImage(handle, name.encode(), array.ctypes.data, oidn.FLOAT3, *layout)
            for name, on in switches.items():
                library.oidnSetFilterBool(handle, name.encode(), on)
            library.oidnSetFilterInt(handle, b"maxMemoryMB", _MEMORY_MB)
            if self.version >= _WITH_QUALITY:
                library.oidnSetFilterInt(handle, b"quality", quality if self.version >= _WITH_FAST else max(quality, FAST + 1))
            library.oidnSetFilterProgressMonitorFunction(handle, monitor, None)
            library.oidnCommitFilter(handle)
            self._check()
            thread = threading.Thread(target=library.oidnExecuteFilter, args=(handle,), name="lancer denoising")
            thread.start()
            try:
                self._wait(thread, fraction)
            finally:
                # Join the thread even after an exception: the images must outlive the filter.
                stop.set()
                thread.join()
            self._check()
        finally:
            library.oidnReleaseFilter(handle)
        self._done += 1

    def _wait(self, thread, fraction):
        working = True
        while working:
            thread.join(_STEP)
            working = thread.is_alive()
            self.memory.look()
            if self._tell is not None:
                self._tell((self._done + fraction[0]) / self._filters)
            if self._poll is not None and self._poll():
                raise Cancelled

    def _check(self):
        code, text = oidn.fault(self._library, self._device)
        if code == oidn.CANCELLED:
            raise Cancelled
        if code:
            raise LancerError(f"Open Image Denoise: {text}")


class Memory:
    """The largest growth of the process's memory among the calls of look()."""

    def __init__(self):
        self._start = _resident_bytes()
        self.known = self._start is not None
        self.growth = 0

    def look(self):
        if self.known:
            self.growth = max(self.growth, _resident_bytes() - self._start)


def _resident_bytes():
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return None
