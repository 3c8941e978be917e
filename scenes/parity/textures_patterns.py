"""Textures of cells and waves, and bumps over them."""

from .catalogue import case, variants
from .nodes import find, material, with_node
from .stages import ball, camera, card, floor, lamp, sky

_COLORS = {"Color1": (0.85, 0.3, 0.15), "Color2": (0.2, 0.35, 0.7)}
# Each texture with the settings and inputs that show it at the size of an object.
_TEXTURES = {
    "wave": ("ShaderNodeTexWave", {"wave_type": "RINGS"}, {"Scale": 0.7, "Distortion": 3.0, "Detail": 1.5}),
    "magic": ("ShaderNodeTexMagic", {"turbulence_depth": 4}, {"Scale": 1.5, "Distortion": 1.2}),
    "checker": ("ShaderNodeTexChecker", {}, {"Scale": 3.0, **_COLORS}),
    "brick": (
        "ShaderNodeTexBrick",
        {"offset": 0.4, "squash": 0.7, "squash_frequency": 3},
        {"Scale": 3.0, "Mortar Size": 0.03, "Mortar Smooth": 0.4, "Bias": -0.2, "Mortar": (0.1, 0.1, 0.1), **_COLORS},
    ),
    "white_noise": ("ShaderNodeTexWhiteNoise", {}, {}),
    "gabor": ("ShaderNodeTexGabor", {}, {"Scale": 2.0, "Frequency": 1.5, "Anisotropy": 0.7}),
    "radial_tiling": ("ShaderNodeRadialTiling", {"normalize": True}, {"Sides": 5.4, "Roundness": 0.3}),
}
# White noise has no pixel without its own value, and no slope.
_SMOOTH = tuple(name for name in _TEXTURES if name != "white_noise")


def _add(nodes, name, vector):
    kind, props, inputs = _TEXTURES[name]
    node = nodes.add(kind, props=props)
    for socket, value in inputs.items():
        found = find(node.inputs, socket)
        found.default_value = (*value, 1.0) if isinstance(value, tuple) else value
    nodes.link(vector, find(node.inputs, "Vector"))
    return node


def _each(names):
    return {name: (name, {"needs": with_node(_TEXTURES[name][0]), "quick": name in ("brick", "wave")}) for name in names}


def _place(nodes):
    return nodes.add("ShaderNodeTexCoord").outputs["Object"]


@variants(values=_each(_TEXTURES))
def pattern(scene, name):
    def surface(nodes):
        place = _place(nodes)
        if name == "white_noise":
            # Cells instead of floats: each has many pixels.
            place = nodes.add("ShaderNodeVectorMath", place, (0.13,) * 3, props={"operation": "SNAP"})
        color = next(socket for socket in _add(nodes, name, place).outputs if socket.enabled)
        return nodes.add("ShaderNodeEmission", Color=color)

    card(scene, material(surface))


@variants(values=_each(_SMOOTH))
def bump_of_pattern(scene, name):
    def surface(nodes):
        node = _add(nodes, name, _place(nodes))
        height = next((socket for socket in node.outputs if socket.name in ("Fac", "Factor", "Value")), node.outputs[0])
        bump = nodes.add("ShaderNodeBump", Strength=0.6, Distance=0.05, Height=height)
        return nodes.add("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5), Normal=bump)

    floor(scene)
    ball(scene, material(surface))
    lamp(scene)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


@case(quick=True)
def wavelength(scene):
    """The spectrum, from beyond violet to beyond red."""

    def surface(nodes):
        along = nodes.add("ShaderNodeSeparateXYZ", _place(nodes)).outputs["X"]
        nanometres = nodes.add("ShaderNodeMath", along, 160.0, 580.0, props={"operation": "MULTIPLY_ADD"})
        return nodes.add("ShaderNodeEmission", Color=nodes.add("ShaderNodeWavelength", nanometres))

    card(scene, material(surface))
