"""The texels of a bake as the library takes them."""

import ctypes
from dataclasses import dataclass

import numpy as np

from . import abi
from .enums import BakeLacks, BakeView

DTYPE = np.dtype([("triangle", np.uint32), ("weights", np.float32, 2), ("dx", np.float32, 2), ("dy", np.float32, 2)])
EMPTY = 0xFFFFFFFF  # triangle of a texel that shows nothing


@dataclass(frozen=True)
class Texels:
    """rows: (height, width) of DTYPE, see lancer_texel; instance: number of the row in the InstanceTable."""

    rows: np.ndarray
    instance: int
    view: BakeView = BakeView.ABOVE
    lacks: BakeLacks = BakeLacks(0)
    bare_roughness: float = 0.0

    def as_struct(self):
        """Return the struct, which refers to rows."""
        rows = np.ascontiguousarray(self.rows, DTYPE)
        address = ctypes.cast(rows.ctypes.data, ctypes.POINTER(abi.Texel))
        struct = abi.Bake(address, rows.size, int(self.instance), int(self.view), int(self.lacks), self.bare_roughness)
        struct.rows = rows
        return struct
