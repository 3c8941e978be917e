"""Checks of materials and lights with and without faults, and the list of findings."""

import dataclasses

import numpy as np
import pytest
from check_scenes import (
    GLASS_,
    GLOW_,
    GREY,
    GREY_,
    LAMP,
    ball,
    box,
    found,
    one,
    only,
    placed,
    scene,
    sheet,
)
from tiny_scenes import move

from addon.bindings.enums import AlphaMode, Integrator, LobeKind, MathOperation, NodeKind, Pass
from addon.bindings.snapshot import Image, Lobe, Material, Node, NodeRef, Principled, Settings
from addon.checks import duplicates
from addon.checks.check import check_snapshot
from addon.checks.finding import Finding, Severity, by_severity, lines
from addon.checks.subject import Subject


def shown(material, images=(), **settings):
    return scene([placed(0, 0)], [ball()], [material], images=tuple(images), settings=Settings(**settings))


def of(kind, **fields):
    return Material("m", lobes=(Lobe(kind, **{"color": (0.5,) * 3, **fields}),))


@pytest.mark.parametrize(
    "bad, good",
    [
        (of(LobeKind.GLOSSY, roughness=1.5), of(LobeKind.GLOSSY, roughness=1.0)),
        (of(LobeKind.GLOSSY, roughness=-0.1), of(LobeKind.GLOSSY, roughness=0.0)),
        (of(LobeKind.GLOSSY, roughness=float("nan")), of(LobeKind.LAMBERT, roughness=7.0)),
        (of(LobeKind.GLASS, ior=0.0), of(LobeKind.GLASS, ior=2.4)),
        (of(LobeKind.GLASS, ior=-1.5), of(LobeKind.GLASS, ior=float("inf"))),
        (of(LobeKind.LAMBERT, weight=(-0.1, 1, 1)), of(LobeKind.LAMBERT, weight=(0, 1, 1))),
        (of(LobeKind.LAMBERT, color=(1.1, 0.5, 0.5)), of(LobeKind.LAMBERT, color=(1.0, 1.0, 1.0))),
        (of(LobeKind.TOON, color=(1.1, 0.5, 0.5)), of(LobeKind.TOON, roughness=7.0)),
        (
            Material("m", lobes=(Lobe(color=(0.8,) * 3), Lobe(LobeKind.GLOSSY, color=(0.8,) * 3))),
            Material(
                "m", lobes=(Lobe(color=(0.8,) * 3, weight=(0.3,) * 3), Lobe(LobeKind.GLOSSY, color=(1,) * 3, weight=(0.7,) * 3))
            ),
        ),
        (
            Material("m", lobes=(Lobe(color=(0.8,) * 3),), transmittance=(0.5,) * 3),
            Material("m", lobes=(Lobe(color=(0.8,) * 3, weight=(0.5,) * 3),), transmittance=(0.5,) * 3),
        ),
        (
            of(LobeKind.PRINCIPLED, principled=Principled(base_color=(2.0, 1.0, 1.0))),
            of(LobeKind.PRINCIPLED, principled=Principled(base_color=(1.0, 1.0, 1.0), coat=1.0, specular=1.0)),
        ),
        (
            of(LobeKind.CONDUCTOR, color=(1.3, 1.0, 1.0), edge=(1.0,) * 3),
            of(LobeKind.CONDUCTOR, color=(1.3, 1.0, 1.0), edge=(7.0,) * 3, option=1),
        ),
    ],
)
def test_materials_outside_the_model(bad, good):
    finding = only(shown(bad))
    assert (finding.kind, finding.severity, finding.material, finding.object) == ("closures", Severity.WRONG, "m", "thing")
    assert found(shown(good)) == []


def test_indices_of_refraction():
    invisible, thin = [("closures", "WASTE")], [("closures", "HINT")]
    for kind in (LobeKind.GLASS, LobeKind.DIELECTRIC, LobeKind.REFRACTION):
        assert found(shown(of(kind, color=(1, 1, 1), ior=1.0))) == invisible
        # Tinted glass is visible.
        assert found(shown(of(kind, color=(1, 0.5, 1), ior=1.0))) == []
        assert found(shown(of(kind, color=(1, 1, 1), ior=1.01))) == []
        assert found(shown(of(kind, ior=0.75))) == thin and found(shown(of(kind, ior=0.75)), thorough=False) == []
    # Without transmission an index of 1 is a common way to remove the highlight.
    plain = Principled(ior=1.0, base_color=(1.0,) * 3)
    assert found(shown(of(LobeKind.PRINCIPLED, principled=plain))) == []
    assert found(shown(of(LobeKind.PRINCIPLED, principled=dataclasses.replace(plain, transmission=1.0)))) == invisible
    # Glass without refraction may be open.
    snapshot = scene([placed(0, 0)], [sheet()], [of(LobeKind.GLASS, color=(1, 0.5, 1), ior=1.0)])
    assert found(snapshot) == []


