"""Numbers as Blender stores them."""

import pytest


def near(value, limit=1e-6):
    """Return an approximation: the limit is sixteen times the rounding of single precision, 2^-24."""
    return pytest.approx(value, rel=limit, abs=limit)
