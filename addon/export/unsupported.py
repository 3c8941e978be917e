"""Settings of a scene that Lancer does not support: each becomes a message that names its owner."""

import bpy

from ..bindings.enums import Pass, PassKind
from ..bindings.numbered_pass import NumberedPass
from ..messages.severity import Severity
from .catchers import is_catcher
from .cycles_settings import check_cycles
from .light_groups import MOST
from .shutter import blurs_motion
from .visibility import object_hidden_from, sees_light_apart

# Passes that engine/passes.py renders, by the names of a view layer's switches.
_COMPONENTS = ("diffuse", "glossy", "transmission")
_PASSES_HERE = {f"{component}_{part}" for component in _COMPONENTS for part in ("direct", "indirect", "color")} | {
    "combined", "z", "mist", "position", "normal", "vector", "uv", "object_index", "material_index", "emit", "environment",
    "ambient_occlusion",
}  # fmt: skip
_PASSES_HERE.add("shadow_catcher")
_PASSES_HERE |= {f"cryptomatte_{kind}" for kind in ("object", "material", "asset")}
# A switch without an image of its own, and a pass that Blender itself draws.
_NO_PASSES = {"cryptomatte_accurate", "grease_pencil"}
# Switches of Cycles' passes for denoising, which are on by default.
_GUIDES_SHAPED_BY = ("denoising_pass_follow_reflections", "denoising_pass_use_albedo_roughness_weighting")
# Passes that stay black with an integrator in every scene.
_LIT = {Pass[f"{component}_{part}".upper()] for component in _COMPONENTS for part in ("direct", "indirect")}
EMPTY_PASSES = {
    "PATH": frozenset(),
    "CLASSIC": frozenset({Pass.AMBIENT_OCCLUSION, *_LIT}),
    "NORMALS": frozenset({Pass.EMISSION, Pass.ENVIRONMENT, Pass.AMBIENT_OCCLUSION, *_LIT}),
}
# Find out once which properties this Blender has: a failing getattr per object takes as long as all other checks.
_OF_OBJECTS = bpy.types.Object.bl_rna.properties
_HAS_OFFSET = "shadow_terminator_shading_offset" in _OF_OBJECTS


def check_scene(scene, messages):
    check_cycles(scene, messages)


def check_passes(scene, passes, messages):
    """Add a message for the requested passes (of enums.Pass, or NumberedPasses) that the integrator leaves empty."""
    integrator = scene.lancer.integrator
    names = [item.name.replace("_", " ").capitalize() for item in sorted(EMPTY_PASSES[integrator].intersection(passes))]
    if integrator != "PATH" and NumberedPass(PassKind.LIGHT_GROUP) in passes:
        names.append("Light groups")
    if names:
        title = scene.lancer.bl_rna.properties["integrator"].enum_items[integrator].name
        names = ", ".join(names)
        messages.add(f"scene '{scene.name}': these passes stay empty with {title}, Path Tracing fills them: {names}")


def check_view_layer(scene, view_layer, messages):
    who = f"view layer '{view_layer.name}'"
    if scene.render.use_freestyle and view_layer.use_freestyle:
        messages.add(f"{who}: Freestyle is not supported by Lancer, Blender draws its lines with EEVEE over the picture")
    if len(view_layer.lightgroups) > MOST:
        messages.add(f"{who}: has {len(view_layer.lightgroups)} light groups, the first {MOST} are rendered")
    names = _missing_passes(view_layer)
    if names:
        messages.add(f"{who}: these passes are not supported: {', '.join(names)}", severity=Severity.LEFT_OUT)
    if view_layer.use_pass_vector and blurs_motion(scene, view_layer):
        messages.add(f"{who}: the pass Vector is empty with motion blur, as in Cycles")
    cycles = getattr(view_layer, "cycles", None)
    if getattr(cycles, "denoising_store_passes", False):
        if scene.render.film_transparent and view_layer.use_pass_environment:
            text = "behind a transparent film Cycles adds the sky to Denoising Albedo if the pass Environment is on"
            messages.add(f"{who}: {text}, here it is never added")
        if bpy.app.version < (4, 0):
            messages.add(
                f"{who}: passes for denoising are those of Cycles 4, in Cycles 3 the albedo of Principled and the depth behind "
                "clear surfaces differ"
            )
        for name in _GUIDES_SHAPED_BY:
            if not getattr(cycles, name, True):
                title = cycles.bl_rna.properties[name].name
                messages.add(f"{who}: passes for denoising without {title} are not supported, they are rendered with it")


def _missing_passes(view_layer):
    """Return the names of all requested passes that are not rendered."""
    names = []
    for owner in (view_layer, getattr(view_layer, "cycles", None), getattr(view_layer, "eevee", None)):
        for field in owner.bl_rna.properties if owner is not None else ():
            name = field.identifier[len("use_pass_") :]
            if not field.identifier.startswith("use_pass_") or name in _PASSES_HERE or name in _NO_PASSES:
                continue
            if getattr(owner, field.identifier) and field.name not in names:
                names.append(field.name)
    return names


def check_object(thing, scene, messages):
    if is_catcher(thing) and scene.lancer.integrator != "PATH":
        messages.add(f"object '{thing.name}': shadow catchers need Path Tracing, it is rendered as any other object")
    if sees_light_apart(object_hidden_from(thing)):
        messages.add(
            f"object '{thing.name}': shadow rays see it and paths do not, or the reverse: light behind it depends on the "
            "sampling of lights, which is not Cycles'; with all switches but Camera equal it does not",
            "feature:sampling of light behind an object with ray visibility",
            Severity.HINT,
        )
    # Cycles is an add-on and may be disabled.
    cycles = getattr(thing, "cycles", None)
    offset = thing.shadow_terminator_shading_offset if _HAS_OFFSET else getattr(cycles, "shadow_terminator_offset", 0.0)
    if offset > 0.0:
        who = f"object '{thing.name}'"
        messages.add(
            f"{who}: the shading offset of the shadow terminator is left out, use the geometry offset",
            "feature:shading offset of the terminator",
        )
    if getattr(cycles, "is_caustics_receiver", False):
        who = f"object '{thing.name}'"
        messages.add(
            f"{who}: shadow caustics are not supported, only the caustics that paths find are shown",
            "feature:shadow caustics",
        )


def check_hair(thing, messages):
    """Add a message for each system of hair particles: the depsgraph has no geometry of strands."""
    for modifier in thing.modifiers:
        if modifier.type != "PARTICLE_SYSTEM" or not modifier.show_render or modifier.particle_system is None:
            continue
        system = modifier.particle_system
        if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
            text = f"hair of particle system '{system.name}' is not supported, it is left out"
            messages.add(f"object '{thing.name}': {text}", "feature:hair particles", severity=Severity.LEFT_OUT)
