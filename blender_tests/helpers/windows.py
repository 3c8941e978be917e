"""A screen of our own, for Blender's program in a real window."""

import contextlib
import os
import shutil
import subprocess


@contextlib.contextmanager
def screen(width, height):
    """The name of a display on the first free number."""
    assert shutil.which("Xvfb"), "Xvfb is missing: apt-get install xvfb xdotool imagemagick libgl1-mesa-dri"
    reading, writing = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp"],
        pass_fds=[writing],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    try:
        # The number and its newline come one by one, and a server that cannot finish its line gives up.
        with open(reading, encoding="ascii") as file:
            number = file.readline().strip()
        assert number, "Xvfb did not start"
        yield f":{number}"
    finally:
        server.terminate()
        server.wait(10)
