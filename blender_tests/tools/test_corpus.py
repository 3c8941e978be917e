"""`make corpus` without Blender: verdicts on two engines' pictures and failures, ranking, page, README, resumption."""

import argparse
import dataclasses
import json
import subprocess

import numpy as np
import pytest

from tools.corpus import clones, measure, noise, page, run, sources, verdicts
from tools.harness.conversation import Ended
from tools.harness.page import marks

SIZE = (24, 32)
PLAN = measure.Plan(budget=1.0, rounds=2, most=16)


class Engine:
    """Replaces a worker: renders pictures of a constant and noise, or ends."""

    def __init__(self, engine, levels, spread=0.0, missing=None, ends=None, seconds=0.001):
        self.engine, self.level, self.spread, self.missing = engine, levels[engine], spread, missing or {}
        self.ends, self.seconds, self.asked = ends or {}, seconds, []

    def __exit__(self, *_):
        self.closed = True

    def ask(self, task, seconds, bytes_, **request):
        self.asked.append((task, request))
        end = self.ends.get((self.engine, task))
        if end:
            raise Ended(*end)
        if task == "open":
            return {"saved_by": "2.83", "blender": "5.0.1", "engine": "CYCLES", "layers": 1, "told": [], "alike": ["Clamp 3"]}
        samples = request["samples"]
        source = np.random.default_rng([request["seed"], self.engine == "LANCER", samples])
        picture = np.ones((*SIZE, 4))
        picture[..., :3] = self.level + self.spread / np.sqrt(samples) * source.standard_normal((*SIZE, 3))
        np.save(request["picture"], picture)
        answer = {"wall": 0.5, "seconds": self.seconds * samples, "peak_bytes": 1e6, "size": [SIZE[1], SIZE[0]]}
        if self.engine == "LANCER":
            answer |= {"messages": [f"no {key}" for key in self.missing], "missing": self.missing, "build_seconds": 0.1}
            answer |= {"export_seconds": 0.2}
        return answer


def measured(folder, ours=1.0, theirs=1.0, missing_file="", **fields):
    """Return (row, the engines that ran)."""
    file = sources.File("some/thing.blend", None if missing_file else folder / "thing.blend", "plot", "", missing_file)
    engines = []

    def start(engine):
        engines.append(Engine(engine, {"LANCER": ours, "CYCLES": theirs}, **fields))
        return engines[-1]

    return measure.Measurement(file, PLAN, start, folder / "pictures", lambda _: None).run(), engines


@pytest.mark.parametrize(
    ("fields", "verdict", "words"),
    [
        ({}, "equal", "mean 0.00%"),
        ({"ours": 1.2}, "untold", "mean 20.00%"),
        ({"ours": 1.2, "missing": {"node:Toon BSDF": 2}}, "told", "mean 20.00%"),
        # A missing feature that does not change the picture is no difference.
        ({"missing": {"node:Toon BSDF": 2}}, "equal", "mean 0.00%"),
        ({"ours": 1.02, "spread": 5.0}, "noise", "noise"),
        ({"ours": 0.0, "theirs": 0.0}, "black", "both pictures are black"),
        ({"theirs": 0.0}, "untold", "Combined"),
        ({"ends": {("LANCER", "render"): ("crash", "ended by SIGSEGV")}}, "failed", "crash: ended by SIGSEGV"),
        ({"ends": {("LANCER", "render"): ("timeout", "not done after 9 s")}}, "failed", "timeout: not done after 9 s"),
        ({"ends": {("LANCER", "render"): ("memory", "needs more")}}, "failed", "memory: needs more"),
        ({"ends": {("CYCLES", "render"): ("crash", "ended by SIGABRT")}}, "cycles", "crash: ended by SIGABRT"),
        ({"ends": {("LANCER", "open"): ("error", "not a blend file")}}, "unreadable", "not a blend file"),
        ({"missing_file": "only a git-lfs pointer is there"}, "missing", "only a git-lfs pointer is there"),
    ],
)
def test_verdicts(tmp_path, fields, verdict, words):
    row, engines = measured(tmp_path, **fields)
    assert (row["verdict"], words in row["sentence"]) == (verdict, True), row
    assert all(engine.closed for engine in engines)


