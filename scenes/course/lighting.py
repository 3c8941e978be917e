"""Local illumination: the models of the texts, the lamps and their attenuation."""

import dataclasses
import math

import numpy as np
import reference
import tiny_scenes
from tiny_scenes import lambert, move, plane, rgb, rotate_x, sphere

from addon.bindings.abi import Falloff, LightKind, LobeKind
from addon.bindings.session import Scene, microfacet
from addon.bindings.snapshot import Light, Lobe, Material, World

from . import studio
from .chapter import Figure, Picture, worst
from .studio import LAMP, SINGLE, SINGLE_WHY, classic, lamp

_KD, _KS = np.array((0.5, 0.25, 0.125)), np.array((0.25, 0.5, 1.0))


def _unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def _dot(a, b):
    return np.sum(a * b, axis=-1, keepdims=True)


class Lit:
    """The pixels of the plane z = 0 under one lamp: unit vectors to lamp and eye, h between them, and lc = I / d²."""

    def __init__(self, shot, intensity=9.0, place=LAMP):
        points, self.v = studio.seen_on_plane(shot)
        way = np.asarray(place) - points
        self.d = np.linalg.norm(way, axis=-1, keepdims=True)
        self.l, self.lc = way / self.d, intensity / self.d**2
        self.h = _unit(self.l + self.v)

    @property
    def cosine(self):
        return self.l[..., 2:]

    def mirrored(self):
        """Returns R·v, R the lamp's direction mirrored at the plane."""
        return _dot(self.l * np.array([-1.0, -1.0, 1.0]), self.v)


def _power(cosine, n):
    return np.maximum(cosine, 0.0) ** n


def _facets(s, alpha, ior):
    """Returns D F G / (4 (l·n)(v·n)) at 50 digits."""
    value = np.vectorize(lambda wo, wi: float(reference.beckmann_bsdf(wo, wi, alpha, ior)), signature="(3),(3)->()")
    return value(s.v, s.l)[..., None]


def minnaert_f(color, k, *cosines):
    """Returns f of lancer.h: below k = 1, cosines are clamped to the one at which all light is reflected."""
    color = np.asarray(color, float)
    least = color.max() ** (1 / (1 - k)) if k < 1 else 0.0
    q = least ** (k + 1)
    scale = 2 * math.pi * ((1 - q) / (k + 1) + q / 2)
    return color / scale * math.prod(np.maximum(cosine, least) for cosine in cosines) ** (k - 1)


_FORMULAS = {
    LobeKind.LAMBERT: lambda s: s.cosine / math.pi,
    LobeKind.BECKMANN: lambda s, roughness=0.5, ior=1.5: _facets(s, roughness, ior) * s.cosine,
    LobeKind.PHONG: lambda s, shininess=50.0: _power(s.mirrored(), shininess) / math.pi,
    LobeKind.BLINN_PHONG: lambda s, shininess=50.0: _power(s.h[..., 2:], shininess) / math.pi,
}


def light_of(kind, s, color=(0.8, 0.8, 0.8), **values):
    """Returns the light of the lamp that a lobe reflects towards the eye by the texts' formula; values: as those of a Lobe."""
    if kind == LobeKind.MINNAERT:
        return minnaert_f(color, values.get("shininess", 50.0), s.cosine, s.v[..., 2:]) * s.cosine * s.lc
    return np.asarray(color) * _FORMULAS[kind](s, **values) * s.lc


def _two(kind, **values):
    """Returns a material of a matt body and a lobe."""
    return Material("course", lobes=(Lobe(color=tuple(_KD)), Lobe(kind, color=tuple(_KS), **values)))


def _one(kind, **values):
    return Material("course", lobes=(Lobe(kind, color=tuple(_KD), **values),))


def _ball(material, world=0.0):
    camera = studio.perspective((0.0, -5.0, 0.8), (0, 0, 0), 160, 0.25)
    lights = [lamp((-3.0, -4.0, 4.0), 60.0)]
    return studio.render(classic([sphere()], [material], lights, world=world, camera=camera, samples=16, max_bounces=0))


