"""Nodes that look around a surface by rays: Ambient Occlusion, Bevel, Raycast."""

import bpy
import numpy as np

from .. import parts
from .catalogue import case, variants
from .nodes import material, shader
from .stages import camera, floor, lamp, sky, studio


def _still_life(scene, surface):
    """Things of one surface that nearly touch: a floor, a block, a ball, and a second block of the same mesh.

    No face lies in the plane of another: Cycles lets such faces shadow each other."""
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 8.0), surface)
    block = parts.cube_mesh("Block", 1.0)
    parts.place(scene, "Block", block, surface, (-0.5, 0.1, 0.52), rotation=(0, 0, 0.4))
    parts.place(scene, "Copy", block, surface, (0.55, 0.9, 0.6), rotation=(0.6, 0.3, 0.2))
    parts.place(scene, "Ball", parts.sphere_mesh("Ball"), surface, (0.75, -0.1, 0.4), 0.4)
    camera(scene, (0.4, -3.6, 2.4), (0.1, 0.2, 0.35), lens=55.0)


def _glow(color):
    """A material that shines in what color(nodes) gives; a vector is brought to 0 ... 1."""

    def surface(nodes):
        value = color(nodes)
        if value.type == "VECTOR":
            half = (0.5, 0.5, 0.5)
            value = nodes.add("ShaderNodeVectorMath", value, half, half, props={"operation": "MULTIPLY_ADD"}).outputs[0]
        return nodes.add("ShaderNodeEmission", Color=value)

    return material(surface)


def _waves(nodes, strength=0.6, normal=None):
    """A normal that a texture bumps."""
    where = nodes.add("ShaderNodeTexCoord").outputs["Object"]
    height = nodes.add("ShaderNodeTexNoise", Vector=where, Scale=3.0, Detail=0.0).outputs[0]
    more = {} if normal is None else {"Normal": normal}
    return nodes.add("ShaderNodeBump", Strength=strength, Distance=0.3, Height=height, **more).outputs[0]


def _varied(nodes):
    """A number between 0 and 1 that varies along the surface."""
    where = nodes.add("ShaderNodeTexCoord").outputs["Object"]
    return nodes.add("ShaderNodeTexNoise", Vector=where, Scale=2.0, Detail=0.0).outputs[0]


# ---- Ambient Occlusion ----


def _occlusion(output="AO", props=None, **inputs):
    def value(nodes):
        given = {name: make(nodes) if callable(make) else make for name, make in inputs.items()}
        return nodes.add("ShaderNodeAmbientOcclusion", props=props, **given).outputs[output]

    return value


@variants(
    values={
        "plain": (_occlusion(), {"quick": True}),
        "near": _occlusion(Distance=0.2, props={"samples": 4}),
        "far": _occlusion("Color", Distance=100.0, Color=(0.8, 0.5, 0.3)),
        "of_world": _occlusion(Distance=0.0),
        "inside": (_occlusion(Distance=0.7, props={"inside": True}), {"quick": True}),
        "local": (_occlusion(props={"only_local": True}), {"quick": True}),
        "local_inside": _occlusion(props={"only_local": True, "inside": True}),
        "bumped": (_occlusion(Normal=_waves), {"quick": True}),
        "varied": _occlusion("Color", Distance=_varied, Color=lambda nodes: nodes.add("ShaderNodeTexCoord").outputs["Object"]),
    },
    bounces=0,
)
def occlusion(scene, value):
    _still_life(scene, _glow(value))
    sky(scene)
    scene.world.light_settings.distance = 0.4
    bpy.data.objects["Copy"].visible_shadow = False


@case(quick=True)
def occlusion_in_diffuse(scene):
    """The share mixes the colours of diffuse surfaces, which scatter it on."""

    def surface(nodes):
        share = _occlusion(Distance=0.6)(nodes)
        color = nodes.add("ShaderNodeMixRGB", share, (0.7, 0.2, 0.05), (0.3, 0.5, 0.7)).outputs[0]
        return nodes.add("ShaderNodeBsdfDiffuse", Color=color)

    _still_life(scene, material(surface))
    lamp(scene)
    sky(scene)


