"""Lamps whose nodes say how strong they shine: slides, photometric files, and what nodes know of a lamp."""

import bpy

from .. import parts
from . import images
from .catalogue import case, variants
from .nodes import Nodes, shader
from .stages import camera, floor, floor_and_block, sky

_UVS_SINCE = (4, 0)
_KINDS = {
    "point": ("POINT", 300.0, {"shadow_soft_size": 0.2}),
    "spot": ("SPOT", 500.0, {"spot_size": 1.1, "spot_blend": 0.2, "shadow_soft_size": 0.1}),
    "sun": ("SUN", 3.0, {"angle": 0.9}),
    "area": ("AREA", 150.0, {"shape": "RECTANGLE", "size": 1.6, "size_y": 0.9}),
}
# Angles in degrees, and intensities for each horizontal angle; of type C one quadrant, half a circle, or all around.
_FILES = {
    "round": (1, (0, 15, 30, 45, 60, 90), (0,), 800.0),
    "quadrant": (1, (0, 20, 40, 60, 80, 90), (0, 30, 60, 90), 600.0),
    "half": (1, (0, 30, 60, 90, 120, 150, 180), (0, 45, 90, 135, 180), 400.0),
    "type_b": (2, (0, 15, 30, 45, 90), (-90, -45, 0, 45, 90), 500.0),
}


def _lit(scene, kind, build, location=(0.9, -0.8, 2.4), **settings):
    """A lamp of that kind over a floor with a block, its strength given by build(nodes); returns the lamp."""
    floor_and_block(scene)
    return _lamp(scene, kind, build, location, **settings)


def _lamp(scene, kind, build, location, **settings):
    name, energy, given = _KINDS[kind]
    thing = parts.add_light(scene, "Light", name, settings.pop("energy", energy), location, **{**given, **settings})
    thing.data.use_nodes = True
    tree = thing.data.node_tree
    tree.nodes.clear()
    nodes = Nodes(tree)
    color, strength = build(nodes)
    emission = nodes.add("ShaderNodeEmission", Color=color, Strength=strength)
    nodes.link(emission, nodes.add("ShaderNodeOutputLight").inputs["Surface"])
    return thing


def _slide(nodes):
    picture = nodes.add("ShaderNodeTexImage", nodes.add("ShaderNodeTexCoord").outputs["UV"])
    picture.image = images.gradient()
    return picture.outputs["Color"], 1.5


@variants(values={name: name for name in _KINDS}, bounces=0, since=_UVS_SINCE)
def lamp_slide(scene, kind):
    """A picture by the lamp's own coordinates."""
    _lit(scene, kind, _slide)


@variants(values={"mirror": 0.0, "rough": 0.3}, since=_UVS_SINCE)
def lamp_slide_in(scene, roughness):
    """A lamp with a picture, which a plate and the camera see."""
    glossy = shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=roughness)
    parts.place(scene, "Plate", parts.plane_mesh("Plate", 8.0), glossy)
    lamp = _lamp(scene, "area", _slide, (0.2, 1.2, 1.4))
    lamp.visible_camera = True
    sky(scene, (0.1, 0.1, 0.1), 1.0)
    camera(scene, (0, -4.0, 1.6), (0, 0, 0.7))


_OUTPUTS = ("Generated", "Normal", "Object", "Camera", "Reflection")


@variants(values={f"{kind}_{name.lower()}": (kind, name) for kind in ("point", "area") for name in _OUTPUTS}, bounces=0)
def lamp_coordinate(scene, value):
    kind, output = value

    def build(nodes):
        source = nodes.add("ShaderNodeTexCoord").outputs[output]
        return nodes.add("ShaderNodeVectorMath", source, (0.4,) * 3, (0.6,) * 3, props={"operation": "MULTIPLY_ADD"}), 1.0

    lamp = _lit(scene, kind, build)
    lamp.scale = 1.3, 0.8, 1.0


@variants(
    values={name.lower().replace(" ", "_"): name for name in ("Position", "Normal", "Incoming", "Parametric", "Backfacing")},
    bounces=0,
    since=_UVS_SINCE,
)
def lamp_geometry(scene, output):
    def build(nodes):
        source = nodes.add("ShaderNodeNewGeometry").outputs[output]
        return nodes.add("ShaderNodeVectorMath", source, (0.4,) * 3, (0.6,) * 3, props={"operation": "MULTIPLY_ADD"}), 1.0

    _lit(scene, "spot", build)


