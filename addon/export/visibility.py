"""Which rays do not see a thing, as the bits of lancer.h."""

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


# To look in vain for what only other Blenders have takes as long as all the rest.
_OF_OBJECTS = tuple(
    (f"visible_{name}", int(bit)) for name, bit in _BITS.items() if f"visible_{name}" in bpy.types.Object.bl_rna.properties
)


def hidden_from(owner):
    """The bits of a world's switches; 0 without an owner, as where Cycles is off."""
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
