"""Scenes under an image of a sky: scanned models with textures, and a tree whose leaves are cut out by alpha."""

import math
import random
from pathlib import Path

import bpy
import numpy as np
from mathutils import Euler, Vector

from . import parts, pictures

# This folder lies beside the project and is not part of it.
MODELS = Path(__file__).resolve().parents[2] / "shared" / "models"


class MissingModels(RuntimeError):
    pass


def textured(name, image, roughness=0.5, coordinates="UV", alpha=False):
    """Returns a Principled material with the image as its base colour and, with alpha, as its alpha."""
    material = parts.principled(name, roughness=roughness, ior=1.5)
    tree = material.node_tree
    principled = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    source = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(source.outputs[coordinates], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], principled.inputs["Base Color"])
    if alpha:
        tree.links.new(texture.outputs["Alpha"], principled.inputs["Alpha"])
    return material


def set_sky(scene, image, strength=1.0):
    parts.set_world(scene, (0, 0, 0), strength)
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])


def _model_mesh(name):
    """Returns the named model upright, 2 high, centred over the origin; smooth, with UVs (from above if the file has none)."""
    path = MODELS / f"{name}.obj"
    if not path.is_file():
        raise MissingModels(f"{path} is missing: the scene 'models' needs the folder shared/models beside the project")
    before = set(bpy.data.objects)
    bpy.ops.wm.obj_import(filepath=str(path))
    thing = next(iter(set(bpy.data.objects) - before))
    mesh = thing.data.copy()
    mesh.transform(thing.matrix_world)
    bpy.data.objects.remove(thing)
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    scale = 2.0 / (high[2] - low[2])
    points = (points - [*((low + high)[:2] / 2), low[2]]) * scale
    mesh.vertices.foreach_set("co", points.ravel().astype(np.float32))
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), True))
    if not mesh.uv_layers:
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        uvs = mesh.uv_layers.new(name="UVMap")
        flat = np.ascontiguousarray(points[corners][:, [0, 2]] * 0.5, np.float32)
        uvs.data.foreach_set("uv", flat.ravel())
    mesh.materials.clear()
    mesh.name = name
    return mesh


def build_models(scene):
    """The Stanford bunny and spot, textured, on a floor under an image of a sky."""
    _show_models(scene)


def build_textured(scene):
    """The same scene with images for roughness and normals, too."""
    _show_models(scene)
    for name in ("Cloth", "Hide", "Tiles"):
        wear_out(bpy.data.materials[name])


def wear_out(material):
    """Adds images for roughness and normals to a material whose colour has an image."""
    tree = material.node_tree
    principled = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    places = next(node for node in tree.nodes if node.type == "TEX_COORD").outputs["UV"]
    normals = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(normals.outputs["Normal"], principled.inputs["Normal"])
    targets = (("Wear", pictures.wear, principled.inputs["Roughness"]), ("Weave", pictures.weave, normals.inputs["Color"]))
    for name, make, target in targets:
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images.get(name) or make()
        tree.links.new(places, texture.inputs["Vector"])
        tree.links.new(texture.outputs["Color"], target)


def _show_models(scene):
    parts.set_size(scene, 640, 480, 64)
    bunny, spot = _model_mesh("stanford-bunny"), _model_mesh("spot")
    cloth = textured("Cloth", pictures.cloth(), 0.5)
    hide = textured("Hide", pictures.cloth("Hide", cells=5), 0.3)
    tiles = textured("Tiles", pictures.cloth("Tiles", cells=24), 0.7)
    parts.place(scene, "Bunny", bunny, cloth, (-1.15, 0.2, 0), rotation=(0, 0, 0.4))
    parts.place(scene, "Spot", spot, hide, (1.2, 0.0, 0), rotation=(0, 0, -0.7))
    floor = parts.plane_mesh("Floor", 24.0)
    flat_uvs(floor)
    parts.place(scene, "Floor", floor, tiles)
    set_sky(scene, pictures.sky())
    parts.add_camera(scene, (0.4, -5.6, 2.4), (0, 0, 0.9), lens=45.0)


def flat_uvs(mesh):
    """Maps the unit square over a grid, corner by corner."""
    layer = mesh.uv_layers.new(name="UVMap") if not mesh.uv_layers else mesh.uv_layers[0]
    size = max(abs(vertex.co.x) for vertex in mesh.vertices)
    for loop in mesh.loops:
        co = mesh.vertices[loop.vertex_index].co
        layer.data[loop.index].uv = (0.5 + 0.5 * co.x / size, 0.5 + 0.5 * co.y / size)


