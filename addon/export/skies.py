"""The Sky Texture: tables and numbers for the core's node SKY.

Each model follows Cycles: analytic models as coefficients, the others as an image of the scattered light beside the sun's disc.
"""

import functools
import math
import os

import numpy as np
from mathutils import Color

from ..bindings import sky
from ..bindings.enums import NodeKind, SkyModel
from .procedural import mapped_vector

_SMALLEST_SUN = 0.0005  # radians; Cycles shows no smaller disc
_EARTH = 6371e3
_HIGHEST_TURBIDITY = 10
# Perez's coefficients of Preetham's model for x, y and Y by turbidity: of the turbidity, and constant.
_PEREZ = np.array(
    (
        ((-0.0193, -0.2592), (-0.0167, -0.2608), (0.1787, -1.4630)),
        ((-0.0665, 0.0008), (-0.0950, 0.0092), (-0.3554, 0.4275)),
        ((-0.0004, 0.2125), (-0.0079, 0.2102), (-0.0227, 5.3251)),
        ((-0.0641, -0.8989), (-0.0441, -1.6537), (0.1206, -2.5771)),
        ((-0.0033, 0.0452), (-0.0109, 0.0529), (-0.0670, 0.3703)),
    )
)
# Chromaticity of the zenith: rows are powers 2, 1, 0 of the turbidity, columns powers 3, 2, 1, 0 of the sun's angle.
_ZENITH = np.array(
    (
        (
            (0.00166, -0.00375, 0.00209, 0.0),
            (-0.02903, 0.06377, -0.03202, 0.00394),
            (0.11693, -0.21196, 0.06052, 0.25886),
        ),
        (
            (0.00275, -0.00610, 0.00317, 0.0),
            (-0.04214, 0.08970, -0.04153, 0.00516),
            (0.15346, -0.26756, 0.06670, 0.26688),
        ),
    )
)


def _sky(graph, site, output):
    node = site.node
    vector = mapped_vector(graph, site)
    # Before 5.0 the only model with an atmosphere is NISHITA, which later versions do not have.
    model = SkyModel[node.sky_type]
    if model in (SkyModel.PREETHAM, SkyModel.HOSEK_WILKIE):
        build = _preetham if model == SkyModel.PREETHAM else _hosek_wilkie
        table = build(*_finite(graph, site, "turbidity", "ground_albedo"), _direction(graph, site))[None]
        matrix = (*_xyz_to_rgb().ravel(), 0.0, 0.0, 0.0)
    else:
        table, matrix = _atmosphere(node, graph, site, model)
    return graph.emit(NodeKind.SKY, vector, option=model, image=graph.grid(table), image_count=1, matrix=matrix)


def _atmosphere(node, graph, site, model):
    """Return the table in RGB and the numbers of the sun."""
    dust = "aerosol_density" if hasattr(node, "aerosol_density") else "dust_density"
    names = ("sun_size", "sun_intensity", "sun_elevation", "sun_rotation", "altitude", "air_density", dust, "ozone_density")
    size, intensity, elevation, rotation, altitude, *densities = _finite(graph, site, *names)
    elevation, rotation = _position(elevation, rotation)
    size = max(size, _SMALLEST_SUN)
    xyz, rims = sky.compute(model, elevation, size, altitude, tuple(max(density, 0.0) for density in densities))
    matrix = _xyz_to_rgb().T
    rims = intensity * (rims @ matrix)
    sun = math.cos(elevation) * math.sin(rotation), math.cos(elevation) * math.cos(rotation), math.sin(elevation)
    horizon = math.asin(_EARTH / (_EARTH + max(altitude, 0.0))) - 0.5 * math.pi
    return (xyz @ matrix).astype(np.float32), (*rims.ravel(), *sun, size if node.sun_disc else 0.0, horizon, 0.0)


