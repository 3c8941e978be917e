"""Denoising of arrays by Open Image Denoise.

    image = denoise(color, albedo, normal).image

The library runs in a thread of its own, which makes no calls to Blender, while the caller polls.
"""

import os
import threading
import time
from dataclasses import dataclass

import numpy as np

from ..bindings.abi import LancerError
from ..bindings.session import Cancelled
from . import oidn

_STEP = 0.05
# Memory limit of the library: it filters large pictures in tiles, which takes 5 % longer and gives the same picture.
_MEMORY_MB = 512
# The largest half-precision number: the range of the network's input, relative to the median of a usual picture.
_BRIGHTEST = 65504.0


@dataclass(frozen=True)
class Denoised:
    image: np.ndarray  # the shape of the colours; alpha unchanged
    seconds: float
    memory_bytes: int  # the images plus the largest growth of the process; 0 if unknown
    version: str


def denoise(color, albedo=None, normal=None, *, threads=0, poll=None, tell=None, library=None):
    """Return the Denoised of linear colours, (height, width, 3 or 4) float32; a fourth channel is copied.

    albedo and normal, (height, width, 3), are those of the first hit; they are denoised first. The arguments are not modified.
    threads: 0 = all. tell(fraction) is called while waiting. Raise Cancelled if poll returns True, LancerError for inputs of
    wrong shape or with values that are not finite, and if the library fails.
    """
    image, guides = _checked(color, albedo, normal)
    library = library or oidn.load()
    started, memory = time.monotonic(), _Memory()
    device = library.oidnNewDevice(oidn.CPU)
    if not device:
        raise LancerError(f"Open Image Denoise: {oidn.fault(library, None)[1]}")
    try:
        # Without affinity: pinned threads would compete with Blender's threads on the same processors.
        library.oidnSetDeviceBool(device, b"setAffinity", False)
        if threads > 0:
            library.oidnSetDeviceInt(device, b"numThreads", threads)
        library.oidnCommitDevice(device)
        _check(library, device)
        number = library.oidnGetDeviceInt(device, b"version")
        exposure = _Exposure(image[..., :3])
        # A black picture needs no denoising.
        if exposure.lit:
            work = _Work(library, device, 1 + len(guides), poll, tell, memory)
            # Denoise the guides first, so that the filter can rely on them (cleanAux).
            for name, guide in guides.items():
                work.run({name: guide}, guide)
            work.run({"color": image, **guides}, image, hdr=True, cleanAux=bool(guides))
            exposure.restore(image[..., :3])
    finally:
        library.oidnReleaseDevice(device)
    held = image.nbytes + sum(guide.nbytes for guide in guides.values())
    version = ".".join(str(part) for part in (number // 10000, number // 100 % 100, number % 100))
    return Denoised(image, time.monotonic() - started, memory.growth + held if memory.known else 0, version)


class _Exposure:
    """Scales colours in place into the network's range, and the denoised colours back.

    The library adjusts exposure itself, but fails for very dark pictures, and an extremely bright pixel spoils its
    surroundings.
    """

    def __init__(self, color):
        peak = color.max(axis=2).astype(np.float64)
        exponents = np.sort(np.frexp(peak[peak > 0.0])[1])
        self.lit = exponents.size > 0
        if not self.lit:
            return
        # Scale by the median exponent of lit pixels: a power of two is exact, and the median ignores single bright pixels.
        self._exponent = int(exponents[exponents.size // 2])
        # Clamp pixels that are too bright, but keep their hue.
        self._excess = np.maximum(peak / np.ldexp(_BRIGHTEST, self._exponent), 1.0)
        color[...] = np.ldexp(color / self._excess[..., None], -self._exponent)

    def restore(self, color):
        # Restore the brightness of visible lamps; single bright pixels are noise that the network has removed.
        seen = color.max(axis=2) > 0.5 * _BRIGHTEST
        excess = np.where(seen, self._excess, 1.0)[..., None]
        color[...] = np.minimum(np.ldexp(color * excess, self._exponent), np.finfo(np.float32).max)


class _Work:
    """Filters of one device, run in order; each counts equally in the progress."""

    def __init__(self, library, device, filters, poll, tell, memory):
        self._library, self._device, self._memory = library, device, memory
        self._poll, self._tell = poll, tell
        self._filters, self._done = filters, 0

    def run(self, inputs, output, **switches):
        """Run a filter with inputs, by their names in the library, and write output."""
        library = self._library
        stop, fraction = threading.Event(), [0.0]

        @oidn.Monitor
        def monitor(_, value):
            fraction[0] = value
            return not stop.is_set()

        handle = library.oidnNewFilter(self._device, b"RT")
        _check(library, self._device)
        try:
            for name, array in (*inputs.items(), ("output", output)):
                height, width, channels = array.shape
                layout = width, height, 0, 4 * channels, 4 * channels * width
                library.oidnSetSharedFilterImage(handle, name.encode(), array.ctypes.data, oidn.FLOAT3, *layout)
            for name, on in switches.items():
                library.oidnSetFilterBool(handle, name.encode(), on)
            library.oidnSetFilterInt(handle, b"maxMemoryMB", _MEMORY_MB)
            library.oidnSetFilterProgressMonitorFunction(handle, monitor, None)
            library.oidnCommitFilter(handle)
            _check(library, self._device)
            thread = threading.Thread(target=library.oidnExecuteFilter, args=(handle,), name="lancer denoising")
            thread.start()
            try:
                self._wait(thread, fraction)
            finally:
                # Join the thread even after an exception: the images must outlive the filter.
                stop.set()
                thread.join()
            _check(library, self._device)
        finally:
            library.oidnReleaseFilter(handle)
        self._done += 1

    def _wait(self, thread, fraction):
        working = True
        while working:
            thread.join(_STEP)
            working = thread.is_alive()
            self._memory.look()
            if self._tell is not None:
                self._tell((self._done + fraction[0]) / self._filters)
            if self._poll is not None and self._poll():
                raise Cancelled


class _Memory:
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


def _checked(color, albedo, normal):
    """Return writable copies of the colours, and of the guides by their names in the library; raise LancerError if invalid."""
    shape = np.shape(color)
    if len(shape) != 3 or shape[2] not in (3, 4) or 0 in shape:
        raise LancerError(f"denoising: colours of shape {shape}, not (height, width, 3 or 4)")
    if normal is not None and albedo is None:
        raise LancerError("denoising: a normal needs an albedo beside it")
    guides = {}
    for name, guide in (("albedo", albedo), ("normal", normal)):
        if guide is None:
            continue
        if np.shape(guide) != (*shape[:2], 3):
            raise LancerError(f"denoising: {name} of shape {np.shape(guide)} beside colours of shape {shape}")
        guides[name] = np.array(guide, np.float32, order="C")
    image = np.array(color, np.float32, order="C")
    for name, array in (("colour", image), *guides.items()):
        if not np.isfinite(array).all():
            raise LancerError(f"denoising: {name} is not finite everywhere")
    return image, guides


def _check(library, device):
    code, text = oidn.fault(library, device)
    if code == oidn.CANCELLED:
        raise Cancelled
    if code:
        raise LancerError(f"Open Image Denoise: {text}")
