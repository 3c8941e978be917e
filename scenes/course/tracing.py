"""Secondary rays: shadows, mirrors, glass, and the end of the recursion."""

import math

import numpy as np
import reference
import tiny_scenes
from tiny_scenes import beckmann, lambert, move, plane, rgb, rotate_x, scale, sphere

from addon.bindings.abi import InstanceKind, Integrator, LightKind, LobeKind
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Light, Lobe, Material, MeshData

from . import studio
from .chapter import Figure, Picture, worst
from .studio import SINGLE, classic, lamp

_GLASS = Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.5),))


def _wrong_shadow(blocker, light, radius, pixels):
    """Returns how many pixels are dark outside of a circle about the origin or lit inside, and how many are dark."""
    # The eye is below the blocker and sees the plane without obstruction.
    camera = studio.parallel((0.5, 0.0, 1.0), width=4.0, pixels=pixels)
    shot = classic([plane(), blocker], [lambert()], [light], camera=camera)
    points, _ = studio.seen_on_plane(shot)
    dark = studio.render(shot)[..., 0] == 0.0
    return int(np.sum(dark != (np.hypot(points[..., 0], points[..., 1]) < radius))), int(dark.sum())


def shadows(quick):
    pixels = 64 if quick else 256
    sun = Light("sun", kind=LightKind.SUN, emission=rgb(1.0))
    by_sun, dark = _wrong_shadow(sphere(0, move(z=9.0)), sun, 1.0, pixels)
    # A lamp at height 10 above a ball of radius r at height 5: the tangent cone's circle in the plane.
    r = 0.5
    by_lamp, _ = _wrong_shadow(sphere(0, move(z=5.0) @ scale(r)), lamp((0, 0, 10.0)), 10 * math.tan(math.asin(r / 5)), pixels)
    figures = [
        Figure.near(
            f"a ball under the sun: pixels of {pixels**2} that are dark outside of its disk, or lit within",
            by_sun,
            0,
            0,
            f"the shadow is a circle of the ball's radius: {dark} pixels",
        ),
        Figure.near(
            "a ball under a lamp: the same for the circle H tan(arcsin(r/(H - h)))",
            by_lamp,
            0,
            0,
            "the cone that touches the ball",
        ),
    ]
    for size in (1e-6, 1.0, 1e6):
        error, count = _acne(size)
        what = f"a ball of radius {size:g}: largest relative deviation of {count} lit pixels from Kd/π (l·n) lc"
        why = "l·n in single precision, from 0.05 up; a shadow of the ball on itself would be a deviation of 1"
        figures.append(Figure.at_most(what, error, 1e-5, why))
    width, height = (160, 120) if quick else (320, 240)
    lab = studio.from_blender("lab", width, height)
    return tuple(figures), (
        Picture("lab", "The course's scene: lamps, shadows, no mirrors", studio.render(lab, max_bounces=0)),
    )


def _acne(size):
    camera = studio.parallel((0, 0, 4.0 * size), width=2.2 * size, pixels=64)
    light = lamp(np.array((0.0, 3.0, 4.0)) * size, size * size)
    shot = classic([sphere(0, scale(size))], [lambert()], [light], camera=camera)
    picture = studio.render(shot)[..., 0]
    points, _ = studio.seen_on_plane(shot)
    x, y = points[..., 0] / size, points[..., 1] / size
    inside = x * x + y * y < 0.99
    normal = np.stack([x, y, np.sqrt(np.where(inside, 1 - x * x - y * y, 1.0))], axis=-1)
    way = np.array((0.0, 3.0, 4.0)) - normal
    distance = np.linalg.norm(way, axis=-1)
    cosine = np.sum(way * normal, axis=-1) / distance
    lit = inside & (cosine > 0.05)
    return worst(picture[lit], (cosine / distance**2 / math.pi)[lit]), int(lit.sum())


def _hall(bounces, **settings):
    """Returns the light between two facing mirrors, each of emission 1 and reflectance 0.5."""
    glow = Material("wall", lobes=(Lobe(LobeKind.MIRROR, color=rgb(0.5)),), emission=rgb(1.0))
    things = [plane(0), plane(0, move(z=2.0) @ rotate_x(math.pi))]
    camera = tiny_scenes.pencil((0, 0, 1.0), (0, 0, 0))
    with Session.upload(classic(things, [glow], camera=camera, max_bounces=bounces, **settings)) as session:
        session.render_all()
        return session.read(0)[0, 0, 0], session.statistics().bounce_rays


