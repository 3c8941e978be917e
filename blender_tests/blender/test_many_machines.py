"""F12 on many machines, in the bpy module of this Python and in Debian's Blender: the same bits, and errors that help."""

import subprocess
import sys
import venv

import blenders
import pytest
import small_cluster
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    with small_cluster.cluster(tmp_path_factory.mktemp("cluster")) as made:
        made.wait_for_workers(2)
        yield made


@pytest.fixture
def case(which, tmp_path):
    return lambda name, *arguments: blenders.run(which, tmp_path, "machine_cases", name, *arguments)


def test_the_picture_is_that_of_this_machine(case, cluster, which):
    got = case("f12", cluster.address, sys.executable)
    assert got["same"] and got["here"] == got["there"] and got["bright"] > 0.0
    assert which == PROGRAM or any("2 workers" in text for text in got["told"])


def test_a_target_error_ends_it_as_on_this_machine(case, cluster):
    got = case("target", cluster.address, sys.executable)
    assert got["here"] == got["there"] and got["same"]
    assert got["here"]["ended_by"] == "target error" and 16 <= got["here"]["samples"] < got["here"]["samples_most"]


def test_errors_say_what_to_do(case, tmp_path):
    assert "Many Machines > Scheduler" in case("failure", "", sys.executable)
    assert "preferences" in case("failure", "tcp://127.0.0.1:1", str(tmp_path / "no_python"))
    assert "nonsense is no address of a scheduler" in case("failure", "nonsense", sys.executable)
    venv.create(tmp_path / "bare", symlinks=True)
    bare = str(tmp_path / "bare" / "bin" / "python")
    assert subprocess.run([bare, "-c", "import distributed"], capture_output=True).returncode == 1
    assert "pip install distributed" in case("failure", "tcp://127.0.0.1:1", bare)
