"""Numbers of the dielectric Fresnel term that the Principled mapping needs."""

import functools
import math

import numpy as np

# Enough for full double precision: the integrand is smooth on [0, 1] apart from a square root at total reflection.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)


def reflectance_at_normal(ior):
    if math.isinf(ior):
        return 1.0
    return ((ior - 1.0) / (ior + 1.0)) ** 2


def ior_of_reflectance(f0):
    """The index above 1 that reflects f0 at normal incidence; infinite for 1."""
    root = math.sqrt(max(0.0, f0))
    return math.inf if root >= 1.0 else (1.0 + root) / (1.0 - root)


@functools.lru_cache(maxsize=1024)
def mean_reflectance(ior):
    """The share of diffuse light that a smooth surface reflects: the integral of 2 mu F(mu) over mu in [0, 1]."""
    if math.isinf(ior):
        return 1.0
    mu = 0.5 * (_NODES + 1.0)
    g2 = ior * ior - 1.0 + mu * mu
    g = np.sqrt(np.maximum(g2, 0.0))
    parallel = (mu * (g + mu) - 1.0) / (mu * (g - mu) + 1.0)
    f = 0.5 * ((g - mu) / (g + mu)) ** 2 * (1.0 + parallel**2)
    f = np.where(g2 < 0.0, 1.0, f)
    return float(np.sum(_WEIGHTS * mu * f))
