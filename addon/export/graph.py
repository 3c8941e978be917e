"""Blender's value nodes as nodes of the core, constants folded on the way.

    graph = NodeGraph("material 'Wood'", messages, images, depsgraph)
    strength = graph.parameter(node, ("Strength",), 1.0)          # a number, or a NodeRef
    color = graph.parameter(node, ("Color",), kind="color")       # three numbers, or a NodeRef
    snapshot.World(radiance=graph.multiply(color, strength), nodes=graph.nodes)

node is a node of Blender, or a Site if it may be inside a group. add, multiply, mix and subtract fold constants too.
surface.emission_of(graph, tree, "OUTPUT_WORLD" or "OUTPUT_LIGHT") reads the whole tree of a world or light.
"""

import math

import bpy

from ..bindings.enums import VectorOperation
from ..bindings.shading import NodeRef
from ..messages.severity import Severity
from . import (
    colors,
    coordinates,
    curves,
    ies,
    looking,
    maths,
    normals,
    patterns,
    places,
    point_density,
    procedural,
    skies,
    spectrum,
    textures,
)
from .arithmetic import THIRDS, triple
from .node_builder import UNKNOWN, NodeBuilder, in_three
from .resolved import ShaderTree
from .shader_cache import Sources
from .sockets import find
from .walk import Site, Walker

_MODULES = (
    maths, colors, curves, coordinates, normals, textures, procedural, patterns, places, spectrum, ies, skies, looking,
    point_density,
)  # fmt: skip
_READERS = {kind: reader for module in _MODULES for kind, reader in module.READERS.items()}
_SCALARS = {"VALUE", "INT", "BOOLEAN"}
_VECTORS = {"VECTOR", "ROTATION"}
# Types of the nodes whose changes over a pixel Cycles follows to images in its texture cache.
_CHANGING = {
    "ATTRIBUTE", "COMBXYZ", "MAPPING", "NEW_GEOMETRY", "SEPXYZ", "TEX_COORD", "TEX_ENVIRONMENT", "TEX_IMAGE", "UVMAP",
    "VECT_MATH", "VERTEX_COLOR",
}  # fmt: skip
_DEEPEST = 150  # depth of recursion in nodes; each node takes several of Python's 1000 nested calls
_STRIDE = 100  # depth in nodes at which _look_ahead computes and caches a value
_CONVERTS_ENDS_ONLY = bpy.app.version >= (5, 0)
# From 5.0 on the constant of a group's socket counts as linked to the inputs that it reaches.
_LINKS_CONSTANTS = bpy.app.version >= (5, 0)


