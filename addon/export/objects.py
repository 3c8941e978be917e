"""Properties of the depsgraph's objects apart from the transform: mesh, materials, visibility. Equal looks are stored once."""

from typing import NamedTuple

import bpy
import numpy as np

from ..bindings.enums import InstanceFlag, InstanceKind, Ray, Shading
from ..messages.severity import Severity
from .attributes import POLYGONS
from .catchers import is_catcher
from .light_groups import group_numbers
from .light_linking import Links
from .mesh import export_mesh, read_positions, shown_mesh
from .mesh_differences import differences, lost_by_exact_shape, show_differences
from .subdivision.divider import PLACES_OTHERWISE, size_in_words
from .subdivision.modifier import may_make_instances
from .unsupported import check_object
from .visibility import object_hidden_from

_TERMINATOR = "shadow_terminator_geometry_offset"
# Before 4.5 the property belongs to Cycles, an add-on that may be disabled.
_HAS_TERMINATOR = _TERMINATOR in bpy.types.Object.bl_rna.properties
_HAS_HOLDOUT = "is_holdout" in bpy.types.Object.bl_rna.properties


class _Own(NamedTuple):
    """The add-on's properties of an object."""

    shape: str = "MESH"
    shading: str = "AS_MESH"


_PLAIN = _Own()


class Look(NamedTuple):
    """A row of the instance table without transform and name."""

    kind: int
    mesh: int
    slots: tuple  # of material numbers
    index: int
    shading: int
    hidden: int  # Ray bits
    flags: int  # InstanceFlag bits
    terminator: float
    links: Links
    fast_distance: float  # of Fast GI; 0 for the world's
    placement: int  # of Objects.placements; -1 for none
    light_group: int  # 0 for none


