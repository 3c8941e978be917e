"""Objects that their animation, or a script, moves, and of which nothing else changes."""

import bpy

# Beginnings of data paths of an object's transform.
_TRANSFORM = ("location", "rotation_", "scale", "delta_location", "delta_rotation_", "delta_scale")
_OF_OBJECTS = bpy.types.Object.bl_rna.properties
# Properties of an object itself that an export reads, in any version of Blender.
_READ = tuple(
    name
    for name in (
        "color", "hide_render", "hide_viewport", "is_holdout", "is_shadow_catcher", "pass_index",
        "shadow_terminator_geometry_offset", "shadow_terminator_shading_offset", "show_instancer_for_render",
        "show_instancer_for_viewport", "visible_camera", "visible_diffuse", "visible_glossy", "visible_shadow",
        "visible_transmission", "visible_volume_scatter",
    )
    if name in _OF_OBJECTS
)  # fmt: skip


def has_traits(thing):
    """Whether more of an object than its place may change while Blender reports that it has moved.

    Blender does not report a script's change of an add-on's property, nor a driver of other properties than the transform.
    """
    return thing.animation_data is not None or thing.is_property_set("lancer")


def traits(thing):
    """Return the values of an object's own properties apart from its transform."""
    own = (thing.lancer.shape, thing.lancer.shading) if thing.is_property_set("lancer") else ()
    return *own, *(tuple(value) if name == "color" else value for name in _READ for value in (getattr(thing, name),))


def only_moves(thing):
    """Whether the animation of an object changes nothing but its transform."""
    animation = thing.animation_data
    if animation is None:
        return True
    if any(True for _ in animation.nla_tracks):
        return False
    action = animation.action
    channels = [] if action is None else _channels(action)
    return all(curve.data_path.startswith(_TRANSFORM) for curves in (channels, animation.drivers) for curve in curves)


def _channels(action):
    """Yield the curves of all of an action's slots, those of other data-blocks too."""
    # Blender 4.3 has layers beside the actions that it makes.
    if bpy.app.version < (4, 4):
        yield from action.fcurves
        return
    for layer in action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                yield from bag.fcurves
