"""Messages of renders: how often they are printed, to which render they belong, which omissions they name."""

import json
import os
import tempfile

import bpy
import stage


def _told():
    """Render, and return the panel's messages."""
    from addon.engine import render_engine as engine

    bpy.ops.render.render()
    return list(engine.last_messages[bpy.context.scene.name])


def _faulty(count):
    """Build lit cubes with an empty material slot each, and one that uses a missing image twice."""
    scene = stage.empty()
    stage.light()
    for i in range(count):
        stage.cube(location=(i, 0, 0)).data.materials.append(None)
    material = stage.shader(name="Painted")
    tree = material.node_tree
    matt = next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE")
    picture = tree.nodes.new("ShaderNodeTexImage")
    tree.links.new(picture.outputs["Color"], matt.inputs["Color"])
    tree.links.new(picture.outputs["Alpha"], matt.inputs["Roughness"])
    stage.cube(location=(0, 2, 0), material=material)
    stage.camera()
    return scene


def persistent():
    """Render three times with Persistent Data, the last time with one cube fewer; then two frames."""
    from addon.engine import render_engine as engine

    scene = _faulty(2)
    scene.render.use_persistent_data = True
    result = {"first": _told()}
    samples = [engine.last_statistics[scene.name]["pixel_samples"]]
    result["second"] = _told()
    bpy.data.objects.remove(bpy.data.objects["Cube.001"])
    result["fewer"] = _told()
    samples.append(engine.last_statistics[scene.name]["pixel_samples"])
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = os.path.join(tempfile.mkdtemp(), "frame")
    bpy.ops.render.render(animation=True)
    result["animation"] = list(engine.last_messages[scene.name])
    result["samples"] = samples
    return result


def layers():
    """Render two view layers, which share the messages of one picture; then the second of them alone."""
    result = {}
    for persistent_data in (False, True):
        scene = _faulty(2)
        scene.render.use_persistent_data = persistent_data
        scene.view_layers.new("Second")
        result[f"both {persistent_data}"] = _told()
        scene.view_layers[0].use = False
        result[f"second {persistent_data}"] = _told()
    return result


def failed_layer(path):
    """Render two view layers; the first fails. Write the panel's messages to path: the program ends with the render."""
    from addon.bindings.abi import LancerError
    from addon.engine import render_engine as engine

    scene = _faulty(1)
    scene.view_layers[0].name = "First"
    scene.view_layers.new("Second")
    genuine = engine.export_picture

    def export(depsgraph, *arguments):
        if depsgraph.view_layer.name == "First":
            raise LancerError("the first layer fails")
        return genuine(depsgraph, *arguments)

    def say(*_):
        with open(path, "w", encoding="utf-8") as file:
            json.dump(list(engine.last_messages[scene.name]), file)

    engine.export_picture = export
    bpy.app.handlers.render_post.append(say)
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        return str(error)
    finally:
        bpy.app.handlers.render_post.remove(say)
        engine.export_picture = genuine


def left_out():
    """Return the messages of a scene with one of each thing that is not rendered."""
    from export_cases import export_told

    scene = stage.empty()
    stage.link("Smoke", bpy.data.volumes.new("Smoke"))
    for name, kinds in (("Fog", ("VolumeScatter",)), ("Milk", ("BsdfDiffuse", "VolumeScatter"))):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        _show(material.node_tree, kinds, "OutputMaterial")
        stage.cube(material=material)
    lamp = stage.light().data
    if hasattr(lamp, "use_custom_distance"):
        lamp.use_custom_distance = True
    world = stage.sky()
    _show(world.node_tree, ("Background", "VolumeScatter"), "OutputWorld")
    scene.world = world
    return {"version": list(bpy.app.version), "told": export_told()[1].lines()}


def _show(tree, kinds, output):
    """Link shader nodes of these kinds to a new output node."""
    tree.nodes.clear()
    end = tree.nodes.new("ShaderNode" + output)
    for kind in kinds:
        node = tree.nodes.new("ShaderNode" + kind)
        tree.links.new(node.outputs[0], end.inputs["Volume" if kind.startswith("Volume") else "Surface"])


def custom_group():
    """A custom node of an add-on with a node tree, which Cycles reads like a group."""
    from export_cases import export_told

    class Wrapper(bpy.types.ShaderNodeCustomGroup):
        bl_name = bl_idname = "LancerTestWrapper"
        bl_label = "Wrapper"

    stage.empty()
    group = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
    if hasattr(group, "interface"):
        group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    else:
        group.outputs.new("NodeSocketShader", "Shader")
    glow, end = group.nodes.new("ShaderNodeEmission"), group.nodes.new("NodeGroupOutput")
    glow.inputs["Color"].default_value = (0.25, 0.5, 0.75, 1.0)
    group.links.new(glow.outputs[0], end.inputs[0])
    material = stage.shader(name="Wrapped")
    tree = material.node_tree
    bpy.utils.register_class(Wrapper)
    node = tree.nodes.new("LancerTestWrapper")
    node.node_tree = group
    output = next(item for item in tree.nodes if item.type == "OUTPUT_MATERIAL")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    stage.cube(material=material)
    snapshot, messages = export_told()
    return {"emission": list(snapshot.materials[0].emission), "messages": messages.lines()}


