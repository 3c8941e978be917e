"""Parts of a picture through the C interface: ranges of tiles, their sums as bytes, and what a part belongs to.

The bytes of a part are described in lancer.h. A part may come from any source: the library checks it before it uses it.
"""

import ctypes
import dataclasses
from dataclasses import dataclass

import numpy as np

from . import abi
from .abi import check, load_library
from .snapshot import Camera, Settings

# One row for each lancer_range.
RANGE = np.dtype([(name, np.uint32) for name, _ in abi.Range._fields_])


class SessionParts:
    """Methods of a Session that renders or joins parts of a picture."""

    def tiles(self):
        """Return the number of pixels of each tile as uint32."""
        return self._counted(self.library.lancer_session_tiles, np.uint32)

    def decide(self):
        """Start to find the numbers of lights and paths of a sample; after wait(), statistics() has them."""
        self._check(self.library.lancer_session_decide(self.handle))

    def plan(self, target=0.0, confidence=0.95):
        """Return the ranges that refine() would start, in order of gain, as an array of RANGE."""
        return self._counted(self.library.lancer_session_plan, RANGE, ctypes.c_double(target), ctypes.c_double(confidence))

    def render_ranges(self, ranges):
        """Start an array of RANGE in the background, each of another tile; wait() reports their progress."""
        ranges = np.ascontiguousarray(ranges, RANGE)
        self._check(self.library.lancer_session_render_ranges(self.handle, len(ranges), ranges.ctypes.data))

    def clear(self):
        """Forget all samples, also after a cancelled range."""
        self._check(self.library.lancer_session_clear(self.handle))

    def export(self):
        """Return all samples as a part: an array of uint8."""
        needed = ctypes.c_size_t()
        self._check(self.library.lancer_session_export(self.handle, None, 0, ctypes.byref(needed)))
        part = np.empty(needed.value, np.uint8)
        self._check(self.library.lancer_session_export(self.handle, part.ctypes.data, part.size, None))
        return part

    def add(self, part):
        """Add the samples of a part, bytes or an array of uint8; raise LancerError and change nothing if it does not fit."""
        part = _bytes_of(part)
        self._check(self.library.lancer_session_import(self.handle, part.ctypes.data, part.size))

    def _counted(self, ask, dtype, *arguments):
        """Return the items that a call writes, which tells their number at first."""
        count = ctypes.c_uint32()
        self._check(ask(self.handle, *arguments, 0, None, ctypes.byref(count)))
        items = np.empty(count.value, dtype)
        self._check(ask(self.handle, *arguments, count.value, items.ctypes.data, ctypes.byref(count)))
        return items


@dataclass(frozen=True)
class PartInfo:
    """The picture that a part belongs to, and the samples that it holds: lancer_part of lancer.h."""

    digest: bytes
    release: str  # of the library that has rendered the samples
    hash: int
    samples: int  # pixel samples
    camera: Camera
    settings: Settings  # with the numbers of lights and paths in use
    tiles: int
    first: int
    end: int


def describe_part(part, library=None):
    """Return the PartInfo of a part whose size and checksum are right; raise LancerError for other bytes."""
    library = library or load_library()
    part = _bytes_of(part)
    raw = abi.Part()
    check(library.lancer_part_describe(part.ctypes.data, part.size, ctypes.byref(raw)), library)
    splits = {"split_lights": raw.split_lights, "split_paths": raw.split_paths}
    release = raw.release.decode("ascii", "replace")
    return PartInfo(
        bytes(raw.digest), release, raw.hash, raw.samples, _camera(raw.camera), _settings(raw.settings, splits),
        raw.tiles, raw.first, raw.end,
    )  # fmt: skip


def _bytes_of(part):
    # An address of no bytes may be null.
    return np.frombuffer(part, np.uint8) if len(part) else np.zeros(0, np.uint8)


def _camera(raw):
    values = {f.name: getattr(raw, f.name) for f in dataclasses.fields(Camera)}
    values |= {name: tuple(values[name]) for name in ("window", "panorama")}
    matrices = ("matrix", "matrix_before", "matrix_after")
    return Camera(**values | {name: np.array(values[name]).reshape(3, 4) for name in matrices})


def _settings(raw, splits):
    values = {name: getattr(raw, name) for name, _ in raw._fields_ if name not in ("passes", "refines")}
    passes = tuple(number for number in abi.Pass if raw.passes >> number & 1)
    return Settings(**values | splits, passes=passes, in_parts=True)


__all__ = ["RANGE", "PartInfo", "SessionParts", "describe_part"]
