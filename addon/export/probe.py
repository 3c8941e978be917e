"""The lobes that the core makes of a material, evaluated at normal incidence: a Principled lobe becomes several."""

from dataclasses import dataclass

from ..bindings.abi import LancerError
from ..bindings.enums import LobeKind
from ..bindings.session import Scene
from ..bindings.snapshot import SceneSnapshot

_KEPT = 16
_TRANSMISSION = 2
_answers = {}


@dataclass(frozen=True)
class ProbedLobe:
    kind: LobeKind
    albedo: tuple  # at normal incidence
    alpha: float  # the mean over both directions
    ior: float


@dataclass(frozen=True)
class Probed:
    lobes: tuple
    emission: tuple
    transmittance: tuple


def probe(material):
    """Return the Probed of a snapshot's Material; None if it has nodes, which vary over the surface, or the core fails.

    Panels call this at every redraw: results are cached until the material changes.
    """
    if material.nodes:
        return None
    kept = _answers.get(material.name)
    if kept is None or kept[0] != material:
        if len(_answers) >= _KEPT:
            _answers.clear()
        kept = _answers[material.name] = material, _ask(material)
    return kept[1]


def _ask(material):
    try:
        with Scene() as scene:
            scene.fill(SceneSnapshot(materials=(material,)))
            scene.commit(threads=1)
            lobes, emission, transmittance = scene.lobes(0)
    except LancerError:
        return None
    return Probed(tuple(_lobe(lobe) for lobe in lobes), _tuple(emission), _tuple(transmittance))


def _lobe(lobe):
    through = lobe.component == _TRANSMISSION and lobe.kind in (LobeKind.LAMBERT, LobeKind.DIFFUSE)
    kind = LobeKind.TRANSLUCENT if through else LobeKind(lobe.kind)
    return ProbedLobe(kind, _tuple(lobe.albedo), float(lobe.roughness.mean()), float(lobe.ior))


def _tuple(values):
    return tuple(float(value) for value in values)
