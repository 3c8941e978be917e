"""Procedural textures, curves, and nodes about the object and the path of a ray."""

import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import find, material, world
from .stages import ball, camera, card, floor, lamp, sky

_MUSGRAVE_IS_NOISE = (4, 1)  # the first Blender in which it is a kind of the Noise Texture
_CELLS_HAVE_OCTAVES = (4, 0)
_KINDS = ("FBM", "MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN")
_RAYS = ("Camera", "Diffuse", "Glossy", "Singular", "Reflection", "Transmission")
_DEPTHS = ("Ray", "Diffuse", "Glossy", "Transmission")


def _shown(scene, build):
    """Shows a colour on a card; build(nodes, vector) returns it."""

    def surface(nodes):
        return nodes.add("ShaderNodeEmission", Color=build(nodes, nodes.add("ShaderNodeTexCoord").outputs["Object"]))

    return card(scene, material(surface))


@variants(values={"1d": "1D", "2d": "2D", "3d": "3D", "4d": "4D"})
def noise(scene, dimensions):
    def build(nodes, vector):
        texture = nodes.add("ShaderNodeTexNoise", props={"noise_dimensions": dimensions})
        if dimensions != "1D":
            nodes.link(vector, find(texture.inputs, "Vector"))
        if dimensions in ("1D", "4D"):
            nodes.link(nodes.add("ShaderNodeSeparateXYZ", vector).outputs["Y"], find(texture.inputs, "W"))
        for name, value in {"Scale": 2.0, "Detail": 2.5, "Roughness": 0.6, "Distortion": 0.7}.items():
            find(texture.inputs, name).default_value = value
        return texture.outputs["Color"]

    _shown(scene, build)


@variants(
    since=_MUSGRAVE_IS_NOISE,
    values={name.lower(): name for name in _KINDS[1:]},
)
def noise_kind(scene, kind):
    def build(nodes, vector):
        props = {"noise_type": kind}
        return nodes.add("ShaderNodeTexNoise", props=props, Vector=vector, Scale=1.0, Detail=1.5).outputs["Fac"]

    _shown(scene, build)


@variants(
    until=_MUSGRAVE_IS_NOISE,
    values={name.lower(): name for name in _KINDS},
)
def musgrave(scene, kind):
    def build(nodes, vector):
        props = {"musgrave_type": kind}
        texture = nodes.add("ShaderNodeTexMusgrave", props=props, Vector=vector, Scale=1.5, Detail=3.3, Dimension=0.8)
        return nodes.add("ShaderNodeMath", texture, 0.5, props={"operation": "ADD"})

    _shown(scene, build)


