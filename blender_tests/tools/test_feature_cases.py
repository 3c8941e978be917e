"""The scenes of `make features`: each has its feature; if it is only compiled in, the picture is the one without it."""

import numpy as np
import pytest

from addon.bindings.enums import Features
from addon.bindings.session import Session
from addon.measure.node_costs import nanoseconds
from tools.features import cases as feature_cases
from tools.features import nodes as feature_nodes
from tools.features import page as features_page

CASES = {case.name: case for case in feature_cases.CASES}
IDLE = [name for name, case in CASES.items() if case.idle]


def rendered(snapshot):
    with Session.upload(snapshot) as session:
        session.render_all(2)
        return session.read(0), session.statistics()


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.used])
def test_a_feature_is_used(name):
    """Some pixel differs, or there is another pass; and all pixels are finite."""
    base = feature_cases.minimal()
    used = CASES[name].used(base)
    picture, statistics = rendered(used)
    assert np.isfinite(picture).all() and statistics.invalid_samples == 0
    if used.settings.passes == base.settings.passes and name != "clamped indirect light":
        assert not np.array_equal(picture, rendered(base)[0])


@pytest.mark.parametrize("name", IDLE)
def test_a_feature_is_only_there(name):
    case, base = CASES[name], feature_cases.minimal()
    idle = case.idle(base)
    picture, with_it = rendered(idle)
    plain, without_it = rendered(base if case.idle_base is None else case.idle_base(base))
    # The square covers 1e-4 of the directions above the floor; a lamp below the floor lights nothing.
    assert abs(picture.mean() / plain.mean() - 1.0) < 1e-3
    # The scene needs code of more features, or requests the general code.
    more = idle.lights != base.lights or idle.instances != base.instances or with_it.features != without_it.features
    assert more or idle.settings.features == Features.ALL


def test_what_the_export_leaves_of_60_nodes_has_their_picture():
    whole, left = feature_cases.grown(), feature_cases.grown(folded=True)
    assert [len(material.nodes) for material in (whole, left)] == [60, 7]
    base = feature_cases.minimal()
    pictures = [rendered(CASES[name].used(base))[0] for name in CASES if name.startswith("60 nodes")]
    assert np.array_equal(*pictures)


def test_the_material_tab_tells_what_nodes_take():
    """Within a factor of 2, which processors differ by between kinds of nodes, of a node in common."""
    names = "noise 3D", "noise 4D", "Voronoi 3D", "Voronoi 3D, smooth", "sine of vectors"
    found = {name: feature_nodes.measured(feature_nodes.NODES[name], rounds=5)[0] for name in names}
    for name in names[1:]:
        told = nanoseconds(feature_nodes.NODES[name]) / nanoseconds(feature_nodes.NODES[names[0]])
        assert 0.5 < found[name] / found[names[0]] / told < 2.0, (name, found)


def test_verdicts():
    def value(cost, uncertainty):
        return {"cost": cost, "uncertainty": uncertainty}

    assert features_page.verdict(value(0.01, 0.005), 0.02) is True
    assert features_page.verdict(value(0.03, 0.005), 0.02) is False
    assert features_page.verdict(value(0.019, 0.005), 0.02) is None


def test_the_page_holds_every_figure(tmp_path):
    found = {"used": {"cost": 0.5, "uncertainty": 0.01, "kernel": "path all"}}
    idle = {"cost": 0.031, "uncertainty": 0.002, "kernel": "path <all>"}
    figures = {
        "machine": {"processor": "P", "system": "S"},
        "commit": "abc",
        "goal": 0.02,
        "quick": False,
        "nodes": {"noise 3D": {"nanoseconds": 51.4, "uncertainty": 2.0, "told": 53.5}},
        "cases": {
            "glass": {"PATH": {**found, "idle": idle}, "CLASSIC": {"idle": {**idle, "note": "not idle"}}},
            "lens": {"PATH": found},
        },
    }
    features_page.write(figures, tmp_path)
    text = (tmp_path / "index.html").read_text()
    assert "+50.0 % ± 1.0" in text and "+3.1 % ± 0.2" in text and "missed" in text and "path &lt;all&gt;" in text
    assert text.count("missed") == 1 and "not idle" in text
    assert text.count("<tr>") == 5 and "51 ns ± 2" in text and "54 ns" in text