def test_large_squares_find_what_noise_hides_in_small_ones():
    """All light is a tenth darker, under noise of a fifth in each square of 8 x 8 pixels."""
    source = np.random.default_rng(7)
    ours, theirs = (level + 1.6 * source.standard_normal((2, 160, 320, 4)) for level in (0.9, 1.0))
    limit, parts = measure.KIND.limit, measure._parts(ours, theirs)
    verdicts_ = {name: measure.figures.judge(numbers, limit).name for name, numbers in parts.items()}
    assert verdicts_["Combined"] == "noise" and verdicts_["Combined, large squares"] == "fail"


def test_both_engines_render_the_same_by_turns(tmp_path):
    row, engines = measured(tmp_path, spread=0.01)
    renders = [[request for task, request in engine.asked if task == "render"] for engine in engines]
    for ours, theirs in zip(*renders, strict=True):
        assert {**ours, "engine": "", "picture": ""} == {**theirs, "engine": "", "picture": ""}
    seeds = [request["seed"] for request in renders[0]]
    assert len(set(seeds)) == len(seeds) == 1 + PLAN.rounds and row["rounds"] == PLAN.rounds


def test_a_silent_difference_is_looked_at_again(tmp_path):
    """It is rendered again with other seeds and more samples; a difference with a message is not."""
    row, engines = measured(tmp_path, ours=1.2, seconds=0.1)
    samples = [request["samples"] for task, request in engines[0].asked if task == "render"]
    assert samples[1:] == [4, 4, 16, 16] and row["samples"] == 16 and "first_look" in row
    row, engines = measured(tmp_path, ours=1.2, seconds=0.1, missing={"feature:hair": 1})
    assert row["samples"] == 4 and "first_look" not in row


def test_a_picture_without_noise_counts_for_no_speed(tmp_path):
    assert "speed" in measured(tmp_path, spread=0.01)[0]
    assert "speed" not in measured(tmp_path)[0]


def test_samples_follow_the_budget(tmp_path):
    """Two rounds of both engines with set-ups of half a second have 0.4 s left: 16 samples of 5 ms."""
    row, _ = measured(tmp_path, seconds=0.005)
    assert row["samples"] == 16
    row, _ = measured(tmp_path, seconds=0.1)
    assert row["samples"] == PLAN.least


def test_figures_are_lancers_over_cycles():
    """Twice the noise is four times the variance, at any level; the hundredth of the pixels with fireflies is left out."""
    source = np.random.default_rng(5)
    level = 10.0 ** source.uniform(-1, 1, (1, 64, 96, 1))
    ours, theirs = (level * (1.0 + spread * source.standard_normal((4, 64, 96, 3))) for spread in (0.02, 0.01))
    found = noise.compare(*noise.relative_variance(ours, theirs))
    assert found["low"] < 4.0 < found["high"] and found["high"] / found["low"] < 1.3
    theirs[0, :4, :4] *= 1000.0
    bright = noise.compare(*noise.relative_variance(ours, theirs))
    assert bright["ratio"] == pytest.approx(found["ratio"], rel=0.05) and bright["all"] < 0.01
    assert noise.compare(np.zeros((4, 4)), np.ones((4, 4))) is None


def row(name, verdict, missing=(), **fields):
    base = {
        "name": name,
        "kind": "plot",
        "note": "",
        "verdict": verdict,
        "sentence": f"{name} <says>",
        "engines": {},
        "told": [],
    }
    return {**base, "alike": [], "messages": [f"no {key}" for key in missing], "missing": dict.fromkeys(missing, 2), **fields}


ROWS = [
    row("a", "told", ["hair"]),
    row("b", "told", ["noise"]),
    row("c", "told", ["noise", "wave"]),
    row("d", "told", ["wave", "fog", "hair"]),
    row("e", "told", ["noise"]),
    row("f", "equal", ["fog"], speed=2.0, variance={"ratio": 0.5}, efficiency=4.0),
    row("g", "untold", speed=0.5, variance={"ratio": 1.0}, efficiency=0.5),
    row("h", "failed"),
]


def test_what_is_missing_is_ranked_by_the_files_that_it_completes():
    """Noise makes b and e right; then hair and wave make one file right each, and two more files have both; fog comes last."""
    ranked = verdicts.rank(ROWS)
    assert [(item["key"], item["completes"], item["total"]) for item in ranked] == [
        ("noise", 2, 2),
        ("hair", 1, 3),
        ("wave", 1, 4),
        ("fog", 1, 5),
    ]
    # Files that are right have the feature, too.
    assert ranked[3]["files"] == 2 and ranked[0]["uses"] == 6


