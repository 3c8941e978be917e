"""Substitutes for inputs and features that Lancer lacks, and the messages about them."""

import bpy
import stage
from export_cases import export_told
from material_cases import Tree, answer


def unknown_sources():
    """Link a node that Lancer does not support to inputs of every type."""
    tree = Tree("fed")
    unknown = stage.unknown(tree.tree)
    node = tree.node("BsdfGlossy", distribution="GGX", Color=(0.9, 0.1, 0.1), Roughness=0.37)
    factor = next(socket for socket in unknown.outputs if socket.type == "VALUE")
    color = next(socket for socket in unknown.outputs if socket.type == "RGBA")
    tree.tree.links.new(factor, node.inputs["Roughness"])
    tree.tree.links.new(color, node.inputs["Color"])
    tree.show(node.outputs[0])
    got = answer(tree.material)["fed"]
    return {"lobes": got["lobes"], "messages": got["messages"]}


def computed_attributes():
    """Return {name: messages} of emission by an Attribute node of that name."""
    result = {}
    for name in ("N", "Ng", "pointiness", "Map.tangent", "GREEN", "uv", "position", "missing"):
        tree = Tree(name)
        color = tree.node("Attribute", attribute_name=name)
        node = tree.node("Emission")
        tree.tree.links.new(color.outputs["Color"], node.inputs["Color"])
        tree.show(node.outputs[0])
        result[name] = answer(tree.material)[name]["messages"]
    return result