@variants(values={name.lower(): name for name in ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS")})
def voronoi(scene, feature):
    def build(nodes, vector):
        texture = nodes.add("ShaderNodeTexVoronoi", props={"feature": feature}, Vector=vector, Scale=1.3)
        return next(socket for socket in texture.outputs if socket.enabled)

    _shown(scene, build)


@variants(values={name.lower(): name for name in ("MANHATTAN", "CHEBYCHEV", "MINKOWSKI")})
def voronoi_metric(scene, metric):
    def build(nodes, vector):
        return nodes.add("ShaderNodeTexVoronoi", props={"distance": metric}, Vector=vector, Scale=1.3).outputs["Color"]

    _shown(scene, build)


@case(since=_CELLS_HAVE_OCTAVES)
def voronoi_octaves(scene):
    def build(nodes, vector):
        props = {"normalize": True}
        texture = nodes.add("ShaderNodeTexVoronoi", props=props, Vector=vector, Scale=0.8, Detail=2.4, Roughness=0.6)
        return texture.outputs["Distance"]

    _shown(scene, build)


@variants(
    values={
        name.lower(): name for name in ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL")
    }
)
def gradient(scene, kind):
    def build(nodes, vector):
        return nodes.add("ShaderNodeTexGradient", props={"gradient_type": kind}, Vector=vector).outputs["Fac"]

    _shown(scene, build)


@variants(values={"rgb": "ShaderNodeRGBCurve", "vector": "ShaderNodeVectorCurve", "float": "ShaderNodeFloatCurve"})
def curves(scene, kind):
    def build(nodes, vector):
        node = nodes.add(kind)
        for number, curve in enumerate(node.mapping.curves):
            curve.points.new(0.3, 0.2 + 0.15 * number)
            curve.points.new(0.6, 0.9 - 0.1 * number)
        node.mapping.update()
        node.inputs[0].default_value = 0.8
        nodes.link(vector, node.inputs[1])
        return node

    _shown(scene, build)


@variants(values={"cardinal": ("RGB", "CARDINAL"), "b_spline": ("RGB", "B_SPLINE"), "hsv": ("HSV", "NEAR")})
def color_ramp_of(scene, ramp):
    mode, interpolation = ramp

    def build(nodes, vector):
        node = nodes.add("ShaderNodeValToRGB", nodes.add("ShaderNodeSeparateXYZ", vector).outputs["X"])
        node.color_ramp.color_mode = mode
        setattr(node.color_ramp, "hue_interpolation" if mode == "HSV" else "interpolation", interpolation)
        node.color_ramp.elements[0].color = (0.9, 0.1, 0.2, 1.0)
        node.color_ramp.elements[1].color = (0.1, 0.3, 0.8, 1.0)
        node.color_ramp.elements.new(0.4).color = (0.2, 0.8, 0.1, 1.0)
        return node.outputs["Color"]

    _shown(scene, build)


@variants(
    quick=True,
    values={name.lower().replace(" ", "_"): name for name in ("Location", "Color", "Alpha", "Object Index", "Random")},
)
def object_info(scene, output):
    """Three balls of one material, and a fourth as an instance of a collection."""
    surface = material(lambda nodes: nodes.add("ShaderNodeEmission", Color=_between(nodes, output)))
    for number in range(3):
        thing = ball(scene, surface, radius=0.5, location=(number - 1.0, 0.3 * number, 0.5))
        thing.name = f"Ball {number}"
        thing.color = (0.2 + 0.3 * number, 0.5, 0.9 - 0.2 * number, 0.3 + 0.2 * number)
        thing.pass_index = 2 * number
    kept = bpy.data.collections.new("Kept")
    kept.objects.link(thing)
    empty = bpy.data.objects.new("Instancer", None)
    empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", kept, (-0.8, -0.6, 1.0)
    scene.collection.objects.link(empty)
    camera(scene, (0, -4.0, 1.6), (0, 0, 0.7))


def _between(nodes, output):
    """Returns an output scaled to the range of visible colours."""
    found = nodes.add("ShaderNodeObjectInfo").outputs[output]
    return nodes.add("ShaderNodeVectorMath", found, (0.2,) * 3, (0.5,) * 3, props={"operation": "MULTIPLY_ADD"})


def _path(nodes, output):
    return nodes.add("ShaderNodeLightPath").outputs[output]


def _found_by_chance(surface):
    """Disables light sampling of the material: light samples have no kind of ray, and the engines weight them differently."""
    if hasattr(surface.cycles, "emission_sampling"):
        surface.cycles.emission_sampling = "NONE"
    else:
        surface.cycles.sample_as_light = False
    return surface


@variants(
    values={
        **{name.lower(): f"Is {name} Ray" for name in _RAYS},
        **{f"{name.lower()}_depth": f"{name} Depth" for name in _DEPTHS},
    }
)
def light_path(scene, output):
    """A ball that emits for some rays only, seen directly, by a mirror, by a rough plate, through glass and by the floor."""

    def build(nodes):
        return nodes.add("ShaderNodeEmission", Color=(0.9, 0.5, 0.2), Strength=_path(nodes, output))

    floor(scene)
    ball(scene, _found_by_chance(material(build)), radius=0.5, location=(0, 0.3, 0.5))
    pane = parts.plane_mesh("Pane", 1.0)
    for number, (kind, roughness) in enumerate((("Glossy", 0.0), ("Glossy", 0.3), ("Refraction", 0.0))):
        look = {"Color": (0.9, 0.9, 0.9), "Roughness": roughness}
        surface = material(lambda nodes, kind=kind, look=look: nodes.add(f"ShaderNodeBsdf{kind}", **look))
        places = ((-1.4, 0.9, 0.8), (1.4, 0.9, 0.8), (0.5, -1.0, 0.5))
        turns = ((1.5, 0, 0.9), (1.5, 0, -0.9), (1.4, 0, 0))
        parts.place(scene, f"Pane {number}", pane, surface, places[number], (1.0, 1.0, 1.0), turns[number])
    sky(scene, (0.3, 0.3, 0.3), 1.0)
    camera(scene, (0, -4.5, 1.8), (0, 0, 0.6))


@variants(values={"camera": "Is Camera Ray", "glossy": "Is Glossy Ray", "depth": "Ray Depth"})
def light_path_of_world(scene, output):
    """A background that differs for some rays."""
    floor(scene)
    mirror = material(lambda nodes: nodes.add("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0))
    ball(scene, mirror, radius=0.7, location=(0, 0.2, 0.7))

    def build(nodes):
        factor = nodes.add("ShaderNodeMath", _path(nodes, output), 0.4, props={"operation": "MULTIPLY"})
        color = nodes.add("ShaderNodeMixRGB", factor, (0.3, 0.3, 0.3), (0.2, 0.6, 0.9))
        return nodes.add("ShaderNodeBackground", Color=color)

    world(scene, build)
    camera(scene, (0, -4.5, 1.8), (0, 0, 0.6))


@case(quick=True)
def light_path_shadow(scene):
    """A visibly solid surface that lets the light of shadow rays pass."""

    def build(nodes):
        mix = nodes.add("ShaderNodeMixShader", _path(nodes, "Is Shadow Ray"))
        nodes.link(nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.3, 0.2)), mix.inputs[1])
        nodes.link(nodes.add("ShaderNodeBsdfTransparent", Color=(0.9, 0.7, 0.3)), mix.inputs[2])
        return mix

    floor(scene)
    ball(scene, material(build), radius=0.6, location=(0, 0.2, 0.8))
    lamp(scene)
    camera(scene, (0, -4.5, 1.8), (0, 0, 0.6))


@case(quick=True)
def light_path_length(scene):
    def build(nodes):
        length = nodes.add("ShaderNodeMath", _path(nodes, "Ray Length"), 0.1, props={"operation": "MULTIPLY"})
        return nodes.add("ShaderNodeEmission", Color=(1.0, 0.8, 0.6), Strength=length)

    card(scene, material(build))
