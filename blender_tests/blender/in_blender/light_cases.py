"""Lamps with all their switches, as they are exported."""

import bpy
import stage
from mathutils import Euler, Matrix

from addon.bindings.shading import NodeRef
from addon.export.images import Images
from addon.export.lights import export_lamp_nodes, export_light
from addon.messages.messages import Messages


def _export(thing, messages):
    bpy.context.view_layer.update()
    return export_light(thing, thing.matrix_world, messages)


def _told(light):
    return {"hidden_from": int(light.hidden_from), "no_shadow": bool(light.no_shadow), "size": list(light.size)}


def _nodes(thing, color=(1.0, 1.0, 1.0), strength=1.0):
    """Link an Emission node to the light's output."""
    light = thing.data
    if bpy.app.version < (5, 2):
        light.use_nodes = True
    tree = light.node_tree
    tree.nodes.clear()
    emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputLight")
    emission.inputs["Color"].default_value = (*color, 1.0)
    emission.inputs["Strength"].default_value = strength
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return tree, emission


def export():
    stage.empty()
    messages = Messages()
    result = {"version": list(bpy.app.version)}
    result["plain"] = _told(_export(stage.light("SPOT"), messages))
    seen = stage.light("POINT")
    seen.visible_camera, seen.visible_glossy, seen.visible_volume_scatter = True, False, False
    result["seen"] = _told(_export(seen, messages))
    unshadowed = stage.light("SUN")
    owner = unshadowed.data.cycles if hasattr(unshadowed.data.cycles, "cast_shadow") else unshadowed.data
    setattr(owner, "cast_shadow" if owner is not unshadowed.data else "use_shadow", False)
    result["unshadowed"] = _told(_export(unshadowed, messages))
    stretched = stage.light("SPOT", rotation=(0.3, 0.2, 0.1))
    stretched.scale = (6.0, 1.0, 2.0)
    result["stretched"] = _told(_export(stretched, messages))
    portal = stage.light("AREA")
    portal.data.cycles.is_portal = True
    opening = _export(portal, messages)
    result["portal"] = {"opening": opening.opening, "emission": list(map(float, opening.emission))}
    portal.data.shape, told = "DISK", Messages()
    _export(portal, told)
    result["round portal"] = told.lines()
    plain, colored = stage.light("POINT"), stage.light("POINT")
    _nodes(colored, (0.5, 0.25, 1.0), 3.0)
    levels = [_export(thing, messages).emission for thing in (colored, plain)]
    result["nodes"] = [a / b for a, b in zip(*levels, strict=True)]
    result["messages"] = messages.lines()
    return result


def transforms():
    """{kind and transform: [matrix or None, share of the plain lamp's emission, messages]}."""
    stage.empty()
    turn = Euler((0.3, 0.4, 0.5)).to_matrix().to_4x4()
    flat = {f"flat {axis}": turn @ Matrix.Diagonal([float(i != k) for k in range(3)] + [1.0]) for i, axis in enumerate("xyz")}
    sheared = Matrix.Identity(4)
    sheared[0][1], sheared[0][2] = 0.75, 0.5
    depsgraph = bpy.context.evaluated_depsgraph_get()
    result = {}
    lamps = {"POINT": {}, "SPOT": {}, "SUN": {}, "AREA": {}, "BALL": {"shadow_soft_size": 0.3}, "DISK": {"angle": 0.3}}
    for kind, fields in lamps.items():
        thing = stage.light({"BALL": "SPOT", "DISK": "SUN"}.get(kind, kind), location=(0, 0, 0), **fields)
        if kind == "SPOT":
            thing.data.shadow_soft_size = 0.0
        if kind == "SUN":
            thing.data.angle = 0.0
        plain = export_light(thing, Matrix.Identity(4), Messages(), depsgraph)
        for name, matrix in {**flat, "sheared": sheared, "mirrored": Matrix.Diagonal((-1.0, 1.0, 1.0, 1.0))}.items():
            messages = Messages()
            light = export_light(thing, matrix, messages, depsgraph)
            shown = None if light is None else light.matrix[:, :3].tolist()
            share = 0.0 if light is None else light.emission[0] / plain.emission[0]
            result[f"{kind} {name}"] = [shown, share, messages.lines()]
    return {"version": list(bpy.app.version), "lamps": result}


def unknown():
    """Return [share of the plain lamp's power, messages] of a light whose nodes have an unsupported node."""
    stage.empty()
    plain, shown = stage.light("POINT"), stage.light("POINT")
    tree, emission = _nodes(shown)
    tree.links.new(stage.unknown(tree).outputs["Color"], emission.inputs["Color"])
    messages = Messages()
    share = _export(shown, messages).emission[0] / _export(plain, Messages()).emission[0]
    return [share, messages.lines()]


def textured():
    """Return [strength's node, kinds of the nodes, messages] of a light with an image, and of one with a constant graph."""
    stage.empty()
    result = {}
    for kind in ("TexImage", "RGB"):
        shown = stage.light("POINT")
        tree, emission = _nodes(shown)
        node = tree.nodes.new("ShaderNode" + kind)
        if kind == "TexImage":
            node.image = bpy.data.images.new("picture", 4, 4)
        tree.links.new(node.outputs["Color"], emission.inputs["Color"])
        messages = Messages()
        bpy.context.view_layer.update()
        shine = export_lamp_nodes(shown, messages, Images())
        light = export_light(shown, shown.matrix_world, messages, shine=shine)
        node = light.strength.node if isinstance(light.strength, NodeRef) else -1
        result[kind] = [node, [int(node.kind) for node in light.nodes], messages.lines()]
    return result
