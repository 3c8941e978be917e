"""Scenes without light, lamps without power, and lamps that are too weak to matter."""

from ..bindings.enums import Integrator, Pass
from .finding import Finding, Severity
from .traits import is_zero

# Sums in single precision lose terms below 2^-24 of the sum; a lamp 256 times nearer gives 2^16 times the light.
_UNSEEN = 2.0**-40


def check_lights(subject):
    snapshot = subject.snapshot
    if snapshot.settings.integrator == Integrator.NORMALS:
        return
    lamps = [light for light in snapshot.lights if not light.opening]
    levels = [max(map(abs, light.emission)) for light in lamps]
    if not (any(level > 0.0 for level in levels) or not is_zero(snapshot.world.radiance) or _any_emission(subject)):
        # A scene with other passes may be meant for those alone, such as masks.
        if set(snapshot.settings.passes) == {Pass.COMBINED}:
            what, advice = "nothing gives light: the picture will be black", "add a lamp or a world colour"
            yield Finding("lights", Severity.WRONG, what, advice)
        return
    strongest = max(levels, default=0.0)
    for light, level in zip(lamps, levels, strict=True):
        place = tuple(light.matrix[:, 3].tolist())
        if not level > 0.0:
            what = "gives no light: its power or colour is 0"
            yield Finding("lights", Severity.HINT, what, "delete or hide it", light=light.name, place=place)
        elif level < _UNSEEN * strongest:
            what = f"is {strongest / level:.2g} times weaker than the strongest lamp: its light is lost in rounding"
            yield Finding("lights", Severity.HINT, what, "delete it, or weaken the other", light=light.name, place=place)


def _any_emission(subject):
    return any(subject.traits[number].emits for number in set(subject.instances.slots.tolist()))
