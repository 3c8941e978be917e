"""The course's models: the lobes that their parameters describe, and the node groups that represent them.

A custom property of a group's tree names the model; the property survives copying, linking, renaming and Blenders without
the add-on. Lancer reads the group's sockets, constant or linked, by name; Cycles and EEVEE show the nodes inside.
"""

import math
from collections import namedtuple

from ..bindings.enums import LobeKind, Rules
from .sockets import find

TAG = "lancer_model"
_INSIDE = "lancer_inside"  # the links between the nodes inside when the group was made
NORMAL = "Normal"

# field: the parameter's field of the lobe.
Parameter = namedtuple("Parameter", "socket kind default low high field", defaults=("color", 0.0, 0.0, math.inf, "color"))
# Keyed by the names of the material's settings, from which the sockets get their descriptions.
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
    """Return the names of a model's parameters, in the order of its sockets."""
    return (*(name for _, *names in MODELS[model] for name in names), "ka")


def lobes_of(model, value):
    """Yield (kind, fields) of each lobe; value(name) returns the value of a parameter."""
    for kind, *names in MODELS[model]:
        yield kind, {PARAMETERS[name].field: value(name) for name in names}


def model_of(tree):
    """Return the model that a node tree represents; None for other trees and for models that this version lacks."""
    model = None if tree is None else tree.get(TAG)
    return model if isinstance(model, str) and model in MODELS else None


def mark(tree, model):
    """Mark a finished tree as the group of a model."""
    tree[TAG], tree[_INSIDE] = model, _inside(tree)


def is_as_made(tree):
    """Whether the same pairs of nodes are linked as when the group was made. Blender versions rename and reorder sockets."""
    return tree.get(_INSIDE) == _inside(tree)


def _inside(tree):
    return "; ".join(sorted(f"{link.from_node.name} > {link.to_node.name}" for link in tree.links))


def read_group(surface, site, weight):
    """Add the lobes and the ambient colour of a group node to a Surface."""
    graph, tree = surface.graph, site.node.node_tree
    model = model_of(tree)
    if not is_as_made(tree):
        graph.tell(
            site,
            f"the nodes inside '{tree.name}' were changed, which only Cycles and EEVEE show; Lancer shows the model that the "
            "node's inputs describe. Ungroup the node to render its nodes instead",
        )
    normal = surface.normal(site, _identifiers(site, NORMAL))
    for kind, fields in lobes_of(model, lambda name: _value(graph, site, name)):
        # The models are the same in all versions of Blender.
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
