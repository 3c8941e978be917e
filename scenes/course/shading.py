"""From the vertices to the pixel: flat, Gouraud and Phong shading; and colours."""

import dataclasses
import math

import numpy as np
import trimesh
from tiny_scenes import lambert, plane, sphere

from addon.bindings.abi import LobeKind, Shading
from addon.bindings.snapshot import Instance, Lobe, Material, MeshData

from . import studio
from .chapter import Figure, Picture, worst
from .studio import SINGLE, SINGLE_WHY, classic, lamp

_PLACE = np.array((0.5, 0.25, 3.0))
_TILTED = MeshData(
    "tilted",
    [(-1, -1, 0), (2, -1, 0), (-1, 2, 0)],
    [(0, 1, 2)],
    normals=np.float32([(0.6, 0, 0.8), (0, 0, 1), (0, -0.6, 0.8)]),
)
_COARSE = MeshData.from_trimesh(trimesh.creation.uv_sphere(count=(8, 16)), "ball")
_COARSE = dataclasses.replace(_COARSE, normals=_COARSE.positions)
_SHINY = Material("shiny", lobes=(Lobe(color=(0.5, 0.1, 0.05)), Lobe(LobeKind.PHONG, color=(1, 1, 1), shininess=30.0)))


def _lit(points, normals):
    """Returns Lambert's law for albedo 1 under a lamp of intensity 9."""
    way = _PLACE - points
    distance = np.linalg.norm(way, axis=-1)
    return np.maximum(np.sum(way * normals, axis=-1) / distance, 0.0) * 9.0 / distance**2 / math.pi


def _triangle(shading):
    """Returns the picture of one triangle with a different normal at each corner, and the places of its pixels."""
    camera = studio.parallel((0.0, 0.0, 5.0), width=4.0, pixels=32)
    shot = classic([Instance(shading=shading)], [lambert()], [lamp(_PLACE)], [_TILTED], camera=camera)
    points, _ = studio.seen_on_plane(shot)
    weights = np.stack(
        [1 - (points[..., 0] + points[..., 1] + 2) / 3, (points[..., 0] + 1) / 3, (points[..., 1] + 1) / 3], axis=-1
    )
    return studio.render(shot)[..., 0], points, weights, np.all(weights > 0.0, axis=-1)


def shading(quick):
    corners, normals = _TILTED.positions.astype(float), _TILTED.normals.astype(float)
    figures = []
    face = np.array([0.0, 0.0, 1.0])
    for kind, name in ((Shading.FLAT, "flat"), (Shading.GOURAUD, "Gouraud"), (Shading.PHONG, "Phong")):
        picture, points, weights, inside = _triangle(kind)
        if kind == Shading.FLAT:
            want, text = np.full(points.shape[:2], _lit(corners.mean(axis=0), face)), "the colour at the triangle's centre"
        elif kind == Shading.GOURAUD:
            want, text = weights @ _lit(corners, normals), "the colours of the corners, interpolated"
        else:
            n = weights @ normals
            want, text = _lit(points, n / np.linalg.norm(n, axis=-1, keepdims=True)), "the colour of the interpolated normal"
        what = f"{name}: largest relative deviation of {int(inside.sum())} pixels from {text}"
        figures.append(Figure.at_most(what, worst(picture[inside], want[inside]), 1e-5, "normals in single precision"))
    pictures, errors = [], {}
    truth = _ball(None)
    for kind, name in ((Shading.FLAT, "Flat"), (Shading.GOURAUD, "Gouraud"), (Shading.PHONG, "Phong")):
        picture = _ball(kind)
        errors[name] = float(np.sqrt(np.mean((picture - truth)[..., :3] ** 2)))
        pictures.append(Picture(name, f"{name}: a ball of {len(_COARSE.triangles)} triangles", picture, 0.8))
    for better, worse in (("Gouraud", "Flat"), ("Phong", "Gouraud")):
        what = f"the ball beside the exact one: error of {better} over that of {worse}"
        figures.append(Figure.at_most(what, errors[better] / errors[worse], 1.0, "the slides' order of the three"))
    return tuple(figures), (*pictures, Picture("exact", "The exact sphere", truth, 0.8))


def _ball(shading):
    """Returns a coarse ball with the sphere's normals, or for None the exact sphere."""
    camera = studio.perspective((0.0, -5.0, 0.8), (0, 0, 0), 160, 0.25)
    thing = sphere() if shading is None else Instance(shading=shading)
    return studio.render(classic([thing], [_SHINY], [lamp((-3, -4, 4), 60.0)], [_COARSE], camera=camera))


def colors(quick):
    figures = []
    kd, lc = np.array((0.5, 0.25, 1.0)), np.array((9.0, 18.0, 27.0))
    alone = []
    for channel in range(3):
        light = lamp(intensity=np.where(np.arange(3) == channel, lc, 0.0))
        alone.append(_pixel(lambert(kd), light))
    together = _pixel(lambert(kd), lamp(intensity=lc))
    others = max(float(np.abs(np.delete(color, channel)).max()) for channel, color in enumerate(alone))
    figures.append(
        Figure.near("a red, a green and a blue lamp: light in the channels that are not theirs", others, 0, 0, "each by itself")
    )
    error = worst(together, sum(alone))
    figures.append(Figure.at_most("a white lamp: relative deviation from the sum of the three", error, SINGLE, SINGLE_WHY))
    factors = {"diffuse_color": np.array((1.0, 0.5, 0.0)), "specular_color": np.array((0.25, 1.0, 2.0))}
    shiny = Material("shiny", lobes=(Lobe(color=tuple(kd)), Lobe(LobeKind.PHONG, color=(0.5, 0.25, 1.0), shininess=4.0)))
    parts = [Material("part", lobes=(lobe,)) for lobe in shiny.lobes]
    got = _pixel(shiny, lamp(intensity=lc, **{name: tuple(value) for name, value in factors.items()}))
    want = sum(_pixel(part, lamp(intensity=lc)) * factor for part, factor in zip(parts, factors.values(), strict=True))
    what = "a lamp with colours for diffuse and specular light: relative deviation from I_d Kd (l·n) + I_s Ks (R·v)ⁿ"
    figures.append(Figure.at_most(what, worst(got, want), SINGLE * 2, "single precision"))
    red, green, blue = (lamp((3 * math.cos(a), 3 * math.sin(a), 4.0), np.eye(3)[i] * 30) for i, a in enumerate((1.6, 3.7, 5.8)))
    camera = studio.perspective((0, -6, 4), (0, 0, 0.5), 200, 0.3)
    shown = studio.render(classic([plane(), sphere(0)], [lambert()], [red, green, blue], camera=camera, samples=4))
    return tuple(figures), (Picture("three", "Three lamps, red, green and blue: white where all arrive", shown),)


def _pixel(material, light):
    shot = classic([plane()], [material], [light], camera=studio.parallel(width=1e-6, pixels=1), max_bounces=0)
    return studio.render(shot)[0, 0, :3]


CHAPTERS = (shading, colors)
