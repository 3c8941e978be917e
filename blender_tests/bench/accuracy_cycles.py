"""accuracy_cycles.py measure ARGUMENTS: what the noise threshold of Cycles comes to, inside Blender's Python module."""

import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "blender_tests")]

import bpy  # noqa: E402
import numpy as np  # noqa: E402

import addon  # noqa: E402
from bench import accuracy_figures as figures  # noqa: E402
from bench import process, worker  # noqa: E402
from scenes.parity import exr  # noqa: E402

_REFERENCE_PARTS = 4
_REFERENCE_SEED = 1001
# Blender's own.
_MOST_SAMPLES = 4096


def render(scene, samples, seed):
    """Luminances as Cycles renders them. How many samples it took for them it does not tell: its pass has shares."""
    worker.set_samples(scene, samples, seed)
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        bpy.ops.render.render(write_still=True)
        layers = exr.read(scene.render.filepath)
    combined = next(value for name, value in layers.items() if "Combined" in name or len(layers) == 1)
    return figures.luminance(combined[..., :3])


def measure(name, threads, width, height, folder, seeds=8, thresholds=(0.05, 0.02, 0.01), reference=8192):
    scene = worker.set_up(name, threads, width, height)
    scene.render.engine = "CYCLES"
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.color_depth, image.exr_codec = "OPEN_EXR_MULTILAYER", "32", "NONE"
    converged = figures.Reference(np.stack(list(_reference(scene, name, Path(folder), reference))))
    result = []
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.adaptive_min_samples = 0
    for threshold in thresholds:
        scene.cycles.adaptive_threshold = threshold
        runs = [render(scene, _MOST_SAMPLES, seed) for seed in range(seeds)]
        real = [figures.real_error(picture, converged) for picture in runs]
        own = figures.root_mean_square(real)
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
    """Without a threshold; each part is kept."""
    scene.cycles.use_adaptive_sampling = False
    count = samples // _REFERENCE_PARTS
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(_REFERENCE_PARTS):
        size = f"{scene.render.resolution_x}x{scene.render.resolution_y}"
        path = folder / f"{name}-{size}-cycles-{bpy.app.version_string}-{count}-{number}.npy"
        if not path.exists():
            np.save(path, render(scene, count, _REFERENCE_SEED + number))
        yield np.load(path)


if __name__ == "__main__":
    addon.register()
    try:
        process.answer({"measure": measure})
    finally:
        addon.unregister()
