"""start.py accuracy.cycles measure JSON: the errors of Cycles with a noise threshold, inside Blender's Python module."""

from pathlib import Path

import bpy
import numpy as np

from tools.bench import worker
from tools.harness import workers
from tools.harness.errors import Reference, luminance, root_mean_square
from tools.harness.f12 import press_f12, registered
from tools.harness.kept import kept_picture

from . import figures

_REFERENCE_PARTS = 4
_REFERENCE_SEED = 1001
# Blender's default.
_MOST_SAMPLES = 4096


def render(scene, samples, seed):
    """Return the luminances that Cycles renders. Their samples are unknown: the pass of sample counts has only shares."""
    worker.set_samples(scene, samples, seed)
    # Row 0 is the top row, as in the files of references.
    return luminance(press_f12(scene).picture[::-1])


def measure(name, threads, width, height, folder, seeds=8, thresholds=(0.05, 0.02, 0.01), reference=8192):
    scene = worker.set_up(name, threads, width, height)
    scene.render.engine = "CYCLES"
    converged = Reference(np.stack(list(_reference(scene, name, Path(folder), reference))))
    result = []
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.adaptive_min_samples = 0
    for threshold in thresholds:
        scene.cycles.adaptive_threshold = threshold
        runs = [render(scene, _MOST_SAMPLES, seed) for seed in range(seeds)]
        real = [converged.distance(picture) for picture in runs]
        own = root_mean_square(real)
        result.append(
            {
                "threshold": threshold,
                "real": real,
                "bias": figures.bias(np.stack(runs), converged),
                "reference_share": (converged.error / own) ** 2 if own > 0.0 else 0.0,
            }
        )
    return {"reference": {"samples": reference, "error": converged.error}, "thresholds": result}


def _reference(scene, name, folder, samples):
    """Return the reference, rendered without a threshold; each part is kept in a file."""
    scene.cycles.use_adaptive_sampling = False
    count = samples // _REFERENCE_PARTS
    for number in range(_REFERENCE_PARTS):
        size = f"{scene.render.resolution_x}x{scene.render.resolution_y}"
        path = folder / f"{name}-{size}-cycles-{bpy.app.version_string}-{count}-{number}.npy"
        yield kept_picture(path, lambda _, seed=_REFERENCE_SEED + number: render(scene, count, seed))


if __name__ == "__main__":
    registered(lambda: workers.answer(measure))
