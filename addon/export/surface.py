"""Shader nodes as weighted lobes, emission, transmittance and holdout, collected through Mix and Add Shaders."""

from dataclasses import fields, replace

from ..bindings import snapshot
from ..bindings.enums import LobeKind, Rules
from ..bindings.shading import NodeRef
from ..messages.severity import Severity
from .arithmetic import is_constant, triple
from .closures import CLOSURES, read_unknown
from .coordinates import default_tangent
from .graph import NodeGraph
from .old_ranges import tell_length
from .sockets import RULES, output_node
from .walk import Site

_MAX_LOBES = 64  # the core's limit
_NONE = (0.0, 0.0, 0.0)  # a normal or tangent: the surface's own
# Lobes linear in their colour, into which a constant weight is multiplied. Rough diffuse is not linear: its interreflection
# between facets depends on powers of the colour.
_LINEAR = {LobeKind.LAMBERT, LobeKind.TRANSLUCENT, LobeKind.REFRACTION, LobeKind.SHEEN, LobeKind.TOON, LobeKind.HAIR}

# Lobes whose colour does not scale them.
_BRIGHT_IF_BLACK = {LobeKind.CONDUCTOR, LobeKind.HAIR_FIBRE}


class Surface:
    """Collects closures upstream of a shader socket, weighted by the Mix and Add Shaders on the way."""

    def __init__(self, graph):
        self.graph = graph
        self.emission = 0.0
        self.transmittance = 0.0
        self.holdout = 0.0
        self.ambient = 0.0
        # Cycles' estimate of the emission, which decides whether to sample it: linked inputs count as 1.
        self.estimated = _NONE
        self._share = 1.0  # estimated weight of the current closure
        self._lobes = []
        self._portals = []

    @property
    def lobes(self):
        if len(self._lobes) > _MAX_LOBES:
            graph = self.graph
            graph.messages.add(
                f"{graph.owner}: has {len(self._lobes)} lobes, the first {_MAX_LOBES} are used", "feature:many lobes"
            )
        return tuple(self._lobes[:_MAX_LOBES])

    @property
    def portals(self):
        if len(self._portals) > _MAX_LOBES:
            graph = self.graph
            text = f"has {len(self._portals)} portals, rays pass those beyond the first {_MAX_LOBES} straight"
            graph.messages.add(f"{graph.owner}: {text}", "feature:many portals")
        return tuple(self._portals[:_MAX_LOBES])

    def read(self, site, socket):
        """Add all closures upstream of a shader socket."""
        root = self.graph.origin(site, socket)
        if root.site is None:
            return
        weights, shares = {_key(root): 1.0}, {_key(root): 1.0}
        # Cycles treats a colour linked to the output as a preview, and samples it as a light only if it is very bright.
        if root.output.type != "SHADER":
            shares[_key(root)] = 0.1
        for origin in self._in_order(root):
            weight = weights.get(_key(origin), 0.0)
            if is_constant(weight, 0.0):
                continue
            self._share = shares[_key(origin)]
            with self.graph.made_by(self.graph.title(origin.site)):
                parts = self._read_one(origin, weight)
            for source, part in parts:
                if source.site is not None:
                    key = _key(source)
                    weights[key] = self.graph.add(weights.get(key, 0.0), self.graph.multiply(weight, part))
                    shares[key] = shares.get(key, 0.0) + self._share * (1.0 if isinstance(part, NodeRef) else part)
        if RULES == Rules.BLENDER_3 and not is_constant(self.transmittance, 0.0) and any(map(_lets_through, self._lobes)):
            # Cycles 3 treats Transparent's direction as sampled from all lobes, and adds the other lobes' values for it.
            self.graph.messages.add(
                f"{self.graph.owner}: beside Translucent, rough Glass or Refraction a Transparent part shows what is behind "
                "in its own colour, which Cycles 3 mixes with theirs",
                "feature:Transparent beside Translucent of Cycles 3",
            )

    def _in_order(self, root):
        """Return the closures from root on, each before those that it mixes. Iterative, for chains of any length."""
        done, order, open_ = set(), [], [(root, False)]
        while open_:
            origin, finished = open_.pop()
            key = _key(origin)
            if finished:
                order.append(origin)
            elif key not in done:
                done.add(key)
                open_.append((origin, True))
                if origin.site.node.type in ("MIX_SHADER", "ADD_SHADER"):
                    sources = (self.graph.origin(origin.site, socket) for socket in _shader_inputs(origin.site))
                    open_.extend((source, False) for source in sources if source.site is not None)
        return reversed(order)

    def _read_one(self, origin, weight):
        """Add one closure, or return the (origin, part of the weight) pairs of a Mix or Add Shader."""
        graph, site, node = self.graph, origin.site, origin.site.node
        if origin.output.type != "SHADER":
            # A colour linked to a shader socket is emission.
            color = graph.color_of(origin)
            self.estimate(color, 1.0)
            self.emit(graph.multiply(color, weight))
            return ()
        if node.type == "MIX_SHADER":
            first, second = (graph.origin(site, socket) for socket in _shader_inputs(site))
            factor = graph.clamped(graph.parameter(site, ("Fac", "Factor"), 0.5, low=0.0, high=1.0))
            rest = graph.subtract(1.0, factor)
            return ((first, rest), (second, factor))
        if node.type == "ADD_SHADER":
            return tuple((graph.origin(site, socket), 1.0) for socket in _shader_inputs(site))
        CLOSURES.get(node.type, read_unknown)(self, site, weight)
        return ()

    # ---- contributions of closures ----

    def emit(self, radiance):
        self.emission = self.graph.add(self.emission, radiance)

    def estimate(self, color, strength):
        level = [1.0 if isinstance(value, NodeRef) else value for value in (color, strength)]
        parts = zip(self.estimated, triple(level[0]), triple(level[1]), strict=True)
        self.estimated = tuple(sum_ + self._share * x * y for sum_, x, y in parts)

    def transmit(self, share):
        self.transmittance = self.graph.add(self.transmittance, share)

    def send_on(self, weight, position, direction):
        """Let a share of the light go on elsewhere. position: None is where it is; direction: (0, 0, 0) is straight on."""
        if is_constant(weight, 0.0):
            return
        self.transmit(weight)
        place = {} if position is None else {"moves": 1, "position": position}
        weight = weight if isinstance(weight, NodeRef) else triple(weight)
        self._portals.append(snapshot.Portal(weight=weight, direction=direction, **place))

    def add_ambient(self, color):
        self.ambient = self.graph.add(self.ambient, color)

    def add(self, kind, weight, color=(1.0, 1.0, 1.0), rules=RULES, **values):
        """Add a lobe; skip black ones and merge it with an equal one, to save time."""
        weight, color = (value if isinstance(value, NodeRef) else triple(value) for value in (weight, color))
        if is_constant(color, 0.0) and kind not in _BRIGHT_IF_BLACK or is_constant(weight, 0.0):
            return
        if kind in _LINEAR and not isinstance(weight, NodeRef) and not isinstance(color, NodeRef):
            color, weight = self.graph.multiply(color, weight), (1.0, 1.0, 1.0)
        lobe = snapshot.Lobe(kind=kind, color=color, weight=weight, rules=rules, **values)
        field = "color" if kind in _LINEAR else "weight"
        for number, other in enumerate(self._lobes):
            if _same_but(lobe, other, field):
                total = tuple(x + y for x, y in zip(getattr(lobe, field), getattr(other, field), strict=True))
                self._lobes[number] = replace(other, **{field: total})
                return
        self._lobes.append(lobe)

    def normal(self, site, names=("Normal",)):
        normal = self.graph.linked(site, names, self.graph.normal)
        tell_length(self.graph, site, normal)
        return normal

    def tangent(self, site, anisotropy):
        """Return the tangent, which only anisotropic lobes need."""
        if is_constant(anisotropy, 0.0):
            return _NONE
        tangent = self.graph.linked(site, ("Tangent",), None)
        return default_tangent(self.graph) if tangent is None else tangent

    def color(self, site, names=("Color",), default=(0.8, 0.8, 0.8)):
        return self.graph.parameter(site, names, default, kind="color")

    def share(self, site, names, default=0.0):
        return self.graph.parameter(site, names, default, low=0.0, high=1.0)


