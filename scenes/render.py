"""Renders a scene of this folder, a .blend file or a bug report with Lancer: `make render` calls it."""

import argparse
import contextlib
import os
import re
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402

import addon  # noqa: E402
import scenes  # noqa: E402
from addon.measure.scene_features import kernel_in_words  # noqa: E402
from scenes import replay  # noqa: E402

FORMATS = {".png": "PNG", ".exr": "OPEN_EXR", ".jpg": "JPEG", ".jpeg": "JPEG", ".tif": "TIFF", ".tiff": "TIFF", ".hdr": "HDR"}


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--scene", default="showcase", choices=sorted(scenes.BUILDERS), help="a scene of this folder")
    what.add_argument("--blend", type=Path, help="a .blend file")
    what.add_argument("--snapshot", type=Path, help="a snapshot (.npz) or a bug report (.zip)")
    parser.add_argument("--frame", type=int, help="default: the current frame of the file")
    parser.add_argument("--samples", type=int, help="per pixel; default: the setting of the scene")
    parser.add_argument("--output", type=Path, help="the picture; default: build/NAME.png")
    arguments = parser.parse_args()
    if arguments.samples is not None and arguments.samples < 1:
        parser.error(f"--samples {arguments.samples}: at least 1 is needed")
    return arguments


@contextlib.contextmanager
def captured_output():
    """Redirects Blender's own standard output to a file, and yields (terminal, that file)."""
    sys.stdout.flush()
    saved = os.dup(1)
    with os.fdopen(os.dup(1), "w", buffering=1) as terminal, tempfile.TemporaryFile("w+") as log:
        os.dup2(log.fileno(), 1)
        try:
            yield terminal, log
        finally:
            sys.stdout.flush()
            os.dup2(saved, 1)
            os.close(saved)


class Progress:
    """Shows the engine's status line: rewritten in place on a terminal, one line per 10 % elsewhere."""

    def __init__(self, terminal):
        self.terminal = terminal
        self.shown = -1
        self.width = 0

    def __call__(self, text, *_):
        match = re.search(r"(\d+)\s*/\s*(\d+)", text)
        if not match or int(match[2]) == 0:
            return
        percent = 100 * int(match[1]) // int(match[2])
        line = f"{percent:3d} %  {text.strip()}"
        if self.terminal.isatty():
            self.terminal.write("\r" + line.ljust(self.width))
            self.terminal.flush()
            self.width = len(line)
        elif percent // 10 > self.shown // 10:
            print(line, file=self.terminal)
        self.shown = percent

    def close(self):
        if self.width:
            print(file=self.terminal)


def open_scene(arguments):
    if arguments.blend is None:
        return scenes.load(arguments.scene)
    if not arguments.blend.is_file():
        sys.exit(f"{arguments.blend}: there is no such file.")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(arguments.blend.resolve()), load_ui=False)
    except RuntimeError as error:
        sys.exit(f"{arguments.blend} could not be opened: {str(error).strip()}")
    return bpy.context.scene


def output_path(arguments):
    source = arguments.blend or arguments.snapshot
    name = arguments.scene if source is None else source.stem
    output = (arguments.output or ROOT / "build" / f"{name}.png").absolute()
    if output.suffix.lower() not in FORMATS:
        sys.exit(f"{output.name}: the name should end in one of {', '.join(FORMATS)}")
    output.parent.mkdir(parents=True, exist_ok=True)
    return output


def set_up(scene, arguments):
    """Applies the options of this run to the scene; the file is never saved."""
    scene.render.engine = "LANCER"
    if arguments.samples is not None:
        scene.lancer.quality, scene.lancer.samples, scene.lancer.target_error = "CUSTOM", arguments.samples, 0.0
        for layer in scene.view_layers:
            layer.samples = 0
    if arguments.frame is not None:
        scene.frame_set(arguments.frame)
    output = output_path(arguments)
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "IMAGE"
    image.file_format = FORMATS[output.suffix.lower()]
    scene.render.filepath = str(output)
    return output


def render(scene, terminal):
    progress = Progress(terminal)
    bpy.app.handlers.render_stats.append(progress)
    try:
        bpy.ops.render.render(write_still=True, scene=scene.name)
    finally:
        bpy.app.handlers.render_stats.remove(progress)
        progress.close()


def main():
    arguments = read_arguments()
    if arguments.snapshot is not None:
        again(arguments)
        return
    started = time.perf_counter()
    failure = None
    with captured_output() as (terminal, log):
        scene = open_scene(arguments)
        output = set_up(scene, arguments)
        before = output.stat().st_mtime_ns if output.exists() else None
        try:
            render(scene, terminal)
        except RuntimeError as error:
            failure = str(error).strip()
        log.seek(0)
        warnings = [line.strip() for line in log if line.startswith("Warning:")]
    for line in warnings:
        print(line)
    if failure is None and (not output.exists() or output.stat().st_mtime_ns == before):
        failure = "Blender wrote no picture."
    if failure:
        sys.exit(failure)
    report(addon.engine.last_statistics[scene.name], output, time.perf_counter() - started)


def again(arguments):
    """Renders a snapshot."""
    output = output_path(arguments)
    with captured_output() as (terminal, _):
        progress = Progress(terminal)
        try:
            kind = FORMATS[output.suffix.lower()]
            lines = replay.replay(arguments.snapshot, arguments.samples, output, kind, progress)
        finally:
            progress.close()
    print("\n".join(lines))


def report(statistics, output, seconds):
    print(f"{seconds:.1f} s in all, {statistics['seconds']:.1f} s of it rendering")
    print(f"{statistics['samples']} samples a pixel, {statistics['rays_per_second'] / 1e6:.2f} million rays/s")
    for feature in statistics["uses"]:
        print(feature["text"])
    print(f"shaded by the code for {kernel_in_words(statistics['kernel'])} ({statistics['instruction_set']})")
    print(os.path.relpath(output))


if __name__ == "__main__":
    addon.register()
    try:
        main()
    finally:
        addon.unregister()
