"""The course's models: the lobes that their parameters describe, and the node groups that stand for them.

A custom property of a group's tree names the model: copies, links, renames and Blenders without the add-on keep it. The
sockets alone are read, constant or linked, by their names; the nodes inside are what Cycles and EEVEE show.
"""

import math
from collections import namedtuple

from ..bindings.enums import LobeKind, Rules
from .sockets import find

TAG = "lancer_model"
_INSIDE = "lancer_inside"  # what the nodes inside were like when the group was made
NORMAL = "Normal"

# field: of the lobe that it shapes.
Parameter = namedtuple("Parameter", "socket kind default low high field", defaults=("color", 0.0, 0.0, math.inf, "color"))
# By the names of the material's own settings, which give the sockets their defaults, ranges and descriptions.
PARAMETERS = {
    "ka": Parameter("Ambient"),
    "kd": Parameter("Diffuse"),
    "ks": Parameter("Specular"),
    "roughness": Parameter("Roughness", "number", 0.2, 0.0, 1.0, "roughness"),
    "ior": Parameter("IOR", "number", 1.5, 1e-6, field="ior"),
    "shininess": Parameter("Shininess", "number", 50.0, field="shininess"),
    "darkness": Parameter("Darkness", "number", 1.0, field="shininess"),
}
# The lobes of each model, and the parameters of each lobe.
MODELS = {
    "KD_KS": ((LobeKind.LAMBERT, "kd"), (LobeKind.BECKMANN, "ks", "roughness", "ior")),
    "PHONG": ((LobeKind.LAMBERT, "kd"), (LobeKind.PHONG, "ks", "shininess")),
    "BLINN_PHONG": ((LobeKind.LAMBERT, "kd"), (LobeKind.BLINN_PHONG, "ks", "shininess")),
    "MINNAERT": ((LobeKind.MINNAERT, "kd", "darkness"),),
}


def parameters_of(model):
    """Names of a model's parameters, in the order of its sockets."""
    return (*(name for _, *names in MODELS[model] for name in names), "ka")


def lobes_of(model, value):
    """(kind, fields) of each lobe; value gives that of a parameter by its name."""
    for kind, *names in MODELS[model]:
        yield kind, {PARAMETERS[name].field: value(name) for name in names}


def model_of(tree):
    """The model that a node tree stands for; None for all other trees and for models of versions to come."""
    model = None if tree is None else tree.get(TAG)
    return model if isinstance(model, str) and model in MODELS else None


def mark(tree, model):
    """Makes a finished tree the group of a model."""
    tree[TAG], tree[_INSIDE] = model, _inside(tree)


def is_as_made(tree):
    """Whether the same nodes are linked as when the group was made; of sockets Blender changes names and numbers."""
    return tree.get(_INSIDE) == _inside(tree)


def _inside(tree):
    return "; ".join(sorted(f"{link.from_node.name} > {link.to_node.name}" for link in tree.links))


def read_group(surface, site, weight):
    """Adds the lobes of a group node, and its share of ambient light."""
    graph, tree = surface.graph, site.node.node_tree
    model = model_of(tree)
    if not is_as_made(tree):
        graph.tell(
            site,
            f"the nodes inside '{tree.name}' were changed, which Cycles and EEVEE show; Lancer shows the model by the node's "
            "inputs alone. Ungroup the node to have its nodes instead",
        )
    normal = surface.normal(site, _identifiers(site, NORMAL))
    for kind, fields in lobes_of(model, lambda name: _value(graph, site, name)):
        # The models are the same in all Blenders.
        surface.add(kind, weight, rules=Rules.BLENDER_45, normal=normal, **fields)
    surface.add_ambient(graph.multiply(_value(graph, site, "ka"), weight))


def _value(graph, site, name):
    wanted = PARAMETERS[name]
    identifiers = _identifiers(site, wanted.socket)
    if find(site.node, identifiers) is None:
        graph.tell(site, f"has no input '{wanted.socket}', {wanted.default:g} is used")
        return wanted.default if wanted.kind == "number" else (wanted.default,) * 3
    return graph.parameter(site, identifiers, wanted.default, wanted.kind, wanted.low, wanted.high)


def _identifiers(site, name):
    return tuple(socket.identifier for socket in site.node.inputs if socket.name == name)
