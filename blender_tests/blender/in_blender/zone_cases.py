"""Trees that Blender resolves before Cycles reads them: names in messages, animated values, groups of the course, users."""

import bpy
import stage
from export_cases import export_told
from material_cases import Tree, answer, read

from addon.export.resolved import ShaderTree
from addon.operators import course_groups


class ZoneTree(Tree):
    def repeat(self, kind, name, iterations, body):
        """Add a zone of one item; body(the item inside) returns the item of the next iteration. Return both nodes."""
        first, last = (self.tree.nodes.new(f"GeometryNodeRepeat{end}") for end in ("Input", "Output"))
        first.pair_with_output(last)
        last.repeat_items.clear()
        last.repeat_items.new(kind, name)
        first.inputs["Iterations"].default_value = iterations
        self.tree.links.new(body(first.outputs[name]), last.inputs[name])
        return first, last

    def layered(self, iterations, name):
        """Look up an image, which is missing, at the colour of each iteration."""

        def body(color):
            return self.node("TexImage", name=name, Vector=color).outputs["Color"]

        first, last = self.repeat("RGBA", "Paint", iterations, body)
        self.show(self.node("Emission", Color=last.outputs["Paint"]).outputs[0])
        return first


def names():
    """Return what is told about a node whose own name begins like those that Blender gives."""
    stage.empty()
    tree = ZoneTree("painted")
    tree.layered(3, "2_Wood")
    told = answer(tree.material)["painted"]
    return {"messages": told["messages"], "panel": told["panel"]}


def driven():
    """Return the emission at two frames, whose iterations follow the frame; and the users of data before and after."""
    scene = stage.empty()
    tree = ZoneTree("driven")
    first, last = tree.repeat("FLOAT", "Power", 1, lambda power: tree.node("Math", Value=power).outputs[0])
    tree.show(tree.node("Emission", Color=(1, 1, 1), Strength=last.outputs["Power"]).outputs[0])
    curve = tree.tree.driver_add(first.inputs["Iterations"].path_from_id("default_value"))
    curve.driver.expression = "frame"
    picture = tree.node("TexImage", image=bpy.data.images.new("picture", 2, 2)).image
    stage.cube(1.0, tree.material)
    stage.camera()
    result = {"users": [picture.users, len(bpy.data.node_groups)], "emission": {}}
    for frame in (2, 5):
        scene.frame_set(frame)
        given, messages = export_told()
        result["emission"][frame] = next(item for item in given.materials if item.name == "driven").emission
    return result | {"users after": [picture.users, len(bpy.data.node_groups)], "messages": list(messages)}


def course_models():
    """Return {name: kinds of lobes and messages} of a group of the course, alone and beside a zone."""
    stage.empty()
    result = {}
    for name in ("alone", "beside"):
        tree = ZoneTree(name)
        model = tree.node("Group", node_tree=course_groups.group_of("PHONG"))
        tree.show(model.outputs[0])
        if name == "beside":
            _, last = tree.repeat("FLOAT", "V", 1, lambda value: value)
            tree.tree.links.new(last.outputs["V"], model.inputs["Shininess"])
        record, messages, _ = read(tree.material)
        result[name] = {"lobes": [lobe.kind.name for lobe in record.lobes], "messages": messages}
    return result | {"group": course_groups.group_of("PHONG").name}


def plain():
    """Return whether trees are read as they are: without zones, and with zones in a group."""
    stage.empty()
    tree = ZoneTree("plain")
    tree.show(tree.node("Emission").outputs[0])
    inside = bpy.data.node_groups.new("inside", "ShaderNodeTree")
    tree.node("Group", node_tree=inside)
    before = ShaderTree(tree.material)
    answers = [before.tree == tree.material.node_tree]
    inside.nodes.new("GeometryNodeMenuSwitch")
    after = ShaderTree(tree.material)
    return {"before": answers[0], "after": after.tree == tree.material.node_tree}
