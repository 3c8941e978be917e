"""The benchmark's own figures: errors, intervals, comparison of pictures, goals, and the README's table."""

import numpy as np
import pytest

from tools.bench import compare, estimates, goals, page, plan, roofline


def test_squared_error_takes_off_the_references_noise():
    """Of two noisy halves the reference's variance is known: what is left is the picture's own, 0.04."""
    random = np.random.default_rng(1)
    truth = random.random((200, 200, 3))
    halves = [truth + random.normal(0.0, 0.1, truth.shape) for _ in range(2)]
    reference, variance = estimates.join_halves(*halves)
    picture = truth + random.normal(0.0, 0.2, truth.shape)
    # A variance from 120 000 numbers is known to sqrt(2/120000) = 0.4 % of itself; four of these.
    assert variance == pytest.approx(0.1**2 / 2, rel=0.016)
    assert estimates.squared_error(picture, reference, variance) == pytest.approx(0.04, rel=0.02)
    assert estimates.squared_error(picture, reference) > 0.044


@pytest.mark.parametrize(("freedom", "quantile"), [(1, 12.7062), (4, 2.7764), (30, 2.0423)])
def test_student_quantiles(freedom, quantile):
    """The table's 97.5 % values, of four decimals."""
    assert estimates.student_quantile(freedom) == pytest.approx(quantile, abs=1e-4)


def test_efficiency_is_one_over_error_times_seconds():
    found = estimates.efficiency([0.02, 0.04, 0.03], [2.0, 2.0, 2.0])
    assert found["value"] == pytest.approx(1.0 / (0.03 * 2.0))
    assert found["low"] < found["value"] < found["high"]


def test_efficiency_of_one_run_has_no_interval():
    assert estimates.efficiency([0.02], [2.0]) == {"value": pytest.approx(25.0), "low": None, "high": None}


def test_efficiency_ratio_is_ours_over_theirs():
    ours, theirs = ([0.01, 0.01], [1.0, 1.0]), ([0.02, 0.02], [3.0, 3.0])
    assert estimates.efficiency_ratio(ours, theirs)["value"] == pytest.approx(6.0)


def test_interval_covers():
    """95 % of the intervals over 5 runs hold the truth; of 1000 trials the share is known to 0.7 %, four of these are 2.8 %.

    Errors and seconds spread by a tenth, where their logarithms are as good as normal.
    """
    random, trials, held = np.random.default_rng(2), 1000, 0
    truth = 1.0 / (0.5 * 3.0)
    for _ in range(trials):
        errors = 0.5 * random.normal(1.0, 0.1, 5)
        seconds = 3.0 * random.normal(1.0, 0.1, 5)
        found = estimates.efficiency(errors, seconds)
        held += found["low"] <= truth <= found["high"]
    assert held / trials == pytest.approx(0.95, abs=0.028)


def test_geometric_mean():
    assert estimates.geometric_mean([1.0, 4.0, 16.0]) == pytest.approx(4.0)


def test_comparison_sees_another_picture_and_not_noise():
    random = np.random.default_rng(3)
    picture = random.random((64, 96, 3)) * np.linspace(0.2, 1.0, 96)[:, None]
    noisy = picture + random.normal(0.0, 0.1, picture.shape)
    # Blocks of 64 pixels and 3 channels: noise of 0.1 is 0.0125 in a channel, some 0.02 of the level.
    assert compare.is_same(compare.difference(picture, noisy), 0.05)
    assert not compare.is_same(compare.difference(picture, picture[:, ::-1]), 0.05)
    assert not compare.is_same(compare.difference(picture, 1.2 * picture), 0.05)
    assert compare.difference(picture, 1.2 * picture)["level"] == pytest.approx(0.2)


def _record(rate, errors=None, same=True):
    record = {"samples_per_second": {"median": rate, "min": rate, "max": rate}, "difference": {"same": same}}
    return {**record, "errors": errors, "seconds": [1.0] * len(errors)} if errors else record