def test_things_that_complete_nothing_alone_are_ranked_too():
    ranked = verdicts.rank([row("a", "told", ["x", "y"]), row("b", "told", ["y", "z"])])
    assert [(item["key"], item["completes"]) for item in ranked] == [("y", 0), ("x", 1), ("z", 1)]


def test_means_are_over_equal_files_and_over_all():
    found = verdicts.summary(ROWS)
    assert found["counts"] == {"untold": 1, "failed": 1, "told": 5, "equal": 1}
    assert found["means"]["equal"]["efficiency"] == 4.0 and found["means"]["equal"]["files"] == 1
    assert found["means"]["all"]["efficiency"] == pytest.approx(np.sqrt(2.0))
    assert found["means"]["all"]["least_efficiency"] == 0.5
    assert "1 differs without a message" in verdicts.sentence(found) and "8 files" in verdicts.sentence(found)


def figures():
    fields = {"date": "2026-01-02", "commit": "abc1234", "blender": "5.0.1", "quick": True, "plan": dataclasses.asdict(PLAN)}
    return {**fields, "machine": {"processor": "some processor"}, "files": ROWS, "summary": verdicts.summary(ROWS)}


def test_the_page_has_every_row_and_asks_no_network(tmp_path):
    page.write(figures(), tmp_path)
    text = (tmp_path / "index.html").read_text()
    for item in ROWS:
        assert f">{item['name']}<br>" in text and f"{item['name']} &lt;says&gt;" in text
        assert all(f"Lancer: {message}" in text for message in item["messages"])
    assert text.count("<tr data-verdict=") == len(ROWS)
    # The faults come first.
    order = [text.index(f'<tr data-verdict="{verdict}"') for verdict in ("untold", "failed", "told", "equal")]
    assert order == sorted(order)
    assert "http" not in text and json.loads((tmp_path / "corpus.json").read_text())["files"][0]["name"] == "a"


def test_the_summary_has_date_commit_counts_and_means(tmp_path):
    path = tmp_path / "README.md"
    begin, end = marks("corpus", "corpus")
    path.write_text(f"before\n{begin}\nold\n{end}\nafter\n")
    page.update_tables(figures(), path)
    text = path.read_text()
    assert text.startswith("before\n") and text.endswith("after\n") and "old" not in text
    for words in (
        "2026-01-02, commit abc1234",
        "1 differs without a message",
        "| files with equal pictures | 1 | 2.00x | 0.50x | 4.00x | 4.00x |",
    ):
        assert words in text, words
    # The page has every file and the missing features; the README has one of the tables, of two rows.
    assert sum(line.startswith("|") for line in text.splitlines()) == 4 and "noise" not in text


def arguments(folder):
    fields = {"output": folder / "out", "quick": False, "blender": "", "worker": None}
    return argparse.Namespace(**fields)


def test_a_run_goes_on_where_it_ended(tmp_path, monkeypatch, capsys):
    """Figures are kept while file and settings stay the same; a missing file is looked for again."""
    measured = []

    class Counted:
        def __init__(self, file, *_):
            self.file = file

        def run(self):
            measured.append(self.file.name)
            return row(self.file.name, "missing" if self.file.missing else "equal", seconds=1.0)

    monkeypatch.setattr(measure, "Measurement", Counted)
    for name in ("a", "b"):
        (tmp_path / f"{name}.blend").write_bytes(name.encode())
    files = [sources.File(name, tmp_path / f"{name}.blend") for name in ("a", "b")]
    files.append(sources.File("c", None, missing="no clone"))

    def go(plan=PLAN):
        measured.clear()
        run.measure_all(files, arguments(tmp_path), plan, {**figures(), "files": []})
        return measured[:]

    assert go() == ["a", "b", "c"]
    assert go() == ["c"]
    (tmp_path / "a.blend").write_bytes(b"changed")
    assert go() == ["a", "c"]
    assert go(dataclasses.replace(PLAN, pixels=64)) == ["a", "b", "c"]
    assert "2/3 b: equal (kept)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("verdict", "code"), [("equal", 0), ("told", 0), ("cycles", 0), ("missing", 0), ("untold", 1), ("failed", 1)]
)
def test_exit_code(tmp_path, monkeypatch, verdict, code):
    (tmp_path / "a.blend").write_bytes(b"BLENDER")
    monkeypatch.setattr("sys.argv", ["run.py", "--folder", str(tmp_path), "--output", str(tmp_path / "out")])
    monkeypatch.setattr(
        run, "measure_all", lambda files, a, p, found: (found["files"].append(row("a", verdict)), run.write(found, a.output))
    )
    assert run.main() == code


