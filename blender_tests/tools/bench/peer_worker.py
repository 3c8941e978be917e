"""start.py bench.peer_worker TASK JSON: one measurement of another renderer, on a snapshot; the answer is JSON."""

import importlib
import time

import numpy as np

from addon.bindings.snapshot import SceneSnapshot
from tools.bench import peers
from tools.harness import workers


def _adapter(module):
    return importlib.import_module(f"tools.bench.peers.{module}")


def version(module, option=None):
    adapter = _adapter(module)
    return {"version": adapter.version(option) if option else adapter.version()}


def check(modules, snapshot):
    """Return {module: the reason why it cannot render this snapshot, or None}."""
    loaded, result = SceneSnapshot.load(snapshot), {}
    for module in modules:
        try:
            _adapter(module).check(loaded)
            result[module] = None
        except peers.Cannot as reason:
            result[module] = str(reason)
    return result


def render(module, snapshot, threads, samples, seed, option=None, picture=None, first_look=True):
    """Load the scene, render one sample, then all of them with another seed."""
    adapter, loaded = _adapter(module), SceneSnapshot.load(snapshot)
    pixels = loaded.camera.width * loaded.camera.height
    result = {"samples": samples * pixels}
    # Import before the clock starts, as Blender is running before F12.
    adapter.version(option) if option else adapter.version()
    workers.reset_peak()
    before, started = workers.memory("VmRSS"), time.perf_counter()
    renderer = adapter.Renderer(loaded, threads, option)
    result["setup_seconds"] = time.perf_counter() - started
    if first_look:
        renderer.render(1, 0)
        result["first_pixel_seconds"] = time.perf_counter() - started
    values, result["render_seconds"], result["clock"] = renderer.render(samples, seed)
    result["peak_bytes"] = workers.memory("VmHWM") - before
    if picture:
        np.save(picture, values)
    return result


if __name__ == "__main__":
    workers.answer(version, check, render)
    workers.leave()
