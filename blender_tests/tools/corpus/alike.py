"""A file as its author left it, with those settings made alike that decide what light is looked for, and how long.

What shows in the picture stays the author's: passes, film, filter, lens, blur, world, the depth of paths. What limits or
smooths light to save samples is taken away, since Lancer has no such limits, and so is what would end a render at another
number of samples in one engine than in the other. What makes Cycles fast stays: light tree, guiding, roulette.
"""

import bpy

from tools.parity import engines

# What Lancer takes at most.
_DEEPEST, _MOST_LAYERS = 1024, 1023
_KINDS = ("diffuse", "glossy", "transmission")
# What is taken away of Cycles' own settings, where it is not so already: (setting, value, words for the page).
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
# The same of Simplify, whose other settings are Blender's own.
_SIMPLIFIED = (
    ("use_camera_cull", False, "camera culling"),
    ("use_distance_cull", False, "distance culling"),
    ("texture_limit_render", "OFF", "texture limit {}"),
    ("texture_resolution_render", 100, "texture resolution {}"),
)


def make_alike(scene, pixels, threads):
    """Gives what was changed, in words, as far as it changes what Cycles shows. pixels: of the longer side."""
    told = [*_take(scene.cycles, _TAKEN)]
    if scene.render.use_simplify:
        told += _take(scene.cycles, _SIMPLIFIED)
    told += _light_paths(scene)
    told += _filter(scene)
    for setting in ("film_transparent_glass", "film_transparent_roughness"):
        setattr(scene.lancer, setting, getattr(scene.cycles, setting))
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
    """As deep as the file's Total in both, of every kind."""
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
    """(the view layer that renders, how many would)."""
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