@case()
def occlusion_seen_through(scene):
    """It decides what is transparent; shadows take every surface as open, and a mirror shows the same."""

    def surface(nodes):
        clear = nodes.add("ShaderNodeBsdfTransparent", Color=(0.9, 0.6, 0.3))
        matt = nodes.add("ShaderNodeBsdfDiffuse", Color=(0.4, 0.6, 0.8))
        return nodes.add("ShaderNodeMixShader", _occlusion(Distance=0.6)(nodes), matt, clear)

    _still_life(scene, material(surface))
    mirror = shader("ShaderNodeBsdfGlossy", {"distribution": "GGX"}, Color=(0.8, 0.8, 0.8), Roughness=0.0)
    parts.place(scene, "Mirror", parts.plane_mesh("Mirror", 6.0), mirror, (0, 2.4, 1.0), rotation=(1.5708, 0, 0))
    lamp(scene)
    sky(scene)


@case(quick=True, bounces=0)
def occlusion_of_instances(scene):
    """Instances of a collection, of which each is an object of its own, one of them mirrored."""
    source = bpy.data.collections.new("Source")
    surface = _glow(_occlusion(props={"only_local": True}, Distance=0.8))
    for name, place in (("Block", (0, 0, 0.5)), ("Second", (0.3, -0.6, 0.3))):
        thing = parts.place(scene, name, parts.cube_mesh(name, 1.0), surface, place, rotation=(0, 0.3, 0.4))
        scene.collection.objects.unlink(thing)
        source.objects.link(thing)
    for number, scale in enumerate(((1, 1, 1), (-0.8, 0.9, 1.2))):
        empty = bpy.data.objects.new(f"Instance {number}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", source
        empty.location, empty.scale = (1.1 * number - 0.6, 0.3 * number, 0), scale
        scene.collection.objects.link(empty)
    sky(scene)
    camera(scene, (0.4, -3.8, 2.6), (0.1, 0, 0.4), lens=50.0)


@case(quick=True)
def occlusion_as_height(scene):
    """Rays do not follow the steps of a bump: the share scales the texture's height, and tilts nothing by itself."""

    def surface(nodes):
        share = _occlusion(Distance=0.6)(nodes)
        where = nodes.add("ShaderNodeTexCoord").outputs["Object"]
        waves = nodes.add("ShaderNodeTexNoise", Vector=where, Scale=3.0, Detail=0.0).outputs[0]
        height = nodes.add("ShaderNodeMath", share, waves, props={"operation": "MULTIPLY"})
        normal = nodes.add("ShaderNodeBump", Strength=1.0, Distance=0.5, Height=height)
        return nodes.add("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5), Normal=normal)

    _still_life(scene, material(surface))
    lamp(scene)
    sky(scene)


# ---- Bevel ----


def _bevel(nodes, radius=0.12, samples=8, **inputs):
    given = {name: make(nodes) if callable(make) else make for name, make in inputs.items()}
    return nodes.add("ShaderNodeBevel", props={"samples": samples}, Radius=radius, **given).outputs[0]


@variants(
    values={
        "plain": (lambda nodes: _bevel(nodes), {"quick": True}),
        "wide": lambda nodes: _bevel(nodes, 0.4, 16),
        "few_rays": lambda nodes: _bevel(nodes, 0.2, 2),
        "none": lambda nodes: _bevel(nodes, 0.0),
        "bumped": (lambda nodes: _bevel(nodes, Normal=_waves), {"quick": True}),
        "varied": lambda nodes: _bevel(nodes, _varied(nodes)),
    },
    bounces=0,
)
def bevel(scene, value):
    """Normals as colours, on faces, smooth surfaces and copies."""
    _still_life(scene, _glow(value))
    sky(scene)


def _block(scene, surface):
    """One block on a floor, large in the picture."""
    floor(scene)
    parts.place(scene, "Block", parts.cube_mesh("Block", 1.4), surface, (0, 0, 0.72), rotation=(0, 0, 0.6))
    lamp(scene)
    sky(scene)
    camera(scene, (0, -4.0, 2.6), (0, 0, 0.7), lens=60.0)


@variants(
    values={
        "diffuse": (("ShaderNodeBsdfDiffuse", {}, {}), {"quick": True}),
        "glossy": (("ShaderNodeBsdfGlossy", {"distribution": "GGX"}, {"Roughness": 0.3}), {}),
    },
)
def bevel_of(scene, value):
    kind, props, inputs = value

    def surface(nodes):
        return nodes.add(kind, props=props, Color=(0.7, 0.6, 0.5), Normal=_bevel(nodes, 0.2), **inputs)

    _block(scene, material(surface))


@case(bounces=0)
def bevel_under_displacement(scene):
    """A material that displacement bumps: the bevel replaces its normal, and is added to another."""

    def surface(nodes):
        where = nodes.add("ShaderNodeTexCoord").outputs["Object"]
        waves = nodes.add("ShaderNodeTexNoise", Vector=where, Scale=3.0, Detail=0.0).outputs[0]
        height = nodes.add("ShaderNodeDisplacement", Height=waves, Midlevel=0.5, Scale=0.2)
        left = nodes.add("ShaderNodeVectorMath", where, (1.0, 0.0, 0.0), props={"operation": "DOT_PRODUCT"}).outputs["Value"]
        side = nodes.add("ShaderNodeMath", left, 0.0, props={"operation": "GREATER_THAN"})
        normals = (_bevel(nodes, 0.2), _bevel(nodes, 0.2, Normal=(lambda n: _waves(n, 1.0))))
        half = (0.5, 0.5, 0.5)
        colors = [
            nodes.add("ShaderNodeVectorMath", normal, half, half, props={"operation": "MULTIPLY_ADD"}) for normal in normals
        ]
        return nodes.add("ShaderNodeEmission", Color=nodes.add("ShaderNodeMixRGB", side, *colors)), height

    _block(scene, material(surface))


@variants(values={"sharp": 0.0, "glossy": 0.2, "rough": 0.8}, quick=True)
def bevel_in_mirror(scene, roughness):
    """Edges are rounded in the camera's view and in sharp reflections alone."""
    glow = _glow(lambda nodes: _bevel(nodes, 0.25))
    parts.place(scene, "Block", parts.cube_mesh("Block", 1.0), glow, (0, 0, 0.52), rotation=(0, 0, 0.6))
    mirror = shader("ShaderNodeBsdfGlossy", {"distribution": "GGX"}, Color=(0.8, 0.8, 0.8), Roughness=roughness)
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 20.0), mirror)
    sky(scene)
    camera(scene, (0, -3.6, 1.6), (0, 0, 0.2), lens=55.0)