def test_pictures_outside_the_model():
    """Values of images count after the nodes between image and socket."""
    texels = np.linspace(0.0, 1.0, 64, dtype=np.float32).reshape(8, 8, 1)

    def driven(factor, **fields):
        nodes = (
            Node(NodeKind.IMAGE, image=0, image_count=1, inputs=(0.0,)),
            Node(NodeKind.MATH, option=MathOperation.MULTIPLY, inputs=(NodeRef(0), factor)),
        )
        lobe = Lobe(**{"kind": LobeKind.GLOSSY, "color": (0.5,) * 3, **fields})
        return shown(Material("m", lobes=(lobe,), nodes=nodes), [Image("p", texels)])

    assert found(driven(3.0, roughness=NodeRef(1))) == [("closures", "HINT")]
    assert found(driven(1.0, roughness=NodeRef(1))) == []
    assert found(driven(3.0, color=NodeRef(1))) == [("closures", "WRONG")]
    assert found(driven(1.0, color=NodeRef(1))) == []
    # Half of the texels are 0.6 under an alpha of one half: of the colour that is shown, 1.2.
    veiled = np.zeros((8, 8, 4), np.float32)
    veiled[:4] = 0.6, 0.6, 0.6, 0.5
    painted = Material(
        "m", lobes=(Lobe(color=NodeRef(0)),), nodes=(Node(NodeKind.IMAGE, image=0, image_count=1, inputs=(0.0,)),)
    )
    assert found(shown(painted, [Image("p", veiled, alpha=AlphaMode.ASSOCIATED)])) == [("closures", "WRONG")]
    assert found(shown(painted, [Image("p", veiled, alpha=AlphaMode.STRAIGHT)])) == []
    glass = {"kind": LobeKind.GLASS, "color": (0.9,) * 3, "roughness": 0.0}
    assert found(driven(-1.0, ior=NodeRef(1), **glass)) == [("closures", "WRONG")]
    # Values that depend on the shading point are unknown and not reported.
    nodes = (Node(NodeKind.COORDINATE), Node(NodeKind.MATH, option=MathOperation.MULTIPLY, inputs=(NodeRef(0), 9.0)))
    assert found(shown(Material("m", lobes=(Lobe(LobeKind.GLOSSY, roughness=NodeRef(1)),), nodes=nodes))) == []


def test_light_that_grows_matters_to_paths():
    bright = of(LobeKind.LAMBERT, color=(2.0,) * 3)
    for integrator in (Integrator.CLASSIC, Integrator.NORMALS):
        assert found(shown(bright, integrator=integrator)) == []
    # White paint is a hint if the limit of bounces is high.
    white = of(LobeKind.LAMBERT, color=(1.0,) * 3)
    assert found(shown(white, max_bounces=12)) == [] and found(shown(white, max_bounces=1024)) == [("closures", "HINT")]
    # Unused materials are not checked.
    assert found(scene([placed(0, 0)], [ball()], [GREY, bright])) == []


def test_nothing_gives_light():
    dark = {"lights": (), "world": (0.0, 0.0, 0.0)}
    assert found(one(ball(), **dark)) == [("lights", "WRONG")]
    assert found(one(ball(), **dark, settings=Settings(integrator=Integrator.NORMALS))) == []
    # A scene for masks or depth needs no light.
    assert found(one(ball(), **dark, settings=Settings(passes=(Pass.COMBINED, Pass.MIST)))) == []
    assert found(one(ball(), GLOW_, **dark)) == [] and found(one(ball(), lights=(), world=(0.0, 0.1, 0.0))) == []


