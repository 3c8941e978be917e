"""Everything that the depsgraph shows: meshes once each, and a table of where they stand."""

from itertools import chain

import bpy
import numpy as np

from ..bindings.enums import InstanceFlag, InstanceKind, Ray, Shading
from ..bindings.snapshot import InstanceTable
from .arithmetic import is_constant
from .attributes import named_attributes
from .checks import check_hair, check_object
from .lights import export_light
from .mesh import export_mesh, read_positions
from .visibility import hidden_from

# Types whose surface arrives as a MESH entry of its own, beside the original.
_SHOWN_AS_MESH = {"CURVE", "FONT", "META", "SURFACE"}
# Strokes are drawn by Blender itself, over the picture.
_SHOWS_NOTHING = {"ARMATURE", "CAMERA", "EMPTY", "GPENCIL", "GREASEPENCIL", "LATTICE", "LIGHT_PROBE", "SPEAKER"}
# Before 4.5 what brings a light in did not narrow which rays see it.
_LIGHTS_ARE_OBJECTS = bpy.app.version >= (4, 5)
_POLL_EVERY = 256
_MATRICES_AT_ONCE = 4096


class _Object:
    """What all entries of one object with one mesh have in common."""

    __slots__ = ("kind", "mesh", "slots", "index", "shading", "name", "local", "hidden", "flags", "terminator")


