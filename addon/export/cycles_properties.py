"""Every property of the Cycles add-on on scenes, layers, objects, lamps, worlds, cameras, materials and views, and its fate.

FOLLOWED: Lancer's picture changes with the property as Cycles' does. TOLD: a message says that the picture differs. NO_EFFECT:
the converged picture is the same without it, or another message covers all that the property acts on. Tests hold the list
against the properties of the running Blender, FOLLOWED against controls.py, and TOLD against the messages of an export.

Properties that single versions of Blender lack stand here too.
"""

from enum import Enum
from typing import NamedTuple


class Fate(Enum):
    FOLLOWED = "followed"
    TOLD = "told"
    NO_EFFECT = "no effect"


class Property(NamedTuple):
    fate: Fate
    reason: str
    before: tuple = (99, 0)  # the first Blender in which another property takes the place of this one, which then has no effect


def _all(fate, reason, *names, **more):
    return {name: Property(fate, reason, **more) for name in names}


def _followed(reason, *names, **more):
    return _all(Fate.FOLLOWED, reason, *names, **more)


def _told(reason, *names, **more):
    return _all(Fate.TOLD, reason, *names, **more)


def _none(reason, *names):
    return _all(Fate.NO_EFFECT, reason, *names)


_VOLUMES = "acts on volumes alone, which are reported"
_MOTION = "blurs what moves"
_SUBDIVISION = "divides meshes adaptively"
_CAUSTICS = "acts with a receiver of shadow caustics alone, which is reported"

_SCENE = {
    **_followed("glass shows a transparent film", "film_transparent_glass", "film_transparent_roughness"),
    **_followed("clamps direct light", "sample_clamp_direct"),
    **_followed("leaves caustics out", "caustics_reflective", "caustics_refractive"),
    **_followed("scales the picture", "film_exposure"),
    **_told(
        "Lancer's limits are its own, off by default, and Take Over Cycles' Settings copies them",
        "max_bounces", "transparent_max_bounces", "sample_clamp_indirect", "diffuse_bounces", "glossy_bounces",
        "transmission_bounces", "blur_glossy",
    ),
    **_followed("replaces bounced light, or adds to it", "use_fast_gi", "fast_gi_method", "ao_bounces_render"),
    **_none("acts on Fast GI in views alone", "ao_bounces"),
    **_told("Lancer's filter is its own", "pixel_filter_type", "filter_width"),
    **_told("Lancer spreads samples over the pixel", "use_pixel_jitter"),
    **_followed("leaves objects out", "use_camera_cull", "use_distance_cull", "camera_cull_margin", "distance_cull_margin"),
    **_followed("makes images smaller", "texture_limit_render", "texture_resolution_render"),
    **_none("makes images smaller in views alone", "texture_limit", "texture_resolution"),
    **_none(
        "changes noise and time; Lancer's own setting stands for it, and Take Over Cycles' Settings copies it",
        "samples", "preview_samples", "time_limit", "seed", "use_animated_seed", "use_adaptive_sampling", "adaptive_threshold",
    ),
    **_none(
        "removes noise; Lancer's own setting stands for it, and Take Over Cycles' Settings copies it",
        "use_denoising", "use_preview_denoising",
    ),
    **_none(
        "shapes how Cycles removes noise; Lancer has Open Image Denoise with albedo and normal",
        "denoiser", "denoising_prefilter", "denoising_input_passes", "denoising_quality", "denoising_use_gpu",
        "preview_denoiser", "preview_denoising_prefilter", "preview_denoising_input_passes", "preview_denoising_quality",
        "preview_denoising_start_sample", "preview_denoising_use_gpu",
    ),
    **_none(
        "changes noise and time",
        "adaptive_min_samples", "use_preview_adaptive_sampling", "preview_adaptive_threshold", "preview_adaptive_min_samples",
        "sample_offset", "use_sample_subset", "sample_subset_length", "use_layer_samples", "sampling_pattern",
        "scrambling_distance", "preview_scrambling_distance", "auto_scrambling_distance", "light_sampling_threshold",
        "min_light_bounces", "min_transparent_bounces", "use_guiding", "use_deterministic_guiding",
        "guiding_distribution_type", "guiding_directional_sampling_type", "guiding_roughness_threshold", "use_surface_guiding",
        "surface_guiding_probability", "use_volume_guiding", "volume_guiding_probability", "guiding_training_samples",
        "use_guiding_direct_light", "use_guiding_mis_weights",
    ),
    **_none("changes noise and time; flattened area lamps shine by it as in Cycles", "use_light_tree"),
    **_none("Blender's releases ignore it, builds for developers of Cycles alone read it", "direct_light_sampling_type"),
    **_none(_VOLUMES, "volume_bounces", "volume_step_rate", "volume_preview_step_rate", "volume_max_steps", "volume_biased"),
    **_followed(_SUBDIVISION, "dicing_rate", "max_subdivisions", "dicing_camera", "offscreen_dicing_scale"),
    **_followed(_SUBDIVISION, "feature_set", before=(5, 0)),
    **_none("divides meshes in views alone", "preview_dicing_rate"),
    **_followed(_MOTION, "motion_blur_position", before=(4, 2)),
    **_followed(_MOTION, "rolling_shutter_type", "rolling_shutter_duration"),
    **_none("acts on Script nodes alone, which are reported", "shading_system"),
    **_none("acts on baking alone", "bake_type"),
    **_none("halts Cycles' views", "preview_pause"),
    **_none(
        "changes time and memory",
        "device", "use_auto_tile", "tile_size", "debug_bvh_type", "debug_use_spatial_splits", "debug_use_hair_bvh",
        "debug_use_compact_bvh", "debug_bvh_time_steps", "debug_bvh_layout", "debug_use_cpu_avx2", "debug_use_cpu_avx",
        "debug_use_cpu_sse42", "debug_use_cpu_sse41", "debug_use_cpu_sse3", "debug_use_cpu_sse2",
        "debug_use_cuda_adaptive_compile", "debug_use_hip_adaptive_compile", "debug_use_metal_adaptive_compile",
        "debug_use_optix_debug", "debug_use_texture_cache_eviction", "debug_texture_cache_preserve_unused",
    ),
}  # fmt: skip

