"""Adaptive subdivision of what other objects make, and what materials read of a divided mesh: coordinates and tangents."""

import bmesh
import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import material
from .stages import camera, sky
from .subdivisions import divide


def _of_coordinate(output):
    """Returns a material that shows a vector of Texture Coordinate."""

    def build(nodes):
        return nodes.add("ShaderNodeEmission", Color=nodes.add("ShaderNodeTexCoord").outputs[output])

    return material(build)


def _seen(scene):
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


def _maker(scene, points, kind, **inputs):
    """An object that shows a mesh of Geometry Nodes at each of some points."""
    tree = bpy.data.node_groups.new("Maker", "GeometryNodeTree")
    if bpy.app.version >= (4, 0):
        for direction in ("INPUT", "OUTPUT"):
            tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    kinds = ("NodeGroupInput", "GeometryNodeInstanceOnPoints", kind, "GeometryNodeSetMaterial", "NodeGroupOutput")
    start, copies, made, colored, end = (tree.nodes.new(name) for name in kinds)
    for name, value in inputs.items():
        made.inputs[name].default_value = value
    colored.inputs["Material"].default_value = _of_coordinate("Normal")
    for source, target in (
        (start.outputs[0], copies.inputs["Points"]),
        (made.outputs["Mesh"], colored.inputs["Geometry"]),
        (colored.outputs[0], copies.inputs["Instance"]),
        (copies.outputs[0], end.inputs[0]),
    ):
        tree.links.new(source, target)
    thing = parts.place(scene, "Maker", parts.mesh_from_points("Points", points, []))
    thing.modifiers.new("Maker", "NODES").node_group = tree
    return thing


@case(quick=True)
def subdivided_geometry_of_nodes(scene):
    """Cubes that Geometry Nodes make for instances, rounded by the modifier of their maker."""
    thing = _maker(scene, [(-0.6, 0, 0.3), (0.5, 0.2, 0.5)], "GeometryNodeMeshCube", Size=(0.6, 0.7, 0.8))
    thing.location, thing.scale, thing.rotation_euler = (0.1, 1.5, 0), (1.5, 1.3, 1.6), (0.1, 0.2, 0.4)
    divide(scene, thing, 1.0)
    _seen(scene)


def _particles(scene, source):
    """Two particles that show an object."""
    ground = parts.place(scene, "Ground", parts.plane_mesh("Ground", 2.0))
    ground.show_instancer_for_render = False
    settings = ground.modifiers.new("Particles", "PARTICLE_SYSTEM").particle_system.settings
    settings.type, settings.count, settings.hair_length = "HAIR", 3, 1.0
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", source, 0.9


def _nodes(scene, source):
    """Points of Geometry Nodes that show an object."""
    thing = _maker(scene, [(-0.8, 0, 0.3), (0.7, 0.2, 0.5)], "GeometryNodeMeshCube")
    tree = thing.modifiers[0].node_group
    info = tree.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value, info.inputs["As Instance"].default_value = source, True
    copies = next(node for node in tree.nodes if node.bl_idname == "GeometryNodeInstanceOnPoints")
    copies.inputs["Scale"].default_value = (0.8, 0.9, 1.0)
    tree.links.new(info.outputs["Geometry"], copies.inputs["Instance"])


def _vertices(scene, source):
    """The vertices of a triangle, which show its child."""
    points = parts.mesh_from_points("Points", [(-0.8, 0, 0.3), (0.7, 0.2, 0.5), (0.1, 0.0, 1.4)], [])
    thing = parts.place(scene, "Points", points)
    thing.instance_type = "VERTS"
    source.parent = thing
    source.scale = 3 * [0.9]


@variants(
    values={"particles": _particles, "nodes": _nodes, "vertices": _vertices},
    quick=True,
    since=(4, 5),
    limit=(0.01, 0.2),
    reason="Cycles stitches facets along the shorter diagonals of the surface, Lancer along those of its coordinates; by the "
    "places of the instances the difference would be 1.1 % in the mean and 30 % in the worst blocks",
)
def subdivided_instances_by(scene, make):
    """Instances of a flat body far behind the camera, by whose own place it is divided: the facets are seen."""

    mesh = parts.cube_mesh("Body", 1.0)
    source = parts.place(scene, "Body", mesh, _of_coordinate("Normal"), (0.0, 3.0, -2.0))
    source.scale = (0.9, 1.0, 1.1)
    divide(scene, source, 5.0)
    make(scene, source)
    _seen(scene)


