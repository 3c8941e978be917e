"""What a scene asks for that has no counterpart: each thing becomes a message that names its owner."""

# As passes.py renders them, by the names of a view layer's switches.
_COMPONENTS = ("diffuse", "glossy", "transmission")
_PASSES_HERE = {f"{component}_{part}" for component in _COMPONENTS for part in ("direct", "indirect", "color")} | {
    "combined", "z", "mist", "position", "normal", "uv", "object_index", "material_index", "emit", "environment",
    "ambient_occlusion",
}  # fmt: skip
# No picture of its own, and one that Blender draws itself.
_NO_PASSES = {"cryptomatte_accurate", "grease_pencil"}


def check_scene(scene, messages):
    who = f"scene '{scene.name}'"
    if scene.render.use_motion_blur:
        messages.add(f"{who}: motion blur is not supported, the frame is rendered sharp")
    if scene.render.use_multiview:
        messages.add(f"{who}: stereoscopy is not supported, every view shows the scene's camera")
    # Cycles is an add-on and may be off; 1 is its neutral exposure.
    exposure = getattr(getattr(scene, "cycles", None), "film_exposure", 1.0)
    if exposure != 1.0:
        messages.add(f"{who}: Cycles' film exposure ({exposure:g}) is not supported, use the exposure of colour management")


def check_view_layer(scene, view_layer, messages):
    who = f"view layer '{view_layer.name}'"
    if scene.render.use_freestyle and view_layer.use_freestyle:
        messages.add(f"{who}: Freestyle is not supported by Lancer, Blender draws its lines with EEVEE over the picture")
    names = _missing_passes(view_layer)
    if names:
        messages.add(f"{who}: these passes are not supported: {', '.join(names)}")


def _missing_passes(view_layer):
    """The names of all passes that are asked for and not rendered."""
    names = []
    for owner in (view_layer, getattr(view_layer, "cycles", None), getattr(view_layer, "eevee", None)):
        for field in owner.bl_rna.properties if owner is not None else ():
            name = field.identifier[len("use_pass_") :]
            if not field.identifier.startswith("use_pass_") or name in _PASSES_HERE or name in _NO_PASSES:
                continue
            if getattr(owner, field.identifier) and field.name not in names:
                names.append(field.name)
    names += [f"AOV '{aov.name}'" for aov in view_layer.aovs]
    return names + [f"light group '{group.name}'" for group in view_layer.lightgroups]


def check_object(thing, messages):
    who = f"object '{thing.name}'"
    _check_linking(thing, who, messages)
    if getattr(thing, "is_shadow_catcher", False):
        messages.add(f"{who}: shadow catchers are not supported, it is rendered as any other object")
    name = "shadow_terminator_shading_offset"
    if getattr(thing, name, getattr(getattr(thing, "cycles", None), name, 0.0)) > 0.0:
        messages.add(f"{who}: the shading offset of the shadow terminator is not supported")


def check_hair(thing, messages):
    """Strands are no geometry of the depsgraph: nothing of them arrives by itself."""
    for modifier in thing.modifiers:
        if modifier.type != "PARTICLE_SYSTEM" or not modifier.show_render or modifier.particle_system is None:
            continue
        system = modifier.particle_system
        if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
            messages.add(f"object '{thing.name}': hair of particle system '{system.name}' is not supported, it is left out")


def check_light_object(thing, who, messages):
    _check_linking(thing, who, messages)


def _check_linking(thing, who, messages):
    linking = getattr(thing, "light_linking", None)
    if getattr(linking, "receiver_collection", None) is not None:
        messages.add(f"{who}: light linking ('{linking.receiver_collection.name}') is not supported, it lights everything")
    if getattr(linking, "blocker_collection", None) is not None:
        messages.add(f"{who}: shadow linking ('{linking.blocker_collection.name}') is not supported, everything casts shadow")
