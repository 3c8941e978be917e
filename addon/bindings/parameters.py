"""The nodes that feed a material's parameters: find them, replace them by constants, remove unused ones."""

from __future__ import annotations

import dataclasses

from .enums import NodeKind
from .shading import Lobe, Material, NodeRef, Output, Portal, Principled

_MATERIAL = Material.PARAMETERS
_LOBE = Lobe.PARAMETERS
_PORTAL = Portal.PARAMETERS
_OUTPUT = Output.PARAMETERS
_PRINCIPLED = Principled.PARAMETERS


def is_zero(value):
    """Whether a parameter is the constant 0; False for a NodeRef, whose value is unknown."""
    if isinstance(value, NodeRef):
        return False
    return not any(value) if isinstance(value, tuple) else value == 0.0


def may_be_positive(value):
    if isinstance(value, NodeRef):
        return True
    return max(value) > 0.0 if isinstance(value, tuple) else value > 0.0


def sources(nodes, value):
    """Return the numbers of all nodes that a parameter depends on."""
    found, open_ = set(), [value.node] if isinstance(value, NodeRef) else []
    while open_:
        number = open_.pop()
        if number in found:
            continue
        found.add(number)
        node = nodes[number]
        open_.extend(x.node for x in node.inputs if isinstance(x, NodeRef))
        # A bump evaluates a range of nodes for its height.
        if node.kind == NodeKind.BUMP:
            open_.extend(range(node.first, number))
    return found


def kinds_of_sources(nodes, value):
    return {nodes[number].kind for number in sources(nodes, value)}


def map_parameters(material, change):
    """Return the material with every parameter replaced by change(owner, name, value), or itself if none changes.

    owner: "material", "lobe", "principled", "portal" or "output".
    """

    def mapped(record, owner, names):
        values = {name: change(owner, name, getattr(record, name)) for name in names}
        return {name: value for name, value in values.items() if value is not getattr(record, name)}

    lobes = []
    for lobe in material.lobes:
        changes = mapped(lobe, "lobe", _LOBE)
        if lobe.principled is not None and (inner := mapped(lobe.principled, "principled", _PRINCIPLED)):
            changes["principled"] = dataclasses.replace(lobe.principled, **inner)
        lobes.append(dataclasses.replace(lobe, **changes) if changes else lobe)
    changes = mapped(material, "material", _MATERIAL)
    if any(new is not old for new, old in zip(lobes, material.lobes, strict=True)):
        changes["lobes"] = tuple(lobes)
    for name, owner, names in (("portals", "portal", _PORTAL), ("outputs", "output", _OUTPUT)):
        old = getattr(material, name)
        new = [dataclasses.replace(item, **inner) if (inner := mapped(item, owner, names)) else item for item in old]
        if any(one is not other for one, other in zip(new, old, strict=True)):
            changes[name] = tuple(new)
    return dataclasses.replace(material, **changes) if changes else material


def parameters(material):
    """Return (owner, name, value) of every parameter."""
    found = []

    def note(owner, name, value):
        found.append((owner, name, value))
        return value

    map_parameters(material, note)
    return found


def reached(nodes, values):
    """Return the numbers of the nodes that any of these parameters depends on, in their order."""
    return sorted(set().union(*(sources(nodes, value) for value in values)))


def kept(nodes, order):
    """Return the nodes with the numbers in order, and a function that returns a parameter with their new numbers."""
    number_of = {old: new for new, old in enumerate(order)}

    def renumbered(value):
        return NodeRef(number_of[value.node]) if isinstance(value, NodeRef) else value

    left = []
    for old in order:
        node = nodes[old]
        first = number_of[node.first] if node.kind == NodeKind.BUMP else node.first
        left.append(dataclasses.replace(node, inputs=tuple(map(renumbered, node.inputs)), first=first))
    return tuple(left), renumbered


def only_read(nodes, value):
    """Return the nodes that one parameter depends on, and the parameter that refers to them."""
    left, renumbered = kept(nodes, reached(nodes, [value]))
    return left, renumbered(value)


def read_nodes(material):
    """Return the numbers of the nodes that a material's parameters depend on, in their order."""
    return reached(material.nodes, [value for _, _, value in parameters(material)]) if material.nodes else []


def without_idle_nodes(material):
    """Return the material without the nodes that no parameter depends on."""
    order = read_nodes(material)
    if len(order) == len(material.nodes):
        return material
    nodes, renumbered = kept(material.nodes, order)
    material = map_parameters(material, lambda owner, name, value: renumbered(value))
    return dataclasses.replace(material, nodes=nodes)
