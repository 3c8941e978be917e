"""The light that an atmosphere scatters, computed by the core."""

import functools

import numpy as np

from .abi import check, load_library
from .enums import SKY_WIDTH, SkyModel


@functools.lru_cache(maxsize=4)
def compute(model, elevation, diameter, altitude, densities):
    """Return CIE XYZ as (rows, SKY_WIDTH, 3) and of both rims of the sun (2, 3), as lancer_compute_sky describes them.

    densities: a tuple. The arrays are shared by all that ask for the same sky.
    """
    library = load_library()
    xyz = np.empty((128 if model == SkyModel.NISHITA else 256, SKY_WIDTH, 3), np.float32)
    rims, densities = np.empty((2, 3), np.float32), np.array(densities, float)
    addresses = [array.ctypes.data for array in (densities, xyz, rims)]
    check(library.lancer_compute_sky(model, elevation, diameter, altitude, *addresses), library)
    xyz.flags.writeable = rims.flags.writeable = False
    return xyz, rims
