"""Materials outside the physical model: invalid roughness, IOR and weights, glass without refraction, gain of energy."""

import math

import numpy as np

from ..bindings.enums import Integrator, LobeKind
from ..bindings.shading import NodeRef
from ..bindings.structs import PARAMETERS, Principled
from .finding import Finding, Severity
from .ranges import Ranges
from .traits import clear_lobes

_SHARES = [name for name, (kind, _) in PARAMETERS[Principled].items() if kind == "share"]
# Lobes whose albedo is their colour. The albedo of other lobes depends on Fresnel, or their colour is a refractive index.
_COLORED = {
    LobeKind.LAMBERT, LobeKind.DIFFUSE, LobeKind.MIRROR, LobeKind.GLOSSY, LobeKind.PHONG, LobeKind.BLINN_PHONG,
    LobeKind.DIELECTRIC, LobeKind.GLASS, LobeKind.REFRACTION, LobeKind.TRANSLUCENT, LobeKind.MINNAERT,
    LobeKind.TOON,
}  # fmt: skip
_WITHOUT_ROUGHNESS = {LobeKind.LAMBERT, LobeKind.PHONG, LobeKind.BLINN_PHONG, LobeKind.MIRROR, LobeKind.MINNAERT, LobeKind.TOON}
# Weights of Mix Shaders sum to 1 up to rounding of single precision; colours are entered with three digits.
_MORE_THAN_ALL = 1.001
# Fewer texels of an image than this share are not reported.
_SHARE_OF_TEXELS = 0.01
# IORs this close to 1 count as air: they refract by less than 0.06 degrees at 45 degrees.
_NEARLY_ONE = 1e-3
# Russian roulette ends paths that lose light; a path without loss continues to the limit of bounces.
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
    """Return {material: first instance with it} for all materials in use."""
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
    """Return (name, parameter) pairs of all shares, and of all IORs."""
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
    """Yield flaws of numbers outside their range, as constants or in images."""
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
                f"{name.replace('_', ' ')} {of} {beyond:.4g}, outside the valid range of 0 to 1",
                "bring it into that range",
                share,
            )
    for name, value in indices:
        low, _, share = _extremes(ranges, value, least=0.0)
        if share and not low > 0.0 and name not in told:
            told.add(name)
            of = "goes down to" if isinstance(value, NodeRef) else "is"
            yield Severity.WRONG, f"{name} {of} {low:.4g}, which no material has", "use 1.33 for water, 1.5 for glass", share


def _extremes(ranges, value, least=None):
    """Return (lowest, highest, share of values outside 0 to 1, or not above least if given); the share of a constant is 1."""
    if not isinstance(value, NodeRef):
        value = float(value[0] if isinstance(value, tuple) else value)
        return value, value, 1.0
    values = ranges.values(value)[:, 0]
    if len(values) == 0:
        return 0.0, 1.0, 0.0
    # Rounding in the decoding of an image stays below 0.001.
    out = (values < -1e-3) | (values > 1.0 + 1e-3) if least is None else values <= least
    share = float(out.mean())
    return float(values.min()), float(values.max()), share if share >= _SHARE_OF_TEXELS else 0.0


def _clear(material, ranges):
    """Yield flaws of glass that is invisible, or whose IOR is below 1."""
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
                    f"glass with IOR {low:.7g} neither refracts nor reflects light: it is invisible",
                    "use 1.33 for water, 1.5 for glass",
                    1.0,
                )
        elif low < 1.0 - _NEARLY_ONE and "thin" not in told:
            told.add("thin")
            yield (
                Severity.HINT,
                f"IOR {low:.4g} is below 1, which is right only for air inside water or glass",
                "use 1.33 for water, 1.5 for glass",
                1.0 / low,
            )


def _growing(material, ranges, settings):
    """Yield flaws of materials that reflect more light than they receive, so that each bounce is brighter."""
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
                    f"its colour image goes up to {values.max():.4g}: above 1 light grows with every bounce",
                    "darken the image, or clamp it to 1",
                    share,
                )
            continue
        total += weight * np.array(color)
        diffuse_white |= lobe.kind in (LobeKind.LAMBERT, LobeKind.DIFFUSE) and min(color) >= 1.0
    highest = float(total.max())
    if math.isfinite(highest) and highest > _MORE_THAN_ALL:
        yield (
            Severity.WRONG,
            f"reflects {highest:.4g} times the light that it receives, so that light grows with every bounce",
            "keep colours, and the sum of added shaders, below 1",
            highest,
        )
    elif diffuse_white and min(total) >= 1.0 and settings.max_bounces >= _LONG:
        yield (
            Severity.HINT,
            f"reflects all light: with {settings.max_bounces} bounces paths in closed rooms end late",
            "use 0.9 or less for white paint",
            1.0,
        )


def _color(lobe):
    """Return the lobe's albedo as a colour; None if it is unknown."""
    if lobe.kind in _COLORED:
        return lobe.color
    if lobe.principled is not None:
        return lobe.principled.base_color
    return lobe.color if lobe.kind == LobeKind.CONDUCTOR and lobe.option == 0 else None
