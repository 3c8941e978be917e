"""Code that the measuring programs share: estimates, comparison of pictures, turns, kept results, options, pages."""

import io
import subprocess
import sys

import numpy as np
import pytest

from tools.harness import estimates, page, pictures, turns, workers
from tools.harness.errors import Reference, luminance
from tools.harness.kept import kept, kept_picture
from tools.harness.places import README, ROOT, TABLES
from tools.harness.terminal import Progress, wanted


def test_squared_error_takes_off_the_references_noise():
    """Two noisy halves give the reference's variance; the rest is the picture's own, 0.04."""
    random = np.random.default_rng(1)
    truth = random.random((200, 200, 3))
    halves = [truth + random.normal(0.0, 0.1, truth.shape) for _ in range(2)]
    reference, variance = estimates.join_halves(*halves)
    picture = truth + random.normal(0.0, 0.2, truth.shape)
    # The variance of 120 000 numbers has a relative standard error of sqrt(2/120000) = 0.4 %; four of these.
    assert variance == pytest.approx(0.1**2 / 2, rel=0.016)
    assert estimates.squared_error(picture, reference, variance) == pytest.approx(0.04, rel=0.02)
    assert estimates.squared_error(picture, reference) > 0.044


@pytest.mark.parametrize(("freedom", "quantile"), [(1, 12.7062), (4, 2.7764), (30, 2.0423)])
def test_student_quantiles(freedom, quantile):
    """97.5 % quantiles of a printed table, with four decimals."""
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
    """95 % of the intervals over 5 runs contain the truth; the share of 1000 trials has a standard error of 0.7 %, four of
    these are 2.8 %.

    Errors and seconds vary by a tenth, so that their logarithms are nearly normal.
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
    # Blocks of 64 pixels and 3 channels: noise of 0.1 is 0.0125 in a channel's mean, some 0.02 of the level.
    assert pictures.is_same(pictures.difference(picture, noisy), 0.05)
    assert not pictures.is_same(pictures.difference(picture, picture[:, ::-1]), 0.05)
    assert not pictures.is_same(pictures.difference(picture, 1.2 * picture), 0.05)
    assert pictures.difference(picture, 1.2 * picture)["level"] == pytest.approx(0.2)


def test_competitors_take_turns():
    """Each is measured once per round; medians are over rounds, ratios within rounds."""
    order = []

    def measure(name, number):
        order.append(name)
        return {"seconds": float(number + (name == "b")), "clock": "own"}

    found = turns.by_turns(3, ("a", "b"), measure)
    assert order == ["a", "b"] * 3
    assert turns.middles(found["b"]) == {"seconds": {"median": 2.0, "min": 1.0, "max": 3.0}}
    assert turns.ratio([2.0, 6.0, 4.0], [1.0, 2.0, 4.0]) == {"median": 2.0, "min": 1.0, "max": 3.0}


def test_patterns_choose_by_any_name():
    assert (
        wanted("", "balls")
        and wanted("room, BALL*", "balls")
        and wanted("interior", "a.blend", "interior")
        and wanted("kitch*", "Kitchen")
    )
    assert not wanted("ball", "balls") and not wanted("room,*s2", "balls")


def test_what_was_measured_is_kept_while_its_key_is_the_same(tmp_path):
    calls = []

    def measure():
        calls.append(1)
        return {"n": len(calls)}

    path = tmp_path / "deep" / "result.json"
    assert [kept(path, key, measure)["n"] for key in (["a"], ["a"], ["b"], ["b"])] == [1, 1, 2, 2]


def test_a_reference_that_was_broken_off_is_rendered_again(tmp_path):
    path, values = tmp_path / "deep" / "part.npy", np.arange(6.0).reshape(2, 3)

    def breaks(unfinished):
        np.save(unfinished, np.zeros(1))
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        kept_picture(path, breaks)
    assert not path.exists()
    # Whether it is returned or written.
    assert np.array_equal(kept_picture(path, lambda _: values), values)
    assert np.array_equal(kept_picture(path, None), values)
    assert np.array_equal(kept_picture(tmp_path / "other.npy", lambda unfinished: np.save(unfinished, values)), values)


def test_a_process_answers_or_tells_why_not():
    assert workers.run(["sh", "-c", "echo words; echo '[1, 2]'"]) == [1, 2]
    for command, limit, words in (
        ("echo so >&2; exit 3", None, "^so$"),
        ("exit 4", None, "exit code 4"),
        ("sleep 9", 0.1, "not done"),
    ):
        with pytest.raises(workers.Failed, match=words):
            workers.run(["sh", "-c", command], limit=limit)


def test_lines_that_move_are_for_terminals():
    log, terminal = io.StringIO(), io.StringIO()
    terminal.isatty = lambda: True
    for place in (log, terminal):
        say = Progress(place)
        say.show("going on")
        say("measured")
    assert log.getvalue().endswith("  measured\n") and "going on" not in log.getvalue()
    assert "going on\r" in terminal.getvalue() and terminal.getvalue().endswith("  measured\n")


def test_noise_and_bias_are_told_apart():
    source, shape = np.random.default_rng(1), (200, 300, 1)

    def grey(count, level, noise):
        return [np.repeat(level + noise * source.normal(size=shape), 3, axis=2) for _ in range(count)]

    reference = Reference.of(grey(2, 20.0, 0.2))
    # The mean of two: 0.2 / sqrt 2, relative to 20 and 1 % of it. The square over 60 000 pixels has a relative standard error
    # of sqrt(2/60000) = 0.6 %.
    scale = 20.2
    assert reference.error == pytest.approx(0.2 / 2**0.5 / scale, rel=0.01)
    noise, bias = reference.split([luminance(picture) for picture in grey(5, 20.5, 0.4)])
    assert noise == pytest.approx(0.4 / scale, rel=0.01)
    assert bias == pytest.approx(0.5 / scale, rel=0.01)
    # The reference's own noise is subtracted.
    assert reference.distance(luminance(*grey(1, 20.5, 0.4))) == pytest.approx(np.hypot(0.4, 0.5) / scale, rel=0.01)
    noise, bias = reference.split([luminance(picture) for picture in grey(5, 20.0, 0.4)])
    # The squared bias is a difference with an error of some thousandths of the squared noise; the bias has the root of that.
    assert bias < 0.1 * noise


def test_luminance_of_grey_is_its_level():
    assert luminance(np.full((1, 1, 4), 0.3))[0, 0] == pytest.approx(0.3, rel=1e-12)


def test_a_page_shows_text_as_it_is(tmp_path):
    rows = [["a < b", ("1.5", "no", 1.5)], page.row([page.element("b", "&")], data_verdict="x")]
    page.write(
        tmp_path, "name", {"n": 1}, "A <title>", ["words & words", page.table(["h", "k"], rows, "files")], "i {}", "go()"
    )
    text = (tmp_path / "index.html").read_text()
    for part in (
        "<h1>A &lt;title&gt;</h1>",
        "<p>words &amp; words</p>",
        '<td class="text">a &lt; b</td><td class="no" data-value="1.5">1.5</td>',
        '<tr data-verdict="x"><td class="text"><b>&amp;</b></td></tr>',
        '<table class="files"><thead><tr><th class="text">h</th><th>k</th></tr>',
        "<script>go()</script>",
    ):
        assert part in text, part
    assert (tmp_path / "name.json").read_text() == '{\n "n": 1\n}\n'
    assert page.markdown(["h", "k"], [["a", 1]]) == "| h | k |\n| --- | --- |\n| a | 1 |"


def test_a_table_replaces_what_is_between_the_marks(tmp_path):
    path = tmp_path / "README.md"
    begin, end = page.marks("speed", "bench")
    path.write_text(f"before\n{begin}\nold\n{end}\nafter\n")
    page.put_between(path, "speed", ["new", "", "table", "last"], "bench")
    assert path.read_text() == f"before\n{begin}\nnew\n\ntable\n\nlast\n{end}\nafter\n"
    with pytest.raises(ValueError, match="lacks the lines"):
        page.put_between(path, "other", ["new"])


@pytest.mark.parametrize(
    ("path", "name", "program"),
    [(TABLES, "bench", "bench"), (TABLES, "tradeoff", "tradeoff"), (TABLES, "corpus", "corpus"), (README, "speed", "bench")],
)
def test_the_project_has_a_place_for_each_table(path, name, program):
    text = path.read_text(encoding="utf-8")
    begin, end = page.marks(name, program)
    assert text.count(begin) == text.count(end) == 1 and text.index(begin) < text.index(end)


# Imports modules in a Python without the packages of pyproject's group test.
WITHOUT_TESTS = """
import importlib, runpy, sys
sys.modules.update(dict.fromkeys(("pytest", "scipy", "mpmath")))
runpy.run_path(sys.argv[1])
for name in sys.argv[2:]:
    importlib.import_module(name)
"""


def test_measuring_programs_need_no_package_of_the_tests():
    """make installs the group run for these programs, and the group bench for some."""
    tools = ROOT / "blender_tests" / "tools"
    programs = ("accuracy", "bench", "corpus", "differ", "features", "harness", "parity", "pilot", "tradeoff")
    files = [path for program in programs for path in sorted((tools / program).glob("*.py"))]
    names = [".".join(path.relative_to(tools.parent).with_suffix("").parts) for path in files]
    command = [sys.executable, "-c", WITHOUT_TESTS, str(workers.START), *names]
    subprocess.run(command, check=True, timeout=120)
