"""Traits of materials that decide whether a fault of the geometry is visible."""

from dataclasses import dataclass, replace

from ..bindings.enums import LobeKind
from ..bindings.shading import NodeRef

_CLEAR = (LobeKind.DIELECTRIC, LobeKind.GLASS, LobeKind.REFRACTION)


@dataclass(frozen=True)
class Traits:
    refracts: bool  # refracts light into the body
    passes: bool  # transmits light straight through
    emits: bool
    scatters: bool


def is_zero(value):
    """Whether a parameter is the constant 0."""
    if isinstance(value, NodeRef):
        return False
    return not any(value) if isinstance(value, tuple) else value == 0.0


def is_number(value, number):
    return not isinstance(value, (NodeRef, tuple)) and value == number


def clear_lobes(material):
    """Yield (IOR, lobe) of every lobe that refracts light into the body."""
    for lobe in material.lobes:
        if is_zero(lobe.weight):
            continue
        if lobe.kind in _CLEAR and not is_zero(lobe.color):
            yield lobe.ior, lobe
        elif lobe.kind == LobeKind.PRINCIPLED and lobe.principled is not None:
            principled = lobe.principled
            # A sheet has no inside.
            solid = isinstance(principled.thin_wall, NodeRef) or is_zero(principled.thin_wall)
            if solid and not is_zero(principled.transmission) and not is_number(principled.metallic, 1.0):
                yield principled.ior, lobe


def traits_of(material):
    principled = [lobe.principled for lobe in material.lobes if lobe.principled is not None]
    return Traits(
        # With IOR 1 the orientation of faces does not matter.
        refracts=any(not is_number(ior, 1.0) for ior, _ in clear_lobes(material)),
        passes=not is_zero(material.transmittance),
        emits=not is_zero(material.emission) or any(not is_zero(record.emission) for record in principled),
        scatters=bool(material.lobes),
    )


def look_alike(one, other):
    """Whether two materials are equal except for name and pass index."""
    return one is other or replace(one, name="", material_index=0) == replace(other, name="", material_index=0)
