"""Ray visibility as the bits of lancer.h: the kinds of rays that do not see an object or a world."""

import bpy

from ..bindings.enums import LobeKind, Ray
from .arithmetic import is_constant

_BITS = {
    "camera": Ray.CAMERA,
    "diffuse": Ray.DIFFUSE,
    "glossy": Ray.GLOSSY,
    "transmission": Ray.TRANSMISSION,
    "volume_scatter": Ray.VOLUME,
    "scatter": Ray.VOLUME,
    "shadow": Ray.SHADOW,
}


# Look up once which switches this Blender has: failing lookups per object take as long as all other reads.
_OF_OBJECTS = tuple(
    (f"visible_{name}", int(bit)) for name, bit in _BITS.items() if f"visible_{name}" in bpy.types.Object.bl_rna.properties
)


def hidden_from(owner):
    """Return the bits of a world's switches; 0 without an owner, as when Cycles is disabled."""
    bits = 0
    for name, bit in _BITS.items():
        if not getattr(owner, name, True):
            bits |= int(bit)
    return bits


def object_hidden_from(thing):
    bits = 0
    for name, bit in _OF_OBJECTS:
        if not getattr(thing, name):
            bits |= bit
    return bits


_OF_LIGHT = int(Ray.DIFFUSE | Ray.GLOSSY | Ray.TRANSMISSION)


def sees_light_apart(hidden):
    """Whether a surface blocks the shadow rays of scattered paths but not the paths, or the reverse: Ray bits as above.

    Light behind it then depends on the share of each technique in multiple importance sampling.
    """
    blocks = ~hidden & _OF_LIGHT
    return blocks != 0 if hidden & int(Ray.SHADOW) else blocks != _OF_LIGHT


def report_lamps_in_glass(lights, materials, messages):
    """Report lamps that are hidden from glass here. Since 4.0 Cycles' samples of lamps obey no switch at glass, its rays do."""
    hidden = [light.name for light in lights if light.hidden_from & int(Ray.GLOSSY | Ray.TRANSMISSION)]
    if bpy.app.version < (4, 0) or not hidden or not any(_is_glass(lobe) for item in materials for lobe in item.lobes):
        return
    for name in sorted(set(hidden)):
        messages.add(
            f"light '{name}': its ray visibility hides it from glass, which Cycles' samples of lamps ignore",
            "feature:lamps hidden from glass",
        )


def _is_glass(lobe):
    if lobe.kind == LobeKind.PRINCIPLED:
        return not is_constant(lobe.principled.transmission, 0.0)
    return lobe.kind == LobeKind.GLASS and not is_constant(lobe.roughness, 0.0)
