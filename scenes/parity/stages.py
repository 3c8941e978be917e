"""The surroundings in which features are shown: camera, lamp, sky, floor and subject."""

from .. import parts
from .nodes import shader


def camera(scene, location=(0, -5, 3), target=(0, 0, 0.5), **fields):
    thing = parts.add_camera(scene, location, target)
    for field, value in fields.items():
        setattr(thing.data, field, value)
    return thing


def lamp(scene, energy=150.0, location=(2.5, -2.5, 4)):
    """Adds a large lamp, which paths often find by chance."""
    return parts.add_light(scene, "Lamp", "AREA", energy, location, (0, 0, 0.5), size=3.0)


def sky(scene, color=(0.3, 0.4, 0.55), strength=0.5):
    parts.set_world(scene, color, strength)


def floor(scene, color=(0.5, 0.45, 0.4), size=40.0):
    return parts.place(scene, "Floor", parts.plane_mesh("Floor", size), shader("ShaderNodeBsdfDiffuse", Color=color))


def floor_and_block(scene):
    """A block on a floor, both diffuse, under a camera; the scene adds the light."""
    floor(scene)
    block = shader("ShaderNodeBsdfDiffuse", Color=(0.3, 0.5, 0.75))
    parts.place(scene, "Block", parts.cube_mesh("Block", 1.0), block, (-0.3, 0.2, 0.5), rotation=(0, 0, 0.4))
    camera(scene)


def ball(scene, material, segments=128, radius=1.0, location=(0, 0, 1)):
    return parts.place(scene, "Ball", parts.sphere_mesh("Ball", segments, segments // 2), material, location, radius)


# Shaders whose light on other objects, as caustics, is found by chance.
_MIRRORING = {"BSDF_GLOSSY", "BSDF_ANISOTROPIC", "BSDF_GLASS", "BSDF_REFRACTION", "BSDF_METALLIC", "BSDF_PRINCIPLED"}


def studio(scene, material, light_energy=150.0, caustics=False):
    """A ball of the material on a floor, under a lamp and a dim sky, filling most of the picture.

    caustics: whether the floor receives the caustics of a mirroring ball, the noisiest light of all."""
    floor(scene)
    thing = ball(scene, material)
    thing.visible_diffuse = caustics or not any(node.type in _MIRRORING for node in material.node_tree.nodes)
    lamp(scene, light_energy)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)
    return thing


def open_air(scene, material):
    """A ball before striped blocks under a uniform sky: for glass, whose light from lamps is found by chance alone."""
    floor(scene)
    thing = ball(scene, material)
    block = parts.cube_mesh("Block", 0.8)
    for index in range(4):
        color = (0.9 - 0.2 * index, 0.2 + 0.2 * index, 0.3)
        matt = shader("ShaderNodeBsdfDiffuse", Color=color)
        parts.place(scene, f"Block {index}", block, matt, (1.5 * index - 2.2, 2.2, 0.7), (1.0, 0.5, 1.6))
    sky(scene, (0.7, 0.8, 1.0), 1.0)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)
    return thing


def card(scene, material, size=3.0):
    """One square of the material seen from the front, lit evenly: for textures."""
    thing = parts.place(scene, "Card", parts.plane_mesh("Card", size), material)
    add_uv(thing.data)
    sky(scene, (0.8, 0.8, 0.8), 1.0)
    camera(scene, (0.2, -1.2, 3.2), (0, 0.05, 0), lens=45.0)
    return thing


def displace(surface, method):
    """Sets the method by which a material is displaced: BUMP, DISPLACEMENT or BOTH."""
    owner = surface if "displacement_method" in surface.bl_rna.properties else surface.cycles
    owner.displacement_method = method


def add_uv(mesh, scale=1.0):
    """Adds a UV map from the mesh's extent in x and y to the unit square, repeated `scale` times."""
    layer = mesh.uv_layers.active or mesh.uv_layers.new(name="UVMap")
    xs = [v.co.x for v in mesh.vertices]
    ys = [v.co.y for v in mesh.vertices]
    (x0, x1), (y0, y1) = (min(xs), max(xs)), (min(ys), max(ys))
    for loop in mesh.loops:
        co = mesh.vertices[loop.vertex_index].co
        layer.data[loop.index].uv = (scale * (co.x - x0) / (x1 - x0), scale * (co.y - y0) / (y1 - y0))
    return layer
