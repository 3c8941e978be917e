"""Bug reports: their content, replays with the same bits, and messages for invalid files."""

import dataclasses
import json
import os
import subprocess
import sys
import zipfile

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM
from conftest import ROOT
from rich_snapshot import rich

from addon.bindings import bug_report
from addon.bindings.npz import SnapshotError
from addon.bindings.snapshot import Image

FACTS = {"versions": {"Blender": "9.9"}, "messages": []}


def test_a_report_holds_the_scene_and_the_facts(tmp_path):
    path, told = str(tmp_path / "report.zip"), []
    bug_report.save(path, FACTS, rich(), told.append)
    snapshot, facts = bug_report.load(path)
    assert snapshot == rich() and facts == FACTS
    assert told == [1.0]
    assert os.listdir(tmp_path) == ["report.zip"]
    # A large report calls tell() repeatedly.
    large, told = dataclasses.replace(rich(), images=(Image(texels=np.zeros((1024, 1024, 4), np.float32)),)), []
    bug_report.save(path, FACTS, large, told.append)
    assert told == sorted(told) and told[-1] == 1.0 and len(told) > 10
    # load() accepts a plain snapshot too.
    rich().save(str(tmp_path / "scene.npz"))
    assert bug_report.load(str(tmp_path / "scene.npz")) == (rich(), {})


def test_a_report_that_cannot_be_written_leaves_the_old_one(tmp_path):
    path = tmp_path / "report.zip"
    path.write_text("the old one")

    def fail(_share):
        raise OSError("the disk is full")

    with pytest.raises(OSError):
        bug_report.save(str(path), FACTS, rich(), fail)
    assert path.read_text() == "the old one" and os.listdir(tmp_path) == ["report.zip"]


def _put(path, **files):
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in files.items():
            archive.writestr(name.replace("_", "."), content)


def test_files_that_are_no_reports(tmp_path):
    path = str(tmp_path / "report.zip")
    bug_report.save(path, FACTS)
    with pytest.raises(SnapshotError, match="a report without a scene"):
        bug_report.load(path)
    for files in ({"report_json": "{", "snapshot_npz": "x"}, {"report_json": "{}", "snapshot_npz": b"PK"}, {"other_txt": ""}):
        _put(path, **files)
        with pytest.raises(SnapshotError, match="report.zip|snapshot.npz"):
            bug_report.load(path)
    # Facts that are no dict are ignored.
    rich().save(str(tmp_path / "scene.npz"))
    _put(path, report_json="[1]", snapshot_npz=(tmp_path / "scene.npz").read_bytes())
    assert bug_report.load(path) == (rich(), {})
    with pytest.raises(FileNotFoundError):
        bug_report.load(str(tmp_path / "none.zip"))


def test_reports_spoiled_by_chance(tmp_path):
    """Every corrupted file loads or raises SnapshotError. The first one is corrupted in an unused field, a time stamp."""
    path, generator, ends = str(tmp_path / "report.zip"), np.random.default_rng(3), set()
    bug_report.save(path, FACTS, rich())
    with open(path, "rb") as file:
        whole = np.frombuffer(file.read(), np.uint8)
    for number in range(200):
        data = whole.copy()
        places = generator.integers(0, len(data), generator.integers(1, 9)) if number else np.arange(10, 14)
        data[places] = generator.integers(0, 256, len(places))
        with open(path, "wb") as file:
            file.write(data[: generator.integers(1, len(data)) if number % 4 == 1 else None].tobytes())
        try:
            bug_report.load(path)
            ends.add("loaded")
        except SnapshotError:
            ends.add("refused")
    assert ends == {"loaded", "refused"}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_blender_saves_what_a_maintainer_needs(which, tmp_path):
    got = blenders.run(which, tmp_path, "report_cases", "saved", tmp_path)
    assert got["result"] == [["FINISHED"]] * 3 + [["CANCELLED"]] and got["button"]
    snapshot, facts = bug_report.load(str(tmp_path / "whole.zip"))
    assert len(snapshot.instances) == 2 and len(snapshot.images) == 0
    assert set(facts["versions"]) >= {"Lancer", "library", "Blender", "system", "processor", "numpy"}
    assert facts["versions"]["Blender"].startswith(got["version"])
    assert facts["settings"]["lancer"]["samples"] == 16 and facts["settings"]["render"]["resolution_x"] == 48
    assert facts["settings"]["cycles"]["max_bounces"] == 12
    # The settings contain no path of the user.
    assert "secret" not in json.dumps(facts["settings"])
    told = [(message["text"], message["severity"]) for message in facts["messages"]]
    assert told == [("object 'Cube': material slot 1 is empty, grey is used", "HINT")] and len(facts["exported"]) == 1
    assert facts["statistics"]["error"] > 0.0 and facts["statistics"]["accuracy"]
    assert "It contains the geometry and the images of the scene" in got["console"]
    for name, word in (("without.zip", "without the scene"), ("failed.zip", "without the scene: ")):
        with pytest.raises(SnapshotError, match="without a scene"):
            bug_report.load(str(tmp_path / name))
        assert word in got["console"]
    with zipfile.ZipFile(tmp_path / "failed.zip") as archive:
        (failure,) = json.loads(archive.read("report.json"))["exported"]
    assert failure["severity"] == "FAILED" and "camera" in failure["text"]
    assert "the report could not be written" in got["error"]


def replay(*arguments):
    command = [sys.executable, os.path.join(ROOT, "scenes", "render.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=300)


def test_a_replay_is_the_render(tmp_path):
    """The same snapshot gives the same bits in Blender and in a replay."""
    got = blenders.run(MODULE, tmp_path, "report_cases", "rendered", tmp_path)
    done = replay("--snapshot", tmp_path / "report.zip", "--output", tmp_path / "again.exr")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "reported with Blender: " in done.stdout and "error " in done.stdout and "million rays/s" in done.stdout
    assert "object 'Cube': material slot 1 is empty, grey is used" in done.stdout
    same = blenders.run(MODULE, tmp_path, "report_cases", "same", tmp_path / "picture.exr", tmp_path / "again.exr")
    assert same["shape"] == [27, 48, 4] and same["same"] and got["mean"] > 0.01
    done = replay("--snapshot", tmp_path / "report.zip", "--output", tmp_path / "again.png", "--samples", "3")
    assert done.returncode == 0 and "3 samples in" in done.stdout, done.stdout
    assert (tmp_path / "again.png").read_bytes().startswith(b"\x89PNG")


def test_what_cannot_be_replayed_is_told(tmp_path):
    (tmp_path / "text.zip").write_text("no archive")
    for name, word in (("text.zip", "holds no scene snapshot"), ("none.zip", "there is no such file")):
        done = replay("--snapshot", tmp_path / name, "--output", tmp_path / "x.png")
        assert done.returncode == 1 and word in done.stderr and "Traceback" not in done.stderr, done.stderr
