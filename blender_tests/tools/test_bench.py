"""The benchmark's goals, plans, bounds, page and tables."""

import numpy as np
import pytest

from tools.bench import bakes, contest, goals, page, plan, rays
from tools.harness.page import marks
from tools.harness.verdicts import NOT_MEASURED


def _record(rate, errors=None, same=True):
    record = {"samples_per_second": {"median": rate, "min": rate, "max": rate}, "difference": {"same": same}}
    return {**record, "errors": errors, "seconds": [1.0] * len(errors)} if errors else record


def _figures():
    scenes = {
        "one": {"lancer": _record(4e6, [1.0, 1.0]), "cycles": _record(1e6, [6.0, 6.0])},
        "two": {"lancer": _record(2e6), "cycles": _record(2e6), "mitsuba_llvm": {"cannot": "leaves"}},
        "other": {"lancer": _record(9e6), "cycles": _record(1e6, same=False)},
    }
    lifelike = {"lancer": _record(3e6, [1.0, 1.0]), "cycles": _record(1e6, [2.0, 2.0])}
    figures = {name: {"renderers": records} for name, records in scenes.items()}
    return {"scenes": {**figures, "wood": {"renderers": lifelike, "group": "lifelike"}}}


def test_goals_take_means_over_scenes_of_the_same_picture():
    assert goals.rate_ratios(_figures(), "cycles") == {"one": pytest.approx(4.0), "two": pytest.approx(1.0)}
    assert goals.efficiency_ratios(_figures(), "cycles") == {"one": pytest.approx(6.0)}
    assert goals.rate_ratios(_figures(), "cycles", group="lifelike") == {"wood": pytest.approx(3.0)}
    assert goals.rate_ratios(_figures(), "mitsuba_llvm") == {}


def test_goals_name_every_row_and_what_is_not_measured():
    verdicts = {verdict.what: verdict for verdict in goals.judge(_figures())}
    assert len(verdicts) == 29
    rate = verdicts["samples/s against Cycles"]
    assert (rate.measured, rate.reached) == ("2.00x, least 1.00x (two), 2 scenes", False)
    assert verdicts["efficiency against Cycles"].reached is True
    missing = verdicts["samples/s against Mitsuba llvm_ad_rgb"]
    assert (missing.measured, missing.reached) == (NOT_MEASURED, None)


def test_goals_of_several_figures_need_them_all():
    """A missed figure decides; a missing figure leaves the goal open."""
    figures = {"instances": {"total_seconds": {"median": 0.5}}}
    row = "20 000 instances x 15 744 triangles: export, upload and build"

    def verdict():
        return next(verdict for verdict in goals.judge(figures) if verdict.what == row)

    assert verdict().reached is None
    figures["instances"]["peak_bytes"] = {"median": 200e6}
    assert verdict().reached is True
    figures["instances"]["total_seconds"] = {"median": 1.5}
    assert verdict().reached is False


@pytest.mark.parametrize(("rays", "leaks", "reached"), [(1e8, 0, True), (1e6, 0, None), (1e6, 3, False)])
def test_no_leaks_among_few_rays_prove_nothing(rays, leaks, reached):
    verdicts = goals.judge({"rays": {"leak_rays": rays, "leaks": leaks}})
    assert next(verdict for verdict in verdicts if verdict.goal == "0 in 1e8").reached is reached


def test_bakes_compare_the_noise_of_texels_with_a_surface(monkeypatch, tmp_path):
    def worker(_module, _task, engine, seed, path, **_):
        noise = np.random.default_rng([seed, engine == "CYCLES"]).normal(0.0, 0.1 if engine == "LANCER" else 0.2, (100, 1))
        # Half of the texels have no surface.
        np.save(path, np.concatenate([2.0 + noise * np.ones((100, 3)), np.zeros((100, 3))]))
        return {"seconds": 2.0, "cpu_seconds": 1.0 if engine == "LANCER" else 3.0, "setup_seconds": 0.5}

    monkeypatch.setattr(bakes.workers, "ask", worker)
    monkeypatch.setattr(bakes.jobs, "OUTPUT", tmp_path)
    (tmp_path / "pictures").mkdir()
    found = bakes.measure(20, 2, False, lambda _: None)
    figures = found["room, combined"]
    # The variances of 100 texels in 20 rounds are known to 3 % each; four times that, and the level is 1 % above 2.
    assert np.mean(figures["LANCER"]["squared_errors"]) == pytest.approx((0.1 / 2.02) ** 2, rel=0.13)
    assert figures["efficiency_ratio"]["value"] == pytest.approx(4.0, rel=0.2)
    assert figures["efficiency_ratio_of_processors"]["value"] == pytest.approx(12.0, rel=0.2)
    assert figures["level_ratio"] == pytest.approx(1.0, rel=0.01)
    row = next(row for row in goals.judge({"bakes": found}) if row.what == "bakes: efficiency against Cycles")
    assert row.reached and "4 scenes" in row.measured
    assert goals.bake_ratios({"bakes": {"missing": "no worker"}}) == {}


def test_plans():
    names = [scene.name for scene in plan.scenes()]
    assert names[:2] == ["balls", "balls_exact"] and len(names) == len(set(names))
    assert [scene.name for scene in plan.scenes("balls*,triangle")] == ["balls", "balls_exact", "triangle"]
    assert all(scene.rounds >= 5 for scene in plan.scenes() if scene.reference)
    quick = {scene.name: scene for scene in plan.scenes(quick=True)}
    assert quick["balls"].rounds == 5 and quick["models"].rounds == 1


