"""How F12 reports its accuracy: in the statistics, in the file, as a pass."""

import os
import re
import tempfile

import bpy
import exr
import numpy as np
import stage

from addon.engine import render_engine as engine


def _noisy(**settings):
    """A room with soft shadows."""
    scene = stage.room(samples=settings.pop("samples", 64))
    for light in bpy.data.lights:
        light.shadow_soft_size = 1.0
    for name, value in settings.items():
        setattr(scene.lancer, name, value)
    return scene


def _rendered(scene):
    path = os.path.join(tempfile.mkdtemp(), "picture.exr")
    exr.write_settings(scene, path)
    bpy.ops.render.render(write_still=True)
    with open(path, "rb") as file:
        data = file.read()
    # A string attribute of OpenEXR: name, type, length of four bytes, text.
    found = re.findall(rb"lancer\.(\w+)\.(\w+)\0string\0(....)", data, flags=re.S)
    stamped = {}
    for match in re.finditer(rb"lancer\.\w+\.(\w+)\0string\0(....)", data, flags=re.S):
        length = int.from_bytes(match.group(2), "little")
        stamped[match.group(1).decode()] = data[match.end() : match.end() + length].decode()
    numbers = {k: v for k, v in engine.last_statistics[scene.name].items() if isinstance(v, (int, float, str))}
    return {"numbers": numbers, "stamped": stamped, "layers": sorted({name.decode() for name, _, _ in found}), "path": path}


def told():
    """A render by samples, with the pass of errors."""
    scene = _noisy(use_pass_error=True)
    result = _rendered(scene)
    pictures = exr.read(result["path"])
    luminance = pictures["Combined"][..., :3] @ np.array([0.2126, 0.7152, 0.0722])
    bars = pictures["Lancer Error"][..., 0]
    level = luminance + 0.01 * luminance.mean()
    result["by bars"] = float(np.sqrt(np.mean((bars / level) ** 2)))
    result["least bar"] = float(bars.min())
    return result


def one_sample():
    return _rendered(_noisy(samples=1))


def target():
    """Two renders with a target error: one reaches it, one runs out of samples first."""
    limits = ((0.05, 65536), (1e-6, 100))
    return {"renders": [_rendered(_noisy(target_error=target, samples=samples)) for target, samples in limits]}


def layers():
    """Two view layers."""
    scene = _noisy(samples=4)
    scene.view_layers[0].name = "Front"
    scene.view_layers.new("Back")
    bpy.ops.render.render()
    return {"accuracy": engine.last_statistics[scene.name]["accuracy"]}


def limit():
    """A render that ends at its time limit."""
    return _rendered(_noisy(time_limit=1.0, samples=1 << 24))


def biases():
    """A render in which clamping and the limit of bounces remove light between a cube and the ground."""
    return _rendered(_noisy(max_bounces=1, clamp_indirect=0.01))


def broken_off():
    """A render cancelled as by Esc, once an error estimate is available."""
    original = engine.progress_text

    def told(schedule, progress):
        if schedule.error is not None and schedule.error.known:
            schedule.cancel()
        return original(schedule, progress)

    engine.progress_text = told
    try:
        result = _rendered(_noisy(samples=1 << 24, time_limit=60.0))
    finally:
        engine.progress_text = original
    return {**result, "lines": engine.last_statistics[bpy.context.scene.name]["accuracy"]}