def _deviation(material):
    """Returns the largest relative deviation of the plane's pixels from the sum of the lobes' formulas."""
    shot = classic([plane()], [material], [lamp()], max_bounces=0)
    lit = Lit(shot)
    wanted = {LobeKind.BECKMANN: ("roughness", "ior"), LobeKind.LAMBERT: ()}
    want = 0.0
    for lobe in material.lobes:
        values = {name: getattr(lobe, name) for name in wanted.get(lobe.kind, ("shininess",))}
        want = want + light_of(lobe.kind, lit, lobe.color, **values)
    return worst(studio.render(shot)[..., :3], want)


def models(quick):
    what = "Lambert: largest relative deviation of 256 pixels from Kd/π (l·n) lc"
    figures = [Figure.at_most(what, _deviation(_one(LobeKind.LAMBERT)), SINGLE, SINGLE_WHY)]
    pictures = [Picture("lambert", "Kd alone", _ball(_one(LobeKind.LAMBERT)), 0.6)]
    for kind, name in ((LobeKind.PHONG, "Phong"), (LobeKind.BLINN_PHONG, "Blinn-Phong")):
        for n in (5.0, 50.0, 500.0):
            material = _two(kind, shininess=n)
            what = f"{name}, n = {n:.0f}: largest relative deviation from (Kd (l·n) + Ks cosⁿ) lc/π"
            why = "n times the rounding of a cosine in the power"
            figures.append(Figure.at_most(what, _deviation(material), SINGLE + 3e-7 * n, why))
            if n != 5.0:
                pictures.append(Picture(f"{name}-{n:.0f}", f"{name}, n = {n:.0f}", _ball(material), 0.6))
    return figures, pictures


def facets(quick):
    figures = []
    alphas, cosines = np.float32([0.001, 0.01, 0.1, 0.3, 0.7]), np.float32([1.0, 0.999, 0.9, 0.7, 0.5, 0.1, 0.01])
    terms = {"D": 0.0, "F": 0.0, "G1": 0.0}
    for alpha in alphas:
        # Angles at which the lobe is not negligible.
        at = np.float32(1.0 / np.sqrt(1.0 + (alpha * np.array([0.0, 0.5, 1.0, 2.0])) ** 2))
        d = microfacet(at, 1.0, 1.0, alpha, 1.5)[0]
        # tan² from a cosine has the cosine's rounding errors, (1 - c)/2^-24 of them, times tan²/alpha².
        want = np.array([float(reference.beckmann_d(c, alpha)) for c in at])
        terms["D"] = max(terms["D"], worst(d, want))
        g = microfacet(1.0, 1.0, cosines, alpha, 1.5)[2]
        terms["G1"] = max(terms["G1"], worst(g, [float(reference.g1(c, 1.0, alpha)) for c in cosines]))
    for ior in np.float32([1.001, 1.33, 1.5, 2.4]):
        f = microfacet(1.0, cosines, 1.0, 0.3, ior)[1]
        terms["F"] = max(terms["F"], worst(f, [float(reference.fresnel(c, ior)) for c in cosines]))
    limits = {"D": 5e-6, "F": 1e-6, "G1": 2e-6}
    for name, error in terms.items():
        why = "a dozen operations in single precision" + (", four times that in the exponent" if name == "D" else "")
        figures.append(Figure.at_most(f"{name}: largest relative deviation from 50 digits", error, limits[name], why))
    for alpha, ior in ((0.05, 1.5), (0.3, 1.33), (0.7, 2.0)):
        alpha = float(np.float32(alpha))
        # D amplifies the rounding error of h by 2 tan/alpha²; tan reaches 0.9 on the visible part of the plane.
        limit = SINGLE + 4e-7 * (1 + 0.9 / alpha**2)
        what = f"Kd Ks, α = {alpha:.2g}, IOR {ior}: largest relative deviation of 256 pixels"
        error = _deviation(_two(LobeKind.BECKMANN, roughness=alpha, ior=float(np.float32(ior))))
        figures.append(Figure.at_most(what, error, limit, "h in single precision, on which D depends by 2 tan θ/α²"))
    figures.append(_energy())
    shown = [(0.5, 1.5), (0.2, 1.5), (0.05, 1.5), (0.2, 3.0)]
    pictures = tuple(
        Picture(
            f"{alpha}-{ior}",
            f"α = {alpha}, IOR {ior}",
            _ball(_two(LobeKind.BECKMANN, roughness=alpha, ior=ior)),
            0.6,
        )
        for alpha, ior in shown
    )
    return tuple(figures), pictures


