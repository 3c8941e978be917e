"""The course's models: Minnaert in both integrators, and every parameter of every model from a node."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes
from course import EXACT, color, lamp
from tiny_scenes import lambert, pencil, plane, sphere

from addon.bindings.abi import Integrator, LobeKind
from addon.bindings.enums import Domain, NodeKind
from addon.bindings.snapshot import Instance, Lobe, Material, MeshAttribute, Node, NodeRef


def minnaert(k, rho=0.4):
    return Material("minnaert", lobes=(Lobe(LobeKind.MINNAERT, color=(rho, 0.5 * rho, 0.0), shininess=k),))


@pytest.mark.parametrize("integrator", [Integrator.CLASSIC, Integrator.PATH])
@pytest.mark.parametrize("k", [0.5, 1.0, 1.5, 4.0])
def test_minnaert_under_one_lamp(k, integrator):
    """rho (k + 1)/(2 pi) (cos_i cos_o)^(k - 1) cos_i lc; for k < 1 with q of the least cosine, which none here reaches."""
    position = np.array((-2.5, 0.6, 4.0))
    d = np.linalg.norm(position)
    cos_i, cos_o, rho = position[2] / d, 0.8, 0.4
    q = rho ** ((k + 1) / (1 - k)) if k < 1 else 0.0
    f = (cos_i * cos_o) ** (k - 1) / (2 * math.pi * ((1 - q) / (k + 1) + q / 2))
    got = color([plane()], [minnaert(k, rho)], [lamp(position, 9.0)], integrator=integrator, max_bounces=0)
    assert np.allclose(got, np.array([rho, rho / 2, 0.0]) * f * cos_i * 9 / d**2, rtol=4 * EXACT)


@pytest.mark.parametrize("k", [0.2, 1.0, 3.0])
def test_minnaert_in_a_furnace(k):
    """Under a uniform sky a convex body shows its albedo: rho max(cos, m)^(k - 1), at most 1."""
    rho = 0.6
    for cosine in (0.95, 0.5, 0.1):
        eye = np.array([math.sqrt(1 - cosine**2), 0, cosine])
        view = pencil(tuple(5 * eye))
        snapshot = tiny_scenes.scene([plane()], [minnaert(k, rho)], world=1.0, camera=view, samples=4096, max_bounces=1)
        m = rho ** (1 / (1 - k)) if k < 1 else 0.0
        want = rho * max(cosine, m) ** (k - 1)
        got = tiny_scenes.render(snapshot)[0, 0, 0]
        # BSDF samples alone return the albedo exactly; with samples of the sky the error at 4096 samples is about 1e-3.
        assert want <= 1.0 and np.isclose(got, want, rtol=5e-3), (cosine, got, want)


COLOR = (0.5, 0.25, 0.125)
MODELS = {
    "KD_KS": (Lobe(LobeKind.LAMBERT, color=COLOR), Lobe(LobeKind.BECKMANN, color=COLOR, roughness=0.3, ior=1.7)),
    "PHONG": (Lobe(LobeKind.LAMBERT, color=COLOR), Lobe(LobeKind.PHONG, color=COLOR, shininess=7.0)),
    "BLINN_PHONG": (Lobe(LobeKind.LAMBERT, color=COLOR), Lobe(LobeKind.BLINN_PHONG, color=COLOR, shininess=7.0)),
    "MINNAERT": (Lobe(LobeKind.MINNAERT, color=COLOR, shininess=0.6),),
}
PARAMETERS = {
    LobeKind.LAMBERT: ("color", "weight"),
    LobeKind.BECKMANN: ("color", "weight", "roughness", "ior"),
    LobeKind.PHONG: ("color", "weight", "shininess"),
    LobeKind.BLINN_PHONG: ("color", "weight", "shininess"),
    LobeKind.MINNAERT: ("color", "weight", "shininess"),
}
CASES = [
    (model, number, name)
    for model, lobes in MODELS.items()
    for number, lobe in enumerate(lobes)
    for name in PARAMETERS[lobe.kind]
] + [(model, None, "ambient") for model in MODELS]


def textured(material, number, name):
    """Return the material with one parameter from a node with the same value: half of an attribute of twice the value."""
    owner = material if number is None else material.lobes[number]
    value = getattr(owner, name)
    nodes = (
        Node(NodeKind.ATTRIBUTE, name="twice"),
        Node(NodeKind.VECTOR_MATH, option=2, inputs=(NodeRef(0), (0.5, 0.5, 0.5))),
    )
    changed = dataclasses.replace(owner, **{name: NodeRef(1)})
    if number is not None:
        lobes = tuple(changed if i == number else lobe for i, lobe in enumerate(material.lobes))
        changed = dataclasses.replace(material, lobes=lobes)
    return dataclasses.replace(changed, nodes=nodes), np.ravel(value)


@pytest.mark.parametrize("integrator", [Integrator.CLASSIC, Integrator.PATH])
@pytest.mark.parametrize("model, number, name", CASES)
def test_every_parameter_may_come_from_a_node(model, number, name, integrator):
    """The picture with the parameter from a node equals that with the constant, and changes with the node's value."""
    material = Material(model, lobes=MODELS[model], ambient=(0.25, 0.5, 0.125))
    changed, value = textured(material, number, name)
    pictures = []
    for own, twice in ((material, 2 * value), (changed, 2 * value), (changed, value)):
        square = tiny_scenes.quad()
        twice = np.tile(np.broadcast_to(twice, 3) if len(twice) == 1 else twice, (4, 1))
        mesh = dataclasses.replace(square, attributes=(MeshAttribute("twice", twice, Domain.VERTEX),))
        lights = [lamp((-0.5, 0.4, 2.0), 5.0), lamp((1.0, 1.0, 1.0), 3.0)]
        snapshot = tiny_scenes.scene(
            [Instance(), sphere(1, tiny_scenes.move(0, 0, 0.3) @ tiny_scenes.scale(0.3))],
            [own, lambert(0.5)],
            lights,
            [mesh],
            world=0.3,
            camera=pencil((1.0, 0.5, 2.0), width=1.5, pixels=12),
            integrator=integrator,
            samples=2,
            max_bounces=2,
        )
        pictures.append(tiny_scenes.render(snapshot))
    constant, same, other = pictures
    # Halves of doubled numbers are exact, but a material without nodes is precomputed, with another order of rounding.
    assert np.allclose(constant, same, rtol=1e-5, atol=1e-7)
    unseen = name == "ambient" and integrator == Integrator.PATH
    assert np.allclose(same, other, rtol=1e-5) == unseen
