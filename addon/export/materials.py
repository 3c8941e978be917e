"""Blender materials as lobes with weights, emission, transmittance, holdout and displacement."""

from typing import NamedTuple

import bpy

from ..bindings import snapshot
from ..bindings.enums import LobeKind, MaterialFlag, NodeKind, ObjectFact
from ..bindings.mattes import DEFAULT_SURFACE, ids
from ..bindings.parameters import read_nodes, without_idle_nodes
from ..messages.severity import Severity
from .arithmetic import is_constant, triple
from .course_models import PARAMETERS, lobes_of
from .graph import NodeGraph
from .hit_attributes import of_all_hits
from .images import Images
from .normals import bump, displacement_height
from .outputs import read_lone_outputs, read_outputs
from .shader_cache import ShaderCache, Sources
from .sockets import RULES, output_node
from .surface import Surface
from .walk import Site

# Cycles' surface without a material: since 5.0 its Principled BSDF with default values.
_DEFAULT_LOBE = (
    snapshot.Lobe(LobeKind.LAMBERT, (0.8, 0.8, 0.8))
    if bpy.app.version < (5, 0)
    else snapshot.Lobe(LobeKind.PRINCIPLED, (1.0, 1.0, 1.0), rules=RULES, principled=snapshot.Principled(rules=RULES))
)
_DEFAULT = snapshot.Material(name=DEFAULT_SURFACE, lobes=(_DEFAULT_LOBE,), matte=int(ids([DEFAULT_SURFACE])[0]))
_APART = (ObjectFact.COLOR, ObjectFact.RANDOM)  # values of OBJECT_INFO that the export reads only on request
# Cycles' filter width, in pixels, of the bump that replaces displacement.
_BUMP_WIDTH = 0.1 if bpy.app.version >= (4, 5) else 1.0


class Exported(NamedTuple):
    material: snapshot.Material
    makers: tuple = ()  # of each of its nodes: the name of the user's node that it belongs to, "" without one
    attributes: frozenset = frozenset()  # names of the mesh attributes that it reads
    sources: Sources = Sources()


class Materials:
    """The materials that objects use, by number; each is read once."""

    def __init__(self, messages, override=None, images=None, depsgraph=None, shaders=None):
        """shaders: the ShaderCache of earlier exports; None starts one."""
        self.messages = messages
        self.override = override
        self.depsgraph = depsgraph
        self._shaders = ShaderCache(Images() if images is None else images) if shaders is None else shaders
        self.list = []
        self.aovs = ()  # that the materials fill
        self._numbers = {}
        self._attributes = []
        self._object_attributes = []
        self._of_all_hits = of_all_hits()

    def number(self, material, asker):
        """Return the number of a material; None is Blender's default grey. asker is the object's name."""
        material = self.override or material
        key = None if material is None else material.original.as_pointer()
        if key not in self._numbers:
            self._numbers[key] = len(self.list)
            exported = Exported(_DEFAULT) if material is None else self._read(material, asker)
            self.list.append(exported.material)
            self._attributes.append(exported.attributes)
            self._object_attributes.append(_object_attributes(exported.material))
        return self._numbers[key]

    def _read(self, material, asker):
        def read(messages, images, value):
            return export_material(material, messages, asker, images, self.depsgraph, self.aovs)

        return self._shaders.find(material, self.messages, read, asker)

    def tell_apart(self, numbers):
        """Whether one of these materials reads an object's colour or random number."""
        return any(_tells_apart(self.list[number]) for number in numbers)

    @property
    def read_objects(self):
        """Whether a material reads an ObjectAttribute."""
        return any(self._object_attributes)

    def object_attributes(self, numbers):
        """Return the names of the ObjectAttributes that these materials read."""
        return frozenset().union(*(self._object_attributes[number] for number in numbers))

    def attributes(self, numbers):
        """Return the names of the mesh attributes that these materials read, for export_mesh's wanted."""
        return self._of_all_hits.union(*(self._attributes[number] for number in numbers))


def _tells_apart(material):
    return any(node.kind == NodeKind.OBJECT_INFO and node.option in _APART for node in material.nodes)


def _object_attributes(material):
    return {node.name for node in material.nodes if (node.kind, node.option) == (NodeKind.OBJECT_INFO, ObjectFact.ATTRIBUTE)}


