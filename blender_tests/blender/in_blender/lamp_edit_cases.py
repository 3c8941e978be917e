"""The exports of a 3D view of lamps whose nodes read the objects that show them, each after one edit."""

import bpy
import parts_cases
import stage

_IES = "IESNA:LM-63-1995\nTILT=NONE\n1 -1 {} 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n5 4 1\n"


def _text(candela):
    text = bpy.data.texts.get("lamp.ies") or bpy.data.texts.new("lamp.ies")
    text.clear()
    text.write(_IES.format(candela))
    return text


def _nodes(lamp, *kinds):
    """Link a chain of nodes to the lamp's emission, each by its first output."""
    lamp.use_nodes = True
    tree = lamp.node_tree
    socket = next(node for node in tree.nodes if node.type == "EMISSION").inputs["Color"]
    made = [tree.nodes.new("ShaderNode" + kind) for kind in kinds]
    for node in made:
        tree.links.new(node.outputs[0], socket)
        socket = node.inputs[0] if len(node.inputs) else None
    return made


def _depsgraph():
    bpy.context.view_layer.update()
    return bpy.context.evaluated_depsgraph_get()


def growth():
    """Return the number of images after each of several edits of the text of two lamps."""
    stage.empty()
    for x in range(2):
        (node,) = _nodes(stage.light("POINT", 100.0, (x, -3, 5)).data, "TexIES")
        node.mode, node.ies = "INTERNAL", _text(1)
    stage.camera()
    window, counts = parts_cases.Window(), []
    for number in range(6):
        _text(number + 1)
        window.export(None, _depsgraph())
        counts.append(window.images)
    return [counts, [export[1] for export in window.exports]]


def _build():
    scene = stage.empty()
    _build_twins()
    # A collection with a lamp, shown by two empties.
    collection = bpy.data.collections.new("Lamps")
    inner = bpy.data.objects.new("Inner", bpy.data.lights.new("Inner", "POINT"))
    collection.objects.link(inner)
    (attribute,) = _nodes(inner.data, "Attribute")
    attribute.attribute_type, attribute.attribute_name = "INSTANCER", "heat"
    for number in range(2):
        empty = bpy.data.objects.new(f"Shown {number}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location.x, empty["heat"] = number, 0.25
        scene.collection.objects.link(empty)
    stage.camera()


def _build_twins():
    """Build two objects that share a lamp which reads their colour and has a number that is not finite, and one with a text."""
    first = stage.light("POINT", 100.0, (0, -3, 5))
    first.name = "First"
    stage.link("Second", first.data, (1, -3, 5))
    bright, info = _nodes(first.data, "BrightContrast", "ObjectInfo")
    first.data.node_tree.links.new(info.outputs["Color"], bright.inputs["Color"])
    bright.inputs["Bright"].default_value = float("nan")
    texted = stage.light("POINT", 100.0, (2, -3, 5))
    (node,) = _nodes(texted.data, "TexIES")
    node.mode, node.ies = "INTERNAL", _text(1)


def _color(name, value):
    def edit():
        bpy.data.objects[name].color = (value, 0.5, 0.5, 1.0)

    return edit


def _heat(value):
    def edit():
        bpy.data.objects["Shown 1"]["heat"] = value
        bpy.data.objects["Shown 1"].update_tag()

    return edit


def _write():
    _text(2)
    # Blender sends no update for a text: it shows with the next one.
    bpy.data.objects["Shown 0"].location.y = 2.0


def _move():
    bpy.data.objects["Shown 0"].location.x = 3.0


def _hide():
    bpy.data.objects["First"].hide_viewport = True


def edits():
    """As parts_cases.edits."""
    _build()
    return parts_cases.results(
        {
            "nothing": lambda: setattr(bpy.context.scene.cursor, "location", (1, 2, 3)),
            "colour": _color("Second", 0.25),
            "no number": _heat(float("inf")),
            "another edit": _color("First", 0.75),
            "instancer's property": _heat(0.75),
            "moved instancer": _move,
            "text": _write,
            "hidden": _hide,
        }
    )