def build_leaves(scene, count=6000):
    """A tree of one mesh of count cards, each a leaf cut out by its image's alpha, under sky and sun."""
    parts.set_size(scene, 640, 480, 64)
    leaf = textured("Leaf", pictures.leaf(), 0.6, alpha=True)
    parts.place(scene, "Leaves", crown_mesh("Leaves", count), leaf)
    bark = parts.principled("Bark", base_color=(0.3, 0.2, 0.12), roughness=0.9, ior=1.5)
    parts.place(scene, "Trunk", parts.cone_mesh("Trunk", 0.28, 0.15, 3.0), bark, (0, 0, 1.5))
    ground = parts.principled("Ground", base_color=(0.35, 0.4, 0.2), roughness=1.0, specular_ior_level=0.0)
    parts.place(scene, "Ground", parts.plane_mesh("Ground", 60.0), ground)
    parts.add_light(scene, "Sun", "SUN", 3.0, (5, -6, 9), (0, 0, 2), angle=math.radians(1.0))
    parts.set_world(scene, (0.45, 0.6, 0.9), 0.6)
    parts.add_camera(scene, (0.5, -8.5, 2.2), (0, 0, 2.4), lens=40.0)


def crown_mesh(name, count):
    """Returns count cards with UVs, denser towards the surface of a ball, like a tree's leaves."""
    source = random.Random(count)
    corners, faces = [], []
    for index in range(count):
        direction = Vector([source.gauss(0, 1) for _ in range(3)]).normalized()
        place = Vector((0, 0, 3.2)) + direction * (2.0 * source.random() ** 0.3)
        turn = Euler([source.uniform(0, 2 * math.pi) for _ in range(3)]).to_matrix()
        half = source.uniform(0.12, 0.2)
        for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            corners.append(place + turn @ Vector((half * x, half * y, 0)))
        faces.append([4 * index + k for k in range(4)])
    mesh = parts.mesh_from_points(name, corners, faces)
    layer = mesh.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", np.tile([0, 0, 1, 0, 1, 1, 0, 1], count).astype(np.float32))
    return mesh


def build_foliage(scene, trees=60, tufts=3000):
    """A wood under an image of a sky: trees with cut-out leaves and worn bark, tufts of grass on soil; Normal and Z passes."""
    source = random.Random(trees)
    parts.set_size(scene, 512, 384, 32)
    parts.add_passes(scene)
    leaf = textured("Leaf", pictures.leaf(), 0.5, alpha=True)
    bark = textured("Bark", pictures.grain("Bark", (0.5, 0.4, 0.3)), 0.9)
    soil = textured("Soil", pictures.grain("Soil", (0.45, 0.4, 0.3), waves=60, size=1024), 0.9)
    wear_out(bark)
    wear_out(soil)
    crowns = [crown_mesh(f"Crown {count}", count) for count in (3000, 4000, 5000)]
    trunk = parts.lathe_mesh("Trunk", [(0.3, 0.0), (0.22, 0.4), (0.18, 1.5), (0.1, 3.2), (0.0, 4.0)])
    for index in range(trees):
        place = (source.uniform(-22, 22), source.uniform(-2, 40), 0.0)
        size, turn = source.uniform(0.7, 1.3), (0, 0, source.uniform(0, 2 * math.pi))
        parts.place(scene, "Crown", crowns[index % len(crowns)], leaf, place, size, turn)
        parts.place(scene, "Trunk", trunk, bark, place, size, turn)
    blades = [(0.3 * source.random(), source.uniform(0, 2 * math.pi), source.uniform(0.15, 0.4)) for _ in range(40)]
    corners = [
        (r * math.cos(a) + s * dx, r * math.sin(a) + 0.3 * s * dx, s * up)
        for r, a, s in blades
        for dx, up in ((-0.06, 0.0), (0.06, 0.0), (0.1, 1.0))
    ]
    tuft = parts.mesh_from_points("Tuft", corners, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(blades))])
    grass = parts.principled("Grass", base_color=(0.15, 0.4, 0.08), roughness=0.5, ior=1.5)
    for _ in range(tufts):
        place = (source.uniform(-16, 16), source.uniform(-7, 20), 0.0)
        parts.place(scene, "Tuft", tuft, grass, place, source.uniform(0.6, 1.4), (0, 0, source.uniform(0, 2 * math.pi)))
    floor = parts.plane_mesh("Soil", 120.0)
    flat_uvs(floor)
    parts.place(scene, "Soil", floor, soil)
    set_sky(scene, pictures.sky(), 2.5)
    parts.add_camera(scene, (0.5, -9.5, 1.8), (0, 4, 2.2), lens=32.0)