class Instances:
    """Collects entries; to_table() and meshes give the snapshot's parts, lights the lamps met on the way."""

    def __init__(self, depsgraph, materials, messages):
        self.depsgraph = depsgraph
        self.view_layer = depsgraph.view_layer
        self.materials = materials
        self.messages = messages
        self.meshes = []
        self.lights = []
        self._meshes = {}
        self._objects = {}
        self._sights = {}
        self._checked = set()
        self._checked_hair = set()
        self._list = []
        self._rows = []
        self._matrices = []

    def collect(self, poll):
        shows_surfaces = self.view_layer.use_solid
        for number, entry in enumerate(self.depsgraph.object_instances):
            if number % _POLL_EVERY == 0:
                poll()
            thing = entry.object
            if entry.show_particles and thing.type == "MESH":
                self._check_hair(thing)
            if not entry.show_self:
                continue
            instancer = entry.parent if entry.is_instance else None
            if thing.type == "MESH":
                if shows_surfaces:
                    self._add_mesh(thing, entry.matrix_world, self._sight(thing, instancer), poll)
            elif thing.type == "LIGHT":
                hidden = self._sight(thing, instancer)[0] if _LIGHTS_ARE_OBJECTS else None
                light = export_light(thing, entry.matrix_world, self.messages, self.depsgraph, hidden)
                if light is not None:
                    self.lights.append(light)
            elif thing.type not in _SHOWN_AS_MESH and thing.type not in _SHOWS_NOTHING:
                self.messages.add(f"object '{thing.name}': type {thing.type} is not supported, it is left out")

    def to_table(self, poll):
        objects = self._list
        rows = np.array(self._rows, np.intp)

        def column(attribute):
            return np.array([getattr(item, attribute) for item in objects], np.uint32)[rows]

        # Equal slot lists are kept once, however many objects share them.
        starts, slots = {}, []
        for item in objects:
            if item.slots not in starts:
                starts[item.slots] = len(slots)
                slots.extend(item.slots)
        matrices = np.empty((len(rows), 4, 4))
        for first in range(0, len(rows), _MATRICES_AT_ONCE):
            poll()
            part = self._matrices[first : first + _MATRICES_AT_ONCE]
            numbers = np.fromiter(chain.from_iterable(chain.from_iterable(part)), float, 16 * len(part))
            matrices[first : first + len(part)] = numbers.reshape(-1, 4, 4)
        for number, item in enumerate(objects):
            if item.local is not None:
                poll()
                here = rows == number
                matrices[here] = matrices[here] @ item.local
        return InstanceTable(
            matrices=matrices[:, :3],
            kinds=column("kind"),
            meshes=column("mesh"),
            first_slots=np.array([starts[item.slots] for item in objects], np.uint32)[rows],
            slot_counts=np.array([len(item.slots) for item in objects], np.uint32)[rows],
            object_indices=column("index"),
            shadings=column("shading"),
            hidden_from=column("hidden"),
            flags=column("flags"),
            terminators=np.array([item.terminator for item in objects], np.float32)[rows],
            name_indices=rows.astype(np.uint32),
            names=tuple(item.name for item in objects),
            slots=slots,
        )

    def _sight(self, thing, instancer):
        """(Ray bits that do not see it, InstanceFlag bits) of an object, as the object that brings it in narrows them."""
        key = thing.original.as_pointer(), 0 if instancer is None else instancer.original.as_pointer()
        if key not in self._sights:
            hidden, holdout = hidden_from(thing, "visible_"), self._is_holdout(thing)
            top = thing
            if instancer is not None:
                top = instancer
                hidden |= hidden_from(instancer, "visible_")
                holdout = holdout or self._is_holdout(instancer)
            if not holdout and top.original.indirect_only_get(view_layer=self.view_layer):
                hidden |= int(Ray.CAMERA)
            self._sights[key] = hidden, int(InstanceFlag.HOLDOUT) if holdout else 0
        return self._sights[key]

    def _is_holdout(self, thing):
        return getattr(thing, "is_holdout", False) or thing.original.holdout_get(view_layer=self.view_layer)

    def _add_mesh(self, thing, matrix, sight, poll):
        # Evaluated data lives as long as the depsgraph, while the objects of entries are reused: only addresses are kept.
        key = thing.original.as_pointer(), thing.data.as_pointer(), sight
        number = self._objects.get(key)
        if number is None:
            number = self._objects[key] = self._new_object(thing, key[1], sight, poll)
        if number >= 0:
            self._rows.append(number)
            self._matrices.append(matrix.copy())

    def _new_object(self, thing, data_key, sight, poll):
        """The number of the common part; -1 where there is nothing to see."""
        self._check(thing)
        poll()
        item = _Object()
        item.kind = InstanceKind[thing.lancer.shape]
        item.shading = Shading[thing.lancer.shading]
        item.index = max(0, thing.pass_index)
        item.name = thing.name
        item.hidden, item.flags = sight
        item.terminator = _terminator(thing)
        item.mesh, item.local, used = 0, None, {0}
        item.slots = self._slots(thing)
        if item.kind == InstanceKind.MESH:
            item.mesh, used = self._mesh(thing, data_key, self.materials.attributes(item.slots), poll)
            if item.mesh < 0:
                return -1
        else:
            item.local = _placement(item.kind, read_positions(thing.data))
            if item.local is None:
                self.messages.add(f"object '{thing.name}': has no vertices to place its exact shape by, it is left out")
                return -1
            self._tell_exact(thing, item.slots)
        self._check_slots(thing, used)
        self._list.append(item)
        return len(self._list) - 1

    def _mesh(self, thing, data_key, wanted, poll):
        """The number of the object's mesh and the slots that its faces use; -1 for a mesh without faces.

        wanted: names of attributes. Objects that share a mesh may show it with materials that read different ones.
        """
        copies = self._meshes.setdefault(data_key, [])
        found = next((copy for copy in copies if copy[0] >= wanted), None)
        if found is None:
            original = thing.original.data
            data = export_mesh(thing.data, thing.name if original is None else original.name, poll, wanted)
            poll()
            used = {0} if data.material_slots is None else set(np.unique(data.material_slots).tolist())
            number = -1
            if len(data.triangles):
                self.meshes.append(data)
                number = len(self.meshes) - 1
            found = wanted, number, used
            copies.append(found)
        _, number, used = found
        if number < 0:
            self.messages.add(f"object '{thing.name}': has no faces, it is left out")
        return number, used

    def _slots(self, thing):
        materials = [slot.material for slot in thing.material_slots] or list(thing.data.materials) or [None]
        return tuple(self.materials.number(material, thing.name) for material in materials)

    def _tell_exact(self, thing, slots):
        """Says what materials ask for that only a mesh has."""
        lost = [f"attribute '{name}'" for name in named_attributes(self.materials.attributes(slots))]
        if any(not is_constant(self.materials.list[slot].displacement, 0.0) for slot in slots):
            lost.insert(0, "displacement")
        if lost:
            self.messages.add(f"object '{thing.name}': its exact shape is without what its mesh would have: {', '.join(lost)}")

    def _check_slots(self, thing, used):
        if self.materials.override is not None:
            return
        last = len(thing.material_slots) - 1
        for number in sorted({min(slot, last) for slot in used}) if last >= 0 else ():
            if thing.material_slots[number].material is None:
                self.messages.add(f"object '{thing.name}': material slot {number + 1} is empty, grey is used")

    def _check_hair(self, thing):
        key = thing.original.as_pointer()
        if key not in self._checked_hair:
            self._checked_hair.add(key)
            check_hair(thing, self.messages)

    def _check(self, thing):
        """Says what the object asks for that has no counterpart."""
        key = thing.original.as_pointer()
        if key in self._checked:
            return
        self._checked.add(key)
        check_object(thing, self.depsgraph.scene, self.messages)


def _terminator(thing):
    """Blender's geometry offset of the shadow terminator; before 4.5 it belongs to Cycles, an add-on that may be off."""
    name = "shadow_terminator_geometry_offset"
    return float(getattr(thing, name, getattr(getattr(thing, "cycles", None), name, 0.1)))


def _placement(kind, positions):
    """Unit frame of an exact surface to the object's frame: bounds' centre and half extents; a plane has no extent."""
    if len(positions) == 0:
        return None
    low, high = positions.min(axis=0).astype(float), positions.max(axis=0).astype(float)
    local = np.eye(4)
    local[:3, 3] = 0.5 * (low + high)
    if kind != InstanceKind.PLANE:
        local[:3, :3] = np.diag(0.5 * (high - low))
    return local
