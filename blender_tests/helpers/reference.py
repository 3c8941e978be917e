"""Reference formulas at 50 digits, written from the literature, independent of the core."""

import mpmath as mp

mp.mp.dps = 50


def exact(x):
    """Return the exact value of a float32 or double."""
    return x if isinstance(x, mp.mpf) else mp.mpf(float(x))


def beckmann_d(cos_nh, alpha):
    """chi+(cos) exp(-tan^2/alpha^2) / (pi alpha^2 cos^4)."""
    c, a = exact(cos_nh), exact(alpha)
    if c <= 0:
        return mp.mpf(0)
    tan2 = (1 - c**2) / c**2
    return mp.exp(-tan2 / a**2) / (mp.pi * a**2 * c**4)


def fresnel(cos_lh, ior):
    """Return the mean of both polarisations for light from outside; ior is inside over outside; 1 beyond the critical angle."""
    c, n = exact(cos_lh), exact(ior)
    if mp.isinf(n):
        return mp.mpf(1)
    sin2_t = (1 - c**2) / n**2
    if sin2_t > 1:
        return mp.mpf(1)
    cos_t = mp.sqrt(1 - sin2_t)
    rs = ((c - n * cos_t) / (c + n * cos_t)) ** 2
    rp = ((cos_t - n * c) / (cos_t + n * c)) ** 2
    return (rs + rp) / 2


def g1(cos_nx, cos_xh, alpha):
    """Walter's rational masking term, at most 1, with chi+((x.h)/(x.n))."""
    c, a = exact(cos_nx), exact(alpha)
    if c == 0 or exact(cos_xh) / c <= 0:
        return mp.mpf(0)
    tan = mp.sqrt(1 - c**2) / abs(c)
    if tan == 0:
        return mp.mpf(1)
    b = 1 / (a * tan)
    if b >= mp.mpf("1.6"):
        return mp.mpf(1)
    value = (mp.mpf("3.535") * b + mp.mpf("2.181") * b**2) / (1 + mp.mpf("2.276") * b + mp.mpf("2.577") * b**2)
    return min(value, mp.mpf(1))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def normalize(a):
    length = mp.sqrt(dot(a, a))
    return [x / length for x in a]


def vector(a):
    return [exact(x) for x in a]


def beckmann_bsdf(wo, wi, alpha, ior, color=1.0):
    """color D F G1(wi) G1(wo) / (4 (wi.n)(wo.n)), n = +z, both directions above the surface."""
    wo, wi = normalize(vector(wo)), normalize(vector(wi))
    h = normalize([x + y for x, y in zip(wo, wi, strict=True)])
    g = g1(wi[2], dot(wi, h), alpha) * g1(wo[2], dot(wo, h), alpha)
    return exact(color) * beckmann_d(h[2], alpha) * fresnel(dot(wi, h), ior) * g / (4 * wi[2] * wo[2])


def sphere_hits(origin, direction, radius=1):
    """Return both parameters t of a ray's hits of the sphere |p| = radius, or ()."""
    o, d, r = vector(origin), vector(direction), mp.mpf(radius)
    a, b, c = dot(d, d), dot(o, d), dot(o, o) - r**2
    disc = b**2 - a * c
    if disc < 0:
        return ()
    root = mp.sqrt(disc)
    return (-b - root) / a, (-b + root) / a


def smoothstep(x):
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def rectangle_irradiance(width, height, distance):
    """Return E / L below the centre of a rectangle that faces a parallel plane: four times the corner form factor."""
    a, b = mp.mpf(width) / 2 / distance, mp.mpf(height) / 2 / distance
    u, v = mp.sqrt(1 + a**2), mp.sqrt(1 + b**2)
    return 2 * (a / u * mp.atan(b / u) + b / v * mp.atan(a / v))