class Objects:
    """Reads each object once; meshes, looks and placements are lists indexed by their numbers."""

    def __init__(self, depsgraph, materials, messages, divider, linking, options):
        """linking: the LightLinking. options: the ExportOptions."""
        self._linking = linking
        self._parts = options.parts
        self._on_mesh = options.on_mesh
        self._divider = divider
        self._export_mesh = export_mesh if options.kept is None else options.kept.meshes(export_mesh)
        self.scene = depsgraph.scene
        self.view_layer = depsgraph.view_layer
        self.materials = materials
        self.messages = messages
        self.meshes = []
        self.looks = []
        self.placements = []
        self.groups = group_numbers(depsgraph.view_layer, options.passes)
        self._numbers = {}
        self._meshes = {}
        self._differences = {}  # messages by slots and mesh
        self._may_differ = {}  # whether there may be some, by slots
        self._placed = {}
        self._wanted = {}
        self._checked = set()
        # Query collections only if some are special: Blender's call per object takes longer than all other reads.
        self._asks_layer = _has_special_collections(self.view_layer)

    def sight(self, thing, narrowed):
        """Return (Ray bits that do not see the object, InstanceFlag bits). narrowed: narrowed_by() of an instancer, or None."""
        hidden = object_hidden_from(thing)
        if narrowed is None:
            holdout, indirect, catcher = self._is_holdout(thing), self._is_indirect(thing), is_catcher(thing)
        else:
            # As in Cycles, an original that is a holdout or indirect only leaves its instances as they are.
            hidden |= narrowed[0]
            holdout, indirect = narrowed[1:3]
            catcher = is_catcher(thing) or narrowed[4]
        if indirect and not holdout:
            hidden |= int(Ray.CAMERA)
        return hidden, int(InstanceFlag.HOLDOUT) * holdout | int(InstanceFlag.CATCHER) * catcher

    def narrowed_by(self, instancer):
        """Return an instancer's effect on its instances: (hidden Ray bits, holdout, indirect only, its address, catcher).

        The address is None where it is not needed.
        """
        key = instancer.original.as_pointer() if self._linking.has(instancer) else None
        hidden, holdout, indirect = object_hidden_from(instancer), self._is_holdout(instancer), self._is_indirect(instancer)
        return hidden, holdout, indirect, key, is_catcher(instancer)

    def _is_holdout(self, thing):
        if _HAS_HOLDOUT and (thing.is_holdout or thing.original.is_holdout):
            return True
        return self._asks_layer and thing.original.holdout_get(view_layer=self.view_layer)

    def _is_indirect(self, thing):
        return self._asks_layer and thing.original.indirect_only_get(view_layer=self.view_layer)

    def look(self, thing, owner, original_key, data_key, narrowed, poll):
        """Return (number of the look, name) of an object with a mesh; (-1, "") if nothing of it is visible.

        original_key: the address of the original; data_key: that of the mesh, or of the original if a Divider shows its mesh.
        owner: the evaluated object itself, or the one of which thing is an instance. Read settings of add-ons from owner:
        reading them from a temporary instance allocates memory that Blender never frees.
        """
        if self._parts is not None:
            self._parts.count("objects")
        name = thing.name
        if original_key not in self._checked:
            self._checked.add(original_key)
            check_object(owner, self.scene, self.messages)
        sight = self.sight(thing, narrowed)
        links = self._linking.links(original_key, narrowed and narrowed[3])
        materials = _slot_materials(thing)
        is_divided = data_key == original_key
        # Without slots only nodes give materials to the mesh.
        of_mesh = () if materials or is_divided and not may_make_instances(owner) else list(thing.data.materials)
        slots = tuple([self.materials.number(material, name) for material in materials or of_mesh or [None]])
        # Reading a property that is not set would set it, after which Blender copies it with the object.
        own = owner.lancer if owner.is_property_set("lancer") else _PLAIN
        kind = InstanceKind[own.shape]
        mesh, placement = 0, -1
        if kind == InstanceKind.MESH:
            mesh, used = self._mesh(thing, owner, name, data_key, is_divided, slots, self._colors_polygons(own), poll)
            if mesh < 0:
                return -1, ""
            self._tell_mesh(name, slots, mesh)
        else:
            placement, used = self._placement(thing, owner, name, kind, data_key), (0,)
            if placement < 0:
                return -1, ""
            self._tell_exact(name, slots)
        if None in materials:
            self._tell_empty(name, materials, used)
        index, shading = max(0, thing.pass_index), Shading[own.shading]
        group = self.groups.get(owner.lightgroup, 0) if self.groups else 0
        fast = _fast_distance(owner)
        look = Look(kind, mesh, slots, index, shading, *sight, _terminator(owner), links, fast, placement, group)
        number = self._numbers.setdefault(look, len(self.looks))
        if number == len(self.looks):
            self.looks.append(look)
        return number, name

    def _colors_polygons(self, own):
        """Whether Classic shades each face with one colour, which requires the polygon of each triangle."""
        return own.shading == "FLAT" and self.scene.lancer.integrator == "CLASSIC"

    def _mesh(self, thing, owner, name, data_key, is_divided, slots, polygons, poll):
        """Return the number of the object's mesh, -1 without faces, and the slots that its faces use.

        Objects that share a mesh may have materials that read different attributes: the mesh is read again if one is missing.
        """
        wanted = self._wanted.get(slots)
        if wanted is None:
            wanted = self._wanted[slots] = self.materials.attributes(slots)
        if polygons:
            wanted = wanted | {POLYGONS}
        copies = self._meshes.setdefault(data_key, [])
        found = next((copy for copy in copies if copy[0] >= wanted), None)
        if found is None:
            data = self._read_mesh(thing, owner, name, data_key, is_divided, wanted, poll)
            poll()
            used = (0,) if data.material_slots is None else tuple(np.unique(data.material_slots).tolist())
            number = -1
            if len(data.triangles):
                self.meshes.append(data)
                number = len(self.meshes) - 1
                if self._on_mesh is not None:
                    self._on_mesh(data)
            found = wanted, number, used
            copies.append(found)
        _, number, used = found
        # Geometry Nodes may produce instances alone: add no message.
        if number < 0 and not any(modifier.type == "NODES" for modifier in thing.modifiers):
            self.messages.add(f"object '{name}': has no faces, it is left out")
        return number, used

    def _read_mesh(self, thing, owner, name, data_key, is_divided, wanted, poll):
        settings = self._divider.settings(owner)
        if settings is not None:
            key = data_key, self._divider.key(settings, owner)
            return self._divided_mesh(thing, owner, None if is_divided else thing.data, name, key, settings, wanted, poll)

        def read():
            original = thing.original.data
            with shown_mesh(thing, owner) as mesh:
                return self._export_mesh(mesh, name if original is None else original.name, poll, wanted)

        return read() if self._parts is None else self._parts.mesh(thing, owner, thing.data, data_key, wanted, read)

    def _divided_mesh(self, thing, owner, made, name, key, settings, wanted, poll):
        """made: the mesh of an instance that the object's nodes made; None for the object's own, whose data is not read."""

        def read():
            return self._divider.mesh(owner, made, settings, name, wanted, poll)

        if self._parts is None:
            mesh = read()
        else:
            mesh = self._parts.mesh(thing, owner, owner.original.data if made is None else made, key, wanted, read)
        self.messages.add(f"object '{name}': {size_in_words(mesh)}", severity=Severity.HINT)
        if PLACES_OTHERWISE:
            text = "Cycles of this version cuts the faces elsewhere, which coarse displacement shows; a low dicing rate helps"
            self.messages.add(f"object '{name}': {text}", "feature:facets of adaptive subdivision", Severity.HINT)
        elif owner.type != "MESH":
            text = "Cycles divides the mesh before the modifier adaptively, Lancer that behind it; convert the object to a mesh"
            self.messages.add(f"object '{name}': {text}", "feature:adaptive subdivision of curves", Severity.HINT)
        return mesh

    def _placement(self, thing, owner, name, kind, data_key):
        """Return the number of the transform from the unit shape to the mesh's bounds; -1 if the mesh has no vertices."""
        number = self._placed.get((kind, data_key))
        if number is None:
            with shown_mesh(thing, owner) as mesh:
                placement = _placement(kind, read_positions(mesh))
            number = -1 if placement is None else len(self.placements)
            self._placed[kind, data_key] = number
            if placement is not None:
                self.placements.append(placement)
        if number < 0:
            self.messages.add(
                f"object '{name}': has no vertices to place its exact shape by, it is left out", severity=Severity.LEFT_OUT
            )
        return number

    def _tell_mesh(self, name, slots, mesh):
        """Add messages about the mesh with a number under these materials; objects that share both share the checks."""
        found = self._differences.get((slots, mesh))
        if found is None:
            materials = [self.materials.list[slot] for slot in slots]
            may_differ = self._may_differ.get(slots)
            if may_differ is None:
                may_differ = self._may_differ[slots] = show_differences(materials)
            found = differences(self.meshes[mesh], materials) if may_differ else ()
            self._differences[slots, mesh] = found
        for text, key in found:
            self.messages.add(f"object '{name}': {text}", key, severity=Severity.HINT)

    def _tell_exact(self, name, slots):
        """Add a message about attributes and displacement that materials read and that an exact shape lacks."""
        lost = lost_by_exact_shape(self.materials.attributes(slots), [self.materials.list[slot] for slot in slots])
        if lost:
            self.messages.add(f"object '{name}': its exact shape lacks what its mesh would have: {', '.join(lost)}")

    def _tell_empty(self, name, materials, used):
        if self.materials.override is not None:
            return
        for number in sorted({min(slot, len(materials) - 1) for slot in used}):
            if materials[number] is None:
                self.messages.add(f"object '{name}': material slot {number + 1} is empty, grey is used", severity=Severity.HINT)