def _bent(scene, surface):
    """A smooth bar whose upper end is moved and turned by a modifier, and so is no more in its undeformed place."""

    def make(bm):
        bmesh.ops.create_cube(bm, size=1.0)
        bmesh.ops.subdivide_edges(bm, edges=bm.edges[:], cuts=2, use_grid_fill=True)
        for vertex in bm.verts:
            vertex.co.z *= 1.6

    thing = parts.place(scene, "Bar", parts.mesh_from_bmesh("Bar", make, True), surface, (0, 0, 0.9))
    thing.rotation_euler = (0.2, 0.1, 0.5)
    bend = thing.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.deform_axis, bend.angle = "BEND", "Y", 1.2
    return thing


@variants(values={"smooth": "CATMULL_CLARK", "simple": "SIMPLE"}, quick=True)
def subdivided_generated_of_deformed(scene, kind):
    """Generated coordinates are those before modifiers that deform."""
    divide(scene, _bent(scene, _of_coordinate("Generated")), kind=kind)
    _seen(scene)


@case()
def subdivided_generated_of_armature(scene):
    """The upper half of a bar is turned by a bone."""
    frame = bpy.data.armatures.new("Frame")
    holder = parts.place(scene, "Frame", frame, location=(0, 0, 0.9))
    thing = _bent(scene, _of_coordinate("Generated"))
    thing.modifiers.clear()
    bpy.context.view_layer.objects.active = holder
    bpy.ops.object.mode_set(mode="EDIT")
    bone = frame.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    group = thing.vertex_groups.new(name="Bone")
    group.add([vertex.index for vertex in thing.data.vertices if vertex.co.z > 0.0], 1.0, "REPLACE")
    holder.pose.bones["Bone"].rotation_mode = "XYZ"
    holder.pose.bones["Bone"].rotation_euler = (0.5, 0.7, 0.2)
    thing.modifiers.new("Armature", "ARMATURE").object = holder
    divide(scene, thing)
    _seen(scene)


@variants(values={"displaced": ("DISPLACE", {"strength": 0.5}, 1.0), "repeated": ("ARRAY", {"count": 2}, 0.6)})
def subdivided_generated_of(scene, choice):
    """Vertices that move along their normals, and vertices that a modifier adds, which have the coordinates of its copies."""
    kind, settings, scale = choice
    thing = _bent(scene, _of_coordinate("Generated"))
    thing.modifiers.clear()
    modifier = thing.modifiers.new("Modifier", kind)
    for name, value in settings.items():
        setattr(modifier, name, value)
    thing.scale = 3 * [scale]
    divide(scene, thing)
    _seen(scene)


def _radial(nodes):
    return nodes.add("ShaderNodeTangent", props={"direction_type": "RADIAL", "axis": "Z"}).outputs[0]


def _of_uv_map(nodes):
    return nodes.add("ShaderNodeTangent", props={"direction_type": "UV_MAP"}).outputs[0]


def _of_geometry(nodes):
    return nodes.add("ShaderNodeNewGeometry").outputs["Tangent"]


@variants(values={"radial": _radial, "uv_map": _of_uv_map, "geometry": _of_geometry}, quick=True)
def subdivided_tangents_without_map(scene, tangent):
    """Tangents of a deformed mesh without a UV map."""

    def build(nodes):
        half = nodes.add("ShaderNodeVectorMath", props={"operation": "MULTIPLY_ADD"})
        nodes.tree.links.new(tangent(nodes), half.inputs[0])
        half.inputs[1].default_value = half.inputs[2].default_value = (0.5, 0.5, 0.5)
        return nodes.add("ShaderNodeEmission", Color=half.outputs[0])

    divide(scene, _bent(scene, material(build)))
    _seen(scene)


@case("LOBES", bounces=1)
def subdivided_brushed_without_map(scene):
    """Anisotropic metal without a UV map, whose tangents run around its Generated coordinates."""

    def build(nodes):
        return nodes.add("ShaderNodeBsdfPrincipled", Base_Color=(0.8, 0.7, 0.6), Metallic=1.0, Roughness=0.35, Anisotropic=0.8)

    divide(scene, _bent(scene, material(build)))
    parts.add_light(scene, "Sun", "SUN", 2.5, (1.5, -1.0, 1.2), angle=0.2)
    _seen(scene)
