"""Principled and the wide lobes against Cycles: exact values under suns, and the albedo under a white sky."""

import json
import math

import blenders
import numpy as np
import principled_specs
import pytest
import tiny_scenes
from blenders import MODULE, PROGRAM
from principled_specs import ANGLES, SUNS

from addon.bindings.session import Scene
from addon.bindings.snapshot import Material

# A third of a percent is invisible. The tables of multiple scattering agree with exact integrals to 0.1 %.
LIMIT = 0.003
SAMPLES = 512


@pytest.fixture(scope="module", params=[MODULE, PROGRAM], ids=["module", "program"])
def materials(request, library, tmp_path_factory):
    """Return the version, the specs, a function that returns the arrays of a Blender case, and a scene with the materials."""
    folder = tmp_path_factory.mktemp("principled")
    version = tuple(blenders.run(request.param, folder, "principled_cases", "version"))
    specs = principled_specs.specs(version)
    asked = folder / "asked.json"
    nodes = [node for _, node, _ in specs]
    asked.write_text(json.dumps({"specs": nodes, "angles": ANGLES, "suns": SUNS, "samples": SAMPLES}))

    def measured(name):
        got = blenders.run(request.param, folder, "principled_cases", name, asked)
        return {key: np.array(values) for key, values in got.items() if key != "console"}

    with Scene.upload(tiny_scenes.scene([], [Material(name, lobes=(lobe,)) for name, _, lobe in specs]), library) as scene:
        yield version, specs, measured, scene


def frame(angle):
    """Return tangent, bitangent and normal of a cell rotated by that angle, as rows; the view is +z."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return np.array([(c, 0.0, -s), (0.0, 1.0, 0.0), (s, 0.0, c)])


def bends(wo, wi, ior):
    """Return (n,) bool: whether a facet can refract wo into wi, or both are on one side. Cycles' evaluation lacks this test and
    returns light for other pairs too."""
    h = -(wo + ior * wi)
    h = h * np.sign(h[:, 2:])
    return (wi[:, 2] > 0.0) | ((h @ wo > 0.0) & ((h * wi).sum(axis=1) < 0.0))


def figures(name, angle, ours, theirs):
    return f"{name}, seen at {angle} degrees: Lancer {np.round(ours, 5).tolist()}, Cycles {np.round(theirs, 5).tolist()}"


def test_suns(materials):
    """Compare f cos of each pair of directions, without noise."""
    version, specs, measured, scene = materials
    got = measured("suns")
    wrong = []
    for i, (name, _, lobe) in enumerate(specs):
        for j, angle in enumerate(ANGLES):
            wo, wi = frame(angle) @ (0.0, 0.0, 1.0), np.array(SUNS) @ frame(angle).T
            f, _ = scene.bsdf(i, wo, wi)
            emission = scene.lobes(i, wo)[1]
            possible = bends(wo, wi, lobe.principled.ior if lobe.principled else 1.0)
            ours, theirs = f * np.abs(wi[:, 2:]) + emission, got["sun"][:, i, j]
            # In dark directions the limit is relative to 10 % of the brightest direction, or 1 % of white.
            scale = np.maximum(theirs, max(0.1 * theirs.max(), 0.01))
            allowed = LIMIT * scale
            if np.any((np.abs(ours - theirs) > allowed)[possible]):
                wrong.append(figures(name, angle, ours[possible], theirs[possible]))
    assert not wrong, f"{len(wrong)} of {len(specs) * len(ANGLES)} in Blender {version}\n" + "\n".join(wrong[:20])


def has_honest_sampler(version, lobe):
    """Whether Cycles' sampler of the lobe matches its pdf. It does not for Ashikhmin-Shirley, which keeps back-facing half
    vectors, and for the coat of 3.x, which samples another distribution: their light from a sky is not the integral of f."""
    if lobe.principled:
        return version >= (4, 0) or lobe.principled.coat == 0.0
    return lobe.distribution.name != "ASHIKHMIN_SHIRLEY"


def white_sky(scene, material, wo):
    """Return the mean weight of samples and its standard error, from shifts of a three-dimensional lattice by powers of the
    generalised golden ratio (x^4 = x + 1)."""
    step = 1.2207440846057596 ** -np.arange(1.0, 4.0)
    grid = np.outer(np.arange(8192), step)
    means = []
    for shift in np.random.default_rng(1).random((16, 3)):
        u = np.minimum((grid + shift) % 1.0, 1.0 - 2.0**-24)
        means.append(scene.bsdf_sample(material, wo, u).weight.mean(axis=0, dtype=np.float64))
    return np.mean(means, axis=0), np.std(means, axis=0, ddof=1) / math.sqrt(len(means))


@pytest.mark.slow
def test_sky(materials):
    """Compare the light that a surface reflects to the viewer under a white sky."""
    version, specs, measured, scene = materials
    got = measured("sky")
    wrong, noise = [], []
    for i, (name, _, lobe) in enumerate(specs):
        if not has_honest_sampler(version, lobe):
            continue
        for j, angle in enumerate(ANGLES):
            wo = frame(angle) @ (0.0, 0.0, 1.0)
            ours, error = white_sky(scene, i, wo)
            ours += scene.lobes(i, wo)[1]
            theirs, error = got["sky"][i, j], np.hypot(error, got["noise"][i, j])
            noise.append(error / np.maximum(theirs, 0.1))
            # A value lies beyond 4 standard errors with probability 1/16000: with LIMIT added none of 1500 does.
            if np.any(np.abs(ours - theirs) > LIMIT * np.maximum(theirs, 0.1) + 4.0 * error):
                wrong.append(figures(name, angle, ours, theirs))
    # The noise must be small enough for the limit.
    assert np.percentile(noise, 95) < LIMIT / 2
    assert not wrong, f"{len(wrong)} of {len(specs) * len(ANGLES)} in Blender {version}\n" + "\n".join(wrong[:20])
