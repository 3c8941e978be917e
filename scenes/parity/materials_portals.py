"""Ray Portals: a card that shows what is elsewhere."""

from .. import parts
from .catalogue import case
from .nodes import material, shader, with_node
from .stages import camera, floor, lamp, sky


def _window(scene, build, lit=True):
    """A card that may be a portal before a floor, and far away a second scene, which only a portal shows."""
    floor(scene, size=8.0)
    thing = parts.place(scene, "Card", parts.plane_mesh("Card", 2.4), material(build), (0, 0.5, 1.3), rotation=(1.4, 0, 0.3))
    red, blue = (shader("ShaderNodeBsdfDiffuse", Color=color) for color in ((0.8, 0.2, 0.1), (0.1, 0.3, 0.8)))
    block = parts.cube_mesh("Block", 1.0)
    parts.place(scene, "Far", block, red, (40.5, 3.0, 1.0), rotation=(0.4, 0.3, 0.2))
    parts.place(scene, "Further", block, blue, (39.0, 5.0, 1.5), rotation=(0.1, 0.6, 0.9))
    if lit:
        parts.add_light(scene, "Far light", "AREA", 400.0, (40.0, -3.0, 6.0), (40.0, 3.0, 1.0), size=3.0)
    lamp(scene, 200.0, (1.5, -3, 4))
    sky(scene, strength=0.4)
    camera(scene, (0, -4.2, 2.2), (0, 0, 1.0))
    return thing


def _elsewhere(nodes, by=(40.0, 0.0, 0.0)):
    return nodes.add("ShaderNodeVectorMath", nodes.add("ShaderNodeNewGeometry").outputs["Position"], by)


_PORTAL = "ShaderNodeBsdfRayPortal"


@case(needs=with_node(_PORTAL))
def portal_moves(scene):
    _window(scene, lambda nodes: nodes.add(_PORTAL, Color=(0.9, 0.8, 1.0), Position=_elsewhere(nodes)))


@case(needs=with_node(_PORTAL))
def portal_turns(scene):
    """No position: light goes on where it is, in another direction."""
    _window(scene, lambda nodes: nodes.add(_PORTAL, Direction=(0.3, 1.0, 0.5)))


@case(needs=with_node(_PORTAL))
def portal_moves_and_turns(scene):
    def build(nodes):
        place = nodes.add("ShaderNodeNewGeometry")
        turned = nodes.add(
            "ShaderNodeVectorMath", place.outputs["Incoming"], (-2.0, -3.0, -1.5), props={"operation": "MULTIPLY"}
        )
        return nodes.add(_PORTAL, Position=_elsewhere(nodes, (40.0, -1.0, 0.3)), Direction=turned)

    _window(scene, build)


@case(needs=with_node(_PORTAL))
def portal_mixed(scene):
    """Portals to two places beside glossy and transparent parts."""

    def build(nodes):
        one = nodes.add(_PORTAL, Color=(1.0, 0.5, 0.5), Position=_elsewhere(nodes))
        other = nodes.add(_PORTAL, Color=(0.5, 0.9, 1.0), Position=_elsewhere(nodes, (39.0, 1.0, 0.2)))
        portals = nodes.add("ShaderNodeMixShader", 0.4)
        nodes.link(one, portals.inputs[1])
        nodes.link(other, portals.inputs[2])
        rest = nodes.add("ShaderNodeMixShader", 0.5)
        nodes.link(nodes.add("ShaderNodeBsdfTransparent", Color=(0.9, 0.9, 0.5)), rest.inputs[1])
        nodes.link(nodes.add("ShaderNodeBsdfDiffuse", Color=(0.5, 0.6, 0.3)), rest.inputs[2])
        mix = nodes.add("ShaderNodeMixShader", 0.5)
        nodes.link(portals, mix.inputs[1])
        nodes.link(rest, mix.inputs[2])
        return mix

    _window(scene, build)


@case(since=(5, 0))
def portal_depth(scene):
    """Portals count as surfaces passed straight through, and by themselves."""
    _window(scene, lambda nodes: nodes.add(_PORTAL, Position=_elsewhere(nodes)))

    def build(nodes):
        path = nodes.add("ShaderNodeLightPath")
        color = nodes.add("ShaderNodeCombineXYZ")
        for axis, count in enumerate(("Portal Depth", "Transparent Depth", "Ray Depth")):
            nodes.link(path.outputs[count], color.inputs[axis])
        shine = nodes.add("ShaderNodeEmission", Strength=0.4)
        nodes.link(color, shine.inputs["Color"])
        return shine

    told = material(build)
    parts.place(scene, "Told", parts.cube_mesh("Told", 1.2), told, (41.5, 3.0, 2.0))
    parts.place(scene, "Told here", parts.cube_mesh("Told here", 0.5), told, (1.0, -0.8, 0.3))


@case(needs=with_node(_PORTAL), bounces=4)
def portal_lights(scene):
    """The floor is lit by what a portal shows, and not by its lamp's samples."""
    _window(scene, lambda nodes: nodes.add(_PORTAL, Position=_elsewhere(nodes)))
    scene.objects["Lamp"].data.energy = 1.0
    scene.objects["Far light"].data.size = 8.0