def export_material(material, messages, asker, images, depsgraph, aovs=()):
    """Return the Exported of a material. asker is the name of the first object with the material, which messages include.

    aovs: the Aovs that it may fill.
    """
    who = f"material '{material.name}'" + ("" if asker is None else f" on object '{asker}'")
    own = material.lancer
    graph = NodeGraph(who, messages, images, depsgraph)
    graph.material_index = max(0, material.pass_index)
    common = {
        "name": material.name,
        "ambient": messages.color(own.ka, who, "ambient colour"),
        "material_index": max(0, material.pass_index),
        "matte": int(ids([material.name])[0]),
        "flags": _flags(material),
    }
    if own.model != "NODES":
        return Exported(snapshot.Material(lobes=_own_model(own, who, messages), **common))
    if bpy.app.version < (5, 0) and not material.use_nodes:
        color = messages.color(material.diffuse_color, who, "viewport colour")
        return Exported(snapshot.Material(lobes=(snapshot.Lobe(LobeKind.LAMBERT, color),), **common))
    values = _from_nodes(material, graph, aovs)
    common["flags"] |= values.pop("flags", 0)
    common["ambient"] = _color(graph.add(common["ambient"], values.pop("ambient", 0.0)))
    exported = snapshot.Material(nodes=graph.nodes, **values, **common)
    makers = tuple(graph.makers[number] for number in read_nodes(exported))
    return Exported(without_idle_nodes(exported), makers, frozenset(graph.attributes), graph.sources)


def _flags(material):
    """Return the MaterialFlag bits of Cycles' settings; Cycles is an add-on and may be disabled."""
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
    """Whether Cycles does not sample the emission as a light, by its automatic choice from Blender 3.5 on."""
    automatic = getattr(getattr(material, "cycles", None), "emission_sampling", "") == "AUTO"
    return automatic and 0.0 < max(map(abs, surface.estimated)) <= 0.5


def _own_model(own, who, messages):
    """Return the lobes of the material's own settings, without black ones."""

    def value(name):
        wanted, given = PARAMETERS[name], getattr(own, name)
        what = own.bl_rna.properties[name].name
        if wanted.kind == "color":
            return messages.color(given, who, what)
        return messages.number(given, who, what, wanted.default, wanted.low, wanted.high)

    lobes = (snapshot.Lobe(kind, **fields) for kind, fields in lobes_of(own.model, value))
    return tuple(lobe for lobe in lobes if any(lobe.color))


def _from_nodes(material, graph, aovs):
    """Return the fields of a snapshot.Material from its node tree."""
    who, messages, tree = graph.owner, graph.messages, graph.tree_of(material)
    output = output_node(tree, "OUTPUT_MATERIAL") if tree is not None else None
    if output is None:
        messages.add(f"{who}: has no Material Output node that Cycles uses, black is used", severity=Severity.WRONG)
        return {"lobes": (), "outputs": read_lone_outputs(graph, tree, aovs)}
    site = Site(output)
    has_surface = graph.is_linked(site, ("Surface",))
    graph.has_volume = graph.is_linked(site, ("Volume",))
    if graph.has_volume:
        shown = "its surface alone is shown" if has_surface else "nothing of it is shown"
        messages.add(f"{who}: volumes are not supported, {shown}", "feature:volume", severity=Severity.LEFT_OUT)
        if not has_surface:
            return {"lobes": (), "transmittance": (1.0, 1.0, 1.0), "outputs": read_outputs(graph, tree, aovs)}
    values = _displacement(material, graph, site)
    surface = Surface(graph)
    surface.read(site, output.inputs["Surface"])
    if _is_weak(material, surface):
        values["flags"] = values.get("flags", 0) | int(MaterialFlag.NOT_A_LIGHT)
    return {
        **values,
        "outputs": read_outputs(graph, tree, aovs),
        "lobes": surface.lobes,
        "portals": surface.portals,
        "ambient": surface.ambient,
        "emission": _color(surface.emission),
        "transmittance": _color(surface.transmittance),
        "holdout": surface.holdout if not isinstance(surface.holdout, tuple) else surface.holdout[0],
    }


def _color(value):
    return triple(value) if isinstance(value, (float, tuple)) else value


def _displacement(material, graph, site):
    """Return the fields of displacement: true displacement, a bump in its place, or both, by the material's method."""
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
    # Without a surface, Cycles evaluates no bump.
    if method != "DISPLACEMENT" and graph.is_linked(site, ("Surface",)):
        first, height = graph.height_nodes(lambda: displacement_height(graph, site, socket))
        both = "displacement" in values
        normal = bump(graph, first, height, 1.0, 1.0, graph.normal, _BUMP_WIDTH, undisplaced=both)
        graph.normal = values["normal"] = normal
        # The bump contains the displacement's change of normals: keep the undisplaced normals below it.
        if both:
            values["flags"] = int(MaterialFlag.KEEP_NORMALS)
    return values
