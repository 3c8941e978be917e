"""Tests of every lobe through the probes: sampler against pdf, integral of the pdf, reciprocity, energy, sides."""

import numpy as np
import pytest
import tiny_scenes
from charts import Half, Power, Slopes, Sphere, histogram, integrate_cells, unit
from significance import LEVEL, chi_square, mean_and_error, midpoints, sidak, uniforms, z_test

from addon.bindings.abi import LobeKind
from addon.bindings.session import Scene
from addon.bindings.snapshot import Lobe, Material

COSINES = [1.0, 0.9, 0.5, 0.1, 0.01]
ALPHAS = [1e-4, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.7, 1.0]
EXPONENTS = [0.0, 1.0, 10.0, 200.0, 1e4]


def lobe(kind, **fields):
    return Material(kind.name, lobes=(Lobe(kind, **({"color": (1, 1, 1)} | fields)),))


MATERIALS = (
    [tiny_scenes.lambert(1.0)]
    + [lobe(LobeKind.BECKMANN, roughness=a, ior=np.inf) for a in ALPHAS]
    + [lobe(LobeKind.BECKMANN, roughness=a, ior=1.5) for a in (0.1, 0.5)]
    + [lobe(LobeKind.PHONG, shininess=n) for n in EXPONENTS]
    + [lobe(LobeKind.BLINN_PHONG, shininess=n) for n in EXPONENTS]
    + [lobe(LobeKind.MINNAERT, shininess=k, color=(0.4, 0.2, 0.1)) for k in (0.0, 0.5, 2.0, 30.0)]
    + [
        Material("mixed", lobes=(Lobe(color=(0.5, 0.2, 0.1)), Lobe(LobeKind.BECKMANN, color=(1, 1, 1), roughness=0.3))),
        Material("three", lobes=(Lobe(), Lobe(LobeKind.PHONG, shininess=5.0), Lobe(LobeKind.BLINN_PHONG, shininess=9.0))),
        Material("with mirror", lobes=(Lobe(), Lobe(LobeKind.MIRROR, color=(0.5, 0.5, 0.5)))),
    ]
)
NAMES = [
    f"{m.name}-{m.lobes[-1].roughness if 'BECK' in m.name else m.lobes[-1].shininess}-{m.lobes[-1].ior}" for m in MATERIALS
]
SMOOTH = range(len(MATERIALS))


@pytest.fixture(scope="module")
def scene(library):
    extra = [lobe(LobeKind.MIRROR), lobe(LobeKind.DIELECTRIC, ior=1.5), lobe(LobeKind.DIELECTRIC, ior=1.0)]
    with Scene.upload(tiny_scenes.scene([], list(MATERIALS) + extra), library) as scene:
        yield scene


def direction(cosine, phi=0.7):
    sine = np.sqrt(1.0 - cosine * cosine)
    return np.array([sine * np.cos(phi), sine * np.sin(phi), cosine], np.float32)


def chart_of(material, wo):
    """Return a chart in which the material's pdf from wo is smooth."""
    side = np.sign(wo[2])
    only = material.lobes[0] if len(material.lobes) == 1 else None
    if only is None:
        return Sphere((0, 0, side), 0.0, 3.0)
    if only.kind == LobeKind.LAMBERT:
        return Sphere((0, 0, side), 0.0)
    if only.kind == LobeKind.BECKMANN:
        return Half(wo.astype(float), Slopes(only.roughness, side))
    if only.kind == LobeKind.PHONG:
        return Power(wo * [-1, -1, 1], only.shininess)
    if only.kind == LobeKind.MINNAERT:
        return Power((0, 0, side), only.shininess)
    return Half(wo.astype(float), Power((0, 0, side), only.shininess))


def resolvable(material, wo):
    """Whether the histogram can resolve this lobe from wo.

    Half vectors of float32 directions have an error of 6e-8/|wo + wi|, cells are 0.1 alpha wide. At grazing angles the horizon
    cuts a Phong lobe along its axis, and a rough lobe is a needle in the hemisphere's chart: quadrature by cells fails.
    """
    only = material.lobes[0]
    if only.kind == LobeKind.PHONG or len(material.lobes) > 1:
        return abs(wo[2]) > 0.05
    return only.kind != LobeKind.BECKMANN or 6e-8 / (2 * abs(wo[2])) < 0.005 * only.roughness


