"""Nodes that look around a surface by rays: Ambient Occlusion, Bevel, Raycast. Readers take (graph, site, output)."""

from ..bindings.enums import Coordinate, NodeKind, VectorOperation
from .attributes import attribute_name
from .coordinates import coordinate
from .hit_attributes import COMPUTED, sampled_name
from .settings import occlusion_distance, world_of

_INSIDE, _ALONE = 1, 2  # flags of OCCLUSION
_ONLY_LOCAL = 1  # flag of RAYCAST
_OF_HIT = 0  # option of RAYCAST
_HIT_FACTS = {"Is Hit": 0, "Self Hit": 1, "Hit Distance": 2}
_HIT_PLACES = {"Hit Position": 1, "Hit Normal": 2}  # options of RAYCAST
_ATTRIBUTE, _MEAN, _ALPHA = 3, 2, 4  # option of RAYCAST, and its flags
_NO_NORMAL = (0.0, 0.0, 0.0)


def _occlusion(graph, site, output):
    node = site.node
    distance = graph.parameter(site, ("Distance",), 1.0)
    if distance == 0.0:
        distance = _distance_of_world(graph)
    normal = graph.linked(site, ("Normal",), graph.normal, evaluated=True)
    flags = _INSIDE * node.inside | _ALONE * node.only_local
    share = graph.emit(NodeKind.OCCLUSION, distance, normal, option=node.samples, flags=flags)
    if output.identifier == "AO":
        return share
    return graph.vector_op(VectorOperation.SCALE, graph.value(site, "Color"), scale=share)


def _distance_of_world(graph):
    """Return the world's distance of ambient occlusion, which a constant distance of 0 stands for."""
    graph.reads_layer = True
    return occlusion_distance(None if graph.depsgraph is None else world_of(graph.depsgraph))


def _bevel(graph, site, output):
    normal = graph.linked(site, ("Normal",), _NO_NORMAL, evaluated=True)
    radius = graph.parameter(site, ("Radius",), 0.05)
    return graph.emit(NodeKind.BEVEL, radius, normal, graph.normal, option=site.node.samples)


def _raycast(graph, site, output):
    name, is_number = output.identifier, output.type == "VALUE"
    option, flags, attribute = _HIT_PLACES.get(name, _OF_HIT), _ONLY_LOCAL * site.node.only_local, ""
    if name not in _HIT_FACTS and name not in _HIT_PLACES:
        attribute, is_alpha = sampled_name(site.node, name)
        option, flags = _ATTRIBUTE, flags | (_ALPHA if is_alpha else _MEAN if is_number else 0)
        if attribute in COMPUTED:
            graph.tell(site, f"'{attribute}' of the surface that is hit is computed by Cycles alone, 0 is used")
        if not attribute and not is_alpha:
            return 0.0 if is_number else (0.0, 0.0, 0.0)
    position = graph.linked(site, ("Position",), None, evaluated=True)
    if position is None:
        position = coordinate(graph, Coordinate.POSITION)
    direction = graph.linked(site, ("Direction",), None, evaluated=True)
    if direction is None:
        direction = graph.normal if graph.normal != _NO_NORMAL else coordinate(graph, Coordinate.SHADING_NORMAL)
    length = graph.parameter(site, ("Length",), 1.0)
    name_of_core = attribute_name(attribute) if attribute else ""
    value = graph.emit(NodeKind.RAYCAST, position, direction, length, option=option, flags=flags, name=name_of_core)
    return graph.component(value, _HIT_FACTS.get(name, 0)) if is_number else value


READERS = {"AMBIENT_OCCLUSION": _occlusion, "BEVEL": _bevel, "MATERIAL_RAYCAST": _raycast}
