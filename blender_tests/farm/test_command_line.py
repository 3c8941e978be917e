"""The command line: what may be left out, and how wrong use and failures end: by one sentence and an exit code."""

import argparse
import functools
import os
import signal
import subprocess
import sys

import OpenImageIO as oiio
import pytest
from command_line import called
from conftest import ROOT
from given_pool import GivenPool
from tiny_scenes import showroom

from addon.bindings.abi import LancerError
from addon.farm import arguments, dask_pool, dask_scheduler, render_command
from addon.farm.pool import PoolError

SCENE = showroom(16, samples=4)


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """Return a folder with the scene and with files that hold none, which is the current one."""
    monkeypatch.chdir(tmp_path)
    SCENE.save("scene.npz")
    data = (tmp_path / "scene.npz").read_bytes()
    (tmp_path / "cut.npz").write_bytes(data[:-3000])
    (tmp_path / "broken.zip").write_bytes(b"no archive")
    (tmp_path / "folder.npz").mkdir()
    return tmp_path


@pytest.fixture
def lancer(capsys):
    """Return a function that runs the command and returns (exit code, standard output, standard error)."""
    return functools.partial(called, capsys)


def test_the_module_is_a_program():
    environment = {**os.environ, "PYTHONPATH": ROOT}
    done = subprocess.run([sys.executable, "-m", "addon.farm", "cut.npz"], capture_output=True, text=True, env=environment)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert done.stderr.startswith("lancer: cut.npz holds no scene snapshot: ")


@pytest.mark.parametrize("words", [("scene.npz",), ("render", "scene.npz"), ("scene.npz", "--samples", "2", "--half")])
def test_the_picture_is_named_by_its_scene(lancer, words):
    code, out, err = lancer(*words)
    assert (code, out.splitlines()[-1], err) == (0, "scene.exr", "") and os.path.exists("scene.exr")


PART = ("part", "scene.npz", "--samples", "4", "--output", "part.lancer", "--part")


@pytest.mark.parametrize("words", [
    (),
    ("scene",),
    ("scene.exr",),
    ("--samples", "4"),
    ("render",),
    ("render", "scene.npz", "other.npz"),
    ("scene.npz", "--samples", "0"),
    ("scene.npz", "--samples", "many"),
    ("scene.npz", "--samples", "4.5"),
    ("scene.npz", "--samples", str(2**32 + 4)),
    ("scene.npz", "--samples", "\u00b2"),
    ("scene.npz", "--threads", "-1"),
    ("scene.npz", "--threads", "1025"),
    ("scene.npz", "--target", "0"),
    ("scene.npz", "--target", "nan"),
    ("scene.npz", "--target", "small"),
    ("scene.npz", "--time-limit", "-1"),
    ("scene.npz", "--time-limit", "nan"),
    ("scene.npz", "--time-limit", "inf"),
    ("scene.npz", "--workers", "0"),
    ("scene.npz", "-o", "picture.tga"),
    ("scene.npz", "-o", "nowhere/picture.exr"),
    ("nothing.npz",),
    ("cut.npz",),
    ("broken.zip",),
    ("folder.npz",),
    ("scene.npz", "--scheduler", "nonsense"),
    ("scene.npz", "--scheduler", "nonsense://here:8786"),
    ("scene.npz", "--scheduler", "tcp://here:port"),
    ("part",),
    ("part", "scene.npz"),
    (*PART, "0/2"),
    (*PART, "3/2"),
    (*PART, "1/0"),
    (*PART, "1"),
    (*PART, "1/"),
    (*PART, "-1/2"),
    (*PART, "1/2/3"),
    (*PART, "one/two"),
    (*PART, "1/5"),
    (*PART, "1/2", "--samples", "0"),
    (*PART, "1/2", "--samples", str(2**32 + 4)),
    (*PART, "1/2", "--threads", "-1"),
    (*PART, "1/2", "--output", "nowhere/part.lancer"),
    ("part", "nothing.npz", *PART[2:], "1/2"),
    ("part", "cut.npz", *PART[2:], "1/2"),
    ("part", "broken.zip", *PART[2:], "1/2"),
    ("part", "folder.npz", *PART[2:], "1/2"),
    ("merge",),
    ("merge", "part.lancer"),
    ("merge", "--output", "picture.exr"),
    ("worker",),
    ("worker", "tcp://here:8786", "--threads", "some"),
    ("relay",),
])  # fmt: skip
def test_wrong_use_ends_with_2(lancer, words):
    before = sorted(os.listdir())
    code, out, err = lancer(*words)
    assert (code, out, sorted(os.listdir())) == (2, "", before)
    # argparse tells the use before its sentence.
    said = err.splitlines()
    assert said[-1].startswith("lancer") and not any("Traceback" in line or "invalid _" in line for line in said)


@pytest.mark.parametrize("words, sentence", [
    (("nothing.npz",), "lancer: nothing.npz: there is no such file\n"),
    (("part", "nothing.npz", *PART[2:], "1/2"), "lancer: nothing.npz: there is no such file\n"),
    ((*PART, "1/5"), "lancer: 4 samples are too few for 5 parts\n"),
    (("scene.npz", "--scheduler", "nonsense"), "lancer: nonsense is no address of a scheduler: "),
])  # fmt: skip
def test_sentences_name_what_is_wrong(lancer, words, sentence):
    assert lancer(*words)[2].startswith(sentence)


