"""Blender materials as lobes: their weights and values, what they emit, let through, and where they move the surface."""

from typing import NamedTuple

import bpy

from ..bindings import snapshot
from ..bindings.enums import LobeKind, MaterialFlag, NodeKind, ObjectFact
from ..messages.severity import Severity
from .arithmetic import is_constant, triple
from .course_models import PARAMETERS, lobes_of
from .graph import NodeGraph
from .images import Images
from .normals import bump, displacement_height
from .sockets import RULES, output_node
from .surface import Surface
from .walk import Site

# What Cycles shows where there is no material: since 5.0 its Principled BSDF as it comes.
_DEFAULT_LOBE = (
    snapshot.Lobe(LobeKind.LAMBERT, (0.8, 0.8, 0.8))
    if bpy.app.version < (5, 0)
    else snapshot.Lobe(LobeKind.PRINCIPLED, (1.0, 1.0, 1.0), rules=RULES, principled=snapshot.Principled(rules=RULES))
)
_DEFAULT = snapshot.Material(name="default grey", lobes=(_DEFAULT_LOBE,))
# Cycles' filter width of the bump that stands for displacement, in pixels; before it was one pixel.
_APART = (ObjectFact.COLOR, ObjectFact.RANDOM)  # what an OBJECT_INFO node tells that must be read for it
_BUMP_WIDTH = 0.1 if bpy.app.version >= (4, 5) else 1.0


class _Exported(NamedTuple):
    material: snapshot.Material
    attributes: frozenset = frozenset()  # names of the mesh attributes that it reads
    objects: frozenset = frozenset()  # identities of the objects whose place it reads


class Materials:
    """Numbers the materials that objects ask for; each is read once."""

    def __init__(self, messages, override=None, images=None, depsgraph=None, parts=None):
        """parts: of earlier exports, a Parts."""
        self.messages = messages
        self.override = override
        self.images = Images() if images is None else images
        self.depsgraph = depsgraph
        self._parts = parts
        self.list = []
        self._numbers = {}
        self._attributes = []

    def number(self, material, asker):
        """The number of a material; None is the default grey, as everywhere in Blender. asker is the object's name."""
        material = self.override or material
        key = None if material is None else material.original.as_pointer()
        if key not in self._numbers:
            self._numbers[key] = len(self.list)
            exported = _Exported(_DEFAULT) if material is None else self._read(material, asker)
            self.list.append(exported.material)
            self._attributes.append(exported.attributes)
        return self._numbers[key]

    def _read(self, material, asker):
        if self._parts is None:
            return _export(material, self.messages, asker, self.images, self.depsgraph)

        def read(messages, images):
            return _export(material, messages, asker, images, self.depsgraph)

        return self._parts.shader(material, self.messages, read)

    def tell_apart(self, numbers):
        """Whether one of these materials asks for an object's colour or random number."""
        return any(_tells_apart(self.list[number]) for number in numbers)

    def attributes(self, numbers):
        """Names of the mesh attributes that these materials read: what export_mesh takes as wanted."""
        return frozenset().union(*(self._attributes[number] for number in numbers))


def _tells_apart(material):
    return any(node.kind == NodeKind.OBJECT_INFO and node.option in _APART for node in material.nodes)


def _export(material, messages, asker, images, depsgraph):
    """An _Exported. asker is the object that is met first with it: messages name it too."""
    who = f"material '{material.name}'" + ("" if asker is None else f" on object '{asker}'")
    own = material.lancer
    graph = NodeGraph(who, messages, images, depsgraph)
    graph.material_index = max(0, material.pass_index)
    common = {
        "name": material.name,
        "ambient": messages.color(own.ka, who, "ambient colour"),
        "material_index": max(0, material.pass_index),
        "flags": _flags(material),
    }
    if own.model != "NODES":
        return _Exported(snapshot.Material(lobes=_own_model(own, who, messages), **common))
    if bpy.app.version < (5, 0) and not material.use_nodes:
        color = messages.color(material.diffuse_color, who, "viewport colour")
        return _Exported(snapshot.Material(lobes=(snapshot.Lobe(LobeKind.LAMBERT, color),), **common))
    values = _from_nodes(material, graph)
    common["flags"] |= values.pop("flags", 0)
    common["ambient"] = _color(graph.add(common["ambient"], values.pop("ambient", 0.0)))
    exported = snapshot.Material(nodes=graph.nodes, **values, **common)
    return _Exported(exported, frozenset(graph.attributes), frozenset(graph.objects))


