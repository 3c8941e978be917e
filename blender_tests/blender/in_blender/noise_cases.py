"""The relative variance of a sample of Lancer over that of Cycles, at equal samples."""

import math

import bpy
import numpy as np
import stage
from sky_cases import atmospheres, matt, node_of, world_nodes

_SEEDS = 4


def _ratio(scene):
    variances = {}
    for engine in ("CYCLES", "LANCER"):
        scene.render.engine = engine
        cycles = scene.cycles
        cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = scene.lancer.samples, False, False
        cycles.filter_width, cycles.light_sampling_threshold = 1.0, 0.0
        pictures = []
        for seed in range(_SEEDS):
            cycles.seed = scene.lancer.seed = seed
            pictures.append(stage.picture(scene)[:, :, :3].astype(float))
        mean = np.mean(pictures, axis=0)
        variances[engine] = float(np.mean(np.var(pictures, axis=0, ddof=1) / (mean + 0.01 * mean.mean()) ** 2))
    return variances["LANCER"] / variances["CYCLES"]


def _matt_things():
    surface = matt()
    stage.plane(12.0, surface)
    for x in (-1.5, 0.0, 1.5):
        stage.cube(1.0, surface, location=(x, 0.3 * x, 0.5))
    stage.camera()


def skies():
    """Return {elevation of the sun: ratio} under the newest atmosphere."""
    found = {}
    for elevation in (3.0, 15.0, 50.0):
        scene = stage.empty(96, 64, samples=16)
        tree = world_nodes(scene)
        properties = {"sky_type": atmospheres()[-1], "sun_elevation": math.radians(elevation), "sun_rotation": 2.3}
        sky = node_of(tree, properties)
        tree.links.new(sky.outputs[0], tree.nodes["Background"].inputs["Color"])
        tree.nodes["Background"].inputs["Strength"].default_value = 0.1
        _matt_things()
        found[str(elevation)] = _ratio(scene)
    return found


_PHOTOMETRY = """IESNA:LM-63-1995
TILT=NONE
1 1000 1 5 2 1 2 0 0 0
1 1 100
0 20 40 60 90
0 90
900 800 100 20 0
900 500 300 20 0
"""


def _slide(tree):
    """A projected picture with hard edges, by the directions of the lamp's normal, which all versions have."""
    coordinate, squares = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeTexChecker")
    squares.inputs["Color1"].default_value, squares.inputs["Color2"].default_value = (0.9, 0.7, 0.2, 1), (0.05, 0.1, 0.4, 1)
    squares.inputs["Scale"].default_value = 7.3
    tree.links.new(coordinate.outputs["Normal"], squares.inputs["Vector"])
    return squares.outputs["Color"]


def _luminaire(tree):
    node = tree.nodes.new("ShaderNodeTexIES")
    node.mode, node.ies = "INTERNAL", bpy.data.texts.new("Photometry")
    node.ies.write(_PHOTOMETRY)
    node.inputs["Strength"].default_value = 0.05
    return node.outputs[0]


def _set_nodes(thing, build):
    light = thing.data
    if bpy.app.version < (5, 2):
        light.use_nodes = True
    tree = light.node_tree
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    tree.links.new(build(tree), emission.inputs["Color"])


def lamps():
    """Return {name: ratio} of a slide and an IES lamp, alone and beside two plain lamps."""
    found = {}
    for name, build in (("slide", _slide), ("ies", _luminaire)):
        for is_alone in (True, False):
            scene = stage.empty(96, 64, samples=16)
            _matt_things()
            lamp = stage.light("POINT", location=(0.5, -1.0, 3.0), energy=300.0)
            lamp.data.shadow_soft_size = 0.3
            _set_nodes(lamp, build)
            if not is_alone:
                for x in (-3.0, 3.0):
                    stage.light("POINT", location=(x, -1.5, 2.5), energy=60.0)
            found[f"{name}{'' if is_alone else ' among lamps'}"] = _ratio(scene)
    return found
