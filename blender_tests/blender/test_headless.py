"""`blender -b file.blend -E LANCER -o //out_ -f 1` with the zip installed, in Debian's Blender 3.4.1."""

import os
import signal
import subprocess

import blenders
import pytest
from blenders import PROGRAM


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """Return a user's folder with the add-on installed from its zip."""
    folder = tmp_path_factory.mktemp("home")
    blenders.install(folder)
    return folder


def blend(home, name, function, *arguments):
    path = os.path.join(home, name)
    blenders.run(PROGRAM, home, "file_cases", function, path, *arguments)
    return path


def command_line(path, *tail):
    return [blenders.program(), "-b", path, "-E", "LANCER", "-o", "//out_", *tail]


def render(home, path, *tail):
    return subprocess.run(
        command_line(path, *tail),
        env=blenders.environment(home),
        cwd=home,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=300,
    )


def test_one_frame(home):
    path = blend(home, "room.blend", "room", 4)
    done = render(home, path, "-F", "PNG", "-f", "1")
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    picture = os.path.join(home, "out_0001.png")
    assert os.path.getsize(picture) > 500, said
    # Blender silently uses another engine if this one is missing: the output must contain the engine's own text.
    assert "rays/s" in said


def test_animation(home):
    path = blend(home, "frames.blend", "room", 1)
    done = render(home, path, "-F", "PNG", "-s", "1", "-e", "3", "-a")
    assert done.returncode == 0, done.stdout + done.stderr
    assert all(os.path.exists(os.path.join(home, f"out_000{i}.png")) for i in (1, 2, 3))


def test_failure_is_seen(home):
    path = blend(home, "blind.blend", "room_without_a_camera")
    done = render(home, path, "-F", "PNG", "-o", "//blind_", "-f", "1")
    said = done.stdout + done.stderr
    assert done.returncode == 1, said
    assert "camera" in said.lower() and not os.path.exists(os.path.join(home, "blind_0001.png"))


def test_interrupt(home):
    """Ctrl-C ends a long render without a crash."""
    path = blend(home, "long.blend", "long_render")
    process = subprocess.Popen(
        command_line(path, "-F", "PNG", "-f", "1"),
        env=blenders.environment(home),
        cwd=home,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        bufsize=1,
    )
    try:
        for line in process.stdout:
            if "rays/s" in line:
                break
        process.send_signal(signal.SIGINT)
        rest, _ = process.communicate(timeout=60)
    finally:
        process.kill()
    # A negative code is a crash; without the interrupt 100 000 samples would take far longer than the minute allowed above.
    assert process.returncode >= 0, rest[-2000:]
    assert "Traceback" not in rest
