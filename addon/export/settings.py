"""scene.lancer and Blender's own render settings as the core's settings."""

from ..bindings import snapshot
from ..bindings.enums import Accelerator, Features, Integrator, Pass, PixelFilter


def export_settings(depsgraph, passes=(Pass.COMBINED,)):
    scene = depsgraph.scene
    own = scene.lancer
    render = scene.render
    seed = own.seed + (scene.frame_current if own.use_animated_seed else 0)
    samples = depsgraph.view_layer_eval.samples or own.samples
    return snapshot.Settings(
        integrator=Integrator[own.integrator],
        samples=samples,
        seed=seed & 0xFFFFFFFF,
        max_bounces=own.max_bounces,
        contribution_threshold=own.contribution_threshold,
        clamp_indirect=own.clamp_indirect,
        pixel_filter=PixelFilter[own.pixel_filter],
        filter_width=own.filter_width if own.pixel_filter == "BLACKMAN_HARRIS" else 1.0,
        film_transparent=render.film_transparent,
        features=Features[own.features],
        passes=tuple(sorted({Pass.COMBINED, *passes})),
        threads=render.threads if render.threads_mode == "FIXED" else 0,
        accelerator=Accelerator[own.accelerator],
    )