def _flags(material):
    """Cycles' own settings of a material; it is an add-on and may be off."""
    cycles = getattr(material, "cycles", None)
    flags = MaterialFlag(0)
    if not getattr(cycles, "use_bump_map_correction", True):
        flags |= MaterialFlag.NO_BUMP_CORRECTION
    if getattr(cycles, "emission_sampling", "AUTO") == "NONE" or not getattr(cycles, "sample_as_light", True):
        flags |= MaterialFlag.NOT_A_LIGHT
    if not getattr(cycles, "use_transparent_shadow", getattr(material, "use_transparent_shadow", True)):
        flags |= MaterialFlag.OPAQUE_SHADOWS
    return int(flags)


def _is_weak(material, surface):
    """Whether Cycles leaves the emission to be found by chance: so it decides by itself from Blender 3.5 on."""
    automatic = getattr(getattr(material, "cycles", None), "emission_sampling", "") == "AUTO"
    return automatic and 0.0 < max(map(abs, surface.estimated)) <= 0.5


def _own_model(own, who, messages):
    """The lobes of the material's own settings; black ones are none."""

    def value(name):
        wanted, given = PARAMETERS[name], getattr(own, name)
        what = own.bl_rna.properties[name].name
        if wanted.kind == "color":
            return messages.color(given, who, what)
        return messages.number(given, who, what, wanted.default, wanted.low, wanted.high)

    lobes = (snapshot.Lobe(kind, **fields) for kind, fields in lobes_of(own.model, value))
    return tuple(lobe for lobe in lobes if any(lobe.color))


def _from_nodes(material, graph):
    """The fields of a material that its node tree gives."""
    who, messages, tree = graph.owner, graph.messages, material.node_tree
    output = output_node(tree, "OUTPUT_MATERIAL") if tree is not None else None
    if output is None:
        messages.add(f"{who}: has no Material Output node that Cycles takes, black is used", severity=Severity.WRONG)
        return {"lobes": ()}
    site = Site(output)
    has_surface = graph.is_linked(site, ("Surface",))
    if graph.is_linked(site, ("Volume",)):
        shown = "its surface alone is shown" if has_surface else "nothing of it is shown"
        messages.add(f"{who}: volumes are not supported, {shown}", "feature:volume", severity=Severity.LEFT_OUT)
        if not has_surface:
            return {"lobes": (), "transmittance": (1.0, 1.0, 1.0)}
    values = _displacement(material, graph, site)
    surface = Surface(graph)
    surface.read(site, output.inputs["Surface"])
    if _is_weak(material, surface):
        values["flags"] = values.get("flags", 0) | int(MaterialFlag.NOT_A_LIGHT)
    return {
        **values,
        "lobes": surface.lobes,
        "ambient": surface.ambient,
        "emission": _color(surface.emission),
        "transmittance": _color(surface.transmittance),
        "holdout": surface.holdout if not isinstance(surface.holdout, tuple) else surface.holdout[0],
    }


def _color(value):
    return triple(value) if isinstance(value, (float, tuple)) else value


def _displacement(material, graph, site):
    """True displacement of the material's method, and the bump that stands for it or goes with it."""
    if not graph.is_linked(site, ("Displacement",)):
        return {}
    socket = site.node.inputs["Displacement"]
    method = getattr(material, "displacement_method", None) or getattr(
        getattr(material, "cycles", None), "displacement_method", "BUMP"
    )
    values = {}
    if method != "BUMP":
        offset = graph.input(site, socket)
        if not is_constant(offset, 0.0):
            values["displacement"] = offset
    if method != "DISPLACEMENT":
        first, height = graph.height_nodes(lambda: displacement_height(graph, site, socket))
        both = "displacement" in values
        normal = bump(graph, first, height, 1.0, 1.0, graph.normal, _BUMP_WIDTH, undisplaced=both)
        graph.normal = values["normal"] = normal
        # The bump shows what displacement does to the normals; both would show it twice.
        if both:
            values["flags"] = int(MaterialFlag.KEEP_NORMALS)
    return values