def _energy():
    """Returns the albedo of the layer under a uniform white sky, from the weights of samples; it must be at most 1."""
    rng = np.random.default_rng(2)
    u = rng.random((20000, 3))
    most = 0.0
    material = Material("layer", lobes=(Lobe(LobeKind.BECKMANN, color=(1, 1, 1), roughness=0.3, ior=1.5),))
    with Scene.upload(tiny_scenes.scene([plane()], [material])) as scene:
        for z in (1.0, 0.5, 0.1):
            samples = scene.bsdf_sample(0, (math.sqrt(1 - z * z), 0.0, z), u)
            most = max(most, float(np.mean(samples.weight[:, 0])))
    return Figure.at_most("largest share of light that the layer reflects, at 0°, 60° and 84°", most, 1.0, "no gain of energy")


def minnaert(quick):
    figures, pictures = [], []
    for k in (0.5, 1.0, 1.5, 3.0):
        material = _one(LobeKind.MINNAERT, shininess=k)
        what = f"k = {k:g}: largest relative deviation of 256 pixels"
        limit, why = SINGLE * (1 + abs(k - 1)), "the power of a cosine in single precision"
        figures.append(Figure.at_most(what, _deviation(material), limit, why))
        pictures.append(Picture(f"k{k:g}", f"k = {k:g}", _ball(material), 0.6))
    return figures, pictures


_ATTENUATIONS = {
    Falloff.PHYSICAL: ("1/d²", lambda d, r: 1 / d**2),
    Falloff.CONSTANT: ("1", lambda d, r: 1.0),
    Falloff.LINEAR: ("max(0, 1 - d/r)", lambda d, r: max(0.0, 1 - d / r)),
    Falloff.QUADRATIC: ("max(0, 1 - d²/r²)", lambda d, r: max(0.0, 1 - d**2 / r**2)),
    Falloff.SMOOTH: ("max(0, 1 - d²/r²)²", lambda d, r: max(0.0, 1 - d**2 / r**2) ** 2),
    Falloff.GAUSSIAN: ("exp(-d²/r²)", lambda d, r: math.exp(-(d**2) / r**2)),
}


def _middle(lights, material=None, **settings):
    """Returns the pixel at the middle of the plane."""
    shot = classic([plane()], [material or lambert()], lights, camera=tiny_scenes.pencil((3, 0, 4)), **settings)
    return studio.render(shot)[0, 0, :3]


def lamps(quick):
    figures = []
    for falloff, (text, formula) in _ATTENUATIONS.items():
        light = Light("lamp", move(z=0.0), LightKind.POINT, emission=rgb(6.0), falloff=falloff, falloff_radius=4.0)
        got = [_middle([dataclasses.replace(light, matrix=move(z=d))])[0] for d in (0.5, 1.0, 2.0, 3.5, 5.0)]
        want = [6.0 / math.pi * formula(d, 4.0) for d in (0.5, 1.0, 2.0, 3.5, 5.0)]
        what = f"attenuation {text}: largest relative deviation at five distances"
        figures.append(Figure.at_most(what, worst(got, want), 1e-5, "1 - d/r has lost a digit at d = 3.5, r = 4"))
    half, blend, height = 0.4, 0.5, 5.0
    cone = Light("spot", move(), LightKind.SPOT, emission=rgb(7.0), spot_angle=2 * half, spot_blend=blend)
    got, want = [], []
    for angle in (0.0, 0.2, 0.3, 0.38, 0.42):
        place = (height * math.tan(angle), 0.0, height)
        got.append(_middle([dataclasses.replace(cone, matrix=move(*place))])[0])
        edge = reference.smoothstep((math.cos(angle) - math.cos(half)) / ((1 - math.cos(half)) * blend))
        want.append(7.0 * edge * (math.cos(angle) / height) ** 2 * math.cos(angle) / math.pi)
    why = "the cosine in single precision over an edge that is 0.04 wide"
    figures.append(Figure.at_most("spot: largest relative deviation at five angles", worst(got, want), 2e-5, why))
    sun = Light("sun", rotate_x(math.acos(0.5)), LightKind.SUN, emission=(2, 4, 6))
    error = worst(_middle([sun]), np.array([2, 4, 6]) * 0.5 / math.pi)
    figures.append(Figure.at_most("sun at 60°: largest relative deviation from Kd/π E cos 60°", error, SINGLE, SINGLE_WHY))
    several = [lamp(), lamp((0, 0, 2.0), 4.0), lamp((2, -1, 3.0), (1.0, 2.0, 8.0))]
    together, alone = _middle(several), sum(_middle([light]) for light in several)
    what = "three lamps: largest relative deviation from the sum of one at a time"
    figures.append(Figure.at_most(what, worst(together, alone), SINGLE, SINGLE_WHY))
    stripes = [studio.render(_corridor(falloff)) for falloff in (Falloff.PHYSICAL, Falloff.LINEAR, Falloff.GAUSSIAN)]
    return tuple(figures), (
        Picture("attenuation", "A wall along which a lamp hangs: physical, linear, bell curve", studio.beside(*stripes), 0.5),
        Picture("spot", "A spot, its edge half soft", studio.render(_stage(cone)), 0.12),
    )


