"""Maps from the unit square to directions in which a density is smooth, for histograms and integrals.

direct(u) of a chart returns, for points (count, 2) of the unit square, directions and the solid angle per unit of area;
back(w) maps directions to the square, with NaN for directions outside the chart.
"""

import numpy as np

TWO_PI = 2.0 * np.pi


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def angle(x, y):
    """Return the angle as a fraction of a full turn, 0 to 1."""
    return np.mod(np.arctan2(y, x) / TWO_PI, 1.0)


def frame(axis):
    """Return rows: two directions orthogonal to the axis, and the axis."""
    axis = unit(np.asarray(axis, float))
    helper = np.eye(3)[np.argmin(np.abs(axis))]
    x = unit(np.cross(helper, axis))
    return np.stack([x, np.cross(axis, x), axis])


class Sphere:
    """Directions above a height along the axis, denser near that height: height = u0^crowding; and the angle around it."""

    def __init__(self, axis=(0, 0, 1), lowest=-1.0, crowding=1.0):
        self.frame, self.lowest, self.crowding = frame(axis), lowest, crowding

    def direct(self, u):
        z = self.lowest + (1.0 - self.lowest) * u[:, 0] ** self.crowding
        r = np.sqrt(np.maximum(0.0, 1.0 - z * z))
        w = np.stack([r * np.cos(TWO_PI * u[:, 1]), r * np.sin(TWO_PI * u[:, 1]), z], axis=1) @ self.frame
        return w, TWO_PI * (1.0 - self.lowest) * self.crowding * u[:, 0] ** (self.crowding - 1.0)

    def back(self, w):
        local = w @ self.frame.T
        height = np.maximum(local[:, 2] - self.lowest, 0.0) / (1.0 - self.lowest)
        u = np.stack([height ** (1.0 / self.crowding), angle(local[:, 0], local[:, 1])], axis=1)
        return np.where(local[:, 2:] < self.lowest, np.nan, u)


class Power:
    """Directions around an axis with density cos^exponent: u0 = 1 - cos^(exponent + 1)."""

    def __init__(self, axis, exponent):
        self.frame, self.exponent = frame(axis), exponent

    def direct(self, u):
        k = self.exponent + 1.0
        z = np.exp(np.log1p(-u[:, 0]) / k)
        # 1 - z^2 by expm1: in narrow lobes z is 1 to many digits.
        r = np.sqrt(-np.expm1(2.0 * np.log1p(-u[:, 0]) / k))
        w = np.stack([r * np.cos(TWO_PI * u[:, 1]), r * np.sin(TWO_PI * u[:, 1]), z], axis=1) @ self.frame
        return w, TWO_PI / (k * z**self.exponent)

    def back(self, w):
        local = w @ self.frame.T
        r2 = np.minimum(local[:, 0] ** 2 + local[:, 1] ** 2, 1.0)
        u0 = -np.expm1(0.5 * (self.exponent + 1.0) * np.log1p(-np.minimum(r2, 1 - 1e-16)))
        u = np.stack([u0, angle(local[:, 0], local[:, 1])], axis=1)
        return np.where(local[:, 2:] <= 0.0, np.nan, u)


class Half:
    """Reflections of wo at the half vectors of another chart."""

    def __init__(self, wo, halves):
        self.wo, self.halves = np.asarray(wo, float), halves

    def direct(self, u):
        h, area = self.halves.direct(u)
        cosine = h @ self.wo
        # Back-facing half vectors reflect nothing.
        return 2.0 * cosine[:, None] * h - self.wo, area * 4.0 * np.maximum(cosine, 0.0)

    def back(self, w):
        return self.halves.back(unit(w + self.wo))


class Slopes:
    """Directions whose slopes have the density exp(-slope^2/alpha^2), which resolves tiny alpha."""

    def __init__(self, alpha, side=1.0):
        self.alpha, self.side = alpha, side

    def direct(self, u):
        r2 = -np.log1p(-u[:, 0])
        r = self.alpha * np.sqrt(r2)
        z = 1.0 / np.sqrt(1.0 + r * r)
        h = np.stack([r * z * np.cos(TWO_PI * u[:, 1]), r * z * np.sin(TWO_PI * u[:, 1]), z], axis=1) * self.side
        # d omega = cos^3 d slopes; d slopes = pi alpha^2/(1 - u0) d u.
        return h, z**3 * np.pi * self.alpha**2 / (1.0 - u[:, 0])

    def back(self, h):
        h = h * self.side
        z = np.where(h[:, 2] > 0.0, h[:, 2], np.nan)
        slopes = h[:, :2] / z[:, None] / self.alpha
        return np.stack([-np.expm1(-np.sum(slopes**2, axis=1)), angle(slopes[:, 0], slopes[:, 1])], axis=1)


def integrate_cells(chart, density, cells, points):
    """Return integrals of density over a cells x cells grid of the chart, by points^2 Gauss-Legendre nodes in each cell.

    Cells cut by the horizon (some nodes are 0, some not) use the midpoint rule with five times as many points, which locates
    a jump to points^-1.5 of a cell.
    """
    x, weight = np.polynomial.legendre.leggauss(points)
    smooth, values = _tensor_rule(chart, density, cells, (x + 1.0) / 2.0, weight / 2.0)
    # The corners detect slivers that no inner node lies in.
    _, corners = _tensor_rule(chart, density, cells, np.array([1e-6, 1.0 - 1e-6]), np.array([0.5, 0.5]))
    some = np.any(values != 0.0, axis=(1, 3)) | np.any(corners != 0.0, axis=(1, 3))
    cut = some & (np.any(values == 0.0, axis=(1, 3)) | np.any(corners == 0.0, axis=(1, 3)))
    if not cut.any():
        return smooth
    fine = 5 * points
    for a, b in np.argwhere(cut):
        inner = (np.arange(fine) + 0.5) / fine
        u = np.stack([g.ravel() for g in np.meshgrid((a + inner) / cells, (b + inner) / cells, indexing="ij")], axis=1)
        w, area = chart.direct(u)
        smooth[a, b] = np.where(area > 0.0, density(w) * area, 0.0).mean() / cells**2
    return smooth


def _tensor_rule(chart, density, cells, x, weight):
    points = len(x)
    axis = ((np.arange(cells)[:, None] + x) / cells).ravel()
    u = np.stack([a.ravel() for a in np.meshgrid(axis, axis, indexing="ij")], axis=1)
    w, area = chart.direct(u)
    value = np.where(area > 0.0, density(w) * area, 0.0).reshape(cells, points, cells, points)
    return np.einsum("aibj,i,j->ab", value, weight, weight) / cells**2, value


def histogram(chart, w, cells):
    """Return the counts of directions in each cell, and the number of directions outside the chart."""
    u = chart.back(np.asarray(w, float))
    inside = np.all(np.isfinite(u), axis=1)
    index = np.minimum((u[inside] * cells).astype(int), cells - 1)
    counts = np.zeros((cells, cells))
    np.add.at(counts, (index[:, 0], index[:, 1]), 1)
    return counts, int(np.sum(~inside))
