"""Let both engines estimate the same integral: equal bounces and filters, no clamping, adaptive sampling or denoising."""

import json
import os

import bpy
import decoded_mattes
import exr

from addon.engine import render_engine as lancer_engine

# Pass by its name since 5.0: (switch of the view layer, name before 5.0).
PASSES = {
    "Combined": ("use_pass_combined", "Combined"),
    "Depth": ("use_pass_z", "Depth"),
    "Mist": ("use_pass_mist", "Mist"),
    "Position": ("use_pass_position", "Position"),
    "Normal": ("use_pass_normal", "Normal"),
    "Vector": ("use_pass_vector", "Vector"),
    "UV": ("use_pass_uv", "UV"),
    "Object Index": ("use_pass_object_index", "IndexOB"),
    "Material Index": ("use_pass_material_index", "IndexMA"),
    "Diffuse Direct": ("use_pass_diffuse_direct", "DiffDir"),
    "Diffuse Indirect": ("use_pass_diffuse_indirect", "DiffInd"),
    "Diffuse Color": ("use_pass_diffuse_color", "DiffCol"),
    "Glossy Direct": ("use_pass_glossy_direct", "GlossDir"),
    "Glossy Indirect": ("use_pass_glossy_indirect", "GlossInd"),
    "Glossy Color": ("use_pass_glossy_color", "GlossCol"),
    "Transmission Direct": ("use_pass_transmission_direct", "TransDir"),
    "Transmission Indirect": ("use_pass_transmission_indirect", "TransInd"),
    "Transmission Color": ("use_pass_transmission_color", "TransCol"),
    "Emission": ("use_pass_emit", "Emit"),
    "Environment": ("use_pass_environment", "Env"),
    "Ambient Occlusion": ("use_pass_ambient_occlusion", "AO"),
    "Shadow Catcher": ("use_pass_shadow_catcher", "Shadow Catcher"),
    "Denoising Albedo": ("denoising_store_passes", "Denoising Albedo"),
    "Denoising Normal": ("denoising_store_passes", "Denoising Normal"),
    "Denoising Depth": ("denoising_store_passes", "Denoising Depth"),
    "Denoising Specular Albedo": ("denoising_store_passes", "Denoising Specular Albedo"),
    "Denoising Roughness": ("denoising_store_passes", "Denoising Roughness"),
}


def pass_name(name):
    """Return a pass's name in this Blender. Passes that a scene's builder makes are not in the table."""
    return name if bpy.app.version >= (5, 0) or name not in PASSES else PASSES[name][1]


def unbias(scene, case, samples, seed):
    _set_cycles(scene.cycles, case, samples, seed)
    _set_lancer(scene.lancer, case, samples, seed)
    scene.render.resolution_x, scene.render.resolution_y = case.size
    scene.render.resolution_percentage = 100
    scene.render.use_compositing = scene.render.use_sequencer = False
    scene.render.use_simplify = case.simplify
    layer = bpy.context.view_layer
    # 0: the scene's number of samples.
    layer.samples = 0
    # One pass fewer: Blender 5.0 cannot write two of them if pixels are not square.
    layer.use_pass_combined = "Combined" in case.passes
    for name in PASSES.keys() & set(case.passes):
        _ask_for(layer, scene, PASSES[name][0])


def _ask_for(view_layer, scene, switch):
    owners = (view_layer.cycles, scene.cycles) if switch == "denoising_store_passes" else (view_layer, view_layer.cycles)
    for owner in owners:
        if hasattr(owner, switch):
            setattr(owner, switch, True)
    if switch == "denoising_store_passes" and hasattr(scene.lancer, "use_pass_albedo"):
        scene.lancer.use_pass_albedo = True


def unbias_cycles(cycles, samples, seed):
    """Set the samples of Cycles, without limits of light, from a sequence whose errors are independent between seeds."""
    cycles.device, cycles.samples, cycles.seed = "CPU", samples, seed
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_animated_seed = cycles.use_auto_tile = False
    # The pattern has another name in older Blenders; blue noise, which correlates the errors of pixels, is never used.
    for pattern in ("TABULATED_SOBOL", "PROGRESSIVE_MULTI_JITTER"):
        try:
            cycles.sampling_pattern = pattern
            break
        except TypeError:
            continue


