"""The settings of Blender that the export reads, by Blender's names. Each is shown in a panel while Lancer is the engine.

Add each further setting that the export reads to this list and to a panel (addon/ui). Tests change every setting of a scene
and compare the settings that change the export with this list; they also compare the list with the names in the export's
source and with the panels.
"""

from typing import NamedTuple

_PANORAMA = (
    "panorama_type", "fisheye_fov", "fisheye_lens", "latitude_min", "latitude_max", "longitude_min", "longitude_max",
    "fisheye_polynomial_k0", "fisheye_polynomial_k1", "fisheye_polynomial_k2", "fisheye_polynomial_k3", "fisheye_polynomial_k4",
)  # fmt: skip
_PASSES = (
    "use_pass_z", "use_pass_mist", "use_pass_position", "use_pass_normal", "use_pass_vector", "use_pass_uv",
    "use_pass_object_index", "use_pass_material_index", "use_pass_diffuse_direct", "use_pass_diffuse_indirect",
    "use_pass_diffuse_color",
    "use_pass_glossy_direct", "use_pass_glossy_indirect", "use_pass_glossy_color", "use_pass_transmission_direct",
    "use_pass_transmission_indirect", "use_pass_transmission_color", "use_pass_emit", "use_pass_environment",
    "use_pass_ambient_occlusion", "use_pass_cryptomatte_object", "use_pass_cryptomatte_material", "use_pass_cryptomatte_asset",
)  # fmt: skip


class Controls(NamedTuple):
    """Settings of a type that are read from Blender version since on, before version before."""

    owner: str  # the type's name; Light for lamps of all types
    names: tuple
    since: tuple = (3, 4)
    before: tuple = (99, 0)


