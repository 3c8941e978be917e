"""Short notation for node trees, with names of sockets for all versions of Blender."""

import bpy

from .. import parts

# Principled's sockets by their names since 4.0, with their names in 3.x.
OLD_SOCKETS = {
    **parts.OLD_SOCKETS,
    "Subsurface Weight": "Subsurface",
    "Sheen Weight": "Sheen",
    "Coat Roughness": "Clearcoat Roughness",
    "Coat Normal": "Clearcoat Normal",
}
# Nodes that another node replaced.
_OLD_NODES = {"ShaderNodeBsdfSheen": "ShaderNodeBsdfVelvet"}


class Nodes:
    """A tree under construction."""

    def __init__(self, tree):
        self.tree = tree

    def add(self, kind, *values, props=None, **inputs):
        """Adds and returns a node. values set inputs by position, inputs by name with _ for blanks; an output is linked."""
        if bpy.app.version < (4, 0, 0):
            kind = _OLD_NODES.get(kind, kind)
        node = self.tree.nodes.new(kind)
        # Settings first: they decide which sockets exist.
        for name, value in (props or {}).items():
            setattr(node, name, value)
        for socket, value in zip(node.inputs, values, strict=False):
            self.give(socket, value)
        for name, value in inputs.items():
            self.give(find(node.inputs, name.replace("_", " ")), value)
        return node

    def give(self, socket, value):
        if isinstance(value, bpy.types.Node):
            value = first_output(value)
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
            return
        if isinstance(value, (tuple, list)) and hasattr(socket.default_value, "__len__"):
            value = (*value, 1.0)[: len(socket.default_value)]
        socket.default_value = value

    def link(self, output, socket):
        self.tree.links.new(first_output(output) if isinstance(output, bpy.types.Node) else output, socket)


def first_output(node):
    return next(socket for socket in node.outputs if socket.enabled)


def find(sockets, name):
    """Returns the enabled socket of that name in any version, ignoring case; raises KeyError if there is none."""
    names = [name, OLD_SOCKETS.get(name, name)]
    lower = {n.lower() for n in names}
    for socket in sockets:
        if socket.enabled and socket.name.lower() in lower:
            return socket
    raise KeyError(f"no socket {name} among {[socket.name for socket in sockets if socket.enabled]}")


def material(build, name="Material", displacement=None):
    """Returns a material with the surface that build(nodes) returns."""
    result = bpy.data.materials.new(name)
    nodes = Nodes(parts.enable_nodes(result))
    output = nodes.add("ShaderNodeOutputMaterial")
    surface = build(nodes)
    if isinstance(surface, tuple):
        surface, height = surface
        nodes.link(height, output.inputs["Displacement"])
    nodes.link(surface, output.inputs["Surface"])
    return result


def shader(kind, props=None, name="Material", **inputs):
    """Returns a material of one shader."""
    return material(lambda nodes: nodes.add(kind, props=props, **inputs), name)


def principled(**inputs):
    return shader("ShaderNodeBsdfPrincipled", **inputs)


def world(scene, build):
    """Sets a world with the surface that build(nodes) returns."""
    result = bpy.data.worlds.new("World")
    nodes = Nodes(parts.enable_nodes(result))
    nodes.link(build(nodes), nodes.add("ShaderNodeOutputWorld").inputs["Surface"])
    scene.world = result
    return result


def with_node(kind):
    """Returns a function for a case's `needs`, which reports whether this Blender lacks the node."""

    def needs():
        return "" if hasattr(bpy.types, kind) else f"this Blender has no {kind}"

    return needs


def with_socket(kind, name):
    """Returns a function for a case's `needs`, which reports whether the node lacks the input."""

    def needs():
        tree = bpy.data.node_groups.new("Probe", "ShaderNodeTree")
        names = [socket.name for socket in tree.nodes.new(kind).inputs]
        bpy.data.node_groups.remove(tree)
        return "" if name in names else f"{kind} has no input {name} in this Blender"

    return needs