def _set_cycles(cycles, case, samples, seed):
    unbias_cycles(cycles, samples, seed)
    cycles.light_sampling_threshold = 0.0
    cycles.pixel_filter_type = "BLACKMAN_HARRIS" if case.filter_width else "BOX"
    cycles.filter_width = case.filter_width or 1.0
    cycles.film_exposure = case.exposure
    cycles.max_bounces = case.bounces
    for kind in ("diffuse", "glossy", "transmission"):
        setattr(cycles, kind + "_bounces", case.bounces)
    if hasattr(cycles, "use_light_tree"):
        cycles.use_light_tree = False
    for name, value in case.limited.items():
        setattr(cycles, name, value)
    cycles.volume_bounces = 0
    cycles.transparent_max_bounces = case.transparent_bounces
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0


def unbias_lancer(lancer, samples, seed):
    """Set the samples of Lancer, without limits of light."""
    lancer.quality, lancer.samples, lancer.seed = "CUSTOM", samples, seed
    lancer.clamp_indirect = 0.0
    for setting in ("target_error", "time_limit"):
        if hasattr(lancer, setting):
            setattr(lancer, setting, 0.0)
    if hasattr(lancer, "use_denoising"):
        lancer.use_denoising = False


# Names of Cycles' settings in Lancer where they differ.
_OF_LANCER = {"blur_glossy": "filter_glossy", "sample_clamp_indirect": "clamp_indirect"}


def _set_lancer(lancer, case, samples, seed):
    unbias_lancer(lancer, samples, seed)
    lancer.max_bounces = case.bounces
    for name, value in case.limited.items():
        if hasattr(lancer, _OF_LANCER.get(name, name)):
            setattr(lancer, _OF_LANCER.get(name, name), value)
    lancer.pixel_filter = "BLACKMAN_HARRIS" if case.filter_width else "BOX"
    lancer.filter_width = case.filter_width or 1.0
    if hasattr(lancer, "transparent_bounces"):
        lancer.transparent_bounces = case.transparent_bounces


def _refuse_dropped_samples(statistics):
    """Raise an error if samples overflowed: no scene of the list may exceed the range of floats."""
    if statistics["invalid_samples"]:
        place = tuple(statistics[f"invalid_{name}"] for name in ("x", "y", "sample"))
        raise RuntimeError(f"{statistics['invalid_samples']} samples were not finite, the first at {place}")


def render(scene, engine, case, samples, seed, folder):
    """Return {pass: picture} by an engine, with the names of Blender 5; Combined has RGB, and its alpha is a separate pass."""
    scene.render.engine = engine
    unbias(scene, case, samples, seed)
    path = os.path.join(folder, "picture.exr")
    if os.path.exists(path):
        os.remove(path)
    exr.write_settings(scene, path)
    if scene.render.use_multiview:
        scene.render.image_settings.views_format = "MULTIVIEW"
    bpy.ops.render.render(write_still=True)
    if not os.path.exists(path):
        raise RuntimeError(f"{engine} wrote no picture")
    if engine == "LANCER":
        _refuse_dropped_samples(lancer_engine.last_statistics[scene.name])
    stored = exr.read(path)
    result = {}
    for name in case.passes:
        for stored_name in stored:
            # With several views each has a picture, by its name behind that of the pass.
            pass_, dot, view = stored_name.partition(".") if scene.render.use_multiview else (stored_name, "", "")
            if pass_ != pass_name(name):
                continue
            picture = stored[stored_name]
            if name == "Combined":
                result[f"Alpha{dot}{view}"] = picture[..., 3:4]
                picture = picture[..., :3]
            result[f"{name}{dot}{view}"] = picture
    for title in case.mattes:
        result |= _named_mattes(path, stored, title)
    return result


def _named_mattes(path, stored, title):
    """Return the mattes of a cryptomatte as pictures of one channel, by the names of its manifest."""
    told = decoded_mattes.fields(exr.attributes(path), f"{bpy.context.view_layer.name}.{title}")
    found = decoded_mattes.mattes(stored, title, json.loads(told["manifest"]))
    return {f"{title} of {name}": matte[..., None] for name, matte in found.items()}
