"""Measurements use the scene that F12 renders; figures belong to their scenes; registration is all or nothing."""

import subprocess
import sys

import blenders
import pytest
from blenders import MODULE, PROGRAM
from conftest import ROOT


@pytest.fixture(params=[MODULE, PROGRAM])
def case(request, tmp_path):
    return lambda name: blenders.run(request.param, tmp_path, "fault_cases", name)


def test_what_is_measured_is_what_f12_renders(case):
    """A measurement uses render visibility and render levels of modifiers, and changes nothing in the file."""
    got = case("as_rendered")
    measured, rendered = got["meshes"]
    # A cube subdivided twice has 6 * 4^2 quads, two triangles each; the ball with 16 segments is hidden in viewports only.
    assert measured == rendered and dict(measured)["Cube"] == 192 and [name for name, _ in measured].count("Ball.001") == 1
    assert "Ball" not in dict(measured)
    assert got["settings"] and got["camera"] and got["region"][0] == got["region"][1] == 8
    assert got["messages"][0] == got["messages"][1]
    # No further scene or user, no call of other handlers, and the last picture and its figures are kept.
    assert got["scenes"] == ["Scene"] and got["users"] == []
    assert got["calls"][0] == got["calls"][1] and "render_complete" in got["calls"][0]
    assert got["picture"] and got["statistics"]


def test_measuring_without_a_camera(case):
    got = case("without_camera")
    assert "camera" in got["error"] and got["scenes"] == 1 and not any(got["offered"])


def test_statistics_belong_to_layers_and_scenes(case):
    got = case("layers")
    assert got["layers"] == {got["first"]: 2, "Other": 3} and got["last"] == 3
    assert got["by scene"] and got["names"] == ["Scene"]
    # Figures follow a renamed scene where it has an identity, and never appear for another scene.
    assert not got["old name"] and not got["another scene"]
    assert got["gone"] == [[], 0, False]


def test_statistics_follow_a_renamed_scene(tmp_path):
    assert blenders.run(MODULE, tmp_path, "fault_cases", "layers")["new name"]


def test_layers_share_the_time_limit(case):
    """Each layer gets an even share of the remaining time, and at least one sample."""
    got = case("time_limit")
    first, second, third = got["limits"]
    assert 0.0 < first <= 0.6 / 3.0 and 0.0 < second <= 0.3 and 0.0 < third < 0.6
    # The others share the rest of the time: half of it is the second's.
    assert second < 0.6 - second and third <= 0.6
    assert len(got["samples"]) == 3 and min(got["samples"]) >= 1


def test_changes_are_counted_for_figures_alone(case):
    got = case("handlers")
    got.pop("console")
    assert got == {"start": False, "checked": False, "measured": True, "checked again": True, "loaded": False}


def test_the_add_on_is_registered_all_or_none(case):
    got = case("refused")
    assert got["count"] > 20 and got["left"] == [] and got["errors"] == ["this class is refused"] and got["whole"]


def test_both_eyes_are_denoised(tmp_path):
    # Debian's Blender has no denoiser.
    assert blenders.run(MODULE, tmp_path, "fault_cases", "stereo")["differences"] == [0.0, 0.0]


def test_threads_of_a_window_give_way(tmp_path):
    got = blenders.run(MODULE, tmp_path, "fault_cases", "priority")
    # 19 is the lowest priority on Linux.
    assert got["rendered"] and len(got["session"]) >= 2 and set(got["session"]) == {min(19, got["here"] + 5)}


LITTLE_ROOM = """
import resource, sys
sys.path.insert(0, {root!r} + "/addon")
from addon.bindings.abi import LancerError, load_library

with open("/proc/self/statm") as file:
    used = int(file.read().split()[0]) * resource.getpagesize()
limits = resource.getrlimit(resource.RLIMIT_AS)
resource.setrlimit(resource.RLIMIT_AS, (used + (1 << 20), limits[1]))
try:
    load_library()
    print("loaded")
except LancerError as error:
    print(error)
resource.setrlimit(resource.RLIMIT_AS, limits)
print(load_library().lancer_abi_version())
"""


def test_too_little_address_space_is_told():
    """The message must not suggest a new installation, since the library is complete."""
    done = subprocess.run([sys.executable, "-c", LITTLE_ROOM.format(root=ROOT)], capture_output=True, text=True, check=True)
    told, version = done.stdout.splitlines()
    assert "not enough memory or address space" in told and "install" not in told
    assert int(version) > 0


THREADS = """
import sys
sys.path[:0] = [{root!r} + "/addon", {root!r} + "/blender_tests/helpers"]
import tiny_scenes
from addon.bindings.session import Session
snapshot = tiny_scenes.scene([], [], threads=0)
with Session.upload(snapshot) as session:
    print(session.statistics().threads)
"""


def test_all_threads_are_those_that_the_process_may_run():
    script = THREADS.format(root=ROOT)
    done = subprocess.run(["taskset", "-c", "0", sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.split() == ["1"], done.stdout + done.stderr
