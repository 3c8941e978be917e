"""Ray visibility as the bits of lancer.h: the kinds of rays that do not see an object or a world."""

import bpy

from ..bindings.enums import Ray

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


def lights_some_lobes(hidden):
    """Whether a light is hidden from some kinds of scattered rays and not from all: Ray bits as above."""
    return hidden & _OF_LIGHT not in (0, _OF_LIGHT)