def _shader_inputs(site):
    return [socket for socket in site.node.inputs if socket.type == "SHADER"][:2]


def _key(origin):
    return (*origin.site.key, origin.output.as_pointer())


def _lets_through(lobe):
    """Whether a lobe transmits light in more than one direction."""
    if lobe.kind == LobeKind.PRINCIPLED:
        return not is_constant(lobe.principled.transmission, 0.0)
    rough = not is_constant(lobe.roughness, 0.0)
    return lobe.kind == LobeKind.TRANSLUCENT or lobe.kind in (LobeKind.GLASS, LobeKind.REFRACTION) and rough


def _same_but(lobe, other, field):
    """Whether two lobes are equal but for one field, which is constant in both."""
    if any(isinstance(getattr(item, field), NodeRef) for item in (lobe, other)):
        return False
    return all(getattr(lobe, f.name) == getattr(other, f.name) for f in fields(lobe) if f.name != field)


def emission_of(graph: NodeGraph, tree, kind):
    """Return the emission, RGB or NodeRef, of a tree's output node of type kind (OUTPUT_WORLD, OUTPUT_LIGHT).

    Black if nothing is linked; other closures are left out, with a message.
    """
    output = output_node(tree, kind) if tree is not None else None
    if output is None:
        return _NONE
    surface = Surface(graph)
    surface.read(Site(output), output.inputs["Surface"])
    if surface.lobes or not is_constant(surface.transmittance, 0.0) or not is_constant(surface.holdout, 0.0):
        text = "only Background and Emission shine, other shaders are left out"
        graph.messages.add(f"{graph.owner}: {text}", "feature:surfaces of worlds and lights", severity=Severity.LEFT_OUT)
    return surface.emission if isinstance(surface.emission, NodeRef) else triple(surface.emission)