def test_lamps_that_give_nothing():
    black = dataclasses.replace(LAMP, name="black", emission=(0.0, 0.0, 0.0))
    weak = dataclasses.replace(LAMP, name="weak", emission=(1e-15,) * 3)
    for lamp in (black, weak):
        finding = only(one(ball(), lights=(LAMP, lamp)))
        assert (finding.kind, finding.severity, finding.light) == ("lights", Severity.HINT, lamp.name)
        # F12 does not report it, since the lamp may be animated.
        assert found(one(ball(), lights=(LAMP, lamp)), thorough=False) == []
    # The weakest that is no fault is 2^-40 of the strongest: 1.8e-11 of 20.
    for level in (1e-3, 2e-11):
        assert found(one(ball(), lights=(LAMP, dataclasses.replace(LAMP, emission=(level,) * 3)))) == []
    # A lamp without radius is no fault.
    assert found(one(ball(), lights=(dataclasses.replace(LAMP, radius=0.0),))) == []


def test_what_hurts_most_comes_first_and_few_of_a_kind():
    snapshot = scene(
        [placed(0, GLASS_, move(4 * number, 0, 0), f"pane {number}") for number in range(1)]
        + [placed(1 + number, GLASS_, move(0, 4 + 4 * number, 0), f"sheet {number}") for number in range(14)]
        + [placed(15, GREY_, move(0, 0, 9), "a"), placed(15, GREY_, move(0, 0, 9), "b")],
        [box(), *(sheet(1.0, f"sheet {number}") for number in range(14)), ball()],
    )
    findings = check_snapshot(snapshot)
    assert [finding.severity for finding in findings] == sorted((finding.severity for finding in findings), reverse=True)
    told = lines(findings)
    assert len(told) == 4 and told[2].endswith("(and 11 more objects)") and told[3].startswith("object 'b'")
    assert all("\n" not in line and line.count("; ") == 1 for line in told)


def test_lines_say_who_where_and_what_to_do():
    finding = Finding(
        "glass", Severity.WRONG, "is open", "close it", object="Vase", mesh="Vase", material="Glass", place=(1, 2.5, 1e7)
    )
    assert lines([finding]) == ["object 'Vase' (mesh 'Vase', material 'Glass') near (1, 2.5, 1e+07): is open; close it"]
    assert by_severity([dataclasses.replace(finding, severity=Severity.HINT), finding])[0] is finding
    # Findings of one kind are sorted by weight.
    assert by_severity([finding, dataclasses.replace(finding, weight=0.5)])[0].weight == 0.5


def test_a_mesh_shared_by_many_is_told_once():
    snapshot = scene([placed(0, GLASS_, move(3 * number, 0, 0), f"pane {number}") for number in range(9)], [sheet(1.0)])
    finding = only(snapshot)
    assert finding.others == 8 and "and 8 more" in finding.text


def test_many_meshes_in_one_place_are_quick_to_tell_apart():
    """Objects with applied transforms share one matrix: a cheap key must avoid comparing all pairs."""
    meshes = [sheet(1.0, f"sheet {number}", (number, 0, 0)) for number in range(300)]
    subject = Subject(scene([placed(number, GREY_, name=str(number)) for number in range(300)], meshes))
    asked = []
    original = duplicates._same_thing
    duplicates._same_thing = lambda *arguments: asked.append(arguments) or original(*arguments)
    try:
        assert duplicates.duplicate_rows(subject) == [] and asked == []
    finally:
        duplicates._same_thing = original


def test_empty_scenes():
    assert found(scene([])) == [] and found(scene([placed(0)], [sheet(0.0)])) == []
    # Singular matrices whose determinant is only rounding.
    for seed in range(20):
        first, second, share = np.random.default_rng(seed).normal(size=(3, 3))
        flat = np.eye(4)
        flat[:3, :3] = np.stack((first, second, share[0] * first + share[1] * second), axis=1)
        check_snapshot(scene([placed(0, 0, flat), placed(1, 1, flat, "two")], [box(), sheet()]))
    broken = np.eye(4)
    broken[0, 3] = np.nan
    assert found(one(ball(), GREY_, broken)) == []
    nowhere = dataclasses.replace(ball(), positions=np.full_like(ball().positions, np.nan))
    assert found(one(nowhere, GLASS_)) == []


def test_the_check_can_be_stopped():
    def stop(_):
        raise InterruptedError

    with pytest.raises(InterruptedError):
        check_snapshot(one(ball()), poll=stop)
    shares = []
    check_snapshot(one(ball()), poll=shares.append)
    told = [share for share in shares if share is not None]
    assert told == sorted(told) and 0.0 <= told[0] and told[-1] < 1.0