def test_files_of_a_folder(tmp_path):
    (tmp_path / "deep" / "er").mkdir(parents=True)
    (tmp_path / "deep" / "er" / "kitchen.blend").write_bytes(b"BLENDER")
    (tmp_path / "a.blend").write_bytes(b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 3\n")
    (tmp_path / "a.blend1").write_bytes(b"BLENDER")
    found = sources.in_folder(tmp_path)
    assert [(file.name, file.missing) for file in found] == [
        ("a.blend", "only a git-lfs pointer is there"),
        ("deep/er/kitchen.blend", ""),
    ]
    assert [file.name for file in sources.chosen(found, "nothing, KITCH*")] == ["deep/er/kitchen.blend"]
    assert len({file.slug for file in found}) == 2


@pytest.fixture
def clone(tmp_path):
    """Make a bare clone of one repository with two commits. Return (folder of clones, first commit, second)."""
    work = tmp_path / "work"
    (work / "art" / "textures").mkdir(parents=True)
    (work / "other").mkdir()

    def git(*arguments, folder=work):
        settings = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "init.defaultBranch=main"]
        done = subprocess.run(["git", *settings, *arguments], cwd=folder, capture_output=True, text=True, check=True)
        return done.stdout.strip()

    git("init")
    commits = []
    for content in (b"BLENDER one", b"BLENDER two"):
        (work / "art" / "a.blend").write_bytes(content)
        (work / "art" / "textures" / "wood ü.png").write_bytes(bytes(range(256)))
        (work / "other" / "big.bin").write_bytes(b"big")
        if not commits:
            (work / "art" / "inside").symlink_to("textures/wood ü.png")
            (work / "art" / "outside").symlink_to("/etc/passwd")
        git("add", "-A")
        git("commit", "-m", "x")
        commits.append(git("rev-parse", "HEAD"))
    git("clone", "--bare", str(work), str(tmp_path / "clones" / "some+art"), folder=tmp_path)
    return tmp_path / "clones", *commits


def test_a_commit_is_taken_out_of_a_clone(tmp_path, clone):
    folder, first, second = clone
    git = clones.find(folder, "some/art")
    clones.check_out(git, first, "art", tmp_path / "one")
    clones.check_out(git, second, "", tmp_path / "two")
    assert (tmp_path / "one" / "art" / "a.blend").read_bytes() == b"BLENDER one"
    assert (tmp_path / "one" / "art" / "inside").read_bytes() == bytes(range(256))
    # Links out of the repository are not created, and files outside of the root are not checked out.
    assert not (tmp_path / "one" / "art" / "outside").is_symlink() and not (tmp_path / "one" / "other").exists()
    assert (tmp_path / "two" / "art" / "a.blend").read_bytes() == b"BLENDER two" and (tmp_path / "two" / "other").exists()


def test_what_the_list_names_and_clones_lack_is_told(tmp_path, clone):
    folder, first, _ = clone
    rows = [("some/art", first, "art/a.blend"), ("some/art", "0" * 40, "art/a.blend"), ("some/art", first, "art/b.blend")]
    rows.append(("no/body", first, "a.blend"))
    listing = tmp_path / "corpus.toml"
    listing.write_text(
        "".join(f'[[file]]\nrepository = "{r}"\ncommit = "{c}"\npath = "{p}"\nkind = "interior"\n' for r, c, p in rows)
    )
    found = sources.in_list(listing, folder, tmp_path / "files")
    assert [file.missing for file in found] == [
        "",
        f"the clone lacks commit {'0' * 12}",
        "the clone does not hold the file",
        f"no clone of no/body in {folder}",
    ]
    assert found[0].path.read_bytes() == b"BLENDER one" and found[0].kind == "interior"
    nowhere = sources.in_list(listing, None, tmp_path / "files")
    assert all("CLONES=folder" in file.missing for file in nowhere)
