"""Properties of objects, instancers, the view layer, lamps and the sky, which the Attribute node reads by name."""

import bpy

from .. import parts
from .boards import output_of, set_board, shining, size_of, tile_mesh, view_board
from .catalogue import case
from .nodes import material, world
from .stages import camera, card

_OUTPUTS = ("Color", "Vector", "Fac", "Alpha")
_PROPERTIES = {
    "real": 0.3, "whole": 2, "switch": True, "word": "word", "one": [0.7], "two": [0.1, 0.2], "three": [0.1, 0.2, 0.3],
    "four": [0.1, 0.2, 0.3, 0.4], "five": [0.1, 0.2, 0.3, 0.4, 0.5], "wholes": [1, 0, 2], "switches": [True, False, True],
    "group": {"inside": 0.35}, "with space": 0.6, "of both": "word", "rotation_quaternion": "word",
}  # fmt: skip
_PATHS = (
    '["real"]', '["group"]["inside"]', '["three"][1]', "color", "color[0]", "pass_index", "hide_select", "scale", "scale.z",
    "name", "matrix_world", "data", 'data["of both"]', "data.texspace_location", "material_slots[0].material.roughness",
    "texspace_location", "of mesh", "missing", "",
)  # fmt: skip


def _reader(kind, name, output="Color"):
    return output_of("ShaderNodeAttribute", output, {"attribute_type": kind, "attribute_name": name})


def with_alpha(kind, name):
    """The colour plus a share of its alpha, in one tile."""

    def value(nodes):
        node = nodes.add("ShaderNodeAttribute", props={"attribute_type": kind, "attribute_name": name})
        alpha = nodes.add("ShaderNodeMath", node.outputs["Alpha"], 0.3, props={"operation": "MULTIPLY"})
        sum_ = nodes.add("ShaderNodeVectorMath", node.outputs["Color"], alpha, props={"operation": "ADD"})
        return nodes.add("ShaderNodeMixRGB", 0.0, sum_.outputs[0], (0, 0, 0)).outputs[0]

    return value


def _fill(thing):
    for name, value in _PROPERTIES.items():
        thing[name] = value
    thing.color, thing.pass_index, thing.hide_select, thing.scale = (0.2, 0.4, 0.6, 0.8), 2, True, (1, 1, 2)
    thing.data["of mesh"], thing.data["of both"], thing.data["real"] = 0.45, 0.55, 0.95


@case(size=size_of((len(_PROPERTIES) + len(_PATHS)) * len(_OUTPUTS)), bounces=0, quick=True)
def property_of_object(scene):
    """Custom properties of each type, and paths, by each output."""
    names = (*_PROPERTIES, *_PATHS)
    for thing in set_board(scene, [(tile_mesh(), _reader("OBJECT", name, output)) for name in names for output in _OUTPUTS]):
        _fill(thing)


# ---- instancers ----


def source_object(scene, mesh, parent=None):
    thing = bpy.data.objects.new("Source", mesh)
    scene.collection.objects.link(thing)
    thing.parent = parent
    thing.color = (0.1, 0.2, 0.3, 0.4)
    thing.pass_index = 3
    thing["of both"], thing["of object"] = 0.7, 0.35
    if mesh is not None:
        mesh["of data"], mesh["of both data"] = 0.5, 0.55
    return thing


def instancer(scene, place, mesh=None):
    thing = bpy.data.objects.new("Instancer", mesh)
    scene.collection.objects.link(thing)
    thing.location, thing.color, thing.pass_index = place, (0.6, 0.7, 0.8, 0.9), 2
    thing["of both"], thing["of instancer"], thing["of both data"] = 0.2, 0.25, 0.15
    if mesh is not None:
        mesh["of instancer's data"] = 0.65
    return thing


def _alone(scene, place, shown):
    source_object(scene, covered(tile_mesh(), shown)).location = place


def _curve(scene, place, shown):
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions, curve.fill_mode = "2D", "BOTH"
    spline = curve.splines.new("POLY")
    spline.points.add(3)
    spline.use_cyclic_u = True
    for point, (x, y) in zip(spline.points, ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)), strict=True):
        point.co = x, y, 0, 1
    source_object(scene, covered(curve, shown)).location = place


def _collection(scene, place, shown):
    group = bpy.data.collections.new("Group")
    thing = source_object(scene, covered(tile_mesh(), shown))
    scene.collection.objects.unlink(thing)
    group.objects.link(thing)
    maker = instancer(scene, place)
    maker.instance_type, maker.instance_collection = "COLLECTION", group


def _collection_twice(scene, place, shown):
    """The instancer of an instance is the outer one."""
    _collection(scene, place, shown)
    inner = scene.collection.objects[-1]
    scene.collection.objects.unlink(inner)
    inner.location = 0, 0, 0
    inner["of object"], inner["of both"] = 0.85, 0.95
    group = bpy.data.collections.new("Outer group")
    group.objects.link(inner)
    maker = instancer(scene, place)
    maker.instance_type, maker.instance_collection = "COLLECTION", group


