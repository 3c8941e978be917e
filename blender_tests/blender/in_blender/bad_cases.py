"""Scenes that are wrong on purpose. Each returns facts of the picture and the messages, or the text of the error."""

import bpy
import numpy as np
import stage

NAN, INF = float("nan"), float("inf")


def _messages():
    from addon.engine import render_engine as engine

    lines = []
    for texts in engine.last_messages.values():
        lines.extend(str(text) for text in texts)
    return lines


def _outcome():
    """Render the scene. Return facts of the picture, the messages and the error's text."""
    try:
        pixels = stage.picture(bpy.context.scene)
        result = {"finite": bool(np.isfinite(pixels).all()), "mean": float(pixels[..., :3].mean()), "error": ""}
    except RuntimeError as error:
        result = {"finite": True, "mean": 0.0, "error": str(error)}
    return {**result, "messages": _messages()}


def _spoil(vertices):
    """Build the room with some vertices of the cube replaced."""
    stage.room()
    data = bpy.data.objects["Cube"].data
    for index, value in vertices.items():
        data.vertices[index].co = value
    return _outcome()


def nan_vertices():
    return _spoil({0: (NAN, 0, 0), 3: (0, NAN, NAN)})


def infinite_vertices():
    return _spoil({0: (INF, 0, 0), 5: (-INF, 1, 1)})


def huge_vertices():
    return _spoil({0: (3e38, 0, 0), 5: (-3e38, 1, 1)})


def zero_area_faces():
    return _spoil({i: (0.2, 0.2, 0.2) for i in range(5)})


def loose_edges():
    stage.room()
    data = bpy.data.meshes.new("Wire")
    data.from_pydata([(0, 0, 1), (1, 0, 1), (0, 1, 1)], [(0, 1), (1, 2)], [])
    stage.link("Wire", data)
    return _outcome()


def no_faces():
    stage.room()
    stage.link("Dust", bpy.data.meshes.new("Dust"))
    points = bpy.data.meshes.new("Points")
    points.from_pydata([(0, 0, 1), (1, 0, 1)], [], [])
    stage.link("Points", points)
    return _outcome()


def spare_uv_layers():
    stage.room()
    data = bpy.data.objects["Cube"].data
    for i in range(4):
        data.uv_layers.new(name=f"UV{i}")
    return _outcome()


def singular_matrix():
    stage.room()
    bpy.data.objects["Cube"].scale = (1, 0, 1)
    return _outcome()


def no_area():
    stage.room()
    bpy.data.objects["Cube"].scale = (1, 0, 0)
    return _outcome()


def nan_matrix():
    stage.room()
    bpy.data.objects["Cube"].location = (NAN, 0, 0)
    return _outcome()


def mirrored():
    stage.room()
    bpy.data.objects["Cube"].scale = (-1, 1, 1)
    return _outcome()


def _lamp(**fields):
    stage.room()
    for field, value in fields.items():
        setattr(bpy.data.lights["Light"], field, value)
    return _outcome()


def negative_power():
    return _lamp(energy=-100.0)


def nan_power():
    return _lamp(energy=NAN)


def infinite_power():
    return _lamp(energy=INF)


def nan_radius():
    return _lamp(shadow_soft_size=NAN)


def zero_area_light():
    stage.room()
    stage.light("AREA", 10.0, size=0.0)
    return _outcome()


def missing_slot():
    """Faces whose slot does not exist, and a slot without a material."""
    stage.room()
    cube = bpy.data.objects["Cube"]
    cube.data.materials.append(None)
    for polygon in cube.data.polygons:
        polygon.material_index = 7
    cube.data.polygons[0].material_index = 1
    return _outcome()


def missing_image():
    stage.room()
    material = bpy.data.materials["Material"]
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("Gone", 4, 4)
    node.image.source, node.image.filepath = "FILE", "//there/is/no/such.png"
    shader = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
    tree.links.new(node.outputs["Color"], shader.inputs["Color"])
    return _outcome()


def unsupported_node():
    stage.room()
    bpy.data.objects["Cube"].data.materials[0] = stage.shader("ShaderNodeEeveeSpecular", "Fur")
    return _outcome()


def unsupported_features():
    """One of each unsupported feature, nodes excepted."""
    scene = stage.room()
    layer, cube = bpy.context.view_layer, bpy.data.objects["Cube"]
    # Strands on the cube.
    bpy.context.view_layer.objects.active = cube
    system = cube.modifiers.new("Fluff", "PARTICLE_SYSTEM").particle_system
    system.name = "Fluff"
    system.settings.type, system.settings.render_type, system.settings.count = "HAIR", "PATH", 5
    # Passes and Freestyle. Without a line set Blender draws no lines, for which it would need a graphics device.
    layer.use_pass_mist = layer.use_pass_diffuse_direct = layer.use_pass_subsurface_direct = True
    layer.use_pass_cryptomatte_object = layer.use_pass_z = True
    layer.aovs.add().name = "Rust"
    scene.render.use_freestyle = True
    sets = layer.freestyle_settings.linesets
    for lines in list(sets):
        sets.remove(lines)
    # Shadow caustics.
    cube.cycles.is_caustics_receiver = True
    return _outcome()


def factory_scene():
    """The scene that Blender starts with."""
    bpy.ops.wm.read_factory_settings()
    scene = bpy.context.scene
    scene.render.engine = "LANCER"
    scene.lancer.quality, scene.lancer.samples = "CUSTOM", 1
    scene.render.resolution_percentage = 3
    return _outcome()


def wild_material():
    stage.room()
    cube = bpy.data.objects["Cube"]
    cube.data.materials[0] = material = stage.shader("ShaderNodeBsdfPrincipled", "Wild")
    node = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    node.inputs["Roughness"].default_value = NAN
    node.inputs["IOR"].default_value = NAN
    node.inputs["Base Color"].default_value = (-1.0, NAN, 5.0, 1.0)
    return _outcome()


def empty_scene():
    stage.empty()
    stage.camera()
    return _outcome()


def no_camera():
    stage.room()
    bpy.context.scene.camera = None
    return _outcome()


def camera_is_no_camera():
    stage.room()
    bpy.context.scene.camera = bpy.data.objects["Cube"]
    return _outcome()


def panoramic_camera():
    stage.room()
    data = bpy.data.cameras["Camera"]
    data.type = "PANO"
    (data if hasattr(data, "panorama_type") else data.cycles).panorama_type = "EQUIANGULAR_CUBEMAP_FACE"
    return _outcome()


def smallest_picture():
    scene = stage.room()
    scene.render.resolution_x = scene.render.resolution_y = 4
    scene.render.resolution_percentage = 1
    return _outcome()


def no_world_no_light():
    stage.empty()
    stage.plane()
    stage.camera()
    return _outcome()


def text_metaballs_and_curves():
    stage.room()
    stage.link("Text", bpy.data.curves.new("Text", "FONT"), (0, 0, 1))
    bpy.data.curves["Text"].body = "Lancer"
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.1
    curve.splines.new("POLY").points.add(3)
    stage.link("Curve", curve)
    bpy.data.metaballs.new("Meta").elements.new()
    stage.link("Meta", bpy.data.metaballs["Meta"], (1, 1, 1))
    return _outcome()
