"""The Sky Texture: compare the values of Cycles and of the core in the same directions, over the sphere and at the sun."""

import dataclasses
import itertools
import math

import bpy
from mathutils import Matrix, Vector
from procedural_cases import Board

from addon.bindings.enums import Coordinate, NodeKind

_DEGREES = math.pi / 180.0


def _models():
    return [item.identifier for item in bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items]


def atmospheres():
    return [model for model in _models() if model not in ("PREETHAM", "HOSEK_WILKIE")]


def _math(tree, operation, a, b=0.0):
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = operation
    for socket, value in zip(node.inputs, (a, b), strict=False):
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return node.outputs[0]


def _combined(tree, parts):
    node = tree.nodes.new("ShaderNodeCombineXYZ")
    for socket, value in zip(node.inputs, parts, strict=True):
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return node.outputs[0]


def _square(tree, vector):
    """Return two sockets from 0 to 1: of Board's coordinates, which are 0.6 and 0.3 less."""
    parts = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(vector, parts.inputs[0])
    return _math(tree, "ADD", parts.outputs[0], 0.6), _math(tree, "ADD", parts.outputs[1], 0.3)


def over_the_sphere(tree, vector):
    """All directions in equal shares."""
    u, v = _square(tree, vector)
    azimuth, z = _math(tree, "MULTIPLY", u, 2.0 * math.pi), _math(tree, "SUBTRACT", _math(tree, "MULTIPLY", v, 2.0), 1.0)
    across = _math(tree, "SQRT", _math(tree, "SUBTRACT", 1.0, _math(tree, "MULTIPLY", z, z)))
    along = [_math(tree, "MULTIPLY", across, _math(tree, name, azimuth)) for name in ("COSINE", "SINE")]
    return _combined(tree, (*along, z))


def _look_around(node, elevation, rotation, reach):
    """Set the texture mapping of a node without a vector: from a square's generated coordinates, 0 to 1, to directions around
    the sun, up to a distance in radians. They are not quite unit vectors, but the same for both engines.
    """
    sin_e, cos_e, sin_r, cos_r = (f(a) for a in (elevation, rotation) for f in (math.sin, math.cos))
    middle, across, up = (cos_e * sin_r, cos_e * cos_r, sin_e), (cos_r, -sin_r, 0.0), (-sin_e * sin_r, -sin_e * cos_r, cos_e)
    mapping = node.texture_mapping
    mapping.rotation = Matrix((across, up, Vector(across).cross(up))).transposed().to_euler()
    mapping.scale = (2.0 * reach, 2.0 * reach, 0.0)
    mapping.translation = Vector(middle) - reach * (Vector(across) + Vector(up))


class _Patches(Board):
    """Squares whose nodes read generated coordinates, which are those of the texture."""

    def _snapshot(self):
        def placed(node):
            generated = node.kind == NodeKind.COORDINATE and node.option == Coordinate.GENERATED
            return dataclasses.replace(node, option=Coordinate.UV) if generated else node

        found = super()._snapshot()
        materials = [dataclasses.replace(one, nodes=tuple(map(placed, one.nodes))) for one in found.materials]
        return dataclasses.replace(found, materials=materials)


def node_of(tree, properties):
    node = tree.nodes.new("ShaderNodeTexSky")
    for name, value in properties.items():
        # Blender 5.0 has renamed dust.
        setattr(node, "aerosol_density" if name == "dust_density" and not hasattr(node, name) else name, value)
    return node


def _sky(directions, **properties):
    def build(tree, vector):
        node = node_of(tree, properties)
        tree.links.new(directions(tree, vector), node.inputs[0])
        return node.outputs[0]

    return build


def analytic(side):
    """Preetham and Hosek-Wilkie."""
    board = Board(int(side))
    suns = {"high": (0.3, -0.5, 0.8), "low": (-0.7, 0.7, 0.05), "zenith": (0.0, 0.0, 1.0), "below": (0.6, 0.2, -0.1)}
    skies = itertools.product(("PREETHAM", "HOSEK_WILKIE"), suns, (1.0, 2.2, 3.7, 10.0), (0.0, 0.3, 1.0))
    for model, sun, turbidity, albedo in skies:
        if model == "PREETHAM" and (albedo != 0.3 or (sun == "below" and turbidity > 3.0)):
            continue
        if turbidity in (1.0, 3.7) and albedo == 0.3 and model != "PREETHAM":
            continue
        board.square(
            f"{model} {sun} {turbidity} {albedo}",
            _sky(over_the_sphere, sky_type=model, sun_direction=suns[sun], turbidity=turbidity, ground_albedo=albedo),
        )
    return board.answer()


_ATMOSPHERES = {
    "plain": {},
    "thin": {"air_density": 0.0},
    "clear": {"dust_density": 0.0, "ozone_density": 0.0},
    "nothing": {"air_density": 0.0, "dust_density": 0.0, "ozone_density": 0.0},
    "thick": {"air_density": 10.0, "dust_density": 10.0, "ozone_density": 10.0},
    "ground": {"altitude": 0.0},
    "plane": {"altitude": 9000.0},
    "high": {"altitude": 40000.0},
}


def scattering(side):
    """The light of the atmosphere, without the sun's disc."""
    board = Board(int(side))
    for model, elevation in itertools.product(atmospheres(), (15.0, 90.0, 52.0, 0.5, 0.0, -3.0, -90.0, 170.0, -250.0)):
        places = _ATMOSPHERES if elevation in (15.0, -3.0) else ("plain",)
        for place in places:
            board.square(
                f"{model} {elevation} {place}"[:63],
                _sky(
                    over_the_sphere,
                    sky_type=model,
                    sun_disc=False,
                    sun_elevation=elevation * _DEGREES,
                    sun_rotation=0.7 * elevation,
                    **_ATMOSPHERES[place],
                ),
            )
    return board.answer()


def suns(side):
    """The disc of the sun, with the sky beside it. With a disc, Blender takes no vector."""
    board = _Patches(int(side))
    # A direction in floats has an error of 6e-8, which narrow discs show at their limb.
    places = [(15.0, 0.545), (60.0, 0.6), (-0.1, 0.545), (0.1, 2.0), (80.0, 40.0), (10.0, 90.0), (90.0, 3.0), (1.0, 1.0)]
    for model, (elevation, size), high in itertools.product(atmospheres(), places, (0.0, 8000.0)):
        turned = 0.3 + elevation
        # The smallest sun is 0.0005 radians wide.
        reach = 0.6 * max(size * _DEGREES, 0.0005)
        sun = {"sun_elevation": elevation * _DEGREES, "sun_rotation": turned, "sun_size": size * _DEGREES, "altitude": high}

        def build(tree, vector, sun=sun, model=model, reach=reach):
            node = node_of(tree, {"sky_type": model, "sun_intensity": 0.7, **sun})
            _look_around(node, sun["sun_elevation"], sun["sun_rotation"], reach)
            return node.outputs[0]

        board.square(f"{model} {elevation} {size} {high}"[:63], build)
    return board.answer()


def world_nodes(scene):
    scene.world = bpy.data.worlds.new("World")
    if bpy.app.version < (5, 0):
        scene.world.use_nodes = True
    tree = scene.world.node_tree
    tree.nodes.clear()
    background, end = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeOutputWorld")
    background.name = "Background"
    tree.links.new(background.outputs[0], end.inputs["Surface"])
    return tree


def matt():
    material = bpy.data.materials.new("Matt")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse, end = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(diffuse.outputs[0], end.inputs["Surface"])
    return material
