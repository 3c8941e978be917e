"""Scenes of `make differ` in one Blender: fixed seeds, and a fault that is planted in the export."""

import tempfile

from tools.differ import generator
from tools.differ.judge import judge
from tools.differ.mended import SCENES
from tools.differ.record import Record

from addon.export import lights

_SAMPLES = 32
_LIT = [
    Record("frame", "Frame", {"kind": "EXACT", "size": [16, 16], "bounces": 0}),
    Record("material", "Material 1", {}),
    Record("mesh", "Mesh 1", {"shape": "plane", "materials": ["@Material 1"]}),
    Record("object", "Thing 1", {"data": "@Mesh 1", "scale": [9.0, 9.0, 9.0]}),
    Record("lamp", "Lamp 1", {"type": "POINT", "settings": {"energy": 100.0}}),
    Record("object", "Lamp 1 object", {"data": "@Lamp 1", "location": [0.0, 0.0, 4.0]}),
    Record("node", "Material 1/1", {"tree": "Material 1", "kind": "ShaderNodeBsdfDiffuse"}),
    Record(
        "node",
        "Material 1/2",
        {"tree": "Material 1", "kind": "ShaderNodeOutputMaterial", "inputs": {"Surface": ["@Material 1/1", "BSDF"]}},
    ),
]


def fixed(*seeds):
    """{seed: [verdict, text, messages]}"""
    with tempfile.TemporaryDirectory() as folder:
        answers = {seed: judge(generator.describe(int(seed)), folder, _SAMPLES) for seed in seeds}
    return {seed: [answer["verdict"], answer["text"], answer["told"]] for seed, answer in answers.items()}


def mended():
    """{scene: [verdict, text, messages]}"""
    with tempfile.TemporaryDirectory() as folder:
        answers = {name: judge(scene, folder, _SAMPLES) for name, scene in SCENES.items()}
    return {name: [answer["verdict"], answer["text"], answer["told"]] for name, answer in answers.items()}


def planted():
    """The verdicts of a lit floor as it is, and with lamps of one and a half percent more power."""
    factor = lights._watts_to_emission
    with tempfile.TemporaryDirectory() as folder:
        before = judge(_LIT, folder, _SAMPLES)
        lights._watts_to_emission = lambda *arguments: 1.015 * factor(*arguments)
        try:
            after = judge(_LIT, folder, _SAMPLES)
        finally:
            lights._watts_to_emission = factor
    return [before["verdict"], after["verdict"], before["told"] + after["told"]]
