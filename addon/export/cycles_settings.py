"""Cycles' own settings of a scene that change its light and have no counterpart: each that is not as it comes is told.

Those that Lancer's settings stand for (samples, all bounces together, clamping of indirect light, filter, seed) are not read,
and those that change noise and time only need not be.
"""

_KINDS = ("diffuse", "glossy", "transmission")


def check_cycles(scene, messages):
    # Cycles is an add-on and may be off.
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return
    for text in (*_light(scene, cycles), *_simplified(scene, cycles)):
        messages.add(f"scene '{scene.name}': {text}")


def _light(scene, cycles):
    if cycles.film_exposure != 1.0:
        told = f"Cycles' film exposure ({cycles.film_exposure:g})"
        yield f"{told} is not supported, use the exposure of colour management"
    if cycles.use_fast_gi:
        yield "Cycles' Fast GI Approximation is not supported, light bounces on"
    if cycles.sample_clamp_direct > 0.0:
        yield f"Cycles' Clamp Direct Light ({cycles.sample_clamp_direct:g}) is not supported, direct light is not clamped"
    for name in ("reflective", "refractive"):
        if not getattr(cycles, f"caustics_{name}"):
            yield f"Cycles' {name} caustics are off, which is not supported, Lancer shows them"
    # 0 is as Lancer shows it.
    if cycles.blur_glossy > 0.0 and _changed(cycles, "blur_glossy"):
        yield f"Cycles' Filter Glossy ({cycles.blur_glossy:g}) is not supported, reflections after a bounce stay sharp"
    for kind in _KINDS:
        name = f"{kind}_bounces"
        limit = getattr(cycles, name)
        if _changed(cycles, name) and limit < scene.lancer.max_bounces:
            yield f"Cycles' limit of {limit} {kind} bounces is not supported, use Max Bounces of all kinds together"


def _simplified(scene, cycles):
    render = scene.render
    if not render.use_simplify:
        return
    for name, title in (("texture_limit_render", "Texture Limit"), ("texture_resolution_render", "Texture Resolution")):
        if name in cycles.bl_rna.properties and _changed(cycles, name):
            yield f"Simplify's {title} is not supported, pictures are used in full size"
    # Cycles never culls for these.
    camera = scene.camera
    if render.use_multiview or (camera is not None and camera.type == "CAMERA" and camera.data.type == "PANO"):
        return
    for name in ("camera", "distance"):
        switch = f"use_{name}_cull"
        if getattr(cycles, switch) and any(getattr(thing.cycles, switch) for thing in scene.objects):
            yield f"Simplify's {name} culling is not supported, nothing is left out"


def _changed(owner, name):
    """Whether a setting is another than Blender starts with."""
    return getattr(owner, name) != owner.bl_rna.properties[name].default