def foreign_node():
    """A node without a tree that an add-on has made. Nodes of another Blender have its type, too."""
    from export_cases import export_told

    class Foreign(bpy.types.ShaderNode):
        bl_name = bl_idname = "LancerTestForeign"
        bl_label = "Foreign"

        def init(self, context):
            self.outputs.new("NodeSocketColor", "Color")

    stage.empty()
    material = stage.shader("ShaderNodeEmission", name="Shown", Color=(0.25, 0.5, 0.75))
    tree = material.node_tree
    bpy.utils.register_class(Foreign)
    emission = next(item for item in tree.nodes if item.type == "EMISSION")
    node = tree.nodes.new("LancerTestForeign")
    tree.links.new(node.outputs[0], emission.inputs["Color"])
    stage.cube(material=material)
    snapshot, messages = export_told()
    # Blender 3 may crash where its copies of a tree have a node of a class that is gone.
    tree.nodes.remove(node)
    bpy.context.view_layer.update()
    bpy.utils.unregister_class(Foreign)
    return {"emission": list(snapshot.materials[0].emission), "messages": messages.lines()}


def by_sampling():
    """Return the messages of a scene whose sky reads Light Path for the camera; then for glossy rays, without clear layers."""
    from export_cases import export_told

    scene = stage.empty()
    stage.light(shadow_soft_size=0.5)
    sky = stage.sky()
    nodes = sky.node_tree.nodes
    background = next(node for node in nodes if node.type == "BACKGROUND")
    path = nodes.new("ShaderNodeLightPath")
    sky.node_tree.links.new(path.outputs["Is Camera Ray"], background.inputs["Strength"])
    before = export_told()[1].lines()
    sky.node_tree.links.new(path.outputs["Is Glossy Ray"], background.inputs["Strength"])
    scene.lancer.transparent_bounces = 0
    return {"before": before, "after": sorted(export_told()[1].lines())}


def meshes_apart():
    """Return the messages of a flat, a half smooth and two anisotropic objects; then with a sky that glossy rays miss."""
    from export_cases import export_told

    stage.empty()
    for name, method in (("Flat", "BOTH"), ("Half", "DISPLACEMENT")):
        thing = stage.cube(material=_displaced(name, method))
        thing.name = name
    for number, polygon in enumerate(thing.data.polygons):
        polygon.use_smooth = number % 2 == 0
    brushed = stage.shader("ShaderNodeBsdfGlossy" if bpy.app.version >= (4, 0) else "ShaderNodeBsdfAnisotropic", Anisotropy=0.5)
    tree = brushed.node_tree
    tangent = tree.nodes.new("ShaderNodeTangent")
    tangent.direction_type, tangent.uv_map = "UV_MAP", "Gone"
    shader = next(node for node in tree.nodes if node.type.startswith("BSDF"))
    tree.links.new(tangent.outputs["Tangent"], shader.inputs["Tangent"])
    for _ in range(2):
        stage.plane(material=brushed)
    sky = stage.sky()
    nodes = sky.node_tree.nodes
    place = nodes.new("ShaderNodeTexCoord")
    background = next(node for node in nodes if node.type == "BACKGROUND")
    sky.node_tree.links.new(place.outputs["Generated"], background.inputs["Color"])
    before = export_told()[1].lines()
    sky.cycles_visibility.glossy = False
    return {"version": list(bpy.app.version), "before": before, "after": export_told()[1].lines()}


def _displaced(name, method):
    material = stage.shader(name=name)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    node, output = nodes.new("ShaderNodeDisplacement"), next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    node.inputs["Height"].default_value = 0.6
    links.new(node.outputs["Displacement"], output.inputs["Displacement"])
    owner = material if hasattr(material, "displacement_method") else material.cycles
    owner.displacement_method = method
    return material


def empty_passes():
    """Return, for each integrator, the passes that are all zero, and the messages."""
    import pass_cases

    result = {}
    for integrator in ("PATH", "CLASSIC", "NORMALS"):
        scene = pass_cases._gallery()
        pass_cases._ask(scene.view_layers[0], *pass_cases._SWITCHES)
        scene.view_layers[0].cycles.denoising_store_passes = True
        scene.lancer.integrator = integrator
        pictures, messages = pass_cases._read(scene)
        result[integrator] = {
            "black": sorted(name for name, picture in pictures.items() if not picture.any()),
            "told": [line for line in messages if "stay empty" in line],
        }
    return result