CONTROLS = (
    Controls("Scene", ("camera", "world")),
    Controls("RenderSettings", ("resolution_x", "resolution_y", "resolution_percentage", "pixel_aspect_x", "pixel_aspect_y")),
    Controls("RenderSettings", ("use_border", "film_transparent", "threads_mode", "threads")),
    Controls("RenderSettings", ("use_simplify", "simplify_subdivision")),
    Controls("RenderSettings", ("use_motion_blur", "motion_blur_shutter")),
    Controls("RenderSettings", ("motion_blur_position",), since=(4, 2)),
    Controls("CyclesRenderSettings", ("motion_blur_position",), before=(4, 2)),
    Controls("CyclesRenderSettings", ("rolling_shutter_type", "rolling_shutter_duration")),
    Controls("CyclesObjectSettings", ("use_motion_blur", "use_deform_motion", "motion_steps")),
    Controls("RenderSettings", ("use_texture_cache", "use_auto_generate_texture_cache"), since=(5, 2)),
    Controls("CyclesRenderSettings", ("film_transparent_glass", "film_transparent_roughness")),
    Controls("CyclesRenderSettings", ("sample_clamp_direct", "caustics_reflective", "caustics_refractive", "film_exposure")),
    Controls("CyclesRenderSettings", ("use_fast_gi", "fast_gi_method", "ao_bounces_render")),
    Controls("CyclesRenderSettings", ("use_camera_cull", "use_distance_cull", "camera_cull_margin", "distance_cull_margin")),
    Controls("CyclesRenderSettings", ("texture_limit_render",)),
    Controls("CyclesRenderSettings", ("texture_resolution_render",), since=(5, 2)),
    Controls("CyclesObjectSettings", ("use_camera_cull", "use_distance_cull", "ao_distance")),
    Controls("CyclesRenderSettings", ("dicing_rate", "max_subdivisions", "dicing_camera", "offscreen_dicing_scale")),
    Controls("CyclesRenderSettings", ("feature_set",), before=(5, 0)),
    Controls("ViewLayer", ("use_sky", "use_solid", "material_override", "samples", "pass_alpha_threshold", *_PASSES)),
    Controls("ViewLayer", ("use_motion_blur",)),
    Controls("ViewLayer", ("world_override",), since=(4, 2)),
    Controls("CyclesRenderLayerSettings", ("denoising_store_passes", "use_denoising", "pass_debug_sample_count")),
    Controls("CyclesRenderLayerSettings", ("use_pass_shadow_catcher",)),
    Controls("CyclesRenderLayerSettings", ("pass_render_time",), since=(5, 0)),
    Controls("World", ("use_nodes", "color"), before=(5, 0)),
    Controls("WorldLighting", ("distance", "ao_factor")),
    Controls("WorldMistSettings", ("start", "depth", "falloff")),
    Controls("CyclesWorldSettings", ("sampling_method", "sample_map_resolution", "max_bounces")),
    Controls("CyclesVisibilitySettings", ("camera", "diffuse", "glossy", "transmission")),
    Controls("Object", ("location", "rotation_euler", "scale", "delta_location", "delta_rotation_euler", "delta_scale")),
    Controls("Object", ("parent", "hide_viewport", "active_material", "pass_index", "is_holdout", "is_shadow_catcher")),
    Controls("Object", ("visible_camera", "visible_diffuse", "visible_glossy", "visible_transmission", "visible_shadow")),
    Controls("Object", ("shadow_terminator_geometry_offset",), since=(4, 5)),
    Controls("CyclesObjectSettings", ("shadow_terminator_geometry_offset",), before=(4, 5)),
    Controls("CyclesObjectSettings", ("use_adaptive_subdivision", "dicing_rate"), before=(5, 0)),
    Controls("ObjectLightLinking", ("receiver_collection", "blocker_collection"), since=(4, 0)),
    Controls("Camera", ("lens", "angle", "ortho_scale", "sensor_fit", "sensor_width", "sensor_height")),
    Controls("Camera", ("shift_x", "shift_y", "clip_start", "clip_end")),
    Controls("Camera", _PANORAMA, since=(4, 2)),
    Controls("CyclesCameraSettings", _PANORAMA, before=(4, 2)),
    Controls("Camera", ("central_cylindrical_range_u_min", "central_cylindrical_range_u_max"), since=(4, 5)),
    Controls("Camera", ("central_cylindrical_range_v_min", "central_cylindrical_range_v_max"), since=(4, 5)),
    Controls("Camera", ("central_cylindrical_radius",), since=(4, 5)),
    Controls("CameraDOFSettings", ("use_dof", "focus_object", "focus_distance")),
    Controls("CameraDOFSettings", ("aperture_fstop", "aperture_blades", "aperture_rotation", "aperture_ratio")),
    Controls("Light", ("color", "energy", "shadow_soft_size", "angle", "shape", "size", "size_y", "spread")),
    Controls("Light", ("spot_size", "spot_blend")),
    Controls("Light", ("use_soft_falloff", "use_shadow"), since=(4, 2)),
    Controls("Light", ("use_temperature", "temperature", "exposure", "normalize"), since=(4, 5)),
    Controls("Light", ("use_nodes",), before=(5, 2)),
    Controls("CyclesLightSettings", ("is_portal", "max_bounces")),
    Controls("CyclesLightSettings", ("cast_shadow",), before=(4, 2)),
    Controls("Material", ("pass_index",)),
    Controls("Material", ("use_nodes", "diffuse_color"), before=(5, 0)),
    Controls("Material", ("displacement_method", "use_transparent_shadow"), since=(4, 2)),
    Controls("CyclesMaterialSettings", ("displacement_method", "use_transparent_shadow", "sample_as_light"), before=(4, 2)),
    Controls("CyclesMaterialSettings", ("emission_sampling", "use_bump_map_correction"), since=(4, 2)),
)
# Lancer's own types, of which all settings are read.
OWN = ("LancerSceneSettings", "LancerObjectSettings", "LancerMaterialSettings", "LancerLightSettings", "LancerWorldSettings")
