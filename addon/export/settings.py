"""scene.lancer and Blender's own render settings as the core's settings."""

from ..bindings import snapshot
from ..bindings.enums import Accelerator, Features, Integrator, Pass, PixelFilter

# The core's own limit: glass doubles the rays of Classic with every depth.
_DEEPEST_RECURSION = 16


def export_settings(depsgraph, passes, messages):
    scene = depsgraph.scene
    own = scene.lancer
    render = scene.render
    seed = own.seed + (scene.frame_current if own.use_animated_seed else 0)
    bounces = own.max_bounces
    if own.integrator == "CLASSIC" and bounces > _DEEPEST_RECURSION:
        messages.add(f"scene '{scene.name}': {bounces} bounces are more than Classic follows, {_DEEPEST_RECURSION} are used")
        bounces = _DEEPEST_RECURSION
    samples = depsgraph.view_layer_eval.samples or own.samples
    return snapshot.Settings(
        integrator=Integrator[own.integrator],
        samples=samples,
        seed=seed & 0xFFFFFFFF,
        max_bounces=bounces,
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
