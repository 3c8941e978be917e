"""Messages of a render about single settings of scenes and objects."""

import bpy
import stage

# Each of these differs from Lancer's own setting, and its message has this word.
_SETTINGS = {
    "blur_glossy": (2.0, "Filter Glossy 2"),
    "diffuse_bounces": (0, "Diffuse 0"),
    "glossy_bounces": (1, "Glossy 1"),
    "transmission_bounces": (2, "Transmission 2"),
    "transparent_max_bounces": (3, "by Transparent 3, Lancer by Max Bounces 12 and Transparent 8"),
    "pixel_filter_type": ("GAUSSIAN", "filter is Gaussian 1.5, Lancer's is Blackman-Harris 1.5"),
    "filter_width": (2.5, "filter is Blackman-Harris 2.5"),
}
# These change noise or time alone, are read by Lancer, or mean the same in Lancer.
_NEUTRAL = {
    "samples": 7, "seed": 5, "volume_bounces": 3, "diffuse_bounces": 64, "glossy_bounces": 12,
    "use_adaptive_sampling": False, "light_sampling_threshold": 0.1,
    "min_light_bounces": 3, "use_camera_cull": True, "texture_limit_render": "128", "ao_bounces_render": 3,
    "film_exposure": 2.0, "use_fast_gi": True, "sample_clamp_direct": 1.0, "caustics_reflective": False,
    "caustics_refractive": False,
}  # fmt: skip


def _told_of_scene():
    from addon.export.unsupported import check_scene
    from addon.messages.messages import Messages

    messages = Messages()
    check_scene(bpy.context.scene, messages)
    return messages


# name: (settings of Cycles, settings of Lancer); all others have Blender's defaults.
_LIGHT_PATHS = {
    "start": ({}, {}),
    "few bounces here": ({}, {"max_bounces": 3}),
    "other number": ({"max_bounces": 10}, {}),
    "few bounces there": ({"max_bounces": 3}, {}),
    "few of light through glass": ({"transmission_bounces": 2}, {}),
    "same clamp": ({}, {"clamp_indirect": 10.0}),
    "own clamp": ({}, {"clamp_indirect": 2.5}),
    "clamped here alone": ({"sample_clamp_indirect": 0.0}, {"clamp_indirect": 2.5}),
    "same kinds": ({}, {"diffuse_bounces": 4, "glossy_bounces": 4, "filter_glossy": 1.0}),
    "classic": ({}, {"integrator": "CLASSIC"}),
    "normals": ({}, {"integrator": "NORMALS"}),
}


def light_paths():
    result = {"severities": {}}
    for name, (theirs, ours) in _LIGHT_PATHS.items():
        bpy.ops.wm.read_factory_settings(use_empty=False)
        scene = bpy.context.scene
        for owner, changes in ((scene.cycles, theirs), (scene.lancer, ours)):
            for field, value in changes.items():
                setattr(owner, field, value)
        messages = _told_of_scene()
        result[name] = messages.lines()
        if messages:
            result["severities"][name] = [message.severity.name for message in messages.told()]
    return result


def settings():
    """Return the messages for light paths like Lancer's, for neutral changes, and for each other change by itself."""

    def told():
        return _told_of_scene().lines()

    bpy.ops.wm.read_factory_settings(use_empty=False)
    stage.light_paths_alike(bpy.context.scene)
    result = {"alike": told(), "words": {}}
    for name, value in _NEUTRAL.items():
        setattr(bpy.context.scene.cycles, name, value)
    result["neutral"] = told()
    bpy.ops.wm.read_factory_settings(use_empty=False)
    stage.light_paths_alike(bpy.context.scene)
    cycles = bpy.context.scene.cycles
    for name, (value, word) in _SETTINGS.items():
        start = getattr(cycles, name)
        setattr(cycles, name, value)
        result["words"][word] = told()
        setattr(cycles, name, start)
    return result


def objects():
    """Return the messages for single objects: plain, and with each setting that is not supported."""
    from addon.export.unsupported import check_object
    from addon.messages.messages import Messages

    def told(thing):
        messages = Messages()
        check_object(thing, scene, messages)
        return messages.lines()

    scene = stage.empty()
    cube = stage.cube()
    result = {"plain": told(cube)}
    new = hasattr(cube, "shadow_terminator_shading_offset")
    owner, name = (cube, "shadow_terminator_shading_offset") if new else (cube.cycles, "shadow_terminator_offset")
    setattr(owner, name, 0.2)
    result["terminator"] = told(cube)
    setattr(owner, name, 0.0)
    cube.cycles.is_caustics_receiver = True
    result["caustics"] = told(cube)
    cube.cycles.is_caustics_receiver = False
    cube.modifiers.new("Round", "SUBSURF")
    result["divided"] = told(cube)
    return result
