"""Small rules of Cycles that the exporter follows: each case returns the colours of both engines for the same scene."""

import os
import tempfile

import bpy
import numpy as np
import stage

FRAMES = 3


def _scene():
    """Return a scene whose camera looks straight down, with pictures of 8 x 8 pixels that are all equal."""
    scene = stage.empty(8, 8, 1)
    stage.camera((0, 0, 5), (0, 0, 0)).rotation_euler = (0, 0, 0)
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = 1, False, "BOX"
    return scene


def _both(scene):
    """Return [Cycles' colour, ours] in the middle of the picture."""
    result = []
    for engine in ("CYCLES", "LANCER"):
        scene.render.engine = engine
        result.append(stage.picture(scene)[4, 4].astype(float).tolist())
    return result


def _each_frame(scene):
    """Return the same for every frame of an animation."""
    scene.frame_start, scene.frame_end = 1, FRAMES
    result = []
    for engine in ("CYCLES", "LANCER"):
        scene.render.engine = engine
        folder = tempfile.mkdtemp()
        stage.write_exr(scene, os.path.join(folder, "first.exr"))
        scene.render.filepath = os.path.join(folder, "frame_")
        scene.frame_set(1)
        bpy.ops.render.render(animation=True)
        colors = []
        for frame in range(1, FRAMES + 1):
            image = bpy.data.images.load(os.path.join(folder, f"frame_{frame:04}.exr"))
            pixels = np.empty(8 * 8 * 4, np.float32)
            image.pixels.foreach_get(pixels)
            colors.append(pixels.reshape(8, 8, 4)[4, 4].astype(float).tolist())
        result.append(colors)
    return [list(pair) for pair in zip(*result, strict=True)]


def _card(name="Card"):
    """Return (tree, its Emission, its output) of a card that fills the picture."""
    material = stage.shader("ShaderNodeEmission", name)
    stage.plane(20.0, material)
    tree = material.node_tree
    return tree, *(next(node for node in tree.nodes if node.type == kind) for kind in ("EMISSION", "OUTPUT_MATERIAL"))


def animated_world():
    scene = _scene()
    world = stage.sky((1.0, 0.5, 0.25))
    strength = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND").inputs["Strength"]
    for frame in range(1, FRAMES + 1):
        strength.default_value = float(frame)
        strength.keyframe_insert("default_value", frame=frame)
    return _each_frame(scene)


def animated_override():
    scene = _scene()
    stage.plane(20.0)
    material = stage.shader("ShaderNodeEmission", "Override")
    strength = next(node for node in material.node_tree.nodes if node.type == "EMISSION").inputs["Strength"]
    for frame in range(1, FRAMES + 1):
        strength.default_value = float(frame)
        strength.keyframe_insert("default_value", frame=frame)
    bpy.context.view_layer.material_override = material
    return _each_frame(scene)


def outputs():
    result = {}
    settings = {"all": ("ALL", False), "cycles": ("CYCLES", False), "eevee": ("EEVEE", False), "muted": ("ALL", True)}
    for name, (target, mute) in settings.items():
        scene = _scene()
        _, _, output = _card()
        output.target, output.mute = target, mute
        result[name] = _both(scene)
    return result


def filters():
    """A card before a sky, with each combination of the view layer's filters."""
    result = {}
    for name, solid, sky in (("both", True, True), ("surfaces", True, False), ("sky", False, True), ("neither", False, False)):
        scene = _scene()
        stage.sky((0.25, 0.5, 1.0))
        _card()
        bpy.context.view_layer.use_solid, bpy.context.view_layer.use_sky = solid, sky
        result[name] = _both(scene)
    return result


def glow():
    result = {}
    for kelvin in (300, 800, 1000, 1300, 1700, 2500, 4000, 6500, 9000, 12000, 20000):
        scene = _scene()
        tree, emission, _ = _card()
        node = tree.nodes.new("ShaderNodeBlackbody")
        node.inputs[0].default_value = kelvin
        tree.links.new(node.outputs[0], emission.inputs["Color"])
        result[kelvin] = _both(scene)
    return result


def _lamp():
    """Return a lamp of radiance 1, less before Blender 4, that faces the camera and is visible to it."""
    lamp = stage.light("AREA", 9.0 * np.pi, (0, 0, 1), (np.pi, 0, 0), size=3.0)
    lamp.visible_camera = True
    return lamp


