"""scene.lancer and Blender's render settings as the core's settings."""

import bpy

from ..bindings import snapshot
from ..bindings.enums import DEEPEST_RECURSION, Accelerator, Features, Integrator, Pass, PixelFilter
from ..bindings.numbered_pass import NumberedPass, extras

# Number of threads, from the add-on's preferences, if the scene does not fix one; 0 = all.
default_threads = 0
# The exponents of Blender's falloffs.
_MIST_FALLOFFS = {"QUADRATIC": 2.0, "LINEAR": 1.0, "INVERSE_QUADRATIC": 0.5}


def glass_owner(scene):
    """Return the owner of the film_transparent_* settings in use: Cycles, unless Lancer's are set or Cycles is disabled."""
    own, cycles = scene.lancer, getattr(scene, "cycles", None)
    names = ("film_transparent_glass", "film_transparent_roughness")
    return own if cycles is None or any(own.is_property_set(name) for name in names) else cycles


def threads_of(scene):
    """Return the number of threads that may render a scene; 0 = all."""
    render = scene.render
    return render.threads if render.threads_mode == "FIXED" else default_threads


def _of_cycles(scene):
    """Return the settings of Cycles that a scene's picture follows: those that do nothing by default, so that the file asks."""
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return {}
    return {
        "clamp_direct": cycles.sample_clamp_direct,
        "no_reflections": not cycles.caustics_reflective,
        "no_refractions": not cycles.caustics_refractive,
        "exposure": cycles.film_exposure,
    }


def export_settings(depsgraph, passes, world, messages, in_view=False):
    """Return the snapshot.Settings of a depsgraph. world: the layer's evaluated world, or None.

    passes: of enums.Pass, and NumberedPasses. in_view: of a 3D view.
    """
    scene = depsgraph.scene
    own = scene.lancer
    render = scene.render
    glass = glass_owner(scene)
    who = f"scene '{scene.name}'"
    seed = own.seed + (scene.frame_current if own.use_animated_seed else 0)
    bounces = own.max_bounces
    if own.integrator == "CLASSIC" and bounces > DEEPEST_RECURSION:
        messages.add(f"{who}: {bounces} bounces are more than Classic follows, {DEEPEST_RECURSION} are used")
        bounces = DEEPEST_RECURSION
    samples = depsgraph.view_layer_eval.samples or own.samples
    numbered = extras(passes)
    return snapshot.Settings(
        integrator=Integrator[own.integrator],
        samples=samples,
        target_error=own.target_error,
        time_limit=own.time_limit,
        seed=seed & 0xFFFFFFFF,
        max_bounces=bounces,
        diffuse_bounces=own.diffuse_bounces,
        glossy_bounces=own.glossy_bounces,
        transmission_bounces=own.transmission_bounces,
        filter_glossy=own.filter_glossy,
        **_of_cycles(scene),
        **_fast(scene, world, in_view),
        contribution_threshold=own.contribution_threshold,
        clamp_indirect=own.clamp_indirect,
        split_lights=0,
        split_paths=0,
        pixel_filter=PixelFilter[own.pixel_filter],
        # As in Cycles, the window reaches the filter width to each side.
        filter_width=2.0 * own.filter_width if own.pixel_filter == "BLACKMAN_HARRIS" else 1.0,
        film_transparent=render.film_transparent,
        transparent_glass=glass.film_transparent_glass,
        # The setting is a roughness in the units of shader nodes: alpha is its square.
        glass_roughness=messages.number(glass.film_transparent_roughness, who, "glass roughness", 0.1, 0.0, 1.0) ** 2,
        # Before 5.0 Cycles lets paths pass one more transparent surface than shadow rays; since then, at least one.
        transparent_bounces=own.transparent_bounces + 1 if bpy.app.version < (5, 0) else max(1, own.transparent_bounces),
        transparent_shadows=own.transparent_bounces,
        alpha_threshold=messages.number(depsgraph.view_layer_eval.pass_alpha_threshold, who, "alpha threshold", 0.5, 0.0, 1.0),
        environment_reflections=own.environment_reflections,
        blended_features=bpy.app.version >= (5, 2),
        sky_vectors=bpy.app.version >= (5, 2),
        even_choices=bpy.app.version < (4, 0) and numbered["aov_colors"] + numbered["aov_values"] > 0,
        features=Features[own.features],
        passes=tuple(sorted({Pass.COMBINED, *(item for item in passes if not isinstance(item, NumberedPass))})),
        **numbered,
        threads=threads_of(scene),
        accelerator=Accelerator[own.accelerator],
        occlusion_distance=occlusion_distance(world),
        # A layer with another world keeps the mist of the scene's, as in Cycles.
        **_mist(scene.world and scene.world.evaluated_get(depsgraph), messages),
    )


def _fast(scene, world, in_view):
    """Return the settings of Cycles' Fast GI Approximation, whose strength and distance are the world's."""
    cycles = getattr(scene, "cycles", None)
    if cycles is None or world is None or not cycles.use_fast_gi:
        return {}
    light = world.light_settings
    if cycles.fast_gi_method == "ADD":
        return {"ambient": light.ao_factor, "fast_distance": light.distance}
    # Without a strength Cycles keeps the bounces.
    bounces = (cycles.ao_bounces if in_view else cycles.ao_bounces_render) if light.ao_factor > 0.0 else 0
    return {"fast_bounces": bounces, "fast_factor": light.ao_factor, "fast_distance": light.distance}


def world_of(depsgraph):
    """Return the evaluated world of a depsgraph's view layer; None without one."""
    world = getattr(depsgraph.view_layer, "world_override", None) or depsgraph.scene.world
    # The layer and the scene refer to original data, which have no animation.
    return None if world is None else world.evaluated_get(depsgraph)


def occlusion_distance(world):
    """Return the distance of ambient occlusion of a world; without one, Cycles' default."""
    return 10.0 if world is None else world.light_settings.distance


def _mist(world, messages):
    """Return the settings of the mist pass; without a world, Cycles' defaults."""
    if world is None:
        return {"mist_start": 0.0, "mist_depth": 100.0, "mist_falloff": 1.0}
    who, mist = f"world '{world.name}'", world.mist_settings
    return {
        "mist_start": messages.number(mist.start, who, "mist start", 5.0, 0.0),
        "mist_depth": messages.number(mist.depth, who, "mist depth", 25.0, 0.0),
        "mist_falloff": _MIST_FALLOFFS[mist.falloff],
    }
