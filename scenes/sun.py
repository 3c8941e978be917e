"""Columns and balls under the sky of the running Blender, with its sun."""

import math

import bpy

from . import parts


def build(scene):
    parts.set_size(scene, 512, 384, 64)
    _sky(scene)
    stone = parts.principled("Stone", base_color=(0.7, 0.66, 0.58), roughness=0.8)
    brass = parts.principled("Brass", base_color=(0.9, 0.7, 0.35), metallic=1.0, roughness=0.3)
    parts.place(scene, "Court", parts.plane_mesh("Court", 30.0), stone)
    column = parts.lathe_mesh("Column", [(0.0, 0.0), (0.5, 0.0), (0.4, 0.25), (0.3, 0.3), (0.26, 2.4), (0.42, 2.6), (0.0, 2.6)])
    for side in (-1, 1):
        for row in range(4):
            parts.place(scene, f"Column {side} {row}", column, stone, (1.6 * side, 1.7 * row - 1.0, 0))
    for row in range(3):
        parts.place(scene, f"Ball {row}", parts.sphere_mesh(f"Ball {row}", 64, 32, 0.4), brass, (0, 1.7 * row, 0.4))
    parts.add_camera(scene, (0.6, -6.5, 2.0), (0, 1.0, 1.1), lens=35.0)


def _sky(scene):
    parts.set_world(scene, (0, 0, 0), 0.1)
    tree = scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type = "NISHITA" if bpy.app.version < (5, 0) else "MULTIPLE_SCATTERING"
    sky.sun_elevation, sky.sun_rotation = math.radians(35.0), math.radians(130.0)
    tree.links.new(sky.outputs[0], next(node for node in tree.nodes if node.type == "BACKGROUND").inputs["Color"])
