"""Materials outside the model: roughness, IOR and weights that mean nothing, glass that bends no light, light that grows."""

import math

import numpy as np

from ..bindings.enums import Integrator, LobeKind
from ..bindings.shading import NodeRef
from ..bindings.structs import PARAMETERS, Principled
from .finding import Finding, Severity
from .ranges import Ranges
from .traits import clear_lobes

_SHARES = [name for name, (kind, _) in PARAMETERS[Principled].items() if kind == "share"]
# What surely comes back of the light is its colour; of the others Fresnel decides, or a refractive index is no colour.
_COLORED = {
    LobeKind.LAMBERT, LobeKind.DIFFUSE, LobeKind.MIRROR, LobeKind.GLOSSY, LobeKind.PHONG, LobeKind.BLINN_PHONG,
    LobeKind.DIELECTRIC, LobeKind.GLASS, LobeKind.REFRACTION, LobeKind.TRANSLUCENT, LobeKind.MINNAERT,
}  # fmt: skip
_WITHOUT_ROUGHNESS = {LobeKind.LAMBERT, LobeKind.PHONG, LobeKind.BLINN_PHONG, LobeKind.MIRROR, LobeKind.MINNAERT}
# Shares of Mix Shaders in single precision add up to 1 within a few of its steps; colours are set with three digits.
_MORE_THAN_ALL = 1.001
# A hundredth of a picture: single texels are not worth a word.
_SHARE_OF_TEXELS = 0.01
# As air: light turns by less than 0.06 degrees for each 45 degrees.
_NEARLY_ONE = 1e-3
# Roulette ends paths that lose light; one that loses none goes on as long as the scene allows.
_LONG = 64


def check_closures(subject):
    snapshot = subject.snapshot
    used = _first_rows(subject)
    for number in sorted(used):
        subject.poll()
        material = snapshot.materials[number]
        ranges = Ranges(material.nodes, snapshot.images)
        for severity, what, advice, weight in _flaws(material, ranges, snapshot.settings):
            name = subject.name(used[number])
            yield Finding("closures", severity, what, advice, object=name, material=material.name, weight=weight)


def _first_rows(subject):
    """The first instance of each material that any has."""
    table = subject.instances
    starts, first = np.unique(table.first_slots, return_index=True)
    rows = {}
    for row in first[np.argsort(first)].tolist():
        for number in subject.materials_of(row):
            rows.setdefault(number, row)
    return rows


def _flaws(material, ranges, settings):
    yield from _outside(material, ranges)
    yield from _clear(material, ranges)
    if settings.integrator == Integrator.PATH:
        yield from _growing(material, ranges, settings)


def _parameters(material):
    """(name, parameter) of all that is a share, and (name, parameter) of all IORs."""
    shares, indices = [], []
    for lobe in material.lobes:
        record = lobe.principled
        if record is not None:
            shares += [(name, getattr(record, name)) for name in _SHARES]
            indices += [("IOR", record.ior), ("coat IOR", record.coat_ior)]
        else:
            if lobe.kind not in _WITHOUT_ROUGHNESS:
                shares.append(("roughness", lobe.roughness))
            if lobe.kind in (LobeKind.BECKMANN, LobeKind.DIELECTRIC, LobeKind.GLASS, LobeKind.REFRACTION):
                indices.append(("IOR", lobe.ior))
        shares += [("weight", channel) for channel in _channels(lobe.weight)]
    return shares, indices


def _channels(value):
    return value if isinstance(value, tuple) else (value,)


def _outside(material, ranges):
    """Numbers that mean nothing, written there or in a picture."""
    shares, indices = _parameters(material)
    told = set()
    for name, value in shares:
        low, high, share = _extremes(ranges, value)
        if share and not (low >= 0.0 and high <= 1.0) and name not in told and (name != "weight" or not low >= 0.0):
            told.add(name)
            beyond = low if not low >= 0.0 else high
            of = "goes to" if isinstance(value, NodeRef) else "is"
            severity = Severity.HINT if isinstance(value, NodeRef) else Severity.WRONG
            yield (
                severity,
                f"{name.replace('_', ' ')} {of} {beyond:.4g}, and only 0 to 1 means something",
                "bring it into that range",
                share,
            )
    for name, value in indices:
        low, _, share = _extremes(ranges, value, least=0.0)
        if share and not low > 0.0 and name not in told:
            told.add(name)
            of = "goes down to" if isinstance(value, NodeRef) else "is"
            yield Severity.WRONG, f"{name} {of} {low:.4g}, which no matter has", "use 1.33 for water, 1.5 for glass", share