@pytest.mark.parametrize("index", SMOOTH, ids=NAMES)
def test_chi_square_of_the_sampler_against_its_pdf(scene, index):
    material, count, cells = MATERIALS[index], 100000, 12
    wos = [direction(c) for c in COSINES] + [direction(-0.6)]
    for number, wo in enumerate(wos):
        wo = unit(wo.astype(float)).astype(np.float32)
        if not resolvable(material, wo):
            continue
        samples = scene.bsdf_sample(index, wo, uniforms(count, 3, 100 * index + number))
        smooth = (samples.pdf > 0) & (samples.delta == 0)
        assert np.all(np.isfinite(samples.wi)) and np.all(np.isfinite(samples.weight)) and np.all(samples.weight >= 0)
        chart = chart_of(material, wo)
        # For several lobes the chart is the hemisphere, in which a grazing lobe is narrow: use more nodes.
        nodes = 10 if len(material.lobes) == 1 else 32
        counts, outside = histogram(chart, samples.wi[smooth], cells)
        probability = integrate_cells(chart, lambda w, wo=wo: scene.bsdf(index, wo, w)[1].astype(float), cells, nodes)
        # Other samples (delta lobes, directions below the horizon) are one more cell.
        rest = max(0.0, 1.0 - probability.sum())
        observed = np.append(counts.ravel(), count - counts.sum())
        expected = np.append(probability.ravel(), rest) * count
        p = chi_square(observed, expected)
        assert p > sidak(LEVEL, len(wos) * len(MATERIALS)), (wo, p, outside, probability.sum(), counts.sum() / count)


@pytest.mark.parametrize("index", SMOOTH, ids=NAMES)
def test_sample_agrees_with_eval_and_pdf(scene, index):
    for c in COSINES + [-0.6]:
        wo = direction(c)
        samples = scene.bsdf_sample(index, wo, uniforms(2000, 3, index))
        good = (samples.pdf > 0) & (samples.delta == 0) & (samples.weight.max(axis=1) > 0)
        if not good.any():
            continue
        f, pdf = scene.bsdf(index, wo, samples.wi[good])
        cosine = np.abs(samples.wi[good][:, 2])
        weight = f * cosine[:, None] / pdf[:, None]
        # Rounding wi to float changes h by 1e-7 and the slope by 1e-7/alpha relative to alpha: D changes by 2 s times that.
        roughness = min([lobe.roughness for lobe in MATERIALS[index].lobes if lobe.kind == LobeKind.BECKMANN], default=1.0)
        exponent = max([lobe.shininess for lobe in MATERIALS[index].lobes if lobe.kind >= LobeKind.PHONG], default=1.0)
        limit = 2e-5 + 1e-5 / roughness + 2e-6 * exponent + 2e-6 / c**2
        assert np.allclose(pdf, samples.pdf[good], rtol=limit), np.abs(pdf / samples.pdf[good] - 1).max()
        assert np.allclose(weight, samples.weight[good], rtol=limit, atol=1e-6)


@pytest.mark.parametrize("index", SMOOTH, ids=NAMES)
def test_reciprocity(scene, index):
    wo = np.stack([direction(c, p) for c, p in uniforms(500, 2, 1) * [0.98, 6.28] + [0.02, 0]])
    wi = np.stack([direction(c, p) for c, p in uniforms(500, 2, 2) * [0.98, 6.28] + [0.02, 0]])
    there, back = scene.bsdf(index, wo, wi)[0], scene.bsdf(index, wi, wo)[0]
    # The order of products differs, and h differs by its rounding, which narrow lobes amplify.
    roughness = min([lobe.roughness for lobe in MATERIALS[index].lobes if lobe.kind == LobeKind.BECKMANN], default=1.0)
    exponent = max([lobe.shininess for lobe in MATERIALS[index].lobes if lobe.kind >= LobeKind.PHONG], default=1.0)
    limit = 4e-6 + 2e-6 / roughness**2 + 1e-6 * exponent
    assert np.allclose(there, back, rtol=limit, atol=1e-30), np.abs(there - back).max()


@pytest.mark.parametrize("index", SMOOTH, ids=NAMES)
def test_energy(scene, index):
    """No lobe of colour 1 has an albedo above 1; the sampler's mean weight is the integral of f cos."""
    material = MATERIALS[index]
    for c in COSINES:
        wo = direction(c)
        chart = chart_of(material, wo)
        integral = integrate_cells(
            chart, lambda w, wo=wo: (scene.bsdf(index, wo, w)[0][:, 0] * np.abs(w[:, 2])).astype(float), 24, 8
        ).sum()
        if len(material.lobes) == 1:
            # float32 values and the quadrature at the horizon have errors of a few 1e-5.
            assert integral <= 1.0 + 5e-5, (c, integral)
        samples = scene.bsdf_sample(index, wo, uniforms(50000, 3, 7 + index))
        weight = np.where(samples.delta == 0, samples.weight[:, 0], 0.0)
        mean, error = mean_and_error(weight)
        # Besides the sampler's standard error, the quadrature at the horizon has an error of 3e-4.
        p = z_test(mean, np.hypot(error, 3e-4 * integral), integral)
        assert p > sidak(LEVEL, len(COSINES) * len(MATERIALS)), (c, mean, error, integral)


def test_lambert_is_kd_over_pi_on_both_sides(scene):
    for side in (1, -1):
        f, pdf = scene.bsdf(0, direction(0.5 * side), [direction(0.25 * side), direction(-0.25 * side)])
        # Two roundings of float32.
        assert np.allclose(f, [[1 / np.pi] * 3, [0] * 3], rtol=2.5e-7) and np.allclose(pdf, [0.25 / np.pi, 0], rtol=1e-6)