def glowing_lamp():
    scene = _scene()
    light = _lamp().data
    if bpy.app.version < (5, 2):
        light.use_nodes = True
    tree = light.node_tree
    node = tree.nodes.new("ShaderNodeBlackbody")
    node.inputs[0].default_value = 4000.0
    tree.links.new(node.outputs[0], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Color"])
    return {"lamp": _both(scene)}


def instanced_lamps():
    """A lamp instanced by an empty that is hidden from the camera, or in a collection that is Indirect Only."""
    result = {}
    for name in ("plain", "hidden", "indirect"):
        scene = _scene()
        lamp = _lamp()
        group, shelf = bpy.data.collections.new("Group"), bpy.data.collections.new("Shelf")
        scene.collection.objects.unlink(lamp)
        group.objects.link(lamp)
        empty = stage.link("Empty", None)
        scene.collection.objects.unlink(empty)
        scene.collection.children.link(shelf)
        shelf.objects.link(empty)
        empty.instance_type, empty.instance_collection = "COLLECTION", group
        empty.visible_camera = name != "hidden"
        bpy.context.view_layer.layer_collection.children["Shelf"].indirect_only = name == "indirect"
        result[name] = _both(scene)
    return result


def axes():
    """An image of four texels, at coordinates whose axes the node's own mapping exchanges, doubles and drops."""
    result = {}
    for name, chosen in (("plain", "XYZ"), ("exchanged", "YXZ"), ("doubled", "XXZ"), ("dropped", ("NONE", "Y", "Z"))):
        scene = _scene()
        tree, emission, _ = _card()
        picture = bpy.data.images.new("four", 2, 2, float_buffer=True)
        picture.pixels.foreach_set(np.array([0, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1], np.float32))
        node, place = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeCombineXYZ")
        node.image, node.interpolation = picture, "Closest"
        place.inputs[0].default_value, place.inputs[1].default_value = 0.75, 0.25
        for axis, source in zip("xyz", chosen, strict=True):
            setattr(node.texture_mapping, f"mapping_{axis}", source)
        tree.links.new(place.outputs[0], node.inputs[0])
        tree.links.new(node.outputs["Color"], emission.inputs["Color"])
        result[name] = _both(scene)
    return result


def mapping_types():
    """The node's own mapping of each type, moved, turned and scaled, over an image that differs from texel to texel."""
    result = {}
    for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
        scene = _scene()
        tree, emission, _ = _card()
        picture = bpy.data.images.new("ramp", 16, 16, float_buffer=True)
        picture.pixels.foreach_set(np.random.default_rng(5).random(16 * 16 * 4).astype(np.float32))
        node, place = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeCombineXYZ")
        node.image, node.interpolation = picture, "Closest"
        picture.alpha_mode = "CHANNEL_PACKED"
        place.inputs[0].default_value, place.inputs[1].default_value = 0.3, 0.45
        own = node.texture_mapping
        own.vector_type, own.translation, own.rotation, own.scale = kind, (0.3, 0.2, 0.1), (0.0, 0.0, 0.4), (2.0, 1.5, 1.25)
        tree.links.new(place.outputs[0], node.inputs[0])
        tree.links.new(node.outputs["Color"], emission.inputs["Color"])
        result[kind] = _both(scene)
    return result


def names(*asked):
    """Attributes and UV maps of the user that have the names of the exporter's own attributes."""
    result = {}
    for name in asked or ("tangent:", "named:generated", "blank "):
        scene = _scene()
        tree, emission, _ = _card()
        mesh = bpy.data.objects["Plane"].data
        mesh.uv_layers.new(name="UVMap")
        attribute = mesh.attributes.new(name, "FLOAT_COLOR", "POINT")
        attribute.data.foreach_set("color", [0.25, 0.5, 0.75, 1.0] * 4)
        node = tree.nodes.new("ShaderNodeAttribute")
        node.attribute_name = name
        tree.links.new(node.outputs["Color"], emission.inputs["Color"])
        result[name] = _both(scene)
    for name in ("generated", "tangent:") if not asked else ():
        scene = _scene()
        tree, emission, _ = _card()
        layer = bpy.data.objects["Plane"].data.uv_layers.new(name=name)
        for corner in layer.data:
            corner.uv = 0.25, 0.5
        node = tree.nodes.new("ShaderNodeUVMap")
        node.uv_map = name
        tree.links.new(node.outputs[0], emission.inputs["Color"])
        result[f"{name} of corners"] = _both(scene)
    return result