def _has_special_collections(view_layer):
    """Whether any collection is a holdout or indirect only."""
    waiting = [view_layer.layer_collection]
    while waiting:
        collection = waiting.pop()
        if collection.holdout or collection.indirect_only:
            return True
        waiting.extend(collection.children)
    return False


def _slot_materials(thing):
    """Return the materials of an object's slots, None for empty ones.

    An empty slot of the object's own shows the material of its mesh; since 5.2, Cycles leaves it empty.
    """
    slots = thing.material_slots
    if bpy.app.version < (5, 2):
        return [slot.material for slot in slots]
    originals = thing.original.material_slots
    return [
        None if slot.link == "OBJECT" and index < len(originals) and originals[index].material is None else slot.material
        for index, slot in enumerate(slots)
    ]


def _terminator(thing):
    """Return Blender's geometry offset of the shadow terminator."""
    return float(getattr(thing if _HAS_TERMINATOR else getattr(thing, "cycles", None), _TERMINATOR, 0.1))


def _fast_distance(thing):
    """Return the distance of Fast GI of an object; 0 for that of the world."""
    return float(getattr(getattr(thing, "cycles", None), "ao_distance", 0.0))


def _placement(kind, positions):
    """Return the (4, 4) matrix from an exact shape's unit frame to object space, by the bounds' centre and half extents.

    A plane has no extent: only the centre is used. None without positions.
    """
    if len(positions) == 0:
        return None
    low, high = positions.min(axis=0).astype(float), positions.max(axis=0).astype(float)
    local = np.eye(4)
    local[:3, 3] = 0.5 * (low + high)
    if kind != InstanceKind.PLANE:
        local[:3, :3] = np.diag(0.5 * (high - low))
    return local