# ---- Raycast ----

_SINCE = (5, 2)


def _cast(output, only_local=False, **inputs):
    def value(nodes):
        given = {name: make(nodes) if callable(make) else make for name, make in inputs.items()}
        node = nodes.add("ShaderNodeRaycast", props={"only_local": only_local}, **given)
        return next(socket for socket in node.outputs if socket.name == output)

    return value


def _reflection(nodes):
    return nodes.add("ShaderNodeTexCoord").outputs["Reflection"]


def _beside(nodes):
    """The place moved off the surface."""
    place = nodes.add("ShaderNodeNewGeometry").outputs["Position"]
    return nodes.add("ShaderNodeVectorMath", place, (0.1, -0.2, 0.3), props={"operation": "ADD"}).outputs[0]


@variants(
    values={
        "hit": _cast("Is Hit"),
        "self": _cast("Self Hit", Direction=(0.2, 0.3, -1.0), Length=5.0),
        "distance": (_cast("Hit Distance", Direction=_reflection), {"quick": True}),
        "place": _cast("Hit Position", Direction=_reflection, Length=3.0),
        "normal": (_cast("Hit Normal", Direction=_reflection, Length=3.0), {"quick": True}),
        "beside": (_cast("Hit Distance", Position=_beside, Direction=(0.3, 0.8, -0.6)), {"quick": True}),
        "local": (_cast("Hit Distance", True, Direction=(-0.4, 0.6, -0.5)), {"quick": True}),
        "long": _cast("Hit Distance", Direction=(1.0, 1.0, 1.5), Length=0.6),
        "bumped": _cast("Hit Normal", Direction=lambda nodes: _waves(nodes), Length=2.0),
    },
    since=_SINCE,
    bounces=0,
)
def raycast_value(scene, value):
    _still_life(scene, _glow(value))
    sky(scene)


