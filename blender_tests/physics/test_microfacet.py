"""The course's terms D, F, G1, Smith and the whole BSDF against 50 digits."""

import numpy as np
import pytest
import reference
import tiny_scenes

from addon.bindings.session import Scene, microfacet

# The reference uses the exact float32 inputs, so that only the evaluation differs: a dozen float32 operations of 6e-8 each stay
# below 1e-6, and exp(-x) adds x times the relative error of its argument.
ALPHAS = [2e-5, 1e-4, 1e-3, 0.01, 0.1, 0.3, 0.7, 1.0]
IORS = [1.0 + 2.0**-23, 1.0 + 2.0**-20, 1.001, 1.33, 1.5, 2.4, 1e9, 3e19, 0.9, 0.6, 1.0 - 2.0**-20]
COSINES = [1.0, 0.999, 0.9, 0.7071, 0.5, 0.1, 0.01, 1e-3]


def test_beckmann_d(library):
    for alpha in ALPHAS:
        # Angles with a significant value: tan from 0 to 3 alpha, as cosines that are distinct in float32.
        tangents = alpha * np.array([0.0, 0.3, 0.7, 1.0, 1.5, 2.0, 3.0])
        cosines = (1.0 / np.sqrt(1.0 + tangents**2)).astype(np.float32)
        d, _, _ = microfacet(cosines, 1.0, 1.0, alpha, 1.5, library=library)
        for c, got in zip(cosines, d, strict=True):
            want = reference.beckmann_d(c, np.float32(alpha))
            # The probe takes cosines: tan^2 = (1 - c)(1 + c)/c^2 has a few roundings, multiplied by tan^2/alpha^2.
            exponent = float((1 - float(c) ** 2) / float(c) ** 2 / float(np.float32(alpha)) ** 2)
            assert abs(got - want) <= (1e-6 + 1e-6 * exponent) * want, (alpha, c, got, want)


def test_beckmann_d_is_zero_behind(library):
    d, _, _ = microfacet([0.0, -0.1, -1.0], 1.0, 1.0, 0.3, 1.5, library=library)
    assert list(d) == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("ior", IORS)
def test_fresnel(library, ior):
    _, f, _ = microfacet(1.0, COSINES, 1.0, 0.3, ior, library=library)
    for c, got in zip(COSINES, f, strict=True):
        want = reference.fresnel(np.float32(c), np.float32(ior))
        # Below IOR 1 the critical angle is near, where F' is infinite: the rounding is amplified tenfold.
        limit = 1e-6 if ior >= 1.0 else 1e-5
        assert abs(got - want) <= limit * want, (ior, c, got, want)


def test_fresnel_at_the_ends(library):
    _, f, _ = microfacet(1.0, [1.0, 0.5, 1e-3], 1.0, 0.3, np.inf, library=library)
    assert list(f) == [1.0, 1.0, 1.0]
    _, f, _ = microfacet(1.0, [1.0, 0.5, 1e-3], 1.0, 0.3, 1.0, library=library)
    assert list(f) == [0.0, 0.0, 0.0]
    # Beyond the critical angle of 0.6: sin > 0.6.
    _, f, _ = microfacet(1.0, [0.79, 0.1], 1.0, 0.3, 0.6, library=library)
    assert list(f) == [1.0, 1.0]


def test_g1(library):
    for alpha in ALPHAS:
        _, _, got = microfacet(1.0, 1.0, COSINES, alpha, 1.5, library=library)
        for c, value in zip(COSINES, got, strict=True):
            want = reference.g1(np.float32(c), 1.0, np.float32(alpha))
            assert abs(value - want) <= 2e-6 * want, (alpha, c, value, want)
            assert value <= 1.0


def test_g1_at_its_seams(library):
    # For b = 1/(alpha tan) >= 1.6 the term is 1; just below, the rational form itself would exceed 1.
    alpha = np.float32(0.5)
    for b in (1.5999, 1.59, 1.6001):
        c = np.float32(np.cos(np.arctan(1.0 / (b * 0.5))))
        _, _, got = microfacet(1.0, 1.0, c, alpha, 1.5, library=library)
        assert got[0] <= 1.0 and abs(got[0] - reference.g1(c, 1.0, alpha)) <= 2e-6, b
    assert microfacet(1.0, 1.0, [0.0, -0.5], alpha, 1.5, library=library)[2].tolist() == [0.0, 0.0]


def directions(count, seed):
    rng = np.random.default_rng(seed)
    cosine, phi = rng.uniform(0.05, 1.0, count), rng.uniform(0, 2 * np.pi, count)
    sine = np.sqrt(1 - cosine**2)
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=1).astype(np.float32)


@pytest.mark.parametrize("alpha, ior", [(0.05, 1.5), (0.1, 1.33), (0.3, 1.5), (0.5, 2.4), (0.7, 1.0001), (1.0, 3.0)])
def test_whole_bsdf(library, alpha, ior):
    """Kd/pi + Ks D F G / (4 (l.n)(v.n))."""
    lobes = tiny_scenes.lambert(0.25).lobes + tiny_scenes.beckmann(0.75, alpha, ior).lobes
    material = tiny_scenes.Material("lab", lobes=lobes)
    with Scene.upload(tiny_scenes.scene([], [material]), library) as scene:
        wo, wi = directions(200, 1), directions(200, 2)
        # Choose half of the pairs near the mirror direction.
        wi[::2] = wo[::2] * [-1, -1, 1] + np.random.default_rng(3).normal(0, alpha / 3, (100, 3))
        wi[:, 2] = np.abs(wi[:, 2])
        wi /= np.linalg.norm(wi, axis=1, keepdims=True)
        wi = wi.astype(np.float32)
        f, _ = scene.bsdf(0, wo, wi)
    for o, i, got in zip(wo, wi, f[:, 0], strict=True):
        want = 0.25 / reference.mp.pi + reference.beckmann_bsdf(o, i, np.float32(alpha), np.float32(ior), 0.75)
        # h of float32 directions has an error of 1e-7 / |wo + wi|, which D amplifies by 2 tan/alpha^2 per unit of slope.
        h = reference.normalize([a + b for a, b in zip(reference.vector(o), reference.vector(i), strict=True)])
        tangent = float(reference.mp.sqrt(1 - h[2] ** 2) / h[2])
        sensitivity = 2e-7 / float(np.linalg.norm(o.astype(float) + i)) / float(h[2]) ** 2 * 2 * (tangent / alpha**2 + 2)
        assert abs(got - want) <= (4e-6 + 4 * sensitivity) * float(want), (o, i, got, want)


def test_the_reference_itself():
    """Values known in closed form: D(1) = 1/(pi alpha^2), F(1) = ((n-1)/(n+1))^2, G1 = 1 at normal incidence."""
    assert abs(reference.beckmann_d(1.0, 0.5) - 4 / reference.mp.pi) < 1e-40
    assert abs(reference.fresnel(1.0, 1.5) - reference.mp.mpf(1) / 25) < 1e-40
    assert reference.fresnel(0.1, 0.5) == 1
    assert reference.g1(1.0, 1.0, 0.5) == 1
    # Brewster: at tan = n the parallel part vanishes and F is half of the other, ((n^2-1)/(n^2+1))^2.
    n = reference.mp.mpf("1.5")
    brewster = 1 / reference.mp.sqrt(1 + n**2)
    assert abs(reference.fresnel(brewster, n) - ((n**2 - 1) / (n**2 + 1)) ** 2 / 2) < 1e-40
