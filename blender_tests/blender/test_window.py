"""F12 pressed in a real window of Debian's Blender 3.4.1: the picture refines, the window answers, Esc stops and keeps it."""

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
# Bytes of the pictures that in_blender/window_pictures.py shows.
TILES, FRAME = ((60, 120, 180), (180, 60, 120)), (120, 180, 60)


@pytest.fixture(scope="module")
def display():
    """A screen of our own on the first free display number."""
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
        """Until the log has the word that often; a Blender that is gone or silent for so long fails."""
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
        """The screen as (h, w, 3), also kept as a file."""
        path = os.path.join(self.folder, name)
        subprocess.run(["import", "-window", "root", path], env=self.environment, check=True)
        raw = subprocess.run(["convert", path, "-depth", "8", "rgb:-"], check=True, capture_output=True).stdout
        return np.frombuffer(raw, np.uint8).reshape(SCREEN[1], SCREEN[0], 3).astype(float)

    def shot_once_rendered(self, name, before):
        """The first shot in which the middle of the screen is another than before."""
        for _ in range(60):
            now = self.shot(name)
            if np.mean(np.abs(middle(now) - middle(before)).mean(axis=2) > 8) > 0.5 and len(np.unique(middle(now))) > 30:
                return now
        raise AssertionError("no picture on the screen")

    def shot_once_refined(self, name, first):
        """The first shot whose middle has a good deal less noise than that of another."""
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
    """Mean absolute difference of neighbours, twice over: noise, not shading."""
    return np.abs(np.diff(picture, n=2, axis=1)).mean()


def middle(shot):
    """The middle of the render window's picture: it stands centred on the screen."""
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
        # The window answers: its timer comes again and again. How soon is measured by `make bench`.
        window.wait_for("tick", len(window.times("tick")) + 10)
        # Esc stops it and keeps the picture.
        window.press("Escape")
        window.wait_for("render_cancel")
        time.sleep(1.0)
        kept = window.shot("kept.png")
        # More samples may have come before it stopped: it is like the picture before, and unlike what was there without one.
        changed = [np.abs(middle(kept) - middle(other)).mean() for other in (second, before)]
        assert changed[0] < 0.5 * changed[1], "the picture is gone"
        assert roughness(middle(kept)) <= 1.1 * roughness(middle(second))
        # And it can be done again.
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
    """The window answers while the scene's features are measured, and Esc stops that with nothing kept."""
    window = Window(str(tmp_path), display)
    try:
        window.wait_for("ready")
        window.tell("measure")
        window.wait_for("running_modal")
        # A timer goes on beside it: nothing holds the window for the seconds that it takes.
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
    """Progress, figures and buttons are drawn when they change, wherever the pointer is, and go with their file."""
    window = Window(str(tmp_path), display, "panels")
    try:
        window.wait_for("ready")
        window.tell("measure quality")
        window.wait_for("running_modal")
        window.wait_for("draws-progress", 2)
        # A render ends the measurement, which would count its time, and no other can be begun beside it.
        window.press("F12")
        window.wait_for("render_pre")
        window.wait_for("draws-button", len(window.times("draws-button")) + 1)
        window.tell("measure quality")
        window.wait_for("refused")
        window.press("Escape")
        cancelled = window.wait_for("render_cancel")
        # The pointer is in the render window: the panel is drawn anew by itself.
        assert window.wait_for("draws-figures") > cancelled
        # It can be measured again, and another file ends that, and knows nothing of all this.
        window.tell("measure quality")
        window.wait_for("running_modal", 2)
        window.tell("load")
        window.wait_for("knows-nothing")
        # Nor does a measurement outlive the add-on.
        window.tell("measure quality")
        window.wait_for("running_modal", 3)
        window.tell("switch")
        window.wait_for("can-measure")
    finally:
        code = window.close()
    # Blender itself leaves with 1 after Esc; a crash would be a signal's number.
    assert code in (0, 1), f"Blender ended with {code}"


def test_the_add_on_goes_while_it_renders(display, tmp_path):
    """Switched off in the midst of a render it ends that first, and can be switched on and render again; then Blender quits
    while it renders."""
    window = Window(str(tmp_path), display)
    try:
        window.wait_for("ready")
        window.press("F12")
        window.wait_for("render_pre")
        window.wait_for("tick", len(window.times("tick")) + 5)
        window.tell("off")
        # The whole job of Blender's is over then.
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
    """The timer that serves renders is there only while a scene's engine is Lancer."""
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
    """A check that takes for ever is looked at beside the window, and Esc ends it with nothing listed."""
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
    """Bytes of sRGB as light."""
    c = np.array(color) / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def test_pictures_from_files_in_a_window(display, tmp_path):
    """Tiles, a sequence, premultiplied bytes and a space that is no curve: read while the window lives, by whom it is safe."""
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
    # The main thread alone makes data, and none of it is the user's; the files themselves are read beside it.
    work = {word for word in said if "-by-" in word}
    assert work == {"load-by-main-adds-0", "write-by-main-adds-0", "read-by-render-adds-0"}
    with open(tmp_path / "colors.json", encoding="utf-8") as file:
        result = json.load(file)
    wanted = [linear(color) for color in (*TILES, FRAME)]
    # Curves in single precision: 2^-23 times the 2.4 of the exponent, and a few steps of the same size for the film.
    assert np.allclose(result["colors"][:3], wanted, rtol=2.0**-19, atol=0.0)
    # The script's render, all of it in the main thread, sees the same, of the others too.
    assert result["difference"] == 0.0 and np.min(result["colors"]) > 0.0