@variants(
    values={"location": "Location", "color": "Color", "index": "Object Index", "random": "Random"}, bounces=0, size=(64, 48)
)
def lamp_object_info(scene, output):
    def build(nodes):
        found = nodes.add("ShaderNodeObjectInfo").outputs[output]
        return nodes.add("ShaderNodeVectorMath", found, (0.2,) * 3, (0.4,) * 3, props={"operation": "MULTIPLY_ADD"}), 1.0

    lamp = _lit(scene, "point", build)
    lamp.color, lamp.pass_index = (0.9, 0.4, 0.2, 1.0), 3


@variants(
    values={f"{kind}_{output.lower()}": (kind, output) for kind in ("point", "area") for output in ("Linear", "Constant")},
    bounces=0,
)
def lamp_falloff(scene, value):
    kind, output = value

    def build(nodes):
        return (0.9, 0.8, 0.6), nodes.add("ShaderNodeLightFalloff", 0.3, 0.5).outputs[output]

    _lit(scene, kind, build)


@variants(values={"depth": "Ray Depth", "camera": "Is Camera Ray", "shadow": "Is Shadow Ray", "diffuse": "Is Diffuse Ray"})
def lamp_light_path(scene, output):
    """A lamp in view, and lit walls that light each other."""

    def build(nodes):
        fact = nodes.add("ShaderNodeLightPath").outputs[output]
        return (0.9, 0.8, 0.6), nodes.add("ShaderNodeMath", fact, 0.6, 0.5, props={"operation": "MULTIPLY_ADD"})

    floor(scene)
    wall = parts.plane_mesh("Wall", 4.0)
    parts.place(
        scene, "Wall", wall, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.5, 0.3)), (0, 1.5, 1.5), rotation=(1.57, 0, 0)
    )
    lamp = _lamp(scene, "area", build, (0.6, 0.2, 2.0), size=0.8, size_y=0.8)
    lamp.visible_camera = True
    camera(scene, (0, -4.5, 1.8), (0, 0, 0.8))


def _photometry(name):
    """The text of a photometric file."""
    kind, v, h, candela = _FILES[name]
    rows = [[candela * (1.0 - 0.8 * i / len(v)) * (1.0 + 0.3 * k) for i in range(len(v))] for k in range(len(h))]
    lines = ["IESNA:LM-63-1995", "[TEST] made", "TILT=NONE", f"1 1000 1.2 {len(v)} {len(h)} {kind} 2 0 0 0", "1.0 0.9 100"]
    lines += [" ".join(map(str, v)), ",".join(map(str, h)), *(" ".join(f"{x:.2f}" for x in row) for row in rows)]
    text = bpy.data.texts.new(name)
    text.write("\n".join(lines) + "\n")
    return text


def _luminaire(nodes, name, turned=False):
    inputs = {}
    if turned:
        place = nodes.add("ShaderNodeTexCoord").outputs["Normal"]
        inputs["Vector"] = nodes.add("ShaderNodeMapping", place, Rotation=(0.3, 0.2, 0.5))
    node = nodes.add("ShaderNodeTexIES", props={"mode": "INTERNAL"}, Strength=0.01, **inputs)
    node.ies = _photometry(name)
    return (1.0, 0.9, 0.8), node


@variants(values={name: (name, {"quick": name == "quadrant"}) for name in _FILES}, bounces=0)
def lamp_ies(scene, name):
    _lit(scene, "point", lambda nodes: _luminaire(nodes, name, True), energy=200.0)


# Before 4.0 an area lamp is seen from its axis alone, around which the horizontal angle is arbitrary.
@variants(values={"spot": "spot", "area": ("area", {"since": (4, 0)})}, bounces=0)
def lamp_ies_of(scene, kind):
    """By the default vector."""
    _lit(scene, kind, lambda nodes: _luminaire(nodes, "half")).rotation_euler = 0.4, 0.3, 0.5


@case(bounces=0)
def lamp_ies_without_file(scene):
    _lit(scene, "point", lambda nodes: ((0.9, 0.8, 0.7), nodes.add("ShaderNodeTexIES", Strength=0.01)))


@case()
def lamps_with_nodes(scene):
    """Many lamps, some with nodes, between which sampling chooses."""
    floor_and_block(scene)
    for number in range(12):
        place = (number % 4 - 1.5, number // 4 - 1.2, 1.6 + 0.2 * (number % 3))
        if number % 3 == 0:
            _lamp(scene, "point", lambda nodes: _luminaire(nodes, "round", True), place, energy=40.0).name = f"Lamp {number}"
        else:
            parts.add_light(scene, f"Lamp {number}", "POINT", 4.0 + number, place, shadow_soft_size=0.1)