def _extremes(ranges, value, least=None):
    """(lowest, highest, share of what is out of 0 ... 1, or not above least); a constant is all or nothing."""
    if not isinstance(value, NodeRef):
        value = float(value[0] if isinstance(value, tuple) else value)
        return value, value, 1.0
    values = ranges.values(value)[:, 0]
    if len(values) == 0:
        return 0.0, 1.0, 0.0
    # Rounding of a picture's curve is below a thousandth.
    out = (values < -1e-3) | (values > 1.0 + 1e-3) if least is None else values <= least
    share = float(out.mean())
    return float(values.min()), float(values.max()), share if share >= _SHARE_OF_TEXELS else 0.0


def _clear(material, ranges):
    """Glass that is not there, or that is thinner than air."""
    told = set()
    for ior, lobe in clear_lobes(material):
        values = ranges.values(ior)[:, 0] if isinstance(ior, NodeRef) else np.array([float(ior)])
        if len(values) == 0 or not (values > 0.0).all():
            continue
        low = float(values.min())
        color = lobe.color if lobe.principled is None else lobe.principled.base_color
        white = not isinstance(color, NodeRef) and min(color) > 0.99
        if not isinstance(ior, NodeRef) and abs(low - 1.0) < _NEARLY_ONE:
            if white and len(material.lobes) == 1 and "invisible" not in told:
                told.add("invisible")
                yield (
                    Severity.WASTE,
                    f"glass with IOR {low:.7g} bends and mirrors no light: it cannot be seen",
                    "use 1.33 for water, 1.5 for glass",
                    1.0,
                )
        elif low < 1.0 - _NEARLY_ONE and "thin" not in told:
            told.add("thin")
            yield (
                Severity.HINT,
                f"IOR {low:.4g} is below 1, which is right for air within water or glass alone",
                "use 1.33 for water, 1.5 for glass",
                1.0 / low,
            )


def _growing(material, ranges, settings):
    """More light comes back than arrived: each bounce is brighter than the one before."""
    total = np.zeros(3)
    if not isinstance(material.transmittance, NodeRef):
        total += np.maximum(material.transmittance, 0.0)
    diffuse_white = False
    for lobe in material.lobes:
        color = _color(lobe)
        if color is None or isinstance(lobe.weight, NodeRef):
            continue
        weight = np.array(lobe.weight)
        if isinstance(color, NodeRef):
            values = ranges.values(color).max(axis=1) if len(ranges.values(color)) else np.zeros(0)
            bright = values * weight.max() > _MORE_THAN_ALL
            if len(values) and bright.mean() >= _SHARE_OF_TEXELS:
                share = float(bright.mean())
                yield (
                    Severity.WRONG,
                    f"its picture of colours goes up to {values.max():.4g}: above 1 light grows with every bounce",
                    "darken the picture, or clamp it to 1",
                    share,
                )
            continue
        total += weight * np.array(color)
        diffuse_white |= lobe.kind in (LobeKind.LAMBERT, LobeKind.DIFFUSE) and min(color) >= 1.0
    highest = float(total.max())
    if math.isfinite(highest) and highest > _MORE_THAN_ALL:
        yield (
            Severity.WRONG,
            f"sends back {highest:.4g} times the light that it gets, so that light grows with every bounce",
            "keep colours, and the sum of added shaders, below 1",
            highest,
        )
    elif diffuse_white and min(total) >= 1.0 and settings.max_bounces >= _LONG:
        yield (
            Severity.HINT,
            f"keeps all light: with {settings.max_bounces} bounces paths in closed rooms end late",
            "use 0.9 or less for white paint",
            1.0,
        )


def _color(lobe):
    """The colour that surely comes back; None where nothing is sure."""
    if lobe.kind in _COLORED:
        return lobe.color
    if lobe.principled is not None:
        return lobe.principled.base_color
    return lobe.color if lobe.kind == LobeKind.CONDUCTOR and lobe.option == 0 else None
