"""F12 in a real window of Debian's Blender 3.4.1: the picture refines, the window responds, Esc stops and keeps it."""

import json
import os
import shutil
import subprocess
import time

import blenders
import numpy as np
import pytest
import windows
from conftest import HERE, ROOT

SCREEN = (1280, 800)
# Colours of the images in in_blender/window_pictures.py.
TILES, FRAME = ((60, 120, 180), (180, 60, 120)), (120, 180, 60)


@pytest.fixture(scope="module")
def display():
    """Return a virtual screen on the first free display number."""
    for tool in ("Xvfb", "xdotool", "import", "convert"):
        assert shutil.which(tool), f"{tool} is missing: apt-get install xvfb xdotool imagemagick libgl1-mesa-dri"
    with windows.screen(*SCREEN) as name:
        yield name


class Window:
    """A running Blender and its log."""

    def __init__(self, folder, display, *kind):
        self.folder = folder
        self.environment = blenders.environment(folder, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1")
        script = os.path.join(HERE, "blender", "in_blender", "window_case.py")
        self.output = open(os.path.join(folder, "console.txt"), "w", encoding="utf-8")
        place = ["-p", "0", "0", *map(str, SCREEN)]
        self.process = subprocess.Popen(
            [blenders.program(), "--factory-startup", *place, "-P", script, "--", str(folder), *kind],
            env=self.environment,
            cwd=folder,
            stdout=self.output,
            stderr=subprocess.STDOUT,
        )

    def log(self):
        path = os.path.join(self.folder, "log.txt")
        if not os.path.exists(path):
            return []
        with open(path, encoding="utf-8") as file:
            return [(float(line.split()[0]), line.split()[1]) for line in file if line.endswith("\n")]

    def times(self, word):
        return [at for at, what in self.log() if what == word]

    def wait_for(self, word, count=1, patience=90):
        """Wait until the log has the word that often; fail if Blender has ended or does not write it in time."""
        limit = time.monotonic() + patience
        while len(self.times(word)) < count:
            said = open(self.output.name, encoding="utf-8", errors="replace").read()[-2000:]
            assert self.process.poll() is None, f"Blender ended with {self.process.returncode}\n{said}"
            assert time.monotonic() < limit, f"no '{word}' in {patience} s\n{said}"
            time.sleep(0.05)
        return self.times(word)[-1]

    def press(self, key):
        middle = [str(SCREEN[0] // 2), str(SCREEN[1] // 2)]
        subprocess.run(["xdotool", "mousemove", *middle, "key", key], env=self.environment, check=True)

    def shot(self, name):
        """Return a screenshot as (h, w, 3), and keep it as a file."""
        path = os.path.join(self.folder, name)
        subprocess.run(["import", "-window", "root", path], env=self.environment, check=True)
        raw = subprocess.run(["convert", path, "-depth", "8", "rgb:-"], check=True, capture_output=True).stdout
        return np.frombuffer(raw, np.uint8).reshape(SCREEN[1], SCREEN[0], 3).astype(float)

    def shot_once_rendered(self, name, before):
        """Return the first screenshot in which the centre of the screen differs from before."""
        for _ in range(60):
            now = self.shot(name)
            if np.mean(np.abs(middle(now) - middle(before)).mean(axis=2) > 8) > 0.5 and len(np.unique(middle(now))) > 30:
                return now
        raise AssertionError("no picture on the screen")

    def shot_once_refined(self, name, first):
        """Return the first screenshot whose centre has clearly less noise than that of first."""
        for _ in range(120):
            now = self.shot(name)
            if roughness(middle(now)) < 0.8 * roughness(middle(first)):
                return now
            time.sleep(0.25)
        raise AssertionError("the picture on the screen does not refine")

    def tell(self, word):
        open(os.path.join(self.folder, word), "w").close()

    def close(self):
        self.tell("quit")
        try:
            return self.process.wait(30)
        finally:
            self.process.kill()
            self.output.close()


def roughness(picture):
    """Return the mean absolute second difference of neighbours, which measures noise instead of shading."""
    return np.abs(np.diff(picture, n=2, axis=1)).mean()


def middle(shot):
    """Return the centre of the render window's picture, which is centred on the screen."""
    h, w, _ = shot.shape
    return shot[h // 2 - 100 : h // 2 + 120, w // 2 - 160 : w // 2 + 160]


def test_f12_in_a_window(display, tmp_path):
    window = Window(str(tmp_path), display)
    try:
        window.wait_for("ready")
        before = window.shot("before.png")
        window.press("F12")
        window.wait_for("render_pre")
        # The first picture on the screen, then one with less noise.
        first = window.shot_once_rendered("first.png", before)
        second = window.shot_once_refined("second.png", first)
        # The window responds: its timer keeps running. `make bench` measures the latency.
        window.wait_for("tick", len(window.times("tick")) + 10)
        # Esc stops it and keeps the picture.
        window.press("Escape")
        window.wait_for("render_cancel")
        time.sleep(1.0)
        kept = window.shot("kept.png")
        # Further samples may have come before the stop: the picture is like the one before, and unlike an empty window.
        changed = [np.abs(middle(kept) - middle(other)).mean() for other in (second, before)]
        assert changed[0] < 0.5 * changed[1], "the picture is gone"
        assert roughness(middle(kept)) <= 1.1 * roughness(middle(second))
        # Render again.
        window.press("F12")
        window.wait_for("render_pre", 2)
        time.sleep(1.0)
        window.press("Escape")
        window.wait_for("render_cancel", 2)
    finally:
        code = window.close()
        os.makedirs(os.path.join(ROOT, "build"), exist_ok=True)
        for name in ("first.png", "second.png", "kept.png"):
            if os.path.exists(tmp_path / name):
                shutil.copy(tmp_path / name, os.path.join(ROOT, "build", "window_" + name))
    # Blender itself leaves with 1 when its last render was broken off; a crash would be a signal's number.
    assert code in (0, 1), f"Blender ended with {code}"


def test_features_are_measured_beside_the_window(display, tmp_path):
    """The window responds during a measurement of features, and Esc stops it without results."""
    window = Window(str(tmp_path), display)
    try:
        window.wait_for("ready")
        window.tell("measure")
        window.wait_for("running_modal")
        # A timer keeps running: the measurement does not block the window.
        window.wait_for("tick", len(window.times("tick")) + 5)
        window.tell("measuring?")
        window.wait_for("measuring")
        window.press("Escape")
        for asked in range(90):
            window.tell("measuring?")
            window.wait_for("tick", len(window.times("tick")) + 2)
            if len(window.times("measuring")) < asked + 2:
                break
        window.wait_for("nothing")
    finally:
        code = window.close()
    # Blender itself leaves with 1 after Esc; a crash would be a signal's number.
    assert code in (0, 1), f"Blender ended with {code}"


def test_panels_tell_what_goes_on(display, tmp_path):
    """Progress, figures and buttons are redrawn when they change, wherever the pointer is, and end with their file."""
    window = Window(str(tmp_path), display, "panels")
    try:
        window.wait_for("ready")
        window.tell("measure quality")
        window.wait_for("running_modal")
        window.wait_for("draws-progress", 2)
        # A render stops the measurement, and no other can start during it.
        window.press("F12")
        window.wait_for("render_pre")
        window.wait_for("draws-button", len(window.times("draws-button")) + 1)
        window.tell("measure quality")
        window.wait_for("refused")
        window.press("Escape")
        cancelled = window.wait_for("render_cancel")
        # The pointer is in the render window: the panel must redraw by itself.
        assert window.wait_for("draws-figures") > cancelled
        # Measure again; loading another file ends the measurement and drops all figures.
        window.tell("measure quality")
        window.wait_for("running_modal", 2)
        window.tell("load")
        window.wait_for("knows-nothing")
        # Disabling the add-on ends a measurement.
        window.tell("measure quality")
        window.wait_for("running_modal", 3)
        window.tell("switch")
        window.wait_for("can-measure")
    finally:
        code = window.close()
    # Blender itself leaves with 1 after Esc; a crash would be a signal's number.
    assert code in (0, 1), f"Blender ended with {code}"


def test_the_add_on_goes_while_it_renders(display, tmp_path):
    """Disabling the add-on during a render ends the render first; it can be enabled and render again; then Blender quits during
    a render."""
    window = Window(str(tmp_path), display)
    try:
        window.wait_for("ready")
        window.press("F12")
        window.wait_for("render_pre")
        window.wait_for("tick", len(window.times("tick")) + 5)
        window.tell("off")
        # Blender's whole render job has ended.
        assert window.wait_for("off") >= window.wait_for("render_cancel")
        window.wait_for("tick", len(window.times("tick")) + 5)
        window.tell("on")
        window.wait_for("on")
        window.press("Escape")
        window.press("F12")
        window.wait_for("render_pre", 2)
        window.wait_for("tick", len(window.times("tick")) + 5)
        window.tell("quit")
        code = window.process.wait(90)
    finally:
        window.close()
    # Blender itself leaves with 1 when its last render was broken off; a crash would be a signal's number.
    assert code in (0, 1), f"Blender ended with {code}"


def test_nothing_runs_for_other_engines(display, tmp_path):
    """The timer for renders runs only while a scene's engine is Lancer."""
    window = Window(str(tmp_path), display)
    try:
        window.wait_for("ready")
        window.wait_for("serves")
        window.tell("CYCLES")
        window.wait_for("rests")
        window.tell("LANCER")
        window.wait_for("serves", 2)
    finally:
        code = window.close()
    assert code == 0, f"Blender ended with {code}"


def test_check_scene_leaves_the_window_alive(display, tmp_path):
    """The window responds during a long check, and Esc stops it without findings."""
    window = Window(str(tmp_path), display)
    try:
        window.wait_for("ready")
        window.tell("check")
        window.wait_for("running_modal")
        window.wait_for("tick", len(window.times("tick")) + 3)
        window.tell("measuring?")
        window.wait_for("measuring")
        window.press("Escape")
        window.wait_for("check-cancelled")
        window.tell("measuring?")
        window.wait_for("nothing")
        window.tell("listed?")
        window.wait_for("unlisted")
    finally:
        code = window.close()
    assert code in (0, 1), f"Blender ended with {code}"


def linear(color):
    """Return linear values of sRGB bytes."""
    c = np.array(color) / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def test_pictures_from_files_in_a_window(display, tmp_path):
    """Tiles, a sequence, premultiplied bytes and a colour space that is no curve, read in a window by the right threads."""
    window = Window(str(tmp_path), display, "pictures")
    try:
        window.wait_for("ready")
        window.press("F12")
        window.wait_for("render_complete")
        said = {word for _, word in window.log()}
        window.tell("compare")
        window.wait_for("compared")
    finally:
        code = window.close()
    assert code == 0, f"Blender ended with {code}"
    # Only the main thread creates data, outside the user's; the render thread reads the files.
    work = {word for word in said if "-by-" in word}
    assert work == {"load-by-main-adds-0", "write-by-main-adds-0", "read-by-render-adds-0"}
    with open(tmp_path / "colors.json", encoding="utf-8") as file:
        result = json.load(file)
    wanted = [linear(color) for color in (*TILES, FRAME)]
    # Curves in single precision: 2^-23 times the 2.4 of the exponent, and a few steps of the same size for the film.
    assert np.allclose(result["colors"][:3], wanted, rtol=2.0**-19, atol=0.0)
    # A script's render, entirely in the main thread, gives the same pictures.
    assert result["difference"] == 0.0 and np.min(result["colors"]) > 0.0
