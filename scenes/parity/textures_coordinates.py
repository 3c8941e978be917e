"""The sources of texture coordinates, and colours stored in the mesh."""

import bpy

from .. import parts
from . import images
from .catalogue import case, variants
from .nodes import material
from .stages import add_uv, ball, camera, card, sky


def _matt_picture(nodes, vector):
    picture = nodes.add("ShaderNodeTexImage", props={"image": images.gradient()}, Vector=vector)
    return nodes.add("ShaderNodeBsdfDiffuse", Color=picture.outputs["Color"])


def _turned_ball(scene, surface):
    thing = ball(scene, surface)
    thing.rotation_euler, thing.scale = (0.3, 0.2, 0.5), (1.1, 0.9, 1.0)
    add_uv(thing.data)
    sky(scene, (0.8, 0.8, 0.8), 1.0)
    camera(scene, (0, -3.4, 2.0), (0, 0, 1))
    return thing


@variants(values={name.lower(): name for name in ("Generated", "Normal", "UV", "Object", "Camera", "Window", "Reflection")})
def coordinate(scene, output):
    _turned_ball(scene, material(lambda nodes: _matt_picture(nodes, nodes.add("ShaderNodeTexCoord").outputs[output])))


@case()
def coordinate_of_another_object(scene):
    other = bpy.data.objects.new("Other", None)
    scene.collection.objects.link(other)
    other.location, other.rotation_euler, other.scale = (0.3, 0.2, 0.5), (0.4, 0.1, 0.9), (1.5, 0.8, 1.0)

    def build(nodes):
        return _matt_picture(nodes, nodes.add("ShaderNodeTexCoord", props={"object": other}).outputs["Object"])

    _turned_ball(scene, material(build))


@case()
def coordinate_default(scene):
    """Without a vector, an image reads the UV map, and a box projection the generated coordinates."""
    image = images.gradient()

    def build(nodes, projection):
        picture = nodes.add("ShaderNodeTexImage", props={"image": image, "projection": projection})
        return nodes.add("ShaderNodeBsdfDiffuse", Color=picture)

    _turned_ball(scene, material(lambda nodes: build(nodes, "FLAT"))).location.x = -0.8
    box = material(lambda nodes: build(nodes, "BOX"))
    parts.place(scene, "Cube", parts.cube_mesh("Cube", 1.2), box, (1.0, 0, 1), rotation=(0.3, 0.5, 0.4))


@case()
def coordinate_geometry(scene):
    """Position in the world as a colour."""

    def build(nodes):
        return nodes.add("ShaderNodeEmission", Color=nodes.add("ShaderNodeNewGeometry").outputs["Position"])

    _turned_ball(scene, material(build))


@case()
def uv_map_second(scene):
    def build(nodes):
        return _matt_picture(nodes, nodes.add("ShaderNodeUVMap", props={"uv_map": "Second"}))

    thing = card(scene, material(build))
    second = thing.data.uv_layers.new(name="Second")
    for item, (u, v) in zip(second.data, ((0.9, 0.1), (0.8, 0.9), (0.2, 1.3), (0.1, 0.0)), strict=True):
        item.uv = (u, v)


@variants(values={name.lower(): name for name in ("POINT", "TEXTURE", "VECTOR", "NORMAL")})
def mapping(scene, kind):
    def build(nodes):
        uv = nodes.add("ShaderNodeTexCoord").outputs["UV"]
        inputs = {"Rotation": (0.1, 0.2, 0.7), "Scale": (1.5, 0.7, 1.2)}
        if kind in ("POINT", "TEXTURE"):
            inputs["Location"] = (0.2, -0.1, 0.3)
        return _matt_picture(nodes, nodes.add("ShaderNodeMapping", props={"vector_type": kind}, Vector=uv, **inputs))

    card(scene, material(build))


@variants(
    values={
        "float_vertex": ("FLOAT_COLOR", "POINT"),
        "byte_vertex": ("BYTE_COLOR", "POINT"),
        "float_corner": ("FLOAT_COLOR", "CORNER"),
        "byte_corner": (("BYTE_COLOR", "CORNER"), {"quick": True}),
    }
)
def color_attribute(scene, value):
    kind, domain = value

    def build(nodes):
        color = nodes.add("ShaderNodeVertexColor", props={"layer_name": "Paint"})
        return nodes.add("ShaderNodeBsdfDiffuse", Color=color.outputs["Color"])

    thing = card(scene, material(build))
    _paint(thing.data, kind, domain)


def _paint(mesh, kind, domain):
    """A colour for each corner of a square."""
    colors = mesh.color_attributes.new("Paint", kind, domain)
    corners = ((0.9, 0.1, 0.1, 1), (0.1, 0.8, 0.2, 1), (0.2, 0.2, 0.9, 1), (0.8, 0.8, 0.1, 1))
    for item, color in zip(colors.data, corners, strict=True):
        item.color = color


@case()
def attribute_by_name(scene):
    def build(nodes):
        color = nodes.add("ShaderNodeAttribute", props={"attribute_name": "Paint"})
        return nodes.add("ShaderNodeBsdfDiffuse", Color=color.outputs["Color"])

    thing = card(scene, material(build))
    _paint(thing.data, "FLOAT_COLOR", "POINT")


@case()
def mesh_of_several_materials(scene):
    """Faces with different material slots, one of them empty; three faces of each cube are visible."""
    for x, first in ((-1.0, 0), (1.0, 2)):
        mesh = parts.cube_mesh("Cube", 1.2)
        for color in ((0.8, 0.2, 0.1), (0.2, 0.7, 0.2), (0.2, 0.3, 0.9)):
            mesh.materials.append(material(lambda nodes, color=color: nodes.add("ShaderNodeBsdfDiffuse", Color=color)))
        mesh.materials.append(None)
        for face in mesh.polygons:
            face.material_index = (face.index + first) % 4
        parts.place(scene, "Cube", mesh, location=(x, 0, 0), rotation=(0.3, 0.5, 0.4 + x))
    sky(scene, (0.8, 0.8, 0.8), 1.0)
    camera(scene, (0, -4, 1.5), (0, 0, 0))
