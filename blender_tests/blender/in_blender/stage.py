"""Build scenes and render pictures inside Blender, through an interface that all its versions have."""

import math
import os
import tempfile

import bpy
import numpy as np
from mathutils import Euler, Vector


def empty(width=32, height=32, samples=4, engine="LANCER"):
    """Return an empty scene that renders small and fast."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.view_settings.view_transform = "Standard"
    if engine == "LANCER":
        scene.lancer.quality = "CUSTOM"
        scene.lancer.samples, scene.lancer.target_error = samples, 0.0
        scene.lancer.use_denoising = False
        scene.lancer.pixel_filter = "BOX"
        light_paths_alike(scene)
    return scene


def light_paths_alike(scene):
    """Set Cycles' light paths and pixel filter like Lancer's, so that no message warns of them."""
    cycles = scene.cycles
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = scene.lancer.max_bounces
    cycles.blur_glossy = cycles.sample_clamp_indirect = 0.0
    cycles.pixel_filter_type = scene.lancer.pixel_filter


def link(name, data, location=(0, 0, 0), rotation=(0, 0, 0)):
    item = bpy.data.objects.new(name, data)
    item.location, item.rotation_euler = location, Euler(rotation)
    bpy.context.scene.collection.objects.link(item)
    return item


def camera(location=(0, -6, 3), target=(0, 0, 0.5), **fields):
    data = bpy.data.cameras.new("Camera")
    for field, value in fields.items():
        setattr(data, field, value)
    item = link("Camera", data, location)
    item.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = item
    return item


def mesh(name, vertices, faces, material=None, **place):
    data = bpy.data.meshes.new(name)
    data.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    if material is not None:
        data.materials.append(material)
    return link(name, data, **place)


def plane(size=20.0, material=None, **place):
    r = size / 2
    return mesh("Plane", [(-r, -r, 0), (r, -r, 0), (r, r, 0), (-r, r, 0)], [(0, 1, 2, 3)], material, **place)


def cube(size=1.0, material=None, **place):
    r = size / 2
    vertices = [(x, y, z) for x in (-r, r) for y in (-r, r) for z in (-r, r)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return mesh("Cube", vertices, faces, material, **place)


def ball(radius=1.0, material=None, segments=64, **place):
    """Return a smooth UV sphere."""
    rings = segments // 2
    vertices = [(0, 0, radius)]
    for i in range(1, rings):
        theta = math.pi * i / rings
        for k in range(segments):
            phi = 2 * math.pi * k / segments
            vertices.append(
                (radius * math.sin(theta) * math.cos(phi), radius * math.sin(theta) * math.sin(phi), radius * math.cos(theta))
            )
    vertices.append((0, 0, -radius))
    faces = [(0, 1 + k, 1 + (k + 1) % segments) for k in range(segments)]
    for i in range(rings - 2):
        a = 1 + i * segments
        faces += [(a + k, a + segments + k, a + segments + (k + 1) % segments, a + (k + 1) % segments) for k in range(segments)]
    a = 1 + (rings - 2) * segments
    faces += [(a + k, len(vertices) - 1, a + (k + 1) % segments) for k in range(segments)]
    item = mesh("Ball", vertices, faces, material, **place)
    item.data.polygons.foreach_set("use_smooth", [True] * len(item.data.polygons))
    return item


def light(kind="POINT", energy=100.0, location=(2, -2, 4), rotation=(0, 0, 0), **fields):
    data = bpy.data.lights.new("Light", kind)
    data.energy = energy
    for field, value in fields.items():
        setattr(data, field, value)
    return link("Light", data, location, rotation)


def sky(color=(0.2, 0.3, 0.5), strength=1.0):
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    background = next(n for n in world.node_tree.nodes if n.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*color, 1.0)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = world
    return world


def shader(kind="ShaderNodeBsdfDiffuse", name="Material", **inputs):
    """Return a material of one shader node; inputs by socket name with _ for blanks."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    for socket, value in inputs.items():
        value = (*value, 1.0) if isinstance(value, tuple) and len(value) == 3 else value
        node.inputs[socket.replace("_", " ")].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def unknown(tree, attribute="N"):
    """Add a node that Lancer does not support: an attribute that Cycles computes."""
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = attribute
    return node


def room(**settings):
    """Return a scene with a plane, a cube, a lamp, a sky and a camera."""
    scene = empty(**settings)
    plane(material=shader(Color=(0.6, 0.6, 0.6)))
    cube(material=shader(Color=(0.8, 0.2, 0.1)), location=(0, 0, 0.5))
    light()
    sky()
    camera()
    return scene


def write_exr(scene, path=None, layers=False):
    path = path or os.path.join(tempfile.mkdtemp(), "picture.exr")
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "MULTI_LAYER_IMAGE" if layers else "IMAGE"
    image.file_format = "OPEN_EXR_MULTILAYER" if layers else "OPEN_EXR"
    image.color_depth, image.color_mode = "32", "RGBA"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return path


def picture(scene):
    """Render. Return the linear picture, (h, w, 4); row 0 is the bottom row."""
    return pixels(write_exr(scene))


def pixels(path):
    """Return the linear picture in an EXR file, (h, w, 4); row 0 is the bottom row."""
    image = bpy.data.images.load(path)
    width, height = image.size
    values = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(height, width, 4)


def channels(path):
    """Return the channel names of an EXR file, from the headers of all its parts."""
    with open(path, "rb") as file:
        data = file.read(65536)
    names, mark = [], b"channels\0chlist\0"
    at = data.find(mark)
    while at >= 0:
        at += len(mark) + 4
        while data[at] != 0:
            end = data.index(b"\0", at)
            names.append(data[at:end].decode())
            at = end + 1 + 16
        at = data.find(mark, at)
    return names