def _finite(graph, site, *names):
    node, who = site.node, graph.who(site)
    return [graph.messages.number(getattr(node, name), who, node.bl_rna.properties[name].name, 0.0) for name in names]


def _position(elevation, rotation):
    """Return the sun's elevation in a quarter turn up or down, and the rotation to the same position."""
    elevation = math.remainder(elevation, 2.0 * math.pi)
    if abs(elevation) > 0.5 * math.pi:
        elevation, rotation = math.copysign(math.pi, elevation) - elevation, rotation + math.pi
    return elevation, rotation


def _direction(graph, site):
    x, y, z = site.node.sun_direction
    length = math.sqrt(x * x + y * y + z * z)
    if 0.0 < length < math.inf:
        return x / length, y / length, z / length
    graph.tell(site, f"its sun direction ({x:g}, {y:g}, {z:g}) is no direction, the zenith is used", "")
    return 0.0, 0.0, 1.0


def _xyz_to_rgb():
    """Return the matrix from CIE XYZ to the working space."""
    return np.linalg.inv(np.array([Color(row).from_scene_linear_to_xyz_d65()[:] for row in np.eye(3)], float).T)


def _table(sun, radiance, coefficients):
    """Return the texels that the core reads. coefficients: (count, 3)."""
    table = np.zeros((11, 3), np.float32)
    table[0], table[1], table[2 : 2 + len(coefficients)] = sun, radiance, coefficients
    return table


def _preetham(turbidity, albedo, sun):
    theta = math.acos(min(max(sun[2], -1.0), 1.0))
    chi = (4.0 / 9.0 - turbidity / 120.0) * (math.pi - 2.0 * theta)
    luminance = 0.06 * ((4.0453 * turbidity - 4.9710) * math.tan(chi) - 0.2155 * turbidity + 2.4192)
    x, y = (_ZENITH @ np.power(theta, (3, 2, 1, 0))) @ np.power(turbidity, (2, 1, 0))
    c = _PEREZ @ (turbidity, 1.0)
    # Relative to the zenith.
    relative = (1.0 + c[0] * np.exp(c[1])) * (1.0 + c[2] * np.exp(c[3] * theta) + c[4] * math.cos(theta) ** 2)
    return _table(sun, np.array((x, y, luminance)) / relative, c)


def _hosek_wilkie(turbidity, albedo, sun):
    # Below the horizon, the sun is as at it.
    theta = min(math.acos(min(max(sun[2], -1.0), 1.0)), 0.5 * math.pi)
    azimuth = math.atan2(sun[0], sun[1])
    sun = math.sin(theta) * math.sin(azimuth), math.sin(theta) * math.cos(azimuth), math.cos(theta)
    # A Bezier curve of degree 5 over the elevation, between the turbidities and albedos of the data.
    t = ((0.5 * math.pi - theta) / (0.5 * math.pi)) ** (1.0 / 3.0)
    curve = [math.comb(5, i) * (1.0 - t) ** (5 - i) * t**i for i in range(6)]
    turbidity = min(max(turbidity, 1.0), float(_HIGHEST_TURBIDITY))
    low = int(turbidity)
    high, part = min(low + 1, _HIGHEST_TURBIDITY), turbidity - low
    controls = (1.0 - albedo) * _coefficients()[:, 0] + albedo * _coefficients()[:, 1]
    controls = (1.0 - part) * controls[:, low - 1] + part * controls[:, high - 1]
    found = np.einsum("e,cek->ck", curve, controls)
    return _table(sun, found[:, 9], found[:, :9].T)


@functools.lru_cache(maxsize=1)
def _coefficients():
    """Return the data by channel, albedo, turbidity, elevation: nine coefficients and the radiance."""
    path = os.path.join(os.path.dirname(__file__), "hosek_wilkie.txt")
    return np.loadtxt(path).reshape(3, 2, _HIGHEST_TURBIDITY, 6, 10)


READERS = {"TEX_SKY": _sky}
