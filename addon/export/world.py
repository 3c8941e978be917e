"""The world as one constant radiance."""

import bpy

from .checks import check_world
from .sockets import Reader, output_node, source

_BLACK = (0.0, 0.0, 0.0)


def export_world(world, messages):
    if world is None:
        return _BLACK
    who = f"world '{world.name}'"
    check_world(world, who, messages)
    if bpy.app.version < (5, 0) and not world.use_nodes:
        return messages.color(world.color, who, "colour")
    output = output_node(world.node_tree, "OUTPUT_WORLD") if world.node_tree is not None else None
    if output is None:
        return _BLACK
    if source(output.inputs["Volume"]) is not None:
        messages.add(f"{who}: volumes are not supported")
    surface = source(output.inputs["Surface"])
    if surface is None:
        return _BLACK
    reader = Reader(who, messages)
    node = surface.node
    if node.type not in ("BACKGROUND", "EMISSION"):
        reader.tell(node, f"{node.bl_label} is not supported, the world's viewport colour is used")
        return messages.color(world.color, who, "colour")
    strength = reader.number(node, ("Strength",), 1.0)
    return tuple(c * strength for c in reader.color(node, ("Color",)))