def test_a_scene_is_the_same_whatever_order_blender_builds_its_meshes_in(tmp_path):
    random = np.random.default_rng(1)
    positions = random.random((500, 3), np.float32)
    normals = positions / np.linalg.norm(positions, axis=1, keepdims=True)
    corners = random.integers(0, 500, (900, 3), np.uint32)

    def digest(*arrays):
        np.savez(tmp_path / "scene.npz", *arrays)
        return contest.digest_of_scene(tmp_path / "scene.npz")

    first = digest(positions, normals, corners, np.float32([1, 2]))
    assert digest(positions, normals * np.float32(1 + 1e-7), corners[::-1], np.float32([1, 2])) == first
    moved = positions.copy()
    moved[7, 1] += 0.1
    assert digest(moved, normals, corners, np.float32([1, 2])) != first
    assert digest(positions, normals, corners[1:], np.float32([1, 2])) != first
    assert digest(positions, normals, corners, np.float32([2, 1])) != first


def test_page_shows_what_was_measured_and_what_was_not(tmp_path):
    triple = {"median": 3.5e6, "min": 3e6, "max": 4e6}
    kinds = dict.fromkeys(("primary", "diffuse", "shadow"), triple)
    level = {"bytes": 1, "latency": 1e-9, "bandwidth": 1e9}
    figures = {
        "machine": {"processor": "a processor", "processors": 2, "memory_gib": 4.0, "system": "Linux"},
        "threads": 2,
        "quick": True,
        "commit": "abc",
        "renderers": {"lancer": {"title": "Lancer", "version": "1", "missing": None}},
        "scenes": {"gone": {"title": "a scene", "size": [8, 8], "samples": 1, "failed": "no models", "renderers": {}}},
        "rays": {"lancer": {**kinds, "instruction_set": "avx2"}, "embree": {"missing": "no wheel"}},
        "limits": {"clock": 3e9, **dict.fromkeys(("l1", "l2", "l3", "memory"), level)},
        "classic": {"lancer": {"seconds": triple}, "difference": {"median": 0.1, "p90": 0.2, "level": 0.0}},
        "build": {"missing": "no compiler"},
        "goals": [],
    }
    page.write(figures, tmp_path, [])
    text = (tmp_path / "index.html").read_text()
    for words in (
        "no models",
        "Embree: no wheel",
        "no counters",
        "3.00 GHz",
        "not measured: no compiler",
        "classic, lancer, seconds",
    ):
        assert words in text
    assert (tmp_path / "bench.json").exists()


def test_tables_replace_what_is_between_the_marks(tmp_path):
    tables, readme = tmp_path / "tables.md", tmp_path / "README.md"
    for path, name in ((tables, "bench"), (readme, "speed")):
        begin, end = marks(name, "bench")
        path.write_text(f"before\n{begin}\nold\n{end}\nafter\n")
    machine = {"processor": "a processor", "processors": 2, "memory_gib": 4.0, "system": "Linux"}
    renderers = {
        "lancer": {"title": "Lancer", "version": "1", "missing": None},
        "cycles": {"title": "Cycles", "version": "2", "missing": None},
        "mitsuba_llvm": {"title": "Mitsuba", "version": "3", "missing": None},
        "luxcore": {"title": "LuxCore", "version": None, "missing": "no wheel"},
    }
    figures = {**_figures(), "machine": machine, "threads": 2, "quick": False, "commit": "abc", "renderers": renderers}
    for scene in figures["scenes"].values():
        scene["title"] = "a scene"
    figures["scenes"]["alone"] = {"title": "no peers", "renderers": {"lancer": _record(1e6)}}
    page.update_tables(figures, tables, readme)
    text = tables.read_text()
    assert text.startswith("before\n") and text.endswith("after\n") and "old" not in text
    assert "LuxCore (no wheel)" in text and text.count("Commit abc.") == 1
    assert "| samples/s against Cycles | 3.5x in geometric mean | 2.00x, least 1.00x (two), 2 scenes | missed |" in text
    # A head, a line below it and thirteen ratios; only the page has the scenes.
    assert sum(line.startswith("|") for line in text.splitlines()) == 15 and "a scene" not in text
    # The table for users has the scenes on which both renderers were timed.
    text = readme.read_text()
    assert text.startswith("before\n") and text.endswith("after\n") and "old" not in text
    assert "| a scene | 4.00 | 1.00 |" in text and "Mitsuba" not in text and "no peers" not in text


def test_roofline_is_the_clock_over_the_cycles_of_a_ray():
    """15.4 nodes and 4 blocks take 257.4 cycles: 11.4 million rays per second of a core at 2.93 GHz."""
    assert rays.bound(15.4, 4.0, 2.93e9, 1) == pytest.approx(2.93e9 / 257.4)
    traced = {"lancer": {"diffuse": {"median": 5e6}}, "counts": {"diffuse": {"nodes": 15.4, "leaves": 4.0}}}
    (row,) = rays.roofline({"clock": 2.93e9}, traced, 2)
    assert row["fraction"] == pytest.approx(5e6 / (2 * 2.93e9 / 257.4))
    assert rays.roofline({"clock": 2.93e9}, {"lancer": {}, "counts": {}}, 2) == []
