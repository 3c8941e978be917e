"""Frames of a job rendered by Blender itself, by Debian's program with the zip installed and by this Python's module."""

import dataclasses
import os
import subprocess

import blenders
import pytest
from blenders import MODULE, PROGRAM

from addon.farm import lines
from addon.farm.job import Frames


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """Return a user's folder with the add-on, and a file of a small room."""
    folder = tmp_path_factory.mktemp("home")
    blenders.install(folder)
    blenders.run(PROGRAM, folder, "file_cases", "room", folder / "room.blend", 1)
    return folder


@pytest.fixture
def job(home, tmp_path):
    pictures = str(tmp_path / "out" / "f_####.png")
    return Frames(str(home / "room.blend"), "1,2", pictures, blender=blenders.program(), extra=("-F", "PNG"))


def run(command, home, **how):
    done = subprocess.run(
        command, env=blenders.environment(home), cwd=home, capture_output=True, text=True, errors="replace", **how
    )
    return done.returncode, done.stdout + done.stderr


def run_lines(job, home):
    script = os.path.join(home, "job.sh")
    with open(script, "w") as file:
        file.write(lines.text(job, job.tasks()))
    return run(["sh", script], home)


def files(job):
    """Return the time and the size of each file in the folder of the pictures, also of those that are not pictures."""
    folder = os.path.dirname(job.pictures)
    found = {entry.name: entry.stat() for entry in os.scandir(folder)} if os.path.isdir(folder) else {}
    return {name: (stat.st_mtime_ns, stat.st_size) for name, stat in found.items()}


def test_lines_render_what_is_missing(job, home):
    code, said = run_lines(job, home)
    assert code == 0 and said.count("Lancer: error") == 2, said
    first = files(job)
    assert sorted(first) == ["f_0001.png", "f_0002.png"] and min(size for _, size in first.values()) > 500
    os.remove(job.tasks()[0].files[0])
    code, said = run_lines(job, home)
    assert code == 0 and said.count("Lancer: error") == 1, said
    second = files(job)
    assert second["f_0002.png"] == first["f_0002.png"] and sorted(second) == sorted(first)
    # Both frames as one task, which starts Blender: it renders the empty one alone.
    open(job.tasks()[1].files[0], "w").close()
    code, said = run_lines(dataclasses.replace(job, chunk=2), home)
    assert code == 0 and said.count("Lancer: error") == 1, said
    third = files(job)
    assert third["f_0001.png"] == second["f_0001.png"] and third["f_0002.png"][1] == first["f_0002.png"][1]


def test_a_picture_that_is_cut_short_has_no_name(job, home):
    """A limit on the size of files is like a full disk: Blender writes the first bytes, and calls the picture saved."""
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (512, resource.RLIM_INFINITY))"
    first = dataclasses.replace(job, extra=(*job.extra, "--python-expr", limit)).tasks()[0]
    code, said = run(first.arguments, home)
    assert code == 1 and "Not rendered: " + first.files[0] in said, said
    ((name, (_, size)),) = files(job).items()
    assert name.startswith(".part-") and size == 512
    assert run(job.tasks()[0].arguments, home)[0] == 0
    assert files(job)["f_0001.png"][1] > 512


def test_a_failed_render_is_1_and_a_wrong_description_is_2(job, home):
    blenders.run(PROGRAM, home, "file_cases", "room_without_a_camera", home / "blind.blend")
    (first, _) = dataclasses.replace(job, file=str(home / "blind.blend")).tasks()
    code, said = run(first.arguments, home)
    assert code == 1 and "camera" in said.lower(), said
    (first, _) = dataclasses.replace(job, extra=("-F", "BMP")).tasks()
    code, said = run(first.arguments, home)
    assert code == 2 and "f_0001.bmp" in said, said
    assert not files(job)


def test_the_code_of_a_job_in_the_newer_blender(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "f_0002.png").write_text("it is there")
    (tmp_path / "out" / "f_0003.png").touch()
    pattern = str(tmp_path / "out" / "f_####.png")
    found = blenders.run(MODULE, tmp_path, "farm_cases", "animation", pattern, "1,2..3")
    assert found["code"] == 0 and sorted(found["sizes"]) == ["f_0001.png", "f_0002.png", "f_0003.png"]
    assert found["sizes"]["f_0002.png"] == len("it is there") and found["sizes"]["f_0003.png"] > 500
    # A fourth frame has no picture.
    assert blenders.run(MODULE, tmp_path, "farm_cases", "animation", pattern, "1..4")["code"] == 1
