"""Node sockets: their names in each Blender version, and their constant values."""

import math

# Identifiers of the Principled BSDF, newest first; a name that a version lacks is simply not found.
PRINCIPLED = {
    "base_color": ("Base Color",),
    "metallic": ("Metallic",),
    "roughness": ("Roughness",),
    "ior": ("IOR",),
    "alpha": ("Alpha",),
    "specular": ("Specular IOR Level", "Specular"),
    "specular_tint": ("Specular Tint",),
    "transmission": ("Transmission Weight", "Transmission"),
    "transmission_roughness": ("Transmission Roughness",),
    "emission_color": ("Emission Color", "Emission"),
    "emission_strength": ("Emission Strength",),
    "anisotropic": ("Anisotropic",),
    "coat": ("Coat Weight", "Clearcoat"),
    "sheen": ("Sheen Weight", "Sheen"),
    "subsurface": ("Subsurface Weight", "Subsurface"),
    "diffuse_roughness": ("Diffuse Roughness",),
    "thin_film": ("Thin Film Thickness",),
    "thin_wall": ("Thin Wall",),
    "normal": ("Normal",),
    "coat_normal": ("Coat Normal", "Clearcoat Normal"),
}

_GREY = (0.5, 0.5, 0.5)


def find(node, identifiers):
    """The first enabled input with one of the identifiers; None where this Blender has none."""
    for identifier in identifiers:
        for socket in node.inputs:
            if socket.enabled and socket.identifier == identifier:
                return socket
    return None


def source(socket):
    """The output socket that feeds an input, past reroutes and muted nodes; None where nothing does."""
    for _ in range(1000):
        if socket is None or not socket.is_linked:
            return None
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
        if link is None:
            return None
        output = link.from_socket
        if output.node.type == "REROUTE":
            socket = output.node.inputs[0]
        elif output.node.mute:
            inner = next((inner for inner in output.node.internal_links if inner.to_socket == output), None)
            if inner is None:
                return None
            socket = inner.from_socket
        else:
            return output
    return None


def output_node(tree, kind):
    """The output node that renders use: the active one of its type, as Cycles takes it."""
    if hasattr(tree, "get_output_node"):
        node = tree.get_output_node("CYCLES")
        if node is not None and node.type == kind:
            return node
    nodes = [node for node in tree.nodes if node.type == kind and not node.mute]
    return next((node for node in nodes if node.is_active_output), nodes[0] if nodes else None)


class Reader:
    """Reads constants from sockets on behalf of an owner ("material 'Wood'"), and says where there is none."""

    def __init__(self, owner, messages):
        self.owner = owner
        self.messages = messages

    def tell(self, node, text):
        self.messages.add(f"{self.owner}, node '{node.name}': {text}")

    def number(self, node, identifiers, default=0.0, low=0.0, high=math.inf):
        socket = find(node, identifiers)
        if socket is None:
            return default
        fed = source(socket)
        value = socket.default_value
        if fed is not None:
            if fed.node.type == "VALUE":
                value = fed.default_value
            else:
                self.tell(node, f"input '{socket.name}' is linked to '{fed.node.name}', the constant {value:g} is used")
        return self.messages.number(value, f"{self.owner}, node '{node.name}'", socket.name, default, low, high)

    def color(self, node, identifiers, default=_GREY):
        socket = find(node, identifiers)
        if socket is None:
            return default
        fed = source(socket)
        value = socket.default_value
        if fed is not None:
            if fed.node.type == "RGB":
                value = fed.default_value
            else:
                value = _GREY
                self.tell(node, f"input '{socket.name}' is linked to '{fed.node.name}', mid-grey is used")
        if not hasattr(value, "__len__"):
            value = (value,) * 3
        return self.messages.color(value, f"{self.owner}, node '{node.name}'", socket.name, 0.5)

    def unsupported(self, node, names, neutral=0.0):
        """Says so where an input that has no counterpart is in use."""
        socket = find(node, names)
        if socket is None:
            return
        if source(socket) is not None:
            self.tell(node, f"input '{socket.name}' is not supported")
            return
        value = getattr(socket, "default_value", neutral)
        if not hasattr(value, "__len__") and abs(float(value) - neutral) > 1e-6:
            self.tell(node, f"input '{socket.name}' is not supported")
