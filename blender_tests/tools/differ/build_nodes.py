"""Records of nodes as nodes: what this Blender lacks is left out, and links to it with it."""

import bpy

from . import build_outputs
from .record import is_link

_TYPES = {
    "f": ("NodeSocketFloat", "FLOAT"), "c": ("NodeSocketColor", "RGBA"), "v": ("NodeSocketVector", "VECTOR"),
    "s": ("NodeSocketShader", "SHADER"),
}  # fmt: skip
# Principled's sockets since 4.0, and what 3.x calls them; nodes whose inputs were called otherwise.
_OTHER_NAMES = {
    "Specular IOR Level": ("Specular",), "Transmission Weight": ("Transmission",), "Coat Weight": ("Clearcoat",),
    "Coat Roughness": ("Clearcoat Roughness",), "Coat Normal": ("Clearcoat Normal",), "Sheen Weight": ("Sheen",),
    "Emission Color": ("Emission",), "Roughness": ("Sigma",), "Fac": ("Factor",), "Color1": ("Color", "A"),
}  # fmt: skip
_OTHER_NODES = {"ShaderNodeBsdfSheen": "ShaderNodeBsdfVelvet"}


def build_group(name, fields):
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for direction, sockets in (("INPUT", fields["inputs"]), ("OUTPUT", fields["outputs"])):
        for socket, type_ in sockets.items():
            if bpy.app.version >= (4, 0):
                tree.interface.new_socket(socket, in_out=direction, socket_type=_TYPES[type_][0])
            else:
                (tree.inputs if direction == "INPUT" else tree.outputs).new(_TYPES[type_][0], socket)
    return tree


def build_node(tree, name, fields, find):
    """The node, or None where this Blender has none of its kind."""
    kind = fields["kind"]
    if not hasattr(bpy.types, kind):
        kind = _OTHER_NODES.get(kind, kind)
    try:
        node = tree.nodes.new(kind)
    except RuntimeError:
        return None
    node.name = name
    if "aov" in fields:
        build_outputs.name_aov(node, fields["aov"])
    if "zone" in fields:
        node.repeat_items.clear()
        node.repeat_items.new(_TYPES[fields["zone"]][1], "Item")
    end = find(fields.get("pair"))
    if end is not None:
        node.pair_with_output(end)
    for setting, value in fields.get("props", {}).items():
        if isinstance(value, str) and value.startswith("@"):
            value = find(value)
        _set(node, setting, value)
    if "user" in fields:
        own = node.image_user
        own.frame_duration, own.frame_start, own.frame_offset, own.use_cyclic, own.use_auto_refresh = fields["user"]
    if "sampled" in fields:
        node.sample_attribute_items.new("RGBA", "Sampled")
        _socket(node.inputs, "Value_0").default_value = fields["sampled"]
    if "output" in fields:
        value = fields["output"]
        socket = node.outputs[0]
        socket.default_value = value if isinstance(value, float) else (*value, 1.0)[: len(socket.default_value)]
    if "ramp" in fields:
        _set_ramp(node.color_ramp, fields["ramp"])
    if "curves" in fields:
        _set_curves(node.mapping, fields["curves"])
    for setting, value in fields.get("mapping", {}).items():
        _set(node.texture_mapping, setting, value)
    for key, value in fields.get("inputs", {}).items():
        socket = _socket(node.inputs, key)
        if socket is None:
            continue
        if is_link(value):
            link(tree, value, socket, find)
        else:
            _give(socket, value)
    node.mute = fields.get("mute", False)
    return node


def link(tree, value, socket, find):
    """Link an output, [name of the node, key], to an input; nothing where one of them is missing."""
    source = find(value[0])
    output = None if source is None or socket is None else _socket(source.outputs, value[1])
    if output is not None:
        tree.links.new(output, socket)


def build_link(fields, find):
    """The link to a node that is older than its source."""
    node = find(fields["node"])
    if node is not None:
        link(node.id_data, fields["source"], _socket(node.inputs, fields["input"]), find)


def _set(owner, name, value):
    # A choice that this Blender does not offer is left at what the node comes with.
    if value is not None and hasattr(owner, name):
        try:
            setattr(owner, name, value)
        except TypeError:
            return


def _socket(sockets, key):
    """By identifier, enabled ones first; by name, or by number."""
    if key.isdigit():
        return sockets[int(key)]
    for name in (key, *_OTHER_NAMES.get(key, ())):
        for found in ([s for s in sockets if s.identifier == name], [s for s in sockets if s.name == name]):
            if found:
                return next((socket for socket in found if socket.enabled), found[0])
    return None


def _give(socket, value):
    current = getattr(socket, "default_value", None)
    if current is None:
        return
    if hasattr(current, "__len__"):
        value = [value] * 3 if not isinstance(value, list) else value
        socket.default_value = (*value, 1.0)[: len(current)]
    elif not isinstance(value, list):
        socket.default_value = type(current)(value)


def _set_ramp(ramp, fields):
    for setting in ("color_mode", "interpolation", "hue_interpolation"):
        _set(ramp, setting, fields.get(setting))
    elements = fields["elements"]
    while len(ramp.elements) < len(elements):
        ramp.elements.new(0.5)
    for element, (place, color) in zip(ramp.elements, elements, strict=False):
        element.position, element.color = place, color


def _set_curves(mapping, points):
    for number, (x, y) in enumerate(points):
        mapping.curves[number % len(mapping.curves)].points.new(x, y)
    mapping.update()
