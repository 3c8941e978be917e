"""The lobes that the core makes of a material, seen straight on: Principled is many, in layers."""

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
    albedo: tuple  # what it scatters of the light that comes straight on
    alpha: float  # the mean of both directions'
    ior: float


@dataclass(frozen=True)
class Probed:
    lobes: tuple
    emission: tuple
    transmittance: tuple


def probe(material):
    """Probed of a snapshot's Material; None where textures make it another at each point, and where the core cannot be asked.

    A panel asks at every drawing: the core is, once for each change.
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