_LAYER = {
    **_followed("switches denoising off for a layer", "use_denoising"),
    **_followed(
        "asks for passes",
        "denoising_store_passes", "pass_debug_sample_count", "pass_render_time", "use_pass_shadow_catcher",
    ),
    **_told(
        "these passes stay empty",
        "use_pass_volume_direct", "use_pass_volume_indirect", "use_pass_volume_scatter", "use_pass_volume_transmit",
        "use_pass_volume_majorant",
    ),
    **_told(
        "Lancer's passes for denoising are those of Cycles' defaults",
        "denoising_pass_follow_reflections", "denoising_pass_use_albedo_roughness_weighting",
    ),
}  # fmt: skip

_OBJECT = {
    **_followed("moves the end of light on coarse meshes", "shadow_terminator_geometry_offset", before=(4, 5)),
    **_told("Lancer has the geometry offset alone", "shadow_terminator_offset", before=(4, 5)),
    **_followed("leaves the object out", "use_camera_cull", "use_distance_cull"),
    **_followed(_SUBDIVISION, "use_adaptive_subdivision", "dicing_rate", before=(5, 0)),
    **_told("Lancer has the caustics that paths find", "is_caustics_receiver"),
    **_none(_CAUSTICS, "is_caustics_caster"),
    **_followed(_MOTION, "use_motion_blur", "use_deform_motion", "motion_steps"),
    **_followed("ends rays of Fast GI", "ao_distance"),
}

_LIGHT = {
    **_followed("casts shadows", "cast_shadow", before=(4, 2)),
    **_followed("a portal gives no light of its own", "is_portal"),
    **_followed("ends its light samples", "max_bounces"),
    **_told("mirrors and glass show every lamp that has a size", "use_multiple_importance_sampling"),
    **_none(_CAUSTICS, "is_caustics_light"),
}

_WORLD = {
    **_followed("samples the sky", "sampling_method", "sample_map_resolution"),
    **_followed("ends its light samples", "max_bounces"),
    **_told("the sky casts shadows", "use_shadows"),
    **_none(_CAUSTICS, "is_caustics_light"),
    **_none(_VOLUMES, "homogeneous_volume", "volume_sampling", "volume_interpolation", "volume_step_size"),
}

_VISIBILITY = {
    **_followed("hides the sky from kinds of rays", "camera", "diffuse", "glossy", "transmission"),
    **_none(_VOLUMES, "scatter"),
    **_none("Cycles ignores it: a sky stands behind everything", "shadow"),
}

_CAMERA = {
    **_followed(
        "shapes a panorama, in the Blenders that keep it here",
        "panorama_type", "fisheye_fov", "fisheye_lens", "latitude_min", "latitude_max", "longitude_min", "longitude_max",
        "fisheye_polynomial_k0", "fisheye_polynomial_k1", "fisheye_polynomial_k2", "fisheye_polynomial_k3",
        "fisheye_polynomial_k4",
    ),
}  # fmt: skip

_MATERIAL = {
    **_followed("samples surfaces that glow", "sample_as_light", "emission_sampling"),
    **_followed("lets shadows through", "use_transparent_shadow"),
    **_followed("moves surfaces or bends their normals", "displacement_method"),
    **_followed("moves the end of light on bumps", "use_bump_map_correction"),
    **_none(_VOLUMES, "homogeneous_volume", "volume_sampling", "volume_interpolation", "volume_step_rate"),
}

PROPERTIES = {
    "CyclesRenderSettings": _SCENE,
    "CyclesRenderLayerSettings": _LAYER,
    "CyclesObjectSettings": _OBJECT,
    "CyclesLightSettings": _LIGHT,
    "CyclesWorldSettings": _WORLD,
    "CyclesVisibilitySettings": _VISIBILITY,
    "CyclesCameraSettings": _CAMERA,
    "CyclesMaterialSettings": _MATERIAL,
    "CyclesCurveRenderSettings": _none("acts on hair alone, which is reported", "shape", "subdivisions"),
    "CyclesView3DShadingSettings": _none("chooses what Cycles' views show", "render_pass", "show_active_pixels"),
    # Without properties of their own; nodes of a custom camera are the camera's, whose type is reported.
    "CyclesMeshSettings": {},
    "CyclesCustomCameraSettings": {},
}
