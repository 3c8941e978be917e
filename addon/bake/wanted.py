"""The passes that a type of bake reads, and the picture that they make."""

from typing import NamedTuple

import bpy
import numpy as np

from ..bindings.enums import BakeLacks, Pass
from ..export.catchers import SOURCE

_DATA = {
    "POSITION": Pass.POSITION,
    "NORMAL": Pass.NORMAL,
    "UV": Pass.UV,
    "ROUGHNESS": Pass.ROUGHNESS,
    "EMIT": Pass.EMISSION,
    "ENVIRONMENT": Pass.ENVIRONMENT,
    "AO": Pass.AMBIENT_OCCLUSION,
}
_COMPONENTS = ("DIFFUSE", "GLOSSY", "TRANSMISSION")
TYPES = frozenset({*_DATA, *_COMPONENTS, "COMBINED", "SHADOW"})


class Wanted(NamedTuple):
    """direct, indirect, color: which parts of the light of the components count; emission: whether emitted light does."""

    kind: str  # bpy.ops.object.bake's type
    components: tuple = ()
    lacks: BakeLacks = BakeLacks(0)
    direct: bool = False
    indirect: bool = False
    color: bool = False
    emission: bool = False
    whole: bool = False  # all of Combined

    @property
    def passes(self):
        """The core's passes."""
        if self.kind in _DATA:
            return (_DATA[self.kind],)
        if self.whole:
            return (Pass.COMBINED,)
        if self.kind == "SHADOW":
            return (SOURCE,)
        parts = [name for name, is_on in (("DIRECT", self.direct), ("INDIRECT", self.indirect), ("COLOR", self.color)) if is_on]
        found = tuple(Pass[f"{component}_{part}"] for component in self.components for part in parts)
        return (Pass.COMBINED, *found, *((Pass.EMISSION,) if self.emission else ()))

    @property
    def bounces(self):
        """The most scatterings after the first that count; None: as the scene says."""
        return 0 if self.kind in _DATA or not (self.indirect or self.kind == "SHADOW") else None

    def picture(self, read):
        """Return (height, width, 4) float32; read(source): as Session.read."""
        if self.whole:
            return read(Pass.COMBINED)
        rgb = self._sum(read)
        alpha = np.ones((*rgb.shape[:2], 1), np.float32) if self._is_opaque else read(Pass.COMBINED)[..., 3:]
        return np.concatenate([rgb, alpha], axis=2)

    @property
    def _is_opaque(self):
        """Whether Cycles bakes the alpha 1, also where there is no surface."""
        one_part = self.direct != self.indirect and self.color and self.kind in _COMPONENTS
        return self.kind in _DATA or self.kind == "SHADOW" or one_part

    def _sum(self, read):
        if self.kind == "SHADOW":
            return read(SOURCE)
        if self.kind in _DATA:
            values = read(_DATA[self.kind])
            return np.broadcast_to(values, (*values.shape[:2], 3)) if values.shape[2] == 1 else values[..., :3]
        total = read(Pass.EMISSION) if self.emission else np.zeros_like(read(Pass.COMBINED)[..., :3])
        for component in self.components:
            light = [read(Pass[f"{component}_{part}"]) for part, is_on in self._light if is_on]
            color = read(Pass[f"{component}_COLOR"]) if self.color else 1.0
            # Without light the colour itself is baked.
            total = total + (sum(light) * color if light else color if self.color else 0.0)
        return total

    @property
    def _light(self):
        return ("DIRECT", self.direct), ("INDIRECT", self.indirect)


def wanted(kind, pass_filter):
    """Return the Wanted of a type of bake with Blender's bits of a pass filter, or None for a type that is not supported."""
    if kind not in TYPES:
        return None
    if kind in _DATA or kind == "SHADOW":
        return Wanted(kind)
    bits = {item.identifier: item.value for item in bpy.types.BakeSettings.bl_rna.properties["pass_filter"].enum_items}

    def has(*names):
        return all(pass_filter & bits[name] for name in names)

    light = {"direct": has("DIRECT"), "indirect": has("INDIRECT")}
    if kind in _COMPONENTS:
        return Wanted(kind, (kind,), _lacks(kind), **light, color=has("COLOR"))
    lacks = _lacks(*(name for name in _COMPONENTS if has(name)))
    # Glass has lobes of a component that is left out.
    components = _COMPONENTS if any(light.values()) else ()
    whole = all(light.values()) and has("EMIT")
    return Wanted(kind, components, lacks, **light, color=True, emission=has("EMIT"), whole=whole)


def _lacks(*components):
    lacks = BakeLacks(0)
    for name in _COMPONENTS:
        if name not in components:
            lacks |= BakeLacks[name]
    return lacks