def mirrors(quick):
    figures = []
    for bounces in (0, 1, 5, 10):
        value, _ = _hall(bounces)
        what = f"two mirrors of 1/2 that glow by 1, depth {bounces}"
        figures.append(Figure.near(what, value, 2 - 0.5**bounces, SINGLE * 2, "1 + 1/2 + 1/4 + ... up to the depth limit"))
    for threshold, value in ((0.2, 1.75), (0.25, 1.5)):
        got, traced = _hall(10, contribution_threshold=threshold)
        why = "rays whose contribution cannot matter are not traced"
        figures.append(Figure.near(f"the same, contribution threshold {threshold}", got, value, SINGLE * 2, why))
    figures.append(Figure.near("rays traced", traced, 1, 0, "weights 1/2, and 1/4, which is not above the threshold"))
    angles = np.array((1.0, 0.9, 0.7, 0.5, 0.2, 0.05))
    got = [_mirrored(cosine) for cosine in angles]
    want = [float(reference.fresnel(np.float32(cosine), 1.5)) * np.array([0.5, 2.0, 0.75]) for cosine in angles]
    what = "sky in a layer of IOR 1.5 at six angles: largest relative deviation from F Ks"
    figures.append(
        Figure.at_most(what, worst(got, want), 1e-5, "a cosine of 0.05 in single precision, on which F depends by 5")
    )
    width, height = (160, 120) if quick else (320, 240)
    lab = studio.from_blender("lab", width, height)
    return tuple(figures), tuple(
        Picture(f"depth{bounces}", f"Depth {bounces}", studio.render(lab, max_bounces=bounces, samples=4))
        for bounces in (0, 1, 10)
    )


def _mirrored(cosine):
    eye = (5 * math.sqrt(1 - cosine**2), 0.0, 5 * cosine)
    material = beckmann((0.5, 1.0, 0.25), 0.3, 1.5)
    shot = classic([plane()], [material], world=(1, 2, 3), camera=tiny_scenes.pencil(eye))
    return studio.render(shot)[0, 0, :3]


def glass(quick):
    f = 0.04
    figures = []
    slab = Instance(kind=InstanceKind.CYLINDER, matrix=scale(100.0, 100.0, 0.5))
    for bounces, series in ((2, f + (1 - f) ** 2), (4, f + (1 - f) ** 2 * (1 + f + f**2)), (10, 1.0)):
        camera = tiny_scenes.pencil((0.3, 0.0, 3.0), (0.3, 0.0, 0.0))
        value = studio.render(classic([slab], [_GLASS], world=1.0, camera=camera, max_bounces=bounces))[0, 0, 0]
        what = f"a slab of glass before a white sky, depth {bounces}"
        figures.append(Figure.near(what, value, series, SINGLE, "F + (1 - F)² (1 + F + F² + ...), F = 0.04; the sum is 1"))
    figures.append(_snell())
    figures.append(_total())
    pixels = 160 if quick else 320
    shot = tiny_scenes.showroom(pixels, integrator=Integrator.CLASSIC, samples=4, max_bounces=10, passes=(0,))
    return tuple(figures), (Picture("room", "Glass, a mirror, a rough layer, a veil that light passes", studio.render(shot)),)


def _snell():
    """Finds by bisection where a glowing strip appears through a slab, and compares it with the shift by Snell's law."""
    eta, thickness, angle = 1.5, 1.0, 0.7
    inside = math.asin(math.sin(angle) / eta)
    glow = Material("glow", lobes=(), emission=(1, 1, 1))
    # The half-plane from x = 0 on glows.
    strip = MeshData("edge", [(0, -9, 0), (9, -9, 0), (9, 9, 0), (0, 9, 0)], [(0, 1, 2), (0, 2, 3)])
    slab = Instance(kind=InstanceKind.CYLINDER, matrix=scale(100.0, 100.0, thickness / 2))
    camera = tiny_scenes.pencil((-math.sin(angle), 0.0, thickness / 2 + math.cos(angle)), (0, 0, thickness / 2))
    low, high = 0.0, 6.0
    for _ in range(20):
        place = 0.5 * (low + high)
        edge = Instance(mesh=0, matrix=move(place, 0, -thickness / 2 - 2.0), materials=(1,))
        seen = studio.render(classic([slab, edge], [_GLASS, glow], meshes=[strip], camera=camera, max_bounces=2))[0, 0, 0]
        low, high = (place, high) if seen > 0.0 else (low, place)
    expected = thickness * math.tan(inside) + 2.0 * math.tan(angle)
    why = "20 halvings of 6 units, directions in single precision"
    return Figure.near("through a slab at 40°: where the ray arrives", low, expected, 1e-5, why)


def _total():
    """From inside, at 56° where the critical angle is 42°, the reflection of the glowing floor is total."""
    glow = Material("glow", lobes=(), emission=(1, 1, 1))
    camera = tiny_scenes.pencil((0, 0, -1.0), (1.5, 0, 0.0))
    things = [plane(0), plane(1, move(z=-2.0))]
    value = studio.render(classic(things, [_GLASS, glow], world=50.0, camera=camera, max_bounces=3))[0, 0, 0]
    return Figure.near("total reflection: light of a floor of 1, and none of the sky of 50", value, 1.0, SINGLE, "F = 1")


CHAPTERS = (shadows, mirrors, glass)
