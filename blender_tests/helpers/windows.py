"""A virtual screen for Blender's program in a real window."""

import contextlib
import os
import shutil
import subprocess


@contextlib.contextmanager
def screen(width, height):
    """Start an X server on the first free number and yield the name of its display."""
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
        # Read the whole line: the server writes number and newline separately and ends if it cannot write.
        with open(reading, encoding="ascii") as file:
            number = file.readline().strip()
        assert number, "Xvfb did not start"
        yield f":{number}"
    finally:
        server.terminate()
        server.wait(10)
