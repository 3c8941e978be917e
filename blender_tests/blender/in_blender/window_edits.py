"""Inside a real window: the delay until a 3D view of a million faces shows an edit, for each kind of edit.

blender --factory-startup -p 0 0 960 540 -P window_edits.py -- ANSWER.json ENGINE THREADS
"""

import os
import sys
import time

import bpy
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.dirname(HERE))), HERE]

import window_watch  # noqa: E402
from window_watch import delay  # noqa: E402

from scenes import parts  # noqa: E402

ANSWER, ENGINE, THREADS = sys.argv[sys.argv.index("--") + 1 :]
SETTLING, RESTING = 6.0, 1.5  # seconds
TIMES = 4
SIDE = 71  # faces along a side of the panel: 10 082 triangles
LAMP, AWAY = 2.0, 40.0  # heights of the lamp


def grid(name, side):
    steps = np.linspace(-1.5, 1.5, side + 1)
    x, y = np.meshgrid(steps, steps)
    places = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    number = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    faces = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places.tolist(), [], faces.tolist())
    return mesh


def build():
    """A bright panel in the middle of the view, over a dark floor, between two heads of half a million faces each."""
    dark = parts.principled("Dark", base_color=(0.02, 0.02, 0.02), roughness=0.9, ior=1.5)
    grey = parts.principled("Grey", base_color=(0.5, 0.5, 0.5), roughness=0.5, ior=1.5)
    bright = parts.principled("Bright", base_color=(0.8, 0.8, 0.8), roughness=0.9, ior=1.5)
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 30.0), dark, location=(0, 0, -0.5))
    panel = parts.place(scene, "Panel", grid("Panel", SIDE), bright)
    for x in (-4.0, 4.0):
        parts.place(scene, "Head", parts.monkey_mesh("Monkey", 5), grey, location=(x, 0, 1))
    lamp = parts.add_light(scene, "Lamp", "POINT", 500.0, (0, 0, LAMP), shadow_soft_size=0.2)
    parts.set_world(scene, (0.02, 0.02, 0.02), 1.0)
    return panel, bright, lamp


def turned_world():
    """Give the world one bright half, and return the socket of the angle by which it is turned."""
    tree = scene.world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    place, mapping, gradient = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "Mapping", "TexGradient"))
    power = tree.nodes.new("ShaderNodeMath")
    power.operation, power.inputs[1].default_value = "GREATER_THAN", 0.5
    mapping.inputs["Location"].default_value = (0.5, 0.0, 0.0)
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], gradient.inputs["Vector"])
    tree.links.new(gradient.outputs["Fac"], power.inputs[0])
    tree.links.new(power.outputs["Value"], background.inputs["Color"])
    background.inputs["Strength"].default_value = 2.0
    return mapping.inputs["Rotation"]


def measure():
    panel, bright, lamp = build()
    region, _ = yield from window_watch.open_view(scene, ENGINE, 10.0, SETTLING)
    node = next(node for node in bright.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    color = node.inputs["Base Color"]
    mesh = panel.data
    plain = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", plain)

    def shaped(there):
        mesh.vertices.foreach_set("co", plain * (1.0 if there else 0.01))
        mesh.update()

    kinds = {
        "material": lambda there: setattr(color, "default_value", (0.8 if there else 0.02,) * 3 + (1.0,)),
        "object": lambda there: setattr(panel, "location", (0.0 if there else 9.0, 0.0, 0.0)),
        "mesh": shaped,
        "lamp": lambda there: setattr(lamp, "location", (0.0, 0.0, LAMP if there else AWAY)),
    }
    delays = {}
    settled = time.monotonic()
    for name, change in kinds.items():
        delays[name] = []
        for number in range(TIMES):
            delays[name].append((yield from delay(lambda change=change, there=number % 2: change(bool(there)))))
            yield RESTING
        change(True)
        yield RESTING
    lamp.data.energy = 0.0
    rotation = turned_world()
    # The bright half is above the panel, or below it.
    turns = (0.0, -1.5708, 0.0), (0.0, 1.5708, 0.0)
    rotation.default_value = turns[0]
    yield 2.0 * RESTING
    delays["world"] = []
    for number in range(TIMES):
        delays["world"].append((yield from delay(lambda turn=turns[1 - number % 2]: setattr(rotation, "default_value", turn))))
        yield RESTING
    return {**delays, "hold": window_watch.longest_hold(settled), "region": [region.width, region.height]}


scene = window_watch.start(ENGINE, THREADS)
window_watch.run(measure, ANSWER)