def _made(collection, shown):
    """Return an object whose Geometry Nodes instance a cube with that material."""
    cube = stage.cube(1.0, shown)
    tree = bpy.data.node_groups.new("Maker", "GeometryNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    source, output = tree.nodes.new("GeometryNodeObjectInfo"), tree.nodes.new("NodeGroupOutput")
    source.inputs["Object"].default_value, source.inputs["As Instance"].default_value = cube, True
    tree.links.new(source.outputs["Geometry"], output.inputs[0])
    maker = bpy.data.objects.new("Maker", bpy.data.meshes.new("Maker"))
    maker.modifiers.new("Maker", "NODES").node_group = tree
    collection.objects.link(maker)
    return maker


def attributes_of_instances():
    """Return {instancer: messages} of a cube with an Attribute node, as Geometry Nodes and others show it."""
    result = {}
    for name in ("nodes", "group", "vertices", "two below vertices"):
        scene = stage.empty()
        tree = Tree("Read")
        color, node = tree.node("Attribute", attribute_type="INSTANCER", attribute_name="heat"), tree.node("Emission")
        tree.tree.links.new(color.outputs["Color"], node.inputs["Color"])
        shown = tree.show(node.outputs[0])
        instancer = bpy.data.objects.new(name, None)
        scene.collection.objects.link(instancer)
        if name == "nodes":
            _made(scene.collection, shown)
        elif name == "group":
            instancer.instance_type, instancer.instance_collection = "COLLECTION", bpy.data.collections.new("Group")
            _made(instancer.instance_collection, shown)
        else:
            point = bpy.data.meshes.new("Point")
            point.from_pydata([(0, 0, 0)], [], [])
            seat = bpy.data.objects.new("Seat", point)
            scene.collection.objects.link(seat)
            seat.instance_type = "VERTS"
            if name == "vertices":
                stage.cube(1.0, shown).parent = seat
            else:
                for _ in range(2):
                    _made(scene.collection, shown).parent = seat
        told = export_told()[1].lines()
        result[name] = [text for text in told if "Attribute nodes" in text]
    return result


def lamps_of_equal_ids():
    """Return the strength and the messages of a lamp that Geometry Nodes instance beside cubes, all with one id."""
    scene = stage.empty()
    lamp = stage.light()
    lamp.data.use_nodes = True
    read = lamp.data.node_tree.nodes.new("ShaderNodeAttribute")
    read.attribute_type, read.attribute_name = "INSTANCER", "heat"
    tree = lamp.data.node_tree
    tree.links.new(read.outputs["Color"], next(node for node in tree.nodes if node.type == "EMISSION").inputs["Color"])
    maker = _made(scene.collection, None)
    maker["heat"] = 0.25
    tree = maker.modifiers[0].node_group
    output = next(node for node in tree.nodes if node.type == "GROUP_OUTPUT")
    cube = next(node for node in tree.nodes if node.type == "OBJECT_INFO")
    join = tree.nodes.new("GeometryNodeJoinGeometry")
    light = tree.nodes.new("GeometryNodeObjectInfo")
    light.inputs["Object"].default_value, light.inputs["As Instance"].default_value = lamp, True
    # Links to one socket join from the last to the first.
    for source in (light, cube, cube):
        named = tree.nodes.new("GeometryNodeStoreNamedAttribute")
        named.domain, named.inputs["Name"].default_value = "INSTANCE", "heat"
        named.inputs["Value"].default_value = 0.75 if source == light else 0.5
        tree.links.new(source.outputs["Geometry"], named.inputs["Geometry"])
        tree.links.new(named.outputs["Geometry"], join.inputs[0])
    numbered = tree.nodes.new("GeometryNodeSetID")
    tree.links.new(tree.nodes.new("FunctionNodeInputInt").outputs[0], numbered.inputs["ID"])
    tree.links.new(join.outputs[0], numbered.inputs["Geometry"])
    tree.links.new(numbered.outputs["Geometry"], output.inputs[0])
    snapshot, messages = export_told()
    return [light.emission[0] for light in snapshot.lights], [text for text in messages.lines() if "Attribute nodes" in text]


def samplers():
    """Return {name: messages} of surfaces on either side of the limits beyond which Cycles samples the sky with bias."""
    old = bpy.app.version < (4, 0)
    stretched = "BsdfAnisotropic" if old else "BsdfGlossy"
    coat = "Clearcoat" if old else "Coat_Weight"
    cases = {
        "smooth lacquer": ("BsdfGlossy", {"distribution": "ASHIKHMIN_SHIRLEY", "Roughness": 0.25}),
        "rough lacquer": ("BsdfGlossy", {"distribution": "ASHIKHMIN_SHIRLEY", "Roughness": 0.3}),
        "varying lacquer": ("BsdfGlossy", {"distribution": "ASHIKHMIN_SHIRLEY", "Roughness": None}),
        "matt": ("BsdfGlossy", {"distribution": "BECKMANN", "Roughness": 0.9}),
        "even": (stretched, {"distribution": "BECKMANN", "Roughness": 0.9, "Anisotropy": 0.0}),
        "mirror": (stretched, {"distribution": "BECKMANN", "Roughness": 0.0, "Anisotropy": 0.5}),
        "brushed ggx": (stretched, {"distribution": "GGX", "Roughness": 0.4, "Anisotropy": 0.5}),
        "brushed": (stretched, {"distribution": "BECKMANN", "Roughness": 0.4, "Anisotropy": -0.5}),
        "varying brushed": (stretched, {"distribution": "BECKMANN", "Roughness": 0.4, "Anisotropy": None}),
        "bare": ("BsdfPrincipled", {"distribution": "GGX", coat: 0.0}),
        "coated": ("BsdfPrincipled", {"distribution": "GGX", coat: 0.1}),
        "varying coat": ("BsdfPrincipled", {"distribution": "GGX", coat: None}),
    }
    result = {}
    for name, (kind, inputs) in cases.items():
        tree = Tree(name)
        inputs = {key: tree.varying() if value is None else value for key, value in inputs.items()}
        result[name] = answer(tree.show(tree.node(kind, **inputs).outputs[0]))[name]["messages"]
    return result


def clear_beside():
    """Return {name: messages} of closures mixed with a Transparent BSDF, and the lobe of a rough Diffuse in a mix."""
    cases = {
        "leaf": ("BsdfTranslucent", {}),
        "frosted": ("BsdfGlass", {"Roughness": 0.3}),
        "clear": ("BsdfGlass", {"Roughness": 0.0}),
        "wall": ("BsdfDiffuse", {}),
        "clay": ("BsdfDiffuse", {"Roughness": 0.5, "Color": (0.5, 0.25, 0.125)}),
    }
    result = {}
    for name, (kind, inputs) in cases.items():
        tree = Tree(name)
        pane = tree.node("BsdfTransparent").outputs[0]
        result[name] = answer(tree.show(tree.shaders("MixShader", pane, tree.node(kind, **inputs).outputs[0])))[name]
    return result


def facets():
    """Return {node: messages} of each node with multiple scattering between microfacets, and of one without."""
    kinds = {
        "BsdfPrincipled": "MULTI_GGX",
        "BsdfGlass": "MULTI_GGX",
        "BsdfAnisotropic": "MULTI_GGX",
        "BsdfRefraction": "GGX",
    }
    result = {}
    for kind, distribution in kinds.items():
        tree = Tree(kind)
        tree.show(tree.node(kind, distribution=distribution).outputs[0])
        result[kind] = answer(tree.material)[kind]["messages"]
    return result


def scripts():
    """Return {whether Cycles runs scripts: [emission, messages]} of a colour that a script gives."""
    scene = stage.empty()
    tree = Tree("scripted")
    node = tree.node("Script", script=bpy.data.texts.new("script.osl"))
    color = node.outputs.new("NodeSocketColor", "Color")
    shown = tree.node("Emission", Color=(0.9, 0.3, 0.1))
    tree.tree.links.new(color, shown.inputs["Color"])
    stage.cube(1.0, tree.show(shown.outputs[0]))
    stage.camera()
    result = {}
    for runs in (False, True):
        scene.cycles.shading_system = runs
        given, messages = export_told()
        result[str(runs)] = [next(item for item in given.materials if item.name == "scripted").emission, list(messages)]
    return result
