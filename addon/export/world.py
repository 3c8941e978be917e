"""The world: a constant radiance, nodes over the direction, or the course's cube of six images."""

from typing import NamedTuple

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.enums import AlphaMode, Coordinate, Environment, Extension, NodeKind, PathFact
from ..bindings.parameters import kept, reached
from ..messages.severity import Severity
from .graph import NodeGraph
from .lights import lit_surfaces
from .outputs import read_lone_outputs, read_outputs
from .shader_cache import Sources
from .sockets import output_node
from .surface import emission_of
from .visibility import hidden_from, lights_some_lobes

# In the order of lancer.h.
CUBE_SIDES = tuple(f"cube_{sign}_{axis}" for axis in "xyz" for sign in ("positive", "negative"))
# Facts of Light Path that are the same for a sample of the sky and for a scattered ray that meets it.
_SAME_FOR_SAMPLES = {PathFact.IS_CAMERA, PathFact.IS_VOLUME, PathFact.DEPTH, PathFact.TRANSPARENT_DEPTH}


class Sky(NamedTuple):
    world: snapshot.World
    sources: Sources = Sources()


def export_world(world, images, depsgraph, messages, aovs=()):
    """Return the Sky of a world, black if it is None. images: the Images that all materials share; aovs: the Aovs to fill."""
    if world is None:
        return Sky(snapshot.World())
    who = f"world '{world.name}'"
    graph = NodeGraph(who, messages, images, depsgraph)
    graph.is_of_world = True
    own = world.lancer
    cycles = getattr(world, "cycles", None)
    if own.use_cube:
        radiance, outputs = _cube(own, graph, who, messages), ()
    else:
        radiance, outputs = _nodes(world, graph, who, messages, aovs)
    # Nodes of which nothing is left cost nothing.
    nodes, renumbered = kept(graph.nodes, reached(graph.nodes, [radiance, *(output.value for output in outputs)]))
    radiance = renumbered(radiance)
    outputs = tuple(output.replaced(value=renumbered(output.value)) for output in outputs)
    method = getattr(cycles, "sampling_method", "")
    if method == "NONE" and isinstance(radiance, snapshot.NodeRef):
        messages.add(
            f"{who}: Sampling None is not supported, Auto is used; behind objects that cast no shadow it is brighter",
            "feature:sky that is not sampled",
        )
    # An even sky is not sampled as a light in Cycles, and casts shadows in any case.
    elif not getattr(cycles, "use_shadows", True) and isinstance(radiance, snapshot.NodeRef):
        messages.add(f"{who}: a sky that casts no shadows is not supported, it casts them", "feature:sky without shadows")
    if any(node.kind == NodeKind.LIGHT_PATH and node.option not in _SAME_FOR_SAMPLES for node in nodes):
        messages.add(
            f"{who}: its nodes read Light Path: samples of the sky and rays that meet it find other light, and Cycles weighs "
            "the two by sampling of its own",
            "feature:sampling of a sky that reads Light Path",
            Severity.HINT,
        )
    hidden = hidden_from(getattr(world, "cycles_visibility", None))
    if lights_some_lobes(hidden) and isinstance(radiance, snapshot.NodeRef):
        messages.add(
            f"{who}: ray visibility hides it from some lobes of a surface and not from others: their light depends on the "
            "sampling of the sky, which is not Cycles'; with Diffuse, Glossy and Transmission equal it does not",
            "feature:sampling of a sky with ray visibility",
            Severity.HINT,
        )
    sky = snapshot.World(
        radiance=radiance,
        ambient=messages.color(own.ambient_color, who, "ambient colour") if own.use_ambient_color else None,
        nodes=nodes,
        outputs=outputs,
        hidden_from=hidden,
        map_resolution=cycles.sample_map_resolution if method == "MANUAL" else 0,
        lit_surfaces=lit_surfaces(world),
    )
    return Sky(sky, graph.sources)


def _nodes(world, graph, who, messages, aovs):
    """Return the radiance and the Outputs."""
    if bpy.app.version < (5, 0) and not world.use_nodes:
        return messages.color(world.color, who, "colour"), ()
    tree = graph.tree_of(world)
    output = output_node(tree, "OUTPUT_WORLD") if tree is not None else None
    if output is None:
        return (0.0, 0.0, 0.0), read_lone_outputs(graph, tree, aovs)
    if output.inputs["Volume"].is_linked:
        text = f"{who}: volumes are not supported, its background alone is shown"
        messages.add(text, "feature:volume of the world", severity=Severity.LEFT_OUT)
    return emission_of(graph, tree, "OUTPUT_WORLD"), read_outputs(graph, tree, aovs)


def _cube(own, graph, who, messages):
    """Return the radiance of the course's cube: the image of the side through which a direction leaves it."""
    sides = [_side(getattr(own, name), own.bl_rna.properties[name].name, graph.images, who, messages) for name in CUBE_SIDES]
    first = sides[0][0]
    if [number for number, _ in sides] != list(range(first, first + 6)):
        # The core requires consecutive numbers: add the images again if one is used twice or elsewhere.
        first = graph.images.repeat([picture for _, picture in sides])
    direction = graph.emit(NodeKind.COORDINATE, option=Coordinate.GENERATED)
    shown = graph.emit(
        NodeKind.ENVIRONMENT, direction, option=Environment.CUBE, flags=int(Extension.EXTEND), image=first, image_count=6
    )
    strength = messages.number(own.cube_strength, who, "cube strength", 1.0, 0.0)
    return graph.multiply(shown, strength)


def _side(image, name, images, who, messages):
    """Return (number, image) of one side; a black image, with a message, if there is none."""
    found = None
    if image is not None:
        found = images.numbers(
            image,
            None,
            lambda text, key="", **more: messages.add(f"{who}, side {name}: {text}", key, **more),
            in_memory=True,
        )
    if found is not None:
        return found[0], images.list[found[0]]
    messages.add(f"{who}: side {name} of its cube has no image, it is black", severity=Severity.WRONG)
    return -1, snapshot.Image(name="black", texels=np.zeros((1, 1, 3), np.uint8), alpha=AlphaMode.NONE)
