"""Materials that are exported but not rendered: their lobes and nodes as plain data, which the test compares."""

import dataclasses
import gc

import bpy
import numpy as np
import stage
from export_cases import export_told

from addon.bindings.enums import Domain, LobeKind, NodeKind
from addon.bindings.shading import NodeRef
from addon.export.describe import describe_material
from addon.export.graph import NodeGraph
from addon.export.materials import Materials
from addon.messages.messages import Messages


def told(value):
    """Return plain data: records as lists, NodeRefs as {"node": n}, enumerations as numbers."""
    if isinstance(value, NodeRef):
        return {"node": value.node}
    if dataclasses.is_dataclass(value):
        return {field.name: told(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, (tuple, list)):
        return [told(item) for item in value]
    return value


def read(material, name="object"):
    """Return (the record, its messages, the attributes that it reads)."""
    messages = Messages()
    materials = Materials(messages)
    number = materials.number(material, name)
    return materials.list[number], messages.lines(), sorted(materials.attributes([number]))


def panel_lines(material):
    found = describe_material(material)
    return [*found.lobes, *found.losses]


def answer(*materials):
    result = {"version": list(bpy.app.version)}
    for material in materials:
        record, messages, attributes = read(material)
        result[material.name] = {
            **told(record),
            "kinds": [LobeKind(lobe.kind).name for lobe in record.lobes],
            "node kinds": [NodeKind(node.kind).name for node in record.nodes],
            "messages": messages,
            "attributes": attributes,
            "panel": panel_lines(material),
        }
    return result


class Tree:
    """A material under construction."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.output = self.tree.nodes.new("ShaderNodeOutputMaterial")

    def node(self, kind, **inputs):
        """Add a node. inputs: constants or output sockets, by name with _ for blanks, or properties without such an input."""
        node = self.tree.nodes.new(kind if kind.startswith("NodeR") else "ShaderNode" + kind)
        for name, value in inputs.items():
            sockets = [socket for socket in node.inputs if socket.enabled and name.replace("_", " ") == socket.name]
            if not sockets:
                setattr(node, name, value)
            elif isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, sockets[0])
            else:
                sockets[0].default_value = (*value, 1.0) if isinstance(value, tuple) and sockets[0].type == "RGBA" else value
        return node

    def shaders(self, kind, first, second, **inputs):
        node = self.node(kind, **inputs)
        sockets = [socket for socket in node.inputs if socket.type == "SHADER"]
        for source, socket in zip((first, second), sockets, strict=True):
            self.tree.links.new(source, socket)
        return node.outputs[0]

    def show(self, shader):
        self.tree.links.new(shader, self.output.inputs["Surface"])
        return self.material

    def varying(self, name="shade"):
        """Return an output that varies over the surface, so that only the core can evaluate it."""
        return self.node("Attribute", attribute_name=name).outputs["Fac"]


def freed():
    """Return the number of graphs that an export leaves for the collector of reference cycles."""
    stage.empty()
    gc.disable()
    try:
        read(stage.shader())
        return sum(isinstance(thing, NodeGraph) for thing in gc.get_objects())
    finally:
        gc.enable()


def own_models():
    stage.empty()
    materials = []
    for model in ("KD_KS", "PHONG", "BLINN_PHONG", "MINNAERT"):
        material = bpy.data.materials.new(model)
        own = material.lancer
        own.model, own.kd, own.ks = model, (0.5, 0.25, 0.125), (0.75, 0.5, 0.25)
        own.roughness, own.ior, own.shininess, own.ka = 0.25, 1.75, 40.0, (0.5, 0.25, 0.0)
        own.darkness = 0.75
        materials.append(material)
    return answer(*materials)


def principled():
    stage.empty()
    new = bpy.app.version >= (4, 0)
    level, transmission, coat = ("Specular IOR Level", "Transmission Weight", "Coat Weight") if new else (
        "Specular", "Transmission", "Clearcoat"
    )  # fmt: skip
    emission, sheen, subsurface = ("Emission Color", "Sheen Weight", "Subsurface Weight") if new else (
        "Emission", "Sheen", "Subsurface"
    )  # fmt: skip
    base = {"Base_Color": (0.75, 0.5, 0.25), "Roughness": 0.5, "IOR": 1.5, level: 0.5}
    cases = {
        "plain": {"distribution": "GGX"},
        "all": {
            "Metallic": 0.25,
            transmission: 0.5,
            "Anisotropic": 0.75,
            "Anisotropic_Rotation": 0.125,
            coat: 0.5,
            sheen: 0.25,
        },
        "veil": {"Alpha": 0.25},
        "unseen": {"Alpha": 0.0},
        "lamp": {emission: (1.0, 0.5, 0.25), "Emission_Strength": 3.0},
        "lamp under coat": {emission: (1.0, 0.5, 0.25), "Emission_Strength": 3.0, coat: 1.0},
        "wax": {subsurface: 0.5},
    }
    materials = []
    for name, inputs in cases.items():
        tree = Tree(name)
        materials.append(tree.show(tree.node("BsdfPrincipled", **base, **inputs).outputs[0]))
    tree = Tree("textured")
    color = tree.node("Attribute", attribute_name="paint").outputs["Color"]
    node = tree.node("BsdfPrincipled", Base_Color=color, Alpha=tree.varying(), Normal=tree.node("NormalMap").outputs[0])
    materials.append(tree.show(node.outputs[0]))
    return answer(*materials)


def closures():
    """Export a material for each closure node of this Blender with its defaults, and some with other values."""
    stage.empty()
    materials = []
    kinds = [name[len("ShaderNode") :] for name in dir(bpy.types) if name.startswith("ShaderNode")]
    for kind in kinds:
        tree = Tree(kind)
        try:
            node = tree.node(kind)
        except RuntimeError:
            continue
        if any(socket.type == "SHADER" for socket in node.outputs):
            materials.append(tree.show(next(socket for socket in node.outputs if socket.type == "SHADER")))
    glossy = "BsdfAnisotropic"
    for distribution in ("GGX", "BECKMANN", "ASHIKHMIN_SHIRLEY", "MULTI_GGX"):
        tree = Tree(distribution)
        node = tree.node(glossy, distribution=distribution, Roughness=0.25, Anisotropy=0.5, Rotation=0.125)
        materials.append(tree.show(node.outputs[0]))
    velvet, choice = ("BsdfSheen", {"distribution": "ASHIKHMIN"}) if "BsdfSheen" in kinds else ("BsdfVelvet", {})
    tree = Tree("velvet")
    materials.append(tree.show(tree.node(velvet, **choice).outputs[0]))
    tree = Tree("rough")
    materials.append(tree.show(tree.node("BsdfDiffuse", Roughness=0.5, Color=(0.5, 0.25, 0.125)).outputs[0]))
    tree = Tree("colour as shader")
    materials.append(tree.show(tree.node("RGB").outputs[0]))
    return answer(*materials)


def mixing():
    """0.25 of a sum of red and half glass, 0.75 of blue; the same with a varying factor; black closures; long chains."""
    stage.empty()

    def mixed(name, factor=None):
        tree = Tree(name)
        red = tree.node("BsdfDiffuse", Color=(1.0, 0.0, 0.0)).outputs[0]
        blue = tree.node("BsdfDiffuse", Color=(0.0, 0.0, 1.0)).outputs[0]
        glass, hole = tree.node("BsdfGlass").outputs[0], tree.node("Holdout").outputs[0]
        pane, glow = tree.node("BsdfTransparent", Color=(0.5, 1.0, 1.0)), tree.node("Emission", Strength=4.0)
        half = tree.shaders("MixShader", glass, hole, **{fac(): 0.5})
        rest = tree.shaders("AddShader", pane.outputs[0], glow.outputs[0])
        total = tree.shaders("AddShader", red, tree.shaders("AddShader", half, rest))
        share = tree.varying() if factor is None else factor
        return tree.show(tree.shaders("MixShader", total, blue, **{fac(): share}))

    def fac():
        return "Factor" if bpy.app.version >= (5, 0) else "Fac"

    def nothing(name):
        tree = Tree(name)
        black = tree.node("BsdfDiffuse", Color=(0.0, 0.0, 0.0)).outputs[0]
        return tree.show(tree.shaders("MixShader", tree.node("BsdfGlass").outputs[0], black, **{fac(): 1.0}))

    def chain(name, count, value):
        """Mix in half of the same blue in each step; if value is None, add the closure to itself, which doubles it."""
        tree = Tree(name)
        last = tree.node("BsdfDiffuse", Color=(1.0, 0.0, 0.0)).outputs[0]
        blue = tree.node("BsdfDiffuse", Color=(0.0, 0.0, 1.0)).outputs[0]
        for _ in range(count):
            if value is None:
                last = tree.shaders("AddShader", last, last)
            else:
                last = tree.shaders("MixShader", last, blue, **{fac(): value})
        return tree.show(last)

    def sums(name, count):
        """A roughness that adds 1/1024 to a varying number, count times."""
        tree = Tree(name)
        last = tree.varying()
        for _ in range(count):
            node = tree.node("Math", operation="ADD")
            tree.tree.links.new(last, node.inputs[0])
            node.inputs[1].default_value = 1.0 / 1024.0
            last = node.outputs[0]
        return tree.show(tree.node("BsdfDiffuse", Roughness=last).outputs[0])

    return answer(
        sums("sums", 1000),
        mixed("mixed", 0.75),
        mixed("textured"),
        nothing("nothing"),
        chain("long", 400, 0.5),
        chain("doubled", 10, None),
    )


def displacements():
    """Export each method with a varying height, and Blender's default method."""
    stage.empty()
    materials = []
    for method in ("BUMP", "DISPLACEMENT", "BOTH"):
        tree = Tree(method)
        owner = tree.material if hasattr(tree.material, "displacement_method") else tree.material.cycles
        owner.displacement_method = method
        node = tree.node("Displacement", Height=tree.varying(), Midlevel=0.25, Scale=2.0, space="WORLD")
        tree.tree.links.new(node.outputs[0], tree.output.inputs["Displacement"])
        materials.append(tree.show(tree.node("BsdfDiffuse").outputs[0]))
    tree = Tree("chained")
    first = tree.node("Bump", Height=tree.varying("one"))
    second = tree.node("Bump", Height=tree.varying("two"), Normal=first.outputs[0], invert=True)
    materials.append(tree.show(tree.node("BsdfDiffuse", Normal=second.outputs[0]).outputs[0]))
    return answer(*materials)


def attributes():
    """A deformed frustum whose material reads every attribute of a mesh, and a mesh whose material reads none."""
    scene = stage.empty()
    tree = Tree("reader")
    uv = tree.node("UVMap", uv_map="Second").outputs[0]
    paint = tree.node("VertexColor", layer_name="Paint").outputs[0]
    number = tree.node("Attribute", attribute_name="number").outputs["Fac"]
    place = tree.node("TexCoord").outputs["Generated"]
    mapped = tree.node("NormalMap", uv_map="Second").outputs[0]
    total = tree.node("VectorMath").inputs
    for socket, source in zip(total[:2], (uv, place), strict=True):
        tree.tree.links.new(source, socket)
    node = tree.node("BsdfPrincipled", Base_Color=paint, Roughness=number, Normal=mapped, Metallic=total[0].node.outputs[0])
    vertices = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 2)]
    faces = [(0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    item = stage.mesh("Reader", vertices, faces, tree.show(node.outputs[0]))
    mesh = item.data
    mesh.uv_layers.new(name="First")
    mesh.uv_layers.new(name="Second")
    mesh.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    mesh.attributes.new("number", "FLOAT", "FACE")
    second = mesh.uv_layers["Second"]
    for loop in mesh.loops:
        x, y, _ = mesh.vertices[loop.vertex_index].co
        second.data[loop.index].uv = (0.5 * x + 0.5, 0.25 * y)
    for i in range(5):
        mesh.color_attributes["Paint"].data[i].color = (0.1 * i, 0.5, 0.25, 0.5)
        mesh.attributes["number"].data[i].value = float(i)
    # The modifier moves vertices; GENERATED keeps their places before it.
    modifier = item.modifiers.new("Cast", "CAST")
    modifier.cast_type, modifier.factor = "SPHERE", 1.0
    stage.mesh("Plain", vertices, faces, stage.shader("ShaderNodeBsdfDiffuse", "blind"))
    scene.render.use_simplify = False
    snapshot, messages = export_told()
    return {
        mesh.name: {
            "triangles": mesh.triangles.tolist(),
            "positions": mesh.positions.tolist(),
            "attributes": {a.name: [Domain(a.domain).name, a.values.tolist()] for a in mesh.attributes},
        }
        for mesh in snapshot.meshes
    } | {"messages": list(messages), "original": np.array(vertices, float).tolist(), "version": list(bpy.app.version)}


def panel():
    """Return a panel's lines for Principled, which the core computes, and the number of calls of the core without a change."""
    from addon.export import probe

    asked, ask = [], probe._ask
    probe._ask = lambda material: asked.append(material.name) or ask(material)
    said = {}

    def say(name, **inputs):
        material = stage.shader("ShaderNodeBsdfPrincipled", name)
        node = next(item for item in material.node_tree.nodes if item.type == "BSDF_PRINCIPLED")
        for socket, value in inputs.items():
            # Named otherwise before 4.0.
            socket = next(known for known in (socket, *_OLDER.get(socket, ())) if known in node.inputs)
            node.inputs[socket].default_value = value
        said[name] = [panel_lines(material) for _ in range(3)]
        return node

    say("matt", **{"Base Color": (0.8, 0.4, 0.2, 1.0), "Specular IOR Level": 0.0})
    say("metal", **{"Base Color": (0.5, 0.5, 0.5, 1.0), "Metallic": 1.0, "Roughness": 0.3})
    node = say("coated", **{"Specular IOR Level": 0.0, "Coat Weight": 1.0, "Coat Roughness": 0.1})
    node.inputs["Alpha"].default_value = 0.25
    said["veil"] = [panel_lines(bpy.data.materials["coated"])]
    probe._ask = ask
    return {"said": said, "asked": asked, "version": list(bpy.app.version)}


_OLDER = {"Specular IOR Level": ("Specular",), "Coat Weight": ("Clearcoat",), "Coat Roughness": ("Clearcoat Roughness",)}