class NodeGraph(NodeBuilder):
    def __init__(self, owner, messages, images=None, depsgraph=None, unknown="mid-grey"):
        """unknown: the colour of nodes that are not supported, mid-grey for surfaces and white for emitters."""
        super().__init__(owner, messages, images, unknown)
        self.depsgraph = depsgraph
        self.attributes = set()  # names of mesh attributes that the nodes read
        self.objects = set()  # identities of the objects whose transform the nodes read
        self.is_of_world = False  # whether the nodes are seen in a direction, and not at a place of a mesh
        self.is_of_lamp = False  # whether the nodes are seen at a point of a lamp
        self.has_volume = False  # whether the material has a volume beside its surface
        # For a lamp: a function that returns four numbers by the name of an ObjectAttribute or of LAMP_FACTS.
        self.lamp_value = None
        self.texts = set()  # (identity, contents) of the texts that the nodes read
        self.files = set()  # file_state() of the files that the nodes read, images apart
        self.reads_layer = False  # whether the nodes read properties of the view layer, the scene or its world
        self.reads_time = False  # whether the nodes read the frame or the time
        self.material_index = 0  # of the owner; 0 if the owner is no material
        self.normal = (0.0, 0.0, 0.0)  # the bumped normal of the whole material; (0, 0, 0) is the shading normal
        self._ignored = set()
        self._walker = Walker(_has_scripts(depsgraph))
        self._tree = None  # the ShaderTree that is read
        self._active = set()
        self._is_ahead = False

    def read_integrator(self):
        """Return the scene's integrator; "" without a depsgraph."""
        self.reads_layer = True
        return "" if self.depsgraph is None else self.depsgraph.scene.lancer.integrator

    @property
    def sources(self):
        """The Sources that the nodes read."""
        return Sources(frozenset(self.objects), self.reads_layer, self.reads_time, frozenset(self.texts), frozenset(self.files))

    def tree_of(self, block):
        """Return the nodes of a material, world or light as Cycles reads them; None without any."""
        self._tree = ShaderTree(block)
        for name in self._tree.models:
            text = f"beside zones, bundles or menus the nodes inside the group '{name}' are shown, as in Cycles"
            self.messages.add(f"{self.owner}: {text}")
        return self._tree.tree

    def title(self, site):
        """Return a node's name, behind those of the groups around it, with which the user finds it."""
        return " / ".join(self._name(node) for node in (*site.path, site.node))

    def _name(self, node):
        return node.name if self._tree is None else self._tree.name(node)

    def origin(self, site, socket):
        """Return the Origin of a socket, and tell of the nodes before it that Cycles ignores."""
        found = self._walker.origin(site, socket)
        while self._walker.ignored:
            self._tell_ignored(self._walker.ignored.pop())
        return found

    def _tell_ignored(self, site):
        is_script = site.node.type == "SCRIPT"
        # The scene decides whether scripts run.
        self.reads_layer = self.reads_layer or is_script
        if site.key not in self._ignored:
            self._ignored.add(site.key)
            when = " without Open Shading Language" if is_script else ""
            self.tell(site, f"{site.node.bl_label} has no effect{when}, as in Cycles", "", Severity.HINT)

    def who(self, site):
        """Return the owner and the node, as messages name them."""
        return f"{self.owner}, node '{self._name(_site(site).node)}'"

    def tell(self, site, text, key=None, severity=Severity.DIFFERENT):
        """Add a message that names the node. key: of Messages.add; None counts the node's type as missing, "" nothing."""
        key = f"node:{_site(site).node.bl_label}" if key is None else key
        self.messages.add(f"{self.who(site)}: {text}", key, severity)

    def parameter(self, site, names, default=0.0, kind="number", low=-math.inf, high=math.inf):
        """Return the node's first input with one of the names, made finite; default if this Blender has none.

        kind: number, color (not negative) or vector. low and high limit constant numbers.
        """
        site = _site(site)
        socket = find(site.node, names)
        if socket is None:
            return default
        value = self._read(site, socket)
        if isinstance(value, NodeRef):
            return value
        if kind == "number":
            value = value if isinstance(value, float) else value[0]
            # Most are usable: name the node only for a message.
            if low <= value <= high and math.isfinite(value):
                return value
            return self.messages.number(value, self.who(site), socket.name, default, low, high)
        if kind == "color":
            return self.messages.color(triple(value), self.who(site), socket.name, 0.5)
        who = self.who(site)
        return tuple(self.messages.number(x, who, socket.name, 0.0) for x in triple(value))

    def value(self, site, name):
        """Return the value of an input, given by identifier or by number."""
        socket = site.node.inputs[name] if isinstance(name, int) else find(site.node, (name,))
        return self.input(site, socket)

    def is_linked(self, site, names):
        site = _site(site)
        socket = find(site.node, names)
        if socket is None:
            return False
        origin = self.origin(site, socket)
        return origin.site is not None or _gives_constant(origin, socket)

    def linked(self, site, names, default, evaluated=False):
        """Return the value linked to an input; default if no link with a supported source reaches the input.

        evaluated: whether Blender 5 evaluates the node if all its inputs are constant.
        """
        site = _site(site)
        socket = find(site.node, names)
        origin = None if socket is None else self.origin(site, socket)
        if origin is not None and origin.site is None:
            if _gives_constant(origin, socket) or evaluated and self._is_evaluated(site, origin, socket):
                return self.input(site, socket)
        if origin is None or origin.site is None:
            return default
        if self._output(origin.site, origin.output) is None:
            source = f"'{self._name(origin.site.node)}' ({origin.site.node.bl_label})"
            self.tell(
                site, f"input '{socket.name}' is linked to {source}, which is not supported, its default is used", _key(origin)
            )
            return default
        return self.input(site, socket)

    def _is_evaluated(self, site, origin, socket):
        """Whether Blender evaluates a node: a group's constant reaches an input, and the others are constant."""
        if not _reaches(origin, socket):
            return False
        others = (other for other in site.node.inputs if other.enabled and other != socket)
        return not any(isinstance(self._read(site, other), NodeRef) for other in others)

    def input(self, site, socket):
        """Return the value that reaches a socket; a constant that is not finite becomes 0, with a message."""
        value = self._read(site, socket)
        if isinstance(value, NodeRef) or all(map(math.isfinite, triple(value))):
            return value
        self.tell(site, f"input '{socket.name}' is not finite, 0 is used", "")
        return 0.0 if isinstance(value, float) else (0.0, 0.0, 0.0)

    def _read(self, site, socket):
        # Most sockets have no link, and need no Origin.
        if not socket.is_linked:
            return _constant(socket)
        origin = self.origin(site, socket)
        value = None if origin.site is None else self._output(origin.site, origin.output)
        types = origin.types
        if value is not None:
            types = (*types, origin.output.type)
        elif origin.site is None:
            value = _constant(origin.socket)
        else:
            value, types = self._stand_in(site, socket, origin), types[:1]
        # Convert at every socket on the way; from 5.0 on only constants are converted at each, node results once.
        if _CONVERTS_ENDS_ONLY and isinstance(value, NodeRef):
            types = (types[0], types[-1])
        for target, source in zip(reversed(types[:-1]), reversed(types[1:]), strict=True):
            value = self._convert(value, source, target)
        return value

    def color_of(self, origin):
        """Return the value of an origin as a colour; the unknown colour, with a message, if it is not supported."""
        value = self._output(origin.site, origin.output)
        if value is None:
            self.tell(
                origin.site, f"{origin.site.node.bl_label} is not supported, {self.unknown} is used", severity=Severity.WRONG
            )
            return UNKNOWN[self.unknown]
        return in_three(value)

    def _output(self, site, output):
        """Return the value of an output; None if its node is not supported or nests too deeply."""
        values = self._scopes[-1].values
        key = (*site.key, output.as_pointer())
        if key in values:
            return values[key]
        if not self._active and not self._is_ahead:
            self._look_ahead(site, output)
        if key in self._active or len(self._active) >= _DEEPEST:
            return None
        self._active.add(key)
        reader = _READERS.get(site.node.type)
        with self.made_by(self.title(site), self._takes_as_steady(site)):
            value = None if reader is None else reader(self, site, output)
        self._active.discard(key)
        values[key] = value
        return value

    def _takes_as_steady(self, site):
        """Whether Cycles takes the values of a node as constant over a pixel where it chooses the level of an image."""
        return self.images is not None and self.images.texture_cache is not None and site.node.type not in _CHANGING

    def _look_ahead(self, site, output):
        """Compute values along chains of nodes that are longer than calls can nest, starting at the far end."""
        self._is_ahead = True
        depths, open_ = {}, [(site, output, None)]
        while open_:
            site, output, sources = open_.pop()
            key = (*site.key, output.as_pointer())
            if sources is not None:
                depths[key] = 1 + max((depths[source] for source in sources), default=0)
                if depths[key] % _STRIDE == 0:
                    self._output(site, output)
            elif key not in depths:
                depths[key] = 0
                origins = [self.origin(site, socket) for socket in site.node.inputs if socket.enabled]
                origins = [origin for origin in origins if origin.site is not None]
                open_.append((site, output, [(*origin.site.key, origin.output.as_pointer()) for origin in origins]))
                open_.extend((origin.site, origin.output, None) for origin in origins)
        self._is_ahead = False

    def _stand_in(self, site, socket, origin):
        """Return the stand-in, with a message, for an input whose source is not supported."""
        source = f"'{self._name(origin.site.node)}' ({origin.site.node.bl_label})"
        if socket.type == "RGBA":
            told = f"input '{socket.name}' is linked to {source}, which is not supported, {self.unknown} is used"
            self.tell(site, told, _key(origin), Severity.WRONG)
            return UNKNOWN[self.unknown]
        value = _constant(socket)
        told = f"{value:g}" if isinstance(value, float) else ", ".join(f"{x:g}" for x in value)
        self.tell(
            site,
            f"input '{socket.name}' is linked to {source}, which is not supported, the constant {told} is used",
            _key(origin),
        )
        return value

    def _convert(self, value, source, target):
        if target in _SCALARS and source not in _SCALARS:
            return self.grey(value) if source == "RGBA" else self.vector_op(VectorOperation.DOT_PRODUCT, value, THIRDS)
        return in_three(value) if target not in _SCALARS else value


def _gives_constant(origin, socket):
    """Whether the constant of a group's socket takes the place of an input's default; not if both hide their vectors."""
    given = origin.socket
    return _reaches(origin, socket) and not (given.type == "VECTOR" and given.hide_value and socket.hide_value)


def _reaches(origin, socket):
    """Whether the constant of a group's socket reaches an input as a link."""
    return _LINKS_CONSTANTS and origin.socket not in (None, socket) and hasattr(origin.socket, "default_value")


def _has_scripts(depsgraph):
    """Whether Cycles runs Script nodes. Cycles is an add-on and may be disabled."""
    return depsgraph is not None and getattr(getattr(depsgraph.scene, "cycles", None), "shading_system", False)


def _site(node):
    return node if isinstance(node, Site) else Site(node)


def _key(origin):
    return f"node:{origin.site.node.bl_label}"


def _constant(socket):
    """Return the constant of a socket; 0 if it has none."""
    value = getattr(socket, "default_value", 0.0)
    if type(value) is float:
        return value
    if hasattr(value, "__len__") and not isinstance(value, str):
        return (*map(float, value[:3]), 0.0, 0.0, 0.0)[:3]
    return float(value) if isinstance(value, (int, float)) else 0.0
