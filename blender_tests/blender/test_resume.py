"""Renders that continue from the file beside the output: to the bits of one long render, also after the end of Blender."""

import signal

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])
FILE = "out_0001.ViewLayer.lancer"


@pytest.fixture
def case(which, tmp_path):
    return lambda name, *arguments: blenders.run(which, tmp_path, "resume_cases", name, *arguments)


def continues(samples):
    return [f"resume file '{FILE}': the picture continues from {samples:.4g} samples per pixel"]


def test_more_samples_of_a_picture(case):
    (first, second, third), (full, empty) = case("more_samples")
    assert first == {"same": True, "facts": [24, "samples", continues(4)], "files": [FILE]}
    assert second == {"same": True, "facts": [40, "samples", continues(24)], "files": [FILE]}
    # A third render has nothing to do.
    assert third == {"same": True, "facts": [40, "samples", continues(40)], "files": [FILE]}
    assert [word for word in full if word.startswith("ViewLayer: 40 samples, ") and word.endswith(" MB")]
    assert "This frame has no file" in empty and full[-1] == empty[-1] == "lancer.delete_resume_files"


@pytest.mark.parametrize("target", [0.0, 0.003])
def test_cancelled_renders_end_as_one_that_is_not(case, target):
    got = case("cancelled", target)
    (few, how, none), (more, why, told) = got["cancelled"]
    assert how == why == "cancelled" and none == [] and told == continues(few) and 0 < few < 16 < more < 64
    assert got["same"] and got["facts"] == [*got["whole"][:2], continues(more)]
    assert got["whole"][1] == ("target error" if target else "samples")
    # No check is made twice, and none is left out.
    assert got["checks"][0] == got["checks"][1] and bool(target) == (len(got["checks"][0]) > 1)


def test_a_killed_render_keeps_what_was_written(which, tmp_path):
    code, said, _ = blenders.attempt(which, tmp_path, "resume_cases", "until_killed", alone=True)
    assert code == -signal.SIGKILL, said
    written = [float(line.split()[0]) for line in (tmp_path / "samples.txt").read_text().splitlines()]
    assert len(written) == 6 and written[3] < written[4] < written[5]
    got = blenders.run(which, tmp_path, "resume_cases", "after_a_kill")
    # Killed while the sixth file replaces the fifth.
    assert got["mean"] == written[4] and got["same"] and got["facts"] == [64, "samples", continues(written[4])]


def test_files_that_do_not_fit_are_told(case):
    got = case("unusable")
    del got["console"]
    reasons = {
        "magic": "it holds no render",
        "format": "it is of another version of Lancer",
        "facts": "it is damaged",
        "samples": "it is damaged: its checksum differs",
        "cut off": "it is incomplete",
        "empty": "it holds no render",
        "camera": "it is of another camera",
        "bounces": "its setting max_bounces is 12, the session's 3",
        "scene": "it is of another scene",
    }
    assert got.pop("the same")[3] == continues(4)
    assert sorted(got) == sorted(reasons)
    for what, (same, samples, ended_by, (told,)) in got.items():
        assert same and (samples, ended_by) == (4, "samples"), what
        assert told.startswith(f"resume file '{FILE}': {reasons[what]}") and told.endswith("; the picture is rendered anew")


def test_layers_and_frames_have_their_files(case):
    got = case("layers_and_frames")
    assert got["first"] == [False] * 4 and got["again"] == [True] * 4
    layers = ("A%2FB %25", "ViewLayer")
    assert got["files"] == [f"out_000{frame}.{layer}.lancer" for frame in (1, 2) for layer in layers]
    assert got["deleted"] == [["FINISHED"], ["out_0001.exr", "out_0002.exr"]]


def test_no_file_unless_asked_and_possible(case):
    none, (samples, ended_by, (told,)) = case("without_files")
    assert none == [] and (samples, ended_by) == (4, "samples") and "cannot be written" in told
