"""Random node trees of worlds and lamps."""

import math

from .node_kinds import SKIES
from .record import Record

_RAYS = ("camera", "diffuse", "glossy", "transmission")
# Samples of a sky are of no kind in Cycles: kinds that they may have in a path are reported if the sky is sampled.
_KINDS_OF_RAYS = {
    "Is Camera Ray": 4, "Is Diffuse Ray": 0.5, "Is Glossy Ray": 0.5, "Is Transmission Ray": 0.5, "Is Reflection Ray": 0.5,
}  # fmt: skip


def world(dice, is_lit):
    """The record of a world; None now and then, where lamps give light."""
    if is_lit and dice.chance(0.25):
        return None
    fields = {}
    hidden = dice.some(_RAYS, 0.05)
    if hidden:
        fields["hidden_from"] = hidden
    if dice.chance(0.2):
        fields["mist"] = {
            "start": dice.number(1.0, 4.0),
            "depth": dice.number(2.0, 6.0),
            "falloff": dice.pick(("LINEAR", "QUADRATIC", "INVERSE_QUADRATIC")),
        }
    if dice.chance(0.1):
        fields["occlusion_distance"] = dice.number(0.3, 3.0)
    if dice.chance(0.1):
        fields["map_resolution"] = dice.pick((4, 16, 128))
    return Record("world", "World", fields)


def world_tree(trees, tree, image=None):
    """A background of one colour, of a picture or of computed nodes; now and then another one for some kinds of rays."""
    dice = trees.dice
    shader = _background(trees, tree, image)
    if dice.chance(0.2):
        kind = dice.pick(("ShaderNodeMixShader", "ShaderNodeMixShader", "ShaderNodeAddShader"))
        inputs = {"Shader": shader, "Shader_001": _background(trees, tree, None)}
        if kind == "ShaderNodeMixShader":
            inputs["Fac"] = dice.number()
            if dice.chance(0.6):
                inputs["Fac"] = [trees.write(tree, "ShaderNodeLightPath", {}, {}), dice.pick(_KINDS_OF_RAYS)]
        shader = [trees.write(tree, kind, {}, inputs), "Shader"]
    trees.write(tree, "ShaderNodeOutputWorld", {}, {"Surface": shader})


def _background(trees, tree, image):
    dice = trees.dice
    color = dice.color(0.2, 0.9)
    if image is not None:
        color = [_picture(trees, tree, image), "Color"]
    elif dice.chance(0.2):
        trees.budget = 5
        color = [_positive(trees, tree, trees.value(tree, "c", 1)), "Vector"]
    strength = dice.number(0.2, 1.2)
    if image is None and not isinstance(color[0], str) and dice.chance(0.2):
        # A tenth of the strength makes it as bright as the other skies.
        color, strength = [_sky(trees, tree), "Color"], 0.1 * strength
    inputs = {"Color": color, "Strength": strength}
    if dice.chance(0.05):
        return [trees.write(tree, "ShaderNodeEmission", {}, inputs), "Emission"]
    return [trees.write(tree, "ShaderNodeBackground", {}, inputs), "Background"]


def _positive(trees, tree, value):
    """A node of the value's amount: no light is darker than black."""
    return trees.write(tree, "ShaderNodeVectorMath", {"operation": "ABSOLUTE"}, {"Vector": value})


def _sky(trees, tree):
    """The Sky Texture, now and then turned. The disc of the sun is as wide as a mirror shows it in some pixels."""
    dice = trees.dice
    props = {name: dice.pick(choices) for name, choices in SKIES.items()}
    props |= {"sun_disc": dice.chance(0.7), "sun_size": dice.pick((0.1, 0.3, 1.0)), "sun_intensity": dice.pick((0.1, 1.0))}
    return trees.write(tree, "ShaderNodeTexSky", props, _turned(trees, tree) if dice.chance(0.3) else {})


def _turned(trees, tree):
    dice = trees.dice
    place = trees.write(tree, "ShaderNodeTexCoord", {}, {})
    turned = {"Vector": [place, "Generated"], "Rotation": dice.vector(-math.pi, math.pi)}
    return {"Vector": [trees.write(tree, "ShaderNodeMapping", {}, turned), "Vector"]}


def _picture(trees, tree, image):
    dice = trees.dice
    props = {
        "image": f"@{image}",
        "projection": dice.pick(("EQUIRECTANGULAR", "EQUIRECTANGULAR", "MIRROR_BALL")),
        "interpolation": dice.pick(("Linear", "Linear", "Closest", "Cubic")),
    }
    inputs = {}
    if dice.chance(0.6):
        place = trees.write(tree, "ShaderNodeTexCoord", {}, {})
        turned = {"Vector": [place, "Generated"], "Rotation": dice.vector(-math.pi, math.pi)}
        if dice.chance(0.3):
            turned["Scale"] = dice.vector(0.5, 2.0)
        inputs = {"Vector": [trees.write(tree, "ShaderNodeMapping", {}, turned), "Vector"]}
    return trees.write(tree, "ShaderNodeTexEnvironment", props, inputs)


def lamp_tree(trees, tree, is_far):
    """Light of one colour, of a temperature or of computed nodes, of a strength that may fall otherwise with the distance.

    is_far: whether it has no distance.
    """
    dice = trees.dice
    trees.add_lamp(tree, is_far)
    color, strength = dice.color(0.2, 1.0), dice.number(0.2, 2.0)
    kind = dice.pick({"plain": 1, "warm": 1, "computed": 2})
    if kind == "warm":
        warm = trees.write(tree, "ShaderNodeBlackbody", {}, {"Temperature": dice.number(2000.0, 9000.0)})
        color = [warm, "Color"]
    elif kind == "computed":
        trees.budget = 5
        color = [_positive(trees, tree, trees.value(tree, "c", 1)), "Vector"]
    if dice.chance(0.2) and not is_far:
        falloff = trees.write(
            tree, "ShaderNodeLightFalloff", {}, {"Strength": round(0.3 * strength, 3), "Smooth": dice.pick((0.0, 0.5, 4.0))}
        )
        strength = [falloff, dice.pick(("Quadratic", "Linear", "Constant"))]
    elif dice.chance(0.2):
        strength = [
            trees.write(
                tree, "ShaderNodeMath", {"operation": dice.pick(("MULTIPLY", "ADD"))}, {"Value": strength, "Value_001": 0.5}
            ),
            "Value",
        ]
    emission = trees.write(tree, "ShaderNodeEmission", {}, {"Color": color, "Strength": strength})
    trees.write(tree, "ShaderNodeOutputLight", {}, {"Surface": [emission, "Emission"]})
