"""scene.lancer and Blender's own render settings as the core's settings."""

import bpy

from ..bindings import snapshot
from ..bindings.enums import Accelerator, Features, Integrator, Pass, PixelFilter

# Threads of a render whose scene leaves their number to Blender, 0 = all: as the add-on's preferences say.
default_threads = 0
# The core's own limit: glass doubles the rays of Classic with every depth.
_DEEPEST_RECURSION = 16
# The exponents of Blender's names.
_MIST_FALLOFFS = {"QUADRATIC": 2.0, "LINEAR": 1.0, "INVERSE_QUADRATIC": 0.5}


def export_settings(depsgraph, passes, world, messages):
    """passes: of enums.Pass; world: the one that is seen, or None."""
    scene = depsgraph.scene
    own = scene.lancer
    render = scene.render
    who = f"scene '{scene.name}'"
    seed = own.seed + (scene.frame_current if own.use_animated_seed else 0)
    bounces = own.max_bounces
    if own.integrator == "CLASSIC" and bounces > _DEEPEST_RECURSION:
        messages.add(f"{who}: {bounces} bounces are more than Classic follows, {_DEEPEST_RECURSION} are used")
        bounces = _DEEPEST_RECURSION
    samples = depsgraph.view_layer_eval.samples or own.samples
    return snapshot.Settings(
        integrator=Integrator[own.integrator],
        samples=samples,
        target_error=own.target_error,
        time_limit=own.time_limit,
        seed=seed & 0xFFFFFFFF,
        max_bounces=bounces,
        contribution_threshold=own.contribution_threshold,
        clamp_indirect=own.clamp_indirect,
        split_lights=0,
        split_paths=0,
        pixel_filter=PixelFilter[own.pixel_filter],
        # The width is that of Cycles' setting, whose window reaches as far to each side.
        filter_width=2.0 * own.filter_width if own.pixel_filter == "BLACKMAN_HARRIS" else 1.0,
        film_transparent=render.film_transparent,
        transparent_glass=own.film_transparent_glass,
        # The setting is a roughness as shader nodes have it.
        glass_roughness=messages.number(own.film_transparent_roughness, who, "glass roughness", 0.1, 0.0, 1.0) ** 2,
        # Before Blender 5.0 Cycles follows paths through one surface more than shadows; since then, through one at least.
        transparent_bounces=own.transparent_bounces + 1 if bpy.app.version < (5, 0) else max(1, own.transparent_bounces),
        transparent_shadows=own.transparent_bounces,
        alpha_threshold=messages.number(depsgraph.view_layer_eval.pass_alpha_threshold, who, "alpha threshold", 0.5, 0.0, 1.0),
        environment_reflections=own.environment_reflections,
        blended_features=bpy.app.version >= (5, 2),
        features=Features[own.features],
        passes=tuple(sorted({Pass.COMBINED, *passes})),
        threads=render.threads if render.threads_mode == "FIXED" else default_threads,
        accelerator=Accelerator[own.accelerator],
        **_world_settings(world, messages),
    )


def _world_settings(world, messages):
    """What the passes of mist and occlusion ask of the world; without one, Cycles' own numbers."""
    if world is None:
        return {"mist_start": 0.0, "mist_depth": 100.0, "mist_falloff": 1.0}
    who = f"world '{world.name}'"
    mist = world.mist_settings
    return {
        "occlusion_distance": messages.number(world.light_settings.distance, who, "occlusion distance", 10.0, 0.0),
        "mist_start": messages.number(mist.start, who, "mist start", 5.0, 0.0),
        "mist_depth": messages.number(mist.depth, who, "mist depth", 25.0, 0.0),
        "mist_falloff": _MIST_FALLOFFS[mist.falloff],
    }
