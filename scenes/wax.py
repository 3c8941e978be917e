"""A head of wax between lamps: light below a surface, with bump and gloss."""

import bpy

from . import parts

_SHARES = {"subsurface_weight": 1.0, "subsurface_scale": 0.3}


def build(scene):
    parts.set_size(scene, 512, 384, 64)
    wax = parts.principled(
        "Wax",
        base_color=(0.85, 0.55, 0.35),
        roughness=0.35,
        subsurface_radius=(1.0, 0.4, 0.2),
        **({"subsurface": 0.3, "subsurface_color": (0.85, 0.55, 0.35)} if bpy.app.version < (4, 0) else _SHARES),
    )
    tree = wax.node_tree
    noise, bump = tree.nodes.new("ShaderNodeTexNoise"), tree.nodes.new("ShaderNodeBump")
    noise.inputs["Scale"].default_value = 12.0
    bump.inputs["Strength"].default_value = 0.25
    bump.inputs["Distance"].default_value = 0.05
    surface = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    tree.links.new(noise.outputs[0], bump.inputs["Height"])
    tree.links.new(bump.outputs[0], surface.inputs["Normal"])
    parts.place(scene, "Head", parts.monkey_mesh("Head", 3), wax, (0, 0, 0.95), rotation=(-0.3, 0, 0.35))
    table = parts.principled("Table", base_color=(0.3, 0.32, 0.35), roughness=0.6)
    parts.place(scene, "Table", parts.plane_mesh("Table", 12.0), table)
    parts.add_light(scene, "Key", "AREA", 180.0, (2.5, -2.5, 3.2), (0, 0, 0.9), size=1.2)
    parts.add_light(scene, "Back", "AREA", 220.0, (-2.0, 2.6, 2.2), (0, 0, 0.9), (1.0, 0.8, 0.6), size=0.8)
    parts.set_world(scene, (0.35, 0.4, 0.5), 0.25)
    parts.add_camera(scene, (0.4, -4.6, 1.6), (0, 0, 0.85), lens=60.0)