def test_specular_lobes_of_the_lectures(scene):
    """Normalised Phong and Blinn-Phong at single pairs of directions, by their formulas in lancer.h."""
    wo, wi = unit(np.array([0.3, 0.1, 0.8])), unit(np.array([-0.4, 0.1, 0.7]))
    for index, material in enumerate(MATERIALS):
        n = material.lobes[0].shininess
        if material.name == "PHONG":
            want = (n + 2) / (2 * np.pi) * max(0.0, wi @ (wo * [-1, -1, 1])) ** n
        elif material.name == "BLINN_PHONG":
            norm = (n + 2) * (n + 4) / (8 * np.pi * (2.0 ** (-n / 2) + n))
            want = norm * unit(wo + wi)[2] ** n
        elif material.name == "MINNAERT":
            # For n < 1 cosines are clamped to at least 0.4 ** (1 / (1 - n)); both cosines here are above it for n = 0.5.
            q = 0.4 ** ((n + 1) / (1 - n)) if n < 1 else 0.0
            low = 0.4 ** (1 / (1 - n)) if n < 1 else 0.0
            area = 2 * np.pi * ((1 - q) / (n + 1) + q / 2)
            want = 0.4 * (max(wo[2], low) * max(wi[2], low)) ** (n - 1) / area
        else:
            continue
        # Rounding of directions changes the base of the power n by 1e-7.
        assert np.isclose(scene.bsdf(index, wo, wi)[0][0, 0], want, rtol=2e-6 + 3e-7 * n, atol=1e-37), material


def test_mirror(scene):
    index = len(MATERIALS)
    for c in (1.0, 0.5, 0.01, -0.5):
        wo = direction(c)
        samples = scene.bsdf_sample(index, wo, uniforms(10, 3, 1))
        assert np.all(samples.delta == 1) and np.array_equal(samples.wi, np.tile(wo * np.float32([-1, -1, 1]), (10, 1)))
        assert np.allclose(samples.weight, 1.0, rtol=1e-6) and np.allclose(samples.pdf, 1.0)
        assert np.all(scene.bsdf(index, wo, samples.wi)[0] == 0.0)


@pytest.mark.parametrize("c", [1.0, 0.8, 0.3, 0.01, -1.0, -0.9, -0.3])
def test_smooth_dielectric(scene, c):
    """The Fresnel share is reflected, the rest refracted by Snell's law; total reflection beyond the critical angle."""
    import reference

    index, wo = len(MATERIALS) + 1, direction(c)
    eta = 1.5 if c > 0 else 1 / 1.5
    f = float(reference.fresnel(abs(float(wo[2])), eta))
    samples = scene.bsdf_sample(index, wo, midpoints(64, 1, 1)[:, [0, 1, 2]])
    samples = np.concatenate([samples, scene.bsdf_sample(index, wo, uniforms(20000, 3, 2))]).view(np.recarray)
    assert np.all(samples.delta == 1)
    reflected = samples.wi[:, 2] * wo[2] > 0
    share = reflected.mean()
    # The share of 20 064 choices: 4 standard errors of a coin. Weight x probability is the share of light.
    assert abs((samples.weight[:, 0] * np.where(reflected, samples.pdf, 0)).max() - f) < 2e-6
    assert abs(share - samples.pdf[reflected].max(initial=0)) < 4 * np.sqrt(0.25 / 20000)
    if reflected.any():
        assert np.allclose(samples.wi[reflected], wo * [-1, -1, 1], atol=2e-7)
    if not reflected.all():
        through = samples[~reflected]
        assert np.allclose(through.weight[:, 0] * through.pdf, 1 - f, rtol=2e-6)
        # Snell's law: the tangential components are opposite, in the ratio of the indices.
        assert np.allclose(through.wi[:, :2], -wo[:2] / eta, atol=3e-7)
        assert np.allclose(np.linalg.norm(through.wi, axis=1), 1.0, atol=3e-7)
    else:
        assert np.sqrt(1 - c * c) / eta > 1


def test_index_one_passes_straight_on(scene):
    samples = scene.bsdf_sample(len(MATERIALS) + 2, direction(0.4), uniforms(100, 3, 3))
    assert np.allclose(samples.wi, -direction(0.4), atol=2e-7) and np.allclose(samples.weight, 1.0, rtol=1e-6)


def test_extremes_give_no_nan(scene):
    grazing = [direction(c) for c in (0.0, 1e-7, -1e-7, 1e-3)]
    for index in range(len(MATERIALS) + 3):
        for wo in grazing:
            samples = scene.bsdf_sample(index, wo, uniforms(200, 3, 4))
            f, pdf = scene.bsdf(index, wo, np.stack(grazing))
            for array in (samples.wi, samples.weight, samples.pdf, f, pdf):
                assert np.all(np.isfinite(array)), (index, wo)
            assert np.all(samples.weight >= 0) and np.all(f >= 0) and np.all(pdf >= 0)
