"""Take Over Cycles' Settings: gives Lancer's settings of a scene the values of its Cycles settings.

    from addon.operators.take_over_cycles import take_over
    take_over(scene)

Cycles' settings stay as they are. Settings that the export reads itself need no copy.
"""

import bpy

from ..bindings.abi import LancerError
from ..denoise import view_layer as denoise
from ..export.cycles_settings import filter_of

# Cycles' threshold bounds an estimate for each pixel, not the error of the picture. At thresholds of 0.05, 0.02 and 0.01, the
# true errors of five scenes were 6 to 19 %, 4 to 9 % and 2 to 7 %. Three times the threshold lies within all three ranges.
ERROR_OF_THRESHOLD = 3.0
# Single precision has seven digits.
_SAME = 1e-6
_GLASS = ("film_transparent_glass", "film_transparent_roughness")
_OFF = "the Cycles add-on is off, there are no settings to take over"


def differing(scene):
    """Return {name of a setting of scene.lancer: value of Cycles' counterpart} of all settings that differ from it.

    Empty while Cycles, an add-on, is disabled.
    """
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return {}
    wanted = {name: _within_limits(_field(scene, name), value) for name, value in _wanted(scene, cycles)}
    return {name: value for name, value in wanted.items() if _differs(getattr(scene.lancer, name), value)}


def take_over(scene):
    """Set all that differs, and return it as differing() does. Raises LancerError while the Cycles add-on is disabled."""
    if not hasattr(scene, "cycles"):
        raise LancerError(f"scene '{scene.name}': {_OFF}")
    changes = differing(scene)
    for name, value in changes.items():
        if name not in _GLASS:
            setattr(scene.lancer, name, value)
    if not changes.keys().isdisjoint(_GLASS):
        # Cycles' settings hold if none of Lancer's own is set.
        for name in _GLASS:
            scene.lancer.property_unset(name)
    return changes


def _wanted(scene, cycles):
    own = scene.lancer
    yield "samples", cycles.samples
    yield "target_error", _target_error(cycles)
    yield "time_limit", cycles.time_limit
    yield "seed", cycles.seed
    yield "use_animated_seed", cycles.use_animated_seed
    yield "max_bounces", cycles.max_bounces
    for kind in ("diffuse", "glossy", "transmission"):
        yield f"{kind}_bounces", _effective(getattr(cycles, f"{kind}_bounces"), cycles.max_bounces, own)
    yield "transparent_bounces", cycles.transparent_max_bounces
    yield "filter_glossy", cycles.blur_glossy
    yield "clamp_indirect", cycles.sample_clamp_indirect
    kind, width = filter_of(cycles)
    yield "pixel_filter", kind
    if width is not None:
        yield "filter_width", width
    if any(own.is_property_set(name) for name in _GLASS):
        for name in _GLASS:
            yield name, getattr(cycles, name)
    yield "preview_samples", cycles.preview_samples
    # Cycles' switch is on by default, in Blenders without a denoiser too.
    if not denoise.missing():
        yield "use_denoising", cycles.use_denoising
        yield "use_preview_denoising", cycles.use_preview_denoising


def _effective(limit, total, own):
    """Return a limit of one kind of bounces, or no limit where the total ends paths first."""
    return limit if limit < total else own.bl_rna.properties["diffuse_bounces"].default


def _target_error(cycles):
    if not cycles.use_adaptive_sampling:
        return 0.0
    # 0 means automatic: Cycles then takes one over the samples, and 0.001 at least.
    threshold = cycles.adaptive_threshold or max(0.001, 1.0 / cycles.samples)
    return ERROR_OF_THRESHOLD * threshold


def _field(scene, name):
    return scene.lancer.bl_rna.properties[name]


def _within_limits(field, value):
    """Return the value clamped to a property's limits, which differ between the two add-ons."""
    return min(max(value, field.hard_min), field.hard_max) if field.type in ("INT", "FLOAT") else value


def _differs(now, value):
    return abs(now - value) > _SAME * abs(value) if isinstance(value, float) else now != value


def titles(scene, changes):
    """Return the names of settings as panels show them."""
    return [_field(scene, name).name for name in changes]


def _described(scene, changes):
    return [f"{_field(scene, name).name} {_shown(_field(scene, name), value)}" for name, value in changes.items()]


def _shown(field, value):
    if field.type == "BOOLEAN":
        return "on" if value else "off"
    return field.enum_items[value].name if field.type == "ENUM" else f"{value:g}"


class LANCER_OT_take_over_cycles(bpy.types.Operator):
    bl_idname = "lancer.take_over_cycles"
    bl_label = "Take Over Cycles' Settings"
    bl_description = (
        "Give Lancer's settings the values of this scene's Cycles settings, which stay as they are. A noise threshold becomes "
        f"a target error of {ERROR_OF_THRESHOLD:g} times the threshold: Cycles' threshold is no error of the picture, and true "
        "errors of scenes rendered with it lie around that"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def description(cls, context, _properties):
        changes = _described(context.scene, differing(context.scene))
        return f"{cls.bl_description}. Here: {', '.join(changes)}" if changes else cls.bl_description

    @classmethod
    def poll(cls, context):
        scene = context.scene
        if scene is None:
            return False
        reason = ""
        if not hasattr(scene, "cycles"):
            reason = _OFF[0].upper() + _OFF[1:]
        elif scene.library is not None:
            reason = "The scene is linked from another file"
        elif not differing(scene):
            reason = "Lancer's settings are already those of Cycles"
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context):
        changes = take_over(context.scene)
        self.report({"INFO"}, f"Lancer: took over {', '.join(_described(context.scene, changes))}")
        return {"FINISHED"}


def register():
    bpy.utils.register_class(LANCER_OT_take_over_cycles)


def unregister():
    bpy.utils.unregister_class(LANCER_OT_take_over_cycles)
