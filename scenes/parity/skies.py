"""The Sky Texture as the world and on a surface: its models, and the sun high, low, below the horizon, wide, turned."""

import math

from .catalogue import variants
from .nodes import material, shader, world
from .stages import ball, camera, floor

_DEGREES = math.pi / 180.0
# The first Blender that has a model, and the first that lacks it again.
_MODELS = {
    "nishita": {"until": (5, 0)},
    "single_scattering": {"since": (5, 0)},
    "multiple_scattering": {"since": (5, 0)},
}
_SKIES = {
    "noon": {"sun_elevation": 50 * _DEGREES, "sun_rotation": 2.5},
    "low": {"sun_elevation": 5 * _DEGREES, "sun_rotation": -2.2, "sun_size": 2 * _DEGREES, "sun_intensity": 0.05},
    "setting": {"sun_elevation": 0.0, "sun_rotation": 1.0, "sun_size": 3 * _DEGREES, "sun_intensity": 0.1},
    "below": {"sun_elevation": -4 * _DEGREES, "sun_rotation": 0.4},
    "wide": {"sun_elevation": 30 * _DEGREES, "sun_rotation": 3.5, "sun_size": 40 * _DEGREES, "sun_intensity": 0.1},
    "plane": {"sun_elevation": 20 * _DEGREES, "sun_rotation": 3.0, "altitude": 12000.0, "dust_density": 5.0},
    "plain": {"sun_elevation": 15 * _DEGREES, "sun_disc": False, "ozone_density": 4.0},
}
_STRENGTHS = {"low": 0.5, "setting": 1.0, "below": 20.0, "plain": 1.0}
# Where the disc is far brighter than the sky, a mirror of it has too few pixels for a mean.
_MIRRORED = ("below", "wide", "plain")


def _things(scene, mirror):
    floor(scene, size=6.0)
    matt = shader("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5))
    ball(scene, matt, radius=0.7, location=(-0.9, 0, 0.7))
    steel = shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0)
    ball(scene, steel if mirror else matt, radius=0.7, location=(0.9, 0, 0.7))
    camera(scene, (0, -4.5, 1.6), (0, 0, 0.9))


def _texture(nodes, properties):
    node = nodes.add("ShaderNodeTexSky")
    for name, value in properties.items():
        # Blender 5.0 has renamed dust.
        setattr(node, "aerosol_density" if name == "dust_density" and not hasattr(node, name) else name, value)
    return node


def _sky(scene, properties, strength, rotation=None, own=None):
    """rotation: of a Mapping before the node, which Blender has for skies without a disc; own: of the node's own mapping."""

    def build(nodes):
        sky = _texture(nodes, properties)
        if own is not None:
            sky.texture_mapping.rotation = own
        if rotation is not None:
            where = nodes.add("ShaderNodeTexCoord").outputs["Generated"]
            nodes.link(nodes.add("ShaderNodeMapping", Vector=where, Rotation=rotation), sky.inputs["Vector"])
        return nodes.add("ShaderNodeBackground", Color=sky.outputs["Color"], Strength=strength)

    world(scene, build)


@variants(
    values={
        f"{model}_{name}": ((model, name), {**_MODELS[model], "quick": name == "noon", "bounces": 1})
        for model in _MODELS
        for name in _SKIES
    }
)
def sky(scene, choice):
    model, name = choice
    _things(scene, name in _MIRRORED)
    _sky(scene, {"sky_type": model.upper(), **_SKIES[name]}, _STRENGTHS.get(name, 0.1))


@variants(
    values={
        "preetham": {"sky_type": "PREETHAM", "sun_direction": (0.5, -0.6, 0.6), "turbidity": 3.0},
        "preetham_low": {"sky_type": "PREETHAM", "sun_direction": (0.5, 0.8, 0.1), "turbidity": 2.2},
        "hosek_wilkie": {"sky_type": "HOSEK_WILKIE", "sun_direction": (0.5, -0.6, 0.6), "turbidity": 2.2, "ground_albedo": 0.3},
        "hosek_wilkie_low": {
            "sky_type": "HOSEK_WILKIE", "sun_direction": (0.5, 0.8, 0.1), "turbidity": 8.0, "ground_albedo": 0.8,
        },
    }
)  # fmt: skip
def sky_analytic(scene, properties):
    _things(scene, mirror=True)
    _sky(scene, properties, 0.3)


_TURNS = {"turned": (0.0, 0.0, 1.1), "tipped": (0.5, -0.3, 2.0)}


@variants(
    values={
        f"{model}_{name}": ((model, name), {**_MODELS[model], "bounces": 1})
        for model in _MODELS
        for name in (*_TURNS, "own_tipped")
    }
)
def sky_mapping(scene, choice):
    """Turned by a Mapping, or with its sun by the mapping that the node has of its own."""
    model, name = choice
    _things(scene, mirror=False)
    if name in _TURNS:
        _sky(scene, {"sky_type": model.upper(), **_SKIES["plain"]}, 1.0, _TURNS[name])
    else:
        _sky(scene, {"sky_type": model.upper(), **_SKIES["noon"]}, 0.1, own=(0.3, -0.2, 2.0))


@variants(values={model: (model, fields) for model, fields in _MODELS.items()}, bounces=1)
def sky_of_two_suns(scene, model):
    """Two skies, mixed. Cycles does not sample several suns apart and misses the light at the rim of narrow ones."""
    _things(scene, mirror=False)

    def build(nodes):
        skies = [
            nodes.add(
                "ShaderNodeBackground",
                Color=_texture(nodes, {"sky_type": model.upper(), **_SKIES[name], "sun_size": 15 * _DEGREES}).outputs["Color"],
                Strength=0.1,
            )
            for name in ("noon", "plane")
        ]
        return nodes.add("ShaderNodeMixShader", 0.3, *skies)

    world(scene, build)


@variants(
    values={
        **{model: (model, fields) for model, fields in _MODELS.items()},
        "preetham": "preetham",
        "hosek_wilkie": "hosek_wilkie",
    }
)
def sky_on_a_surface(scene, model):
    """As the colour of a ball, by its generated coordinates and its normal."""
    floor(scene, size=6.0)

    def painted(nodes, coordinate):
        place = nodes.add("ShaderNodeTexCoord").outputs[coordinate]
        properties = {
            "sky_type": model.upper(),
            "sun_elevation": 0.7,
            "sun_size": 0.6,
            "sun_rotation": 2.0,
            "sun_intensity": 0.01,
        }
        texture = _texture(nodes, properties)
        if coordinate == "Normal":
            texture.sun_disc = False
            nodes.link(place, texture.inputs["Vector"])
        return nodes.add("ShaderNodeEmission", Color=texture.outputs["Color"], Strength=0.5)

    for x, coordinate in ((-0.9, "Generated"), (0.9, "Normal")):
        painting = material(lambda nodes, coordinate=coordinate: painted(nodes, coordinate), coordinate)
        ball(scene, painting, radius=0.7, location=(x, 0, 0.7))
    camera(scene, (0, -4.5, 1.6), (0, 0, 0.9))