@variants(values={"number": "FLOAT", "color": "RGBA", "alpha": "ALPHA"}, since=_SINCE, bounces=0)
def raycast_attribute(scene, kind):
    """Attributes of other objects, whose own materials do not read them."""

    def value(nodes):
        node = nodes.add("ShaderNodeRaycast", Direction=_reflection(nodes), Length=6.0)
        node.sample_attribute_items.new("RGBA" if kind == "ALPHA" else kind, "Tint")
        next(socket for socket in node.inputs if socket.identifier == "Value_0").default_value = "Tint"
        wanted = "Attribute_0_Alpha" if kind == "ALPHA" else "Attribute_0"
        return next(socket for socket in node.outputs if socket.identifier == wanted)

    _still_life(scene, _glow(value))
    for thing in scene.objects:
        if thing.type == "MESH" and "Tint" not in thing.data.attributes:
            tint = thing.data.attributes.new("Tint", "FLOAT_COLOR", "CORNER")
            values = np.random.default_rng(len(thing.data.loops)).uniform(0.1, 0.9, (len(thing.data.loops), 4))
            tint.data.foreach_set("color", values.reshape(-1))
    sky(scene)


@variants(values={"in_diffuse": (True, {"quick": True}), "past_hidden": False}, since=_SINCE)
def raycast(scene, is_visible):
    """A mirror made of a ray, whose hit normal colours diffuse surfaces. Cycles 5.2.3 shows it hidden objects, too."""

    def surface(nodes):
        color = nodes.add(
            "ShaderNodeVectorMath",
            _cast("Hit Normal", Direction=_reflection, Length=4.0)(nodes),
            (0.4, 0.4, 0.4),
            (0.5, 0.5, 0.5),
            props={"operation": "MULTIPLY_ADD"},
        )
        return nodes.add("ShaderNodeBsdfDiffuse", Color=color)

    _still_life(scene, material(surface))
    bpy.data.objects["Copy"].visible_raycast = is_visible
    lamp(scene)
    sky(scene)


@case(since=_SINCE)
def raycast_as_height(scene):
    """The rays of a bump begin beyond its step, so that a curved surface does not hide itself."""

    def surface(nodes):
        distance = _cast("Hit Distance", Direction=(0.2, 0.1, 1.0), Length=3.0)(nodes)
        normal = nodes.add("ShaderNodeBump", Strength=1.0, Distance=0.2, Height=distance)
        return nodes.add("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5), Normal=normal)

    thing = studio(scene, material(surface))
    roof = parts.sphere_mesh("Roof", 64, 32, 3.0)
    parts.place(scene, "Roof", roof, shader("ShaderNodeBsdfDiffuse", Color=(0.2, 0.3, 0.4)), (0, 0, 5.0)).visible_shadow = False
    thing.rotation_euler = (0.1, 0.2, 0.3)