def _vertices(scene, place, shown):
    mesh = parts.mesh_from_points("Seat", [(0, 0, 0)], [])
    maker = instancer(scene, place, mesh)
    maker.instance_type = "VERTS"
    source_object(scene, covered(tile_mesh(), shown), maker)


def _faces(scene, place, shown):
    mesh = parts.plane_mesh("Seat", 0.1)
    maker = instancer(scene, place, mesh)
    maker.instance_type, maker.show_instancer_for_render = "FACES", False
    source_object(scene, covered(tile_mesh(), shown), maker)


def _particles(scene, place, shown):
    """A cube, which looks the same from above whichever way particles turn it."""
    mesh = parts.mesh_from_points("Seat", [(0, 0, 0), (0.001, 0, 0), (0, 0.001, 0)], [(0, 1, 2)])
    maker = instancer(scene, place, mesh)
    maker.show_instancer_for_render = False
    source = source_object(scene, covered(parts.cube_mesh("Cube", 1.0), shown))
    source.location = (0, -50, 0)
    maker.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = maker.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 1, 0, 0, 100
    settings.physics_type, settings.emit_from = "NO", "VERT"
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", source, 1.0
    settings["of settings"], settings["of both data"] = 0.75, 0.85


def covered(data, shown):
    data.materials.append(shown)
    return data


_MAKERS = (_alone, _curve, _collection, _collection_twice, _vertices, _faces, _particles)
_NAMES = (
    "of both", "of object", "of data", "of both data", "of instancer", "of instancer's data", "of settings", "color",
    "pass_index", "instance_faces_scale", "missing",
)  # fmt: skip
_KINDS = ("OBJECT", "INSTANCER")


@case(size=size_of(len(_MAKERS) * len(_NAMES) * len(_KINDS)), bounces=0, quick=True)
def property_of_instancer(scene):
    """Each way to make instances by each place in which a property is looked for."""
    looks = [(make, kind, name) for make in _MAKERS for kind in _KINDS for name in _NAMES]
    for number, (make, kind, name) in enumerate(looks):
        make(scene, (number % 8 + 0.5, number // 8 + 0.5, 0.0), shining(with_alpha(kind, name)))
    view_board(scene, len(looks))


# ---- the view layer, lamps and the world ----

_OF_SCENE = (
    "of layer", "of scene", "of world", "of two", "of all", "color", "pass_alpha_threshold", "frame_current", "world.color",
    "render.film_transparent", '["of scene"]', 'world["of world"]', "samples", "missing", "",
)  # fmt: skip


@case(size=size_of(len(_OF_SCENE) * len(_OUTPUTS)), bounces=0, quick=True)
def property_of_view_layer(scene):
    """Of the layer, else of the scene, else of its world."""
    set_board(scene, [(tile_mesh(), _reader("VIEW_LAYER", name, output)) for name in _OF_SCENE for output in _OUTPUTS])
    layer, sky = bpy.context.view_layer, scene.world
    layer["of layer"], layer["of two"], layer["of all"] = [0.1, 0.2, 0.3], "word", 0.4
    scene["of scene"], scene["of two"], scene["of all"], scene["samples"] = [0.1, 0.2, 0.3, 0.4], 0.5, 0.6, 0.9
    sky["of world"], sky["of two"], sky["of all"] = 0.7, 0.8, 0.9
    sky.color = (0.2, 0.4, 0.6)


@case(bounces=0, quick=True)
def property_of_lamp(scene):
    """A lamp is an object from Blender 4.5 on; before, nothing is found."""
    card(scene, material(lambda nodes: nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8))))
    sun = parts.add_light(scene, "Sun", "SUN", 3.0, (0, 0, 3))
    sun["tint"], sun.data["strength"], sun.data.angle = [0.2, 0.5, 0.8, 0.4], 0.7, 0.0
    scene["tint"] = 0.1
    if bpy.app.version < (5, 2):
        sun.data.use_nodes = True
    tree = sun.data.node_tree
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    for socket, kind, name, output in (("Color", "OBJECT", "tint", "Color"), ("Strength", "INSTANCER", "strength", "Alpha")):
        node = tree.nodes.new("ShaderNodeAttribute")
        node.attribute_type, node.attribute_name = kind, name
        tree.links.new(node.outputs[output], emission.inputs[socket])


@case(bounces=0, quick=True)
def property_of_sky(scene):
    """The world is no object, but has the properties of the scene."""
    scene["tint"] = [0.6, 0.3, 0.2, 0.4]

    def build(nodes):
        of_object = nodes.add("ShaderNodeAttribute", props={"attribute_type": "OBJECT", "attribute_name": "color"})
        of_layer = nodes.add("ShaderNodeAttribute", props={"attribute_type": "VIEW_LAYER", "attribute_name": "tint"})
        sum_ = nodes.add(
            "ShaderNodeVectorMath", of_object.outputs["Color"], of_layer.outputs["Color"], props={"operation": "ADD"}
        )
        return nodes.add("ShaderNodeBackground", Color=sum_.outputs[0], Strength=of_object.outputs["Alpha"])

    world(scene, build)
    camera(scene, (0, -4.5, 1.8), (0, 0, 0.6))