def test_numbers_of_arguments():
    assert [arguments.count(text) for text in ("1", "007", str(2**31))] == [1, 7, 2**31]
    assert [arguments.threads(text) for text in ("0", "3", "1024")] == [0, 3, 1024]
    assert (arguments.percent("2.5"), arguments.seconds("1e3")) == (0.025, 1000.0)
    # The library has 32 bits for them: the second number would be 4.
    for number in (2**31 + 1, 2**32 + 4):
        with pytest.raises(argparse.ArgumentTypeError, match=f"{number} is no number from 1 to {2**31}"):
            arguments.count(str(number))


def raising(error):
    def fail(*_, **__):
        raise error

    return fail


@pytest.mark.parametrize("error, sentence", [
    (LancerError("mesh 'cube': there is none"), "lancer: mesh 'cube': there is none\n"),
    (PoolError("no worker is left"), "lancer: no worker is left\n"),
    (OSError(28, "No space left on device", "picture.exr"), "lancer: [Errno 28] No space left on device: 'picture.exr'\n"),
    (MemoryError(), "lancer: there is not enough memory for this scene\n"),
    (KeyboardInterrupt(), "lancer: interrupted\n"),
])  # fmt: skip
def test_failures_end_with_1(lancer, monkeypatch, error, sentence):
    monkeypatch.setattr(render_command, "render", raising(error))
    assert lancer("scene.npz") == (1, "", sentence)


def test_nobody_at_the_scheduler_is_waited_for_in_vain(lancer, monkeypatch):
    monkeypatch.setattr(dask_scheduler, "Client", raising(OSError("nobody listens")))
    monkeypatch.setattr(dask_pool, "DaskPool", functools.partial(dask_pool.DaskPool, patience=0.0))
    code, out, err = lancer("scene.npz", "--scheduler", "tcp://127.0.0.1:1")
    assert (code, out) == (1, "")
    assert err == "lancer: there is no scheduler at tcp://127.0.0.1:1: nobody listens\n"


def test_missing_certificates_are_told(lancer):
    code, out, err = lancer("scene.npz", "--scheduler", "tls://127.0.0.1:1")
    assert (code, out, err.count("\n")) == (1, "", 1)
    assert err.startswith("lancer: the scheduler at tls://127.0.0.1:1 cannot be spoken to: TLS expects")


def test_missing_dask_is_told(lancer, monkeypatch):
    for name in ("dask_pool", "dask_scheduler", "dask_worker"):
        monkeypatch.delitem(sys.modules, f"addon.farm.{name}", raising=False)
        monkeypatch.delattr(f"addon.farm.{name}", raising=False)
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, out, err = lancer("scene.npz", "--scheduler", "tcp://127.0.0.1:1")
    assert (code, out, err.count("\n")) == (1, "", 1) and err.startswith("lancer: Dask is missing (")
    assert "pip install" in err


# ---- a pool's render, as the scheduler's ----


@pytest.fixture
def by_pool(monkeypatch):
    """Return a function that lets the command render by a pool."""

    def use(pool):
        monkeypatch.setattr(dask_pool, "DaskPool", lambda place, poll: pool)
        pool.dashboard = "http://nowhere"
        return pool

    return use


def test_a_pool_renders_the_same_picture(lancer, by_pool):
    pool = by_pool(GivenPool())
    assert lancer("scene.npz", "--scheduler", "tcp://here:1", "-o", "there.png")[0] == 0
    assert lancer("scene.npz", "-o", "here.png")[0] == 0
    assert len(pool.tasks) > 4
    there, here = (oiio.ImageInput.open(name).read_image("uint8") for name in ("there.png", "here.png"))
    assert (there == here).all() and there.std() > 1.0


def interrupting(pool, at):
    """Let Ctrl-C be pressed when that many parts have come."""
    came = []

    def deliver(waiting):
        came.append(True)
        if len(came) in at:
            signal.raise_signal(signal.SIGINT)
        return [waiting.pop(0)]

    pool.deliver = deliver
    return pool


def test_ctrl_c_keeps_what_has_come(lancer, by_pool):
    before = signal.getsignal(signal.SIGINT)
    pool = by_pool(interrupting(GivenPool(), {5}))
    code, out, err = lancer("scene.npz", "--samples", "4096", "--scheduler", "tcp://here:1")
    assert (code, err) == (0, "") and "cancelled" in out and out.splitlines()[-1] == "scene.exr"
    assert os.path.exists("scene.exr") and len(pool.tasks) < 12
    assert signal.getsignal(signal.SIGINT) is before


def test_a_second_ctrl_c_ends_the_command(lancer, by_pool):
    before = signal.getsignal(signal.SIGINT)
    pool = by_pool(interrupting(GivenPool(), {5}))
    ends = iter((lambda: signal.raise_signal(signal.SIGINT),))
    # The first one cancels the tasks, which may take a while; all is cancelled once more at the end.
    pool.cancel = lambda: next(ends, lambda: None)()
    assert lancer("scene.npz", "--samples", "4096", "--scheduler", "tcp://here:1") == (1, "", "lancer: interrupted\n")
    assert not os.path.exists("scene.exr") and signal.getsignal(signal.SIGINT) is before


def test_ctrl_c_before_the_first_sample_ends_the_command(lancer, by_pool):
    pool = by_pool(GivenPool())
    decide = pool.decide

    def interrupted(poll):
        signal.raise_signal(signal.SIGINT)
        return decide(poll)

    pool.decide = interrupted
    assert lancer("scene.npz", "--scheduler", "tcp://here:1") == (1, "", "lancer: interrupted\n")
    assert not os.path.exists("scene.exr")
