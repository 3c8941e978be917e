"""Give both engines equivalent settings for the light that they compute and for the number of samples.

The author's settings of the picture stay: passes, film, filter, lens, blur, world, the depth of paths. Settings that limit or
smooth light to save samples are switched off, so that all light is compared, and so are settings that end a render at different
numbers of samples in the two engines. Settings that make Cycles fast stay: light tree, guiding, roulette.
"""

import bpy

from tools.parity import engines

# Lancer's maxima.
_DEEPEST, _MOST_LAYERS = 1024, 1023
_KINDS = ("diffuse", "glossy", "transmission")
# Values that Cycles' settings get if they have others: (setting, value, words for the page).
_TAKEN = (
    ("sample_clamp_direct", 0.0, "Clamp Direct {:g}"),
    ("sample_clamp_indirect", 0.0, "Clamp Indirect {:g}"),
    ("blur_glossy", 0.0, "Filter Glossy {:g}"),
    ("caustics_reflective", True, "no reflective caustics"),
    ("caustics_refractive", True, "no refractive caustics"),
    ("use_fast_gi", False, "Fast GI"),
    ("film_exposure", 1.0, "film exposure {:g}"),
    ("shading_system", False, "Open Shading Language"),
    ("use_adaptive_sampling", False, ""),
    ("time_limit", 0.0, ""),
    ("use_sample_subset", False, ""),
    ("sample_offset", 0, ""),
)
# The same for Cycles' part of Simplify.
_SIMPLIFIED = (
    ("use_camera_cull", False, "camera culling"),
    ("use_distance_cull", False, "distance culling"),
    ("texture_limit_render", "OFF", "texture limit {}"),
    ("texture_resolution_render", 100, "texture resolution {}"),
)


def make_alike(scene, pixels, threads):
    """Change the settings. Return the changes that affect Cycles' picture, in words. pixels: of the longer side."""
    told = [*_take(scene.cycles, _TAKEN)]
    if scene.render.use_simplify:
        told += _take(scene.cycles, _SIMPLIFIED)
    told += _light_paths(scene)
    told += _filter(scene)
    scene.lancer.integrator = "PATH"
    scene.lancer.use_animated_seed = False
    return told + _render(scene.render, pixels, threads)


def _take(owner, wanted):
    for name, value, words in wanted:
        now = getattr(owner, name, value)
        if now != value:
            setattr(owner, name, value)
            if words:
                yield words.format(now)


def _light_paths(scene):
    """Give both engines the depth of the file's Total, for every kind of bounce."""
    cycles, lancer = scene.cycles, scene.lancer
    depth = min(cycles.max_bounces, _DEEPEST)
    limits = [f"{kind} {getattr(cycles, kind + '_bounces')}" for kind in _KINDS if getattr(cycles, kind + "_bounces") < depth]
    if limits:
        yield f"bounces of {', '.join(limits)}"
    cycles.max_bounces = lancer.max_bounces = depth
    for kind in _KINDS:
        setattr(cycles, kind + "_bounces", depth)
    cycles.transparent_max_bounces = lancer.transparent_bounces = min(cycles.transparent_max_bounces, _MOST_LAYERS)


def _filter(scene):
    cycles, lancer = scene.cycles, scene.lancer
    if cycles.pixel_filter_type == "GAUSSIAN":
        cycles.pixel_filter_type = "BLACKMAN_HARRIS"
        yield "Gaussian filter"
    lancer.pixel_filter = cycles.pixel_filter_type
    lancer.filter_width = cycles.filter_width


def _render(render, pixels, threads):
    render.threads_mode, render.threads = "FIXED", threads
    render.use_compositing = render.use_sequencer = False
    render.use_stamp = render.use_persistent_data = False
    longer = max(render.resolution_x, render.resolution_y)
    for axis in ("resolution_x", "resolution_y"):
        # Blender's own limit is 4 pixels.
        setattr(render, axis, max(4, round(getattr(render, axis) * pixels / longer)))
    render.resolution_percentage = 100
    return [*_take(render, (("use_freestyle", False, "Freestyle"), ("use_multiview", False, "stereoscopy")))]


def choose_layer(scene):
    """Return (the view layer to render, the number of view layers that the file renders)."""
    used = [layer for layer in scene.view_layers if layer.use] or [scene.view_layers[0]]
    for layer in scene.view_layers:
        layer.use = layer == used[0]
        layer.samples = 0
    return used[0], len(used)


def set_samples(scene, samples, seed):
    engines.unbias_cycles(scene.cycles, samples, seed)
    engines.unbias_lancer(scene.lancer, samples, seed)


def missing_libraries():
    return sorted(library.filepath for library in bpy.data.libraries if library.is_missing)
