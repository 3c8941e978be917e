"""Which rays do not see a thing, as the bits of lancer.h."""

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


def hidden_from(owner, prefix=""):
    """The bits of an object ("visible_"), or of a world's switches; 0 without an owner, as where Cycles is off."""
    bits = 0
    for name, bit in _BITS.items():
        if not getattr(owner, prefix + name, True):
            bits |= int(bit)
    return bits