def _figures():
    scenes = {
        "one": {"lancer": _record(4e6, [1.0, 1.0]), "cycles": _record(1e6, [6.0, 6.0])},
        "two": {"lancer": _record(2e6), "cycles": _record(2e6), "mitsuba_llvm": {"cannot": "leaves"}},
        "other": {"lancer": _record(9e6), "cycles": _record(1e6, same=False)},
    }
    return {"scenes": {name: {"renderers": records} for name, records in scenes.items()}}


def test_goals_take_means_over_scenes_of_the_same_picture():
    assert goals.rate_ratios(_figures(), "cycles") == {"one": pytest.approx(4.0), "two": pytest.approx(1.0)}
    assert goals.efficiency_ratios(_figures(), "cycles") == {"one": pytest.approx(6.0)}
    assert goals.rate_ratios(_figures(), "mitsuba_llvm") == {}


def test_goals_name_every_row_and_what_is_not_measured():
    verdicts = {verdict.what: verdict for verdict in goals.judge(_figures())}
    assert len(verdicts) == 17
    rate = verdicts["samples/s against Cycles"]
    assert (rate.measured, rate.reached) == ("2.00x, least 1.00x (two), 2 scenes", False)
    assert verdicts["efficiency against Cycles"].reached is True
    missing = verdicts["samples/s against Mitsuba llvm_ad_rgb"]
    assert (missing.measured, missing.reached) == (goals.NOT_MEASURED, None)


def test_goals_of_several_figures_need_them_all():
    """One that is missed decides; one that is missing leaves it open."""
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


def test_plans():
    names = [scene.name for scene in plan.scenes()]
    assert names[:2] == ["balls", "balls_exact"] and len(names) == len(set(names))
    assert [scene.name for scene in plan.scenes("balls*,triangle")] == ["balls", "balls_exact", "triangle"]
    assert all(scene.rounds >= 5 for scene in plan.scenes() if scene.reference)
    quick = {scene.name: scene for scene in plan.scenes(quick=True)}
    assert quick["balls"].rounds == 5 and quick["models"].rounds == 1


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


def test_readme_table_replaces_what_is_between_the_marks(tmp_path):
    readme = tmp_path / "README.md"
    readme.write_text(f"before\n{page.BEGIN}\nold\n{page.END}\nafter\n")
    machine = {"processor": "a processor", "processors": 2, "memory_gib": 4.0, "system": "Linux"}
    renderers = {
        "lancer": {"title": "Lancer", "version": "1", "missing": None},
        "cycles": {"title": "Cycles", "version": "2", "missing": None},
        "luxcore": {"title": "LuxCore", "version": None, "missing": "no wheel"},
    }
    figures = {**_figures(), "machine": machine, "threads": 2, "quick": False, "commit": "abc", "renderers": renderers}
    figures["goals"] = [verdict.as_dict() for verdict in goals.judge(figures)]
    for scene in figures["scenes"].values():
        scene["title"] = "a scene"
    page.update_readme(readme, figures)
    text = readme.read_text()
    assert text.startswith("before\n") and text.endswith("after\n") and "old" not in text
    assert "| one: a scene | 4.00 | 1.00 |" in text
    assert "| other: a scene | 9.00 | another picture |" in text
    assert "LuxCore (no wheel)" in text
    readme.write_text("no marks")
    with pytest.raises(ValueError, match="lacks the lines"):
        page.update_readme(readme, figures)


def test_roofline_is_the_clock_over_the_cycles_of_a_ray():
    """15.4 nodes and 4 blocks are 257.4 cycles: 11.4 million rays a second of a core at 2.93 GHz."""
    assert roofline.bound(15.4, 4.0, 2.93e9, 1) == pytest.approx(2.93e9 / 257.4)
    rays = {"lancer": {"diffuse": {"median": 5e6}}, "counts": {"diffuse": {"nodes": 15.4, "leaves": 4.0}}}
    (row,) = roofline.rows({"clock": 2.93e9}, rays, 2)
    assert row["fraction"] == pytest.approx(5e6 / (2 * 2.93e9 / 257.4))
    assert roofline.rows({"clock": 2.93e9}, {"lancer": {}, "counts": {}}, 2) == []
