"""`make corpus` in Blender: small files as artists save them, by both engines, each in its own processes."""

import json
import os
import subprocess
import sys

import blenders
import pytest
from blenders import MODULE, PROGRAM

from tools.harness.places import TOOLS
from tools.harness.workers import START


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("corpus")
    blenders.run(MODULE, tmp_path_factory.mktemp("case"), "corpus_cases", "files", folder)
    (folder / "broken.blend").write_bytes(b"BLENDER-v500" + bytes(100))
    return folder


def run(folder, output, *arguments):
    """Return (exit code, output, record)."""
    command = [sys.executable, START, "corpus.run", "--folder", folder, "--output", output, "--quick"]
    command += ["--pixels", "48", "--budget", "1", "--threads", "2", *arguments]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600)
    record = output / "corpus.json"
    return done.returncode, done.stdout + done.stderr, json.loads(record.read_text()) if record.exists() else None


@pytest.fixture(scope="module")
def measured(folder, tmp_path_factory):
    output = tmp_path_factory.mktemp("out")
    code, said, record = run(folder, output)
    assert record is not None, said
    return code, said, {row["name"]: row for row in record["files"]}, output


def test_what_differs_by_settings_alone_is_made_alike(measured):
    """Clamps, filters, exposure, bounces of a kind: both engines then show the same, and the page names the changes."""
    row = measured[2]["alike.blend"]
    assert row["verdict"] == "equal" and row["parity"]["noise_mean"] < 0.01, row
    told = ", ".join(row["alike"])
    for words in ("Clamp Direct 0.2", "Clamp Indirect 0.1", "Filter Glossy 1", "no reflective caustics", "Fast GI"):
        assert words in told
    for words in ("film exposure 3", "Gaussian filter", "bounces of diffuse 0, glossy 1"):
        assert words in told
    assert "first of 2 view layers" in row["told"][0] and not [text for text in row["messages"] if "Cycles" in text]


def test_a_row_has_its_figures(measured):
    row = measured[2]["alike.blend"]
    assert row["size"] == [48, 24] and row["engine"] == "CYCLES" and row["saved_by"] == row["blender"].rpartition(".")[0]
    ours, theirs = (row["engines"][engine] for engine in ("LANCER", "CYCLES"))
    for record in (ours, theirs):
        assert record["samples_per_second"] > 0 and record["setup_seconds"] > 0 and record["peak_bytes"] > 0
    assert ours["export_seconds"] > 0 and ours["build_seconds"] > 0
    assert row["efficiency"] == pytest.approx(row["speed"] / row["variance"]["ratio"])


def test_what_is_missing_explains_a_difference(measured):
    row = measured[2][os.path.join("deep", "fog.blend")]
    assert (row["verdict"], row["missing"]) == ("told", {"feature:volume": 1})


def test_a_file_without_a_camera_gets_one(measured):
    row = measured[2]["nocamera.blend"]
    assert row["verdict"] == "equal" and row["engine"] == "BLENDER_WORKBENCH"
    assert row["told"] == ["it has no camera, one that frames all is used"]


def test_what_cannot_be_opened_is_a_row(measured):
    assert measured[2]["broken.blend"]["verdict"] == "unreadable"


def test_the_page_and_its_pictures(measured):
    code, said, rows, output = measured
    text = (output / "index.html").read_text()
    assert code == 0 and "4 files: 1 differs with a message, 2 equal, 1 cannot be opened" in said
    for row in rows.values():
        assert f">{row['name']}<br>" in text
        assert all((output / "pictures" / name).stat().st_size > 100 for name in row.get("pictures", ()))
    assert len(rows["alike.blend"]["pictures"]) == 3


def test_a_run_again_renders_nothing(measured, folder):
    _, _, rows, output = measured
    code, said, record = run(folder, output)
    assert code == 0 and said.count("(kept)") == 4, said
    assert {row["name"]: row for row in record["files"]} == rows


def test_an_engine_that_dies_is_a_row(folder, tmp_path):
    """The process of one engine ends by a signal while it renders; the run continues, and fails if the engine is Lancer."""
    script = tmp_path / "worker.py"
    script.write_text(
        f"import os, signal, sys\nsys.path.insert(0, {str(TOOLS)!r})\nimport start\n"
        "from tools.corpus import worker\nrender = worker.render\n"
        "def dies(engine, **fields):\n"
        "    if engine == os.environ['DIES']:\n"
        "        os.kill(os.getpid(), signal.SIGSEGV)\n"
        "    return render(engine, **fields)\n"
        "worker.TASKS['render'] = dies\nworker.main()\n"
    )
    for engine, verdict, expected in (("LANCER", "failed", 1), ("CYCLES", "cycles", 0)):
        os.environ["DIES"] = engine
        try:
            code, said, record = run(folder, tmp_path / engine, "--only", "nocamera*", "--worker", script)
        finally:
            del os.environ["DIES"]
        (row,) = record["files"]
        assert (row["verdict"], row["sentence"], code) == (verdict, "crash: ended by SIGSEGV", expected), said
        # The page has the other engine's picture.
        assert len(row["pictures"]) == 3 or engine == "LANCER"


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_messages_tell_programs_what_is_missing(which, tmp_path):
    got = blenders.run(which, tmp_path, "corpus_cases", "missing")
    assert got["first"] == {"feature:shadow caustics": 1, "node:Attribute": 2}
    # A later render without the feature has no message of it.
    assert got["second"] == {"node:Attribute": 2}
    assert len(got["first lines"]) == 4 and any("slot" in line for line in got["first lines"])
