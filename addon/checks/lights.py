"""Light that is not there, and light too weak to be seen beside the rest."""

from ..bindings.enums import Integrator
from .finding import Finding, Harm
from .traits import is_zero

# Sums of single precision lose what is 2^-24 of them; lamps may stand some 200 times nearer, which brings the square of that.
_UNSEEN = 2.0**-40


def check_lights(subject):
    snapshot = subject.snapshot
    if snapshot.settings.integrator == Integrator.NORMALS:
        return
    levels = [max(light.emission) for light in snapshot.lights]
    shining = any(level > 0.0 for level in levels) or not is_zero(snapshot.world.radiance) or _any_emission(subject)
    if not shining:
        yield Finding(
            "lights", Harm.WRONG, "nothing gives light, so that the picture will be black", "add a lamp or a world colour"
        )
        return
    strongest = max(levels, default=0.0)
    for light, level in zip(snapshot.lights, levels, strict=True):
        place = tuple(light.matrix[:, 3].tolist())
        if not level > 0.0:
            yield Finding(
                "lights",
                Harm.HINT,
                "gives no light: its power or colour is 0",
                "delete or hide it",
                light=light.name,
                place=place,
            )
        elif level < _UNSEEN * strongest:
            what = f"is {strongest / level:.2g} times weaker than the strongest lamp, beside which it is lost in rounding"
            yield Finding("lights", Harm.HINT, what, "delete it, or weaken the other", light=light.name, place=place)


def _any_emission(subject):
    table = subject.instances
    used = (
        {int(slot) for row in range(len(table)) for slot in subject.slots(row)}
        if len(table) < 64
        else set(table.slots.tolist())
    )
    if any(subject.traits[number].emits for number in used):
        return True
    # The ambient colours of CLASSIC's lamps and surfaces need a lamp that is told of above.
    return False