def _corridor(falloff):
    light = Light("lamp", move(0, 0, 0.5), LightKind.POINT, emission=rgb(1.0), falloff=falloff, falloff_radius=2.0)
    return classic([plane()], [lambert(0.8)], [light], camera=studio.parallel((0, 0, 4.0), width=5.0, pixels=100))


def _stage(cone):
    light = dataclasses.replace(cone, matrix=move(0, 0, 5.0))
    camera = studio.perspective((0, -8, 6), (0, 0, 0), 160, 0.35)
    return classic([plane(), sphere(0, move(0.8, 0, 0.6) @ tiny_scenes.scale(0.6))], [lambert(0.8)], [light], camera=camera)


def ambient(quick):
    ka, sky = (0.5, 0.25, 1.0), (0.1, 0.2, 0.4)
    material = Material("ambient", lobes=(), ambient=ka)

    def seen(lights, world):
        """Returns the middle of the plane below a ball, which blocks the lamp."""
        shot = classic([plane(), sphere(1, move(z=9.0))], [material, lambert()], lights, camera=tiny_scenes.pencil((3, 0, 4)))
        return studio.render(dataclasses.replace(shot, world=world))[0, 0, :3]

    one = World(sky, ambient=(0.3, 0.2, 0.1))
    silent = {"ambient_color": (0.0, 0.0, 0.0)}
    term = worst(seen([], one), np.multiply(ka, one.ambient))
    moved = np.abs(seen([lamp((0, 0, 20.0), **silent)], one) - seen([lamp((5, 1, 30.0), 90.0, **silent)], one)).max()
    tinted = (1.0, 0.5, 0.0)
    lamps_own = worst(
        seen([lamp((0, 0, 20.0), ambient_color=tinted)], World()), np.multiply(ka, tinted) * 9.0 / 400.0 / math.pi
    )
    figures = (
        Figure.at_most("Ka Ia: largest relative deviation of the three channels", term, SINGLE, SINGLE_WHY),
        Figure.near(
            "difference that a lamp's place and power make to it, where no light of the lamp arrives", moved, 0, 0, "Ia alone"
        ),
        Figure.at_most("the sky as Ia: the same", worst(seen([], World(sky)), np.multiply(ka, sky)), SINGLE, SINGLE_WHY),
        Figure.at_most("a lamp's own ambient colour: the same from Ka I_a lc/π", lamps_own, SINGLE, SINGLE_WHY),
    )
    shown = [
        Picture(f"ka{k}", f"Ka = {k}", _ball(Material("ball", lobes=(Lobe(color=tuple(_KD)),), ambient=rgb(k)), world=0.2), 0.8)
        for k in (0.0, 0.2, 0.5)
    ]
    return figures, shown


CHAPTERS = (models, facets, minnaert, ambient, lamps)
