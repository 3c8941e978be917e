"""CLASSIC with lobes that the course does not have, and with lamps of limited ray visibility."""

import dataclasses
import math

import numpy as np
import pytest
import reference
import tiny_scenes
from course import EXACT, classic, color, lamp, mirrored_sky, specular
from tiny_scenes import move, pencil, plane, scale

from addon.bindings.enums import Distribution, LobeKind, Ray, Rules
from addon.bindings.snapshot import Instance, Lobe, Material, Principled, World


def smooth(kind, **fields):
    return Material("smooth", lobes=(Lobe(kind, color=(1, 1, 1), ior=1.5, roughness=0.0, **fields),))


@pytest.mark.parametrize(
    "glass, f",
    [
        (smooth(LobeKind.DIELECTRIC), 0.04),
        (smooth(LobeKind.GLASS), 0.04),
        (smooth(LobeKind.GLASS, rules=Rules.BLENDER_3), 0.04),
        (smooth(LobeKind.REFRACTION), 0.0),
        (smooth(LobeKind.REFRACTION, rules=Rules.BLENDER_3), 0.0),
    ],
)
def test_glass_of_every_kind_shows_what_lies_behind(glass, f):
    """A slab at normal incidence over a red floor under a blue sky: (1 - F)^2 of the floor, F of the sky."""
    floor = Material("floor", lobes=(), emission=(1, 0, 0))
    slab = Instance(kind=3, matrix=scale(100.0, 100.0, 0.5))
    camera = pencil((0.3, 0.0, 3.0), (0.3, 0.0, 0.0))
    snapshot = classic([slab, plane(1, move(z=-5.0))], [glass, floor], camera=camera, max_bounces=2)
    snapshot = dataclasses.replace(snapshot, world=World((0, 0, 1)))
    assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :3], ((1 - f) ** 2, 0, f), rtol=EXACT)


def gloss(roughness):
    distribution = Distribution.ASHIKHMIN_SHIRLEY
    return Lobe(LobeKind.GLOSSY, color=(0.5, 1.0, 0.25), roughness=roughness, distribution=distribution)


def clear_coat(roughness):
    """Return a lobe with only the clearcoat of Blender 3."""
    bare = {"base_color": (0, 0, 0), "specular": 0.0, "coat": 1.0, "coat_roughness": roughness}
    return Lobe(LobeKind.PRINCIPLED, principled=Principled(rules=Rules.BLENDER_3, **bare))


@pytest.mark.parametrize("roughness", [0.0, 0.4])
def test_gloss_and_clear_coat_mirror_the_sky(roughness):
    """Ashikhmin-Shirley reflects its colour; the clearcoat reflects a quarter of F with IOR 1.5."""
    assert np.allclose(mirrored_sky(Material("gloss", lobes=(gloss(roughness),))), (0.5, 2.0, 0.75), rtol=EXACT)
    f = float(reference.fresnel(np.float32(0.8), 1.5))
    got = mirrored_sky(Material("coat", lobes=(clear_coat(roughness),)))
    assert np.allclose(got, 0.25 * f * np.array([1, 2, 3]), rtol=EXACT)


@pytest.mark.parametrize(
    "lobe",
    [
        Lobe(LobeKind.MIRROR, color=(1, 1, 1)),
        Lobe(LobeKind.GLOSSY, color=(1, 1, 1), roughness=0.0),
        Lobe(LobeKind.GLOSSY, color=(1, 1, 1), roughness=0.0, distribution=Distribution.ASHIKHMIN_SHIRLEY),
    ],
)
def test_mirrors_look_about_their_own_normal(lobe):
    """A mirror with a normal tilted by 0.6 shows a wall at 1.2 from the view; with the surface's normal it would show the sky.
    A weaker mirror with the surface's normal follows the stronger one."""
    tilted = dataclasses.replace(lobe, normal=(math.sin(0.6), 0.0, math.cos(0.6)))
    weaker = dataclasses.replace(lobe, color=(0.25, 0.25, 0.25))
    wall = plane(1, move(x=5.0) @ tiny_scenes.rotate_y(-math.pi / 2))
    glow = Material("glow", lobes=(), emission=(1, 0, 0))
    for lobes, want in (((tilted,), 1.0), ((weaker, tilted), 1.25)):
        material = Material("bumped", lobes=lobes)
        snapshot = classic([plane(), wall], [material, glow], camera=pencil((0, 0, 3)), max_bounces=1)
        snapshot = dataclasses.replace(snapshot, world=World((0, 0, 1)))
        assert np.allclose(tiny_scenes.render(snapshot)[0, 0, :3], (want, 0, 0), rtol=EXACT)


@pytest.mark.parametrize("glossy", [specular(LobeKind.PHONG, 10.0), specular(LobeKind.BLINN_PHONG, 10.0)])
def test_a_lamp_may_be_hidden_from_a_part(glossy):
    """A lamp hidden from diffuse rays gives only the highlight; from glossy rays only diffuse light; from others all."""
    alone = [dataclasses.replace(glossy, lobes=(lobe,)) for lobe in glossy.lobes]
    place = (-2.5, 0.6, 4.0)
    diffuse, shine = (color([plane()], [material], [lamp(place)]) for material in alone)

    def lit(hidden):
        return color([plane()], [glossy], [lamp(place, hidden_from=int(hidden))])

    assert np.array_equal(lit(Ray.DIFFUSE), shine) and np.array_equal(lit(Ray.GLOSSY), diffuse)
    assert np.all(lit(Ray.DIFFUSE | Ray.GLOSSY) == 0.0)
    assert np.allclose(lit(Ray.CAMERA | Ray.TRANSMISSION), diffuse + shine, rtol=EXACT) and np.all(shine > 0.0)
