"""One file in one Blender, for one engine: answer requests, a line of JSON each, until standard input ends.

Runs under a Python that has bpy (start.py corpus.worker FD), and inside Blender: blender -b -P start.py -- corpus.worker FD
FD: the file descriptor of the answers; standard output, where Blender and libraries print, is ignored.
"""

import json
import os
import sys
import time

import bpy
import numpy as np

import addon
from tools.corpus import alike, framing
from tools.harness import denoising, workers
from tools.harness.f12 import press_f12


def open_file(path, pixels, threads):
    """Open a file without running its scripts. Return facts of it."""
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False, use_scripts=False)
    scene = bpy.context.scene
    told = []
    engine = scene.render.engine
    layer, layers = alike.choose_layer(scene)
    told.append(framing.find_camera(scene, layer))
    if layers > 1:
        told.append(f"the first of {layers} view layers is rendered, '{layer.name}'")
    missing = alike.missing_libraries()
    if missing:
        told.append(f"{len(missing)} linked libraries are not there: {', '.join(missing[:3])}")
    alike_ = alike.make_alike(scene, pixels, threads)
    return {
        "saved_by": ".".join(map(str, bpy.data.version[:2])),
        "blender": bpy.app.version_string,
        "engine": engine,
        "layers": layers,
        "told": [text for text in told if text],
        "alike": alike_,
    }


def render(engine, samples, seed, picture):
    """Press F12 and save the picture as .npy. Return the seconds by the engine's clock and by the wall, and the memory above
    that of Blender with the file.
    """
    scene = bpy.context.scene
    scene.render.engine = engine
    alike.set_samples(scene, samples, seed)
    workers.reset_peak()
    before = workers.memory("VmRSS")
    with _timed_export() as export:
        rendered = press_f12(scene)
    result = {"wall": rendered.wall, "seconds": rendered.seconds, "peak_bytes": max(0, rendered.peak - before)}
    np.save(picture, rendered.picture)
    result["size"] = [*rendered.picture.shape[1::-1]]
    if engine == "LANCER":
        statistics = addon.engine.last_statistics[scene.name]
        wanted = ("build_seconds", "kernel", "features", "triangles", "instances", "lights")
        result |= {name: statistics[name] for name in wanted}
        result |= {"messages": list(addon.engine.last_messages[scene.name]), "missing": addon.engine.last_missing[scene.name]}
        result["export_seconds"] = sum(export)
    return result


def denoised(engine, counts, seed, folder):
    """Press F12 with denoising at each number of samples; write folder/COUNT.npy and return [(count, seconds)]."""
    scene = bpy.context.scene
    denoising.denoise(scene)

    def set_samples(scene, samples, seed):
        alike.set_samples(scene, samples, seed)
        denoising.denoise(scene)

    rendered = denoising.curve(scene, engine, counts, seed, set_samples)
    denoising.denoise(scene, False)
    for count, _, picture in rendered:
        np.save(os.path.join(folder, f"{count}.npy"), picture)
    return [(count, seconds) for count, seconds, _ in rendered]


class _timed_export:
    """A context: the list of the seconds of each export within it."""

    def __enter__(self):
        self.export, seconds = addon.engine.render_engine.export_picture, []

        def timed(*arguments):
            start = time.perf_counter()
            try:
                return self.export(*arguments)
            finally:
                seconds.append(time.perf_counter() - start)

        addon.engine.render_engine.export_picture = timed
        return seconds

    def __exit__(self, *_):
        addon.engine.render_engine.export_picture = self.export


TASKS = {"open": open_file, "render": render, "denoised": denoised}


def serve(answers):
    for line in sys.stdin:
        request = json.loads(line)
        try:
            answer = TASKS[request.pop("task")](**request)
        except Exception as error:
            # The text of Blender's errors has its reports, a line each.
            lines = [text for text in str(error).splitlines() if text.strip()] or [type(error).__name__]
            answer = {"error": lines[0][:500]}
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


def main():
    addon.register()
    with os.fdopen(int(sys.argv[-1]), "w", encoding="utf-8") as answers:
        serve(answers)
    workers.leave()


if __name__ == "__main__":
    main()
