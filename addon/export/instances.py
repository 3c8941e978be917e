"""All visible entries of the depsgraph: each mesh once, a table of instances, and the lights."""

from array import array
from typing import NamedTuple

import bpy
import numpy as np

from ..bindings.enums import PassKind
from ..bindings.mattes import ids
from ..bindings.numbered_pass import MATTES, NumberedPass
from ..bindings.snapshot import InstanceTable
from ..messages.severity import Severity
from .apart import read_infos
from .culling import EVERY_RAY
from .lights import export_lamp_nodes, export_light
from .object_attributes import LAMPS_ARE_OBJECTS, AttributeReader, read_object_attributes
from .objects import Objects
from .unsupported import check_hair

# Types whose surface is a separate MESH entry of the depsgraph.
_SHOWN_AS_MESH = {"CURVE", "FONT", "META", "SURFACE"}
# Types without a surface. Blender itself draws strokes over the image.
_SHOWS_NOTHING = {"ARMATURE", "CAMERA", "EMPTY", "GPENCIL", "GREASEPENCIL", "LATTICE", "LIGHT_PROBE", "SPEAKER"}
# Before 5.0 foreach_get over all entries leaks the temporary object with the mesh of a text object, if it is the first entry.
_LEAKS_FIRST = bpy.app.version < (5, 0)
_POLL_EVERY = 256
# Poll more often for single objects and lamps, each of which may have nodes to read.
_POLL_EVERY_OBJECT = 16


class Places(NamedTuple):
    """The entries of a depsgraph from which the rows of the instance table read their matrices."""

    entries: np.ndarray  # of each row
    count: int  # of all entries
    placements: np.ndarray  # of each row, -1 for none
    exact: tuple  # (4, 4) by those numbers
    one_by_one: bool
    marks: array  # of all entries, see mark_of
    space: object  # the ExportOptions' own

    def shows_the_same(self, depsgraph):
        """Whether the entries are those of the same objects, in the same order, hidden or not as before."""
        marks, count = self.marks, len(self.marks)
        number = -1
        for number, entry in enumerate(depsgraph.object_instances):
            if number >= count or mark_of(entry, entry.object, self.space) != marks[number]:
                return False
        return number + 1 == count

    def matrices(self, depsgraph):
        """(rows, 3, 4)."""
        return self.placed(self.columns(depsgraph), self.entries)

    def placed(self, columns, entries):
        """(rows, 3, 4). columns: of a depsgraph; entries: of each row in it."""
        matrices = columns[entries, :, :3].transpose(0, 2, 1).astype(float, "C")
        rows = np.flatnonzero(self.placements >= 0)
        if len(rows):
            whole = columns[entries[rows]].transpose(0, 2, 1).astype(float)
            matrices[rows] = (whole @ np.array(self.exact)[self.placements[rows]])[:, :3]
        return matrices

    def columns(self, depsgraph):
        """Return (entries, 4, 4), the columns of all matrices. A second walk is faster than a Python object for each entry."""
        walk = depsgraph.object_instances
        if self.one_by_one:
            # Copy each matrix at once: the walk moves the entry that the matrix refers to.
            return np.array([np.array(entry.matrix_world) for entry in walk], np.float32).transpose(0, 2, 1)
        columns = np.empty(16 * len(walk), np.float32)
        walk.foreach_get("matrix_world", columns)
        return columns.reshape(-1, 4, 4)


def mark_of(entry, thing, space):
    """Return a number that differs for other objects and for hidden ones; space: a SpaceView3D that hides some, or None."""
    hidden = space is not None and not thing.visible_in_viewport_get(space)
    # Addresses are multiples of 8.
    return thing.original.as_pointer() | hidden | entry.show_self << 1


class Instances:
    """Collects the entries of a depsgraph: to_table() returns the instances, meshes and lights the other parts of a snapshot.

    There may be millions of entries: only numbers are stored for each, and all matrices are read in one call.
    """

    def __init__(self, depsgraph, materials, messages, shaders, divider, linking, culling, options):
        """shaders: the ShaderCache of lamps. divider: a subdivision.Divider. linking: the LightLinking.

        culling: the Culling. options: the ExportOptions.
        """
        self._linking = linking
        self._culling = culling
        self._boxes = []  # (switches, box) of rows that may be culled, with their numbers
        self.depsgraph = depsgraph
        self.messages = messages
        self.lights = []
        self.has_lamp_instances = False
        self._space = options.space
        self._shaders = shaders
        self._reader = AttributeReader(depsgraph, sees_all=False)
        self._divider = divider
        self._objects = Objects(depsgraph, materials, messages, divider, linking, options)
        self._rows = {}
        self._narrowed = {}
        self._checked_hair = set()
        self._names = []  # of rows that share a look and a name
        self._mattes = [kind for kind in MATTES if NumberedPass(kind) in options.passes]
        self._assets = []  # of the same rows: the names of the objects' topmost parents, where mattes are wanted
        self._geometries = {}
        self.geometries = []  # of the same rows: equal numbers for objects that share one geometry in Cycles
        self._looks = array("I")
        self._row_of = array("I")  # of entries that show a mesh
        self._entries = array("I")
        self._entry_count = 0
        self._first_is_text = False
        self._marks = array("Q")
        self.places = None

    @property
    def meshes(self):
        return self._objects.meshes

    @property
    def culls(self):
        """Whether places decide which objects rays meet."""
        return bool(self._boxes)

    def collect(self, poll):
        shows_surfaces = self.depsgraph.view_layer.use_solid
        rows, row_of, entries = self._rows, self._row_of, self._entries
        marks, space = self._marks, self._space
        number = -1
        for number, entry in enumerate(self.depsgraph.object_instances):
            if number % _POLL_EVERY == 0:
                poll()
            thing = entry.object
            mark = mark_of(entry, thing, space)
            marks.append(mark)
            if mark & 1:
                continue
            if thing.type != "MESH":
                if number == 0:
                    self._first_is_text = thing.type in _SHOWN_AS_MESH
                if entry.show_self:
                    self._add_other(thing, entry, poll)
                continue
            if thing.modifiers and entry.show_particles:
                self._check_hair(thing)
            if not (shows_surfaces and entry.show_self):
                continue
            # Evaluated data lives as long as the depsgraph, but the objects of entries are reused: store addresses only.
            if entry.is_instance:
                key = mark & ~7, self._data_key(entry, thing), self._narrowed_by(entry.parent)
                row = rows.get(key)
                if row is None:
                    row = rows[key] = self._new_row(thing, entry.instance_object, *key, poll)
            else:
                # An object that is no instance appears once: no cache is needed.
                if number % _POLL_EVERY_OBJECT == 0:
                    poll()
                row = self._new_row(thing, thing, mark & ~7, self._data_key(entry, thing), None, poll)
            if row >= 0:
                row_of.append(row)
                entries.append(number)
        self._entry_count = number + 1

    def to_table(self, poll):
        looks = self._objects.looks
        row_of = np.frombuffer(self._row_of, np.uint32)
        look_of = np.frombuffer(self._looks, np.uint32)[row_of]

        def column(values, dtype=np.uint32):
            return np.array(values, dtype)[look_of]

        # Store each list of slots once, however many objects share it.
        starts, slots = {}, []
        for look in looks:
            if look.slots not in starts:
                starts[look.slots] = len(slots)
                slots.extend(look.slots)
        poll()
        placements = column([look.placement for look in looks], np.int32)
        leaks = _LEAKS_FIRST and self._first_is_text
        entries = np.frombuffer(self._entries, np.uint32)
        self.places = Places(
            entries, self._entry_count, placements, tuple(self._objects.placements), leaks, self._marks, self._space
        )
        matrices = self.places.matrices(self.depsgraph)
        poll()
        hidden = column([look.hidden for look in looks])
        if self._boxes:
            hidden[self._culled(row_of, matrices)] = EVERY_RAY
        fast = None
        if any(look.fast_distance for look in looks):
            fast = column([look.fast_distance for look in looks], np.float32)
        links = None
        if any(any(look.links) for look in looks):
            links = np.array([look.links for look in looks], np.uint64)[look_of]
        infos = None
        if any(self._objects.materials.tell_apart(look.slots) for look in looks):
            infos = read_infos(self.depsgraph.object_instances, entries, _POLL_EVERY, poll)
        mattes = {}
        if PassKind.OBJECT_MATTES in self._mattes:
            mattes["object_mattes"] = ids(self._names)[row_of]
        if PassKind.ASSET_MATTES in self._mattes:
            mattes |= {"asset_mattes": ids(self._assets)[row_of], "asset_names": tuple(dict.fromkeys(self._assets))}
        groups = column([look.light_group for look in looks])
        return InstanceTable(
            **mattes,
            light_groups=groups if groups.any() else None,
            attributes=self._attributes(look_of, entries, poll),
            matrices=matrices,
            kinds=column([look.kind for look in looks]),
            meshes=column([look.mesh for look in looks]),
            first_slots=column([starts[look.slots] for look in looks]),
            slot_counts=column([len(look.slots) for look in looks]),
            object_indices=column([look.index for look in looks]),
            shadings=column([look.shading for look in looks]),
            hidden_from=hidden,
            flags=column([look.flags for look in looks]),
            terminators=column([look.terminator for look in looks], np.float32),
            name_indices=row_of,
            names=self._names,
            slots=slots,
            infos=infos,
            links=links,
            fast_distances=fast,
        )

    def _culled(self, row_of, matrices):
        """Return the numbers of the table's rows whose objects are culled."""
        numbers, switches, boxes = (np.array(values) for values in zip(*self._boxes, strict=True))
        place = np.full(len(self._names), -1)
        place[numbers] = np.arange(len(numbers))
        rows = np.flatnonzero(place[row_of] >= 0)
        of = place[row_of[rows]]
        return rows[self._culling.culled(switches[of], boxes[of], matrices[rows])]

    def _attributes(self, look_of, entries, poll):
        materials = self._objects.materials
        if not materials.read_objects:
            return ()
        names = [materials.object_attributes(look.slots) for look in self._objects.looks]
        rows = {int(entry): names[look] for entry, look in zip(entries, look_of, strict=True)}
        return read_object_attributes(self.depsgraph, rows, self.messages, _POLL_EVERY, poll)

    def _data_key(self, entry, thing):
        """Return the address of the mesh that an entry shows; that of the object if it is divided, whose data is not read."""
        if thing.modifiers and self._divider.shows_own_mesh(entry, thing):
            return thing.original.as_pointer()
        return thing.data.as_pointer()

    def _narrowed_by(self, instancer):
        if instancer is None:
            return None
        key = instancer.original.as_pointer()
        narrowed = self._narrowed.get(key)
        if narrowed is None:
            narrowed = self._narrowed[key] = self._objects.narrowed_by(instancer)
        return narrowed

    def _new_row(self, thing, owner, original_key, data_key, narrowed, poll):
        look, name = self._objects.look(thing, owner, original_key, data_key, narrowed, poll)
        if look < 0:
            return -1
        self._looks.append(look)
        self._names.append(name)
        if PassKind.ASSET_MATTES in self._mattes:
            self._assets.append(_top_parent(owner).name)
        if switches := self._culling.switches(owner):
            self._boxes.append((len(self._names) - 1, switches, np.array(thing.bound_box)))
        # To Cycles an object that has materials of its own shares its mesh with its instances alone.
        is_own = any(slot.link == "OBJECT" for slot in owner.material_slots)
        key = data_key, original_key if is_own else None
        self.geometries.append(self._geometries.setdefault(key, len(self._geometries)))
        return len(self._names) - 1

    def _add_other(self, thing, entry, poll):
        if thing.type == "LIGHT":
            if len(self.lights) % _POLL_EVERY_OBJECT == 0:
                poll()
            hidden = None
            # Before 4.5 the visibility of an instancer does not apply to its lights.
            if LAMPS_ARE_OBJECTS:
                narrowed = self._narrowed_by(entry.parent) if entry.is_instance else None
                hidden, _ = self._objects.sight(thing, narrowed)
            self.has_lamp_instances = self.has_lamp_instances or entry.is_instance
            shine = self._lamp_nodes(thing, entry)
            light = export_light(thing, entry.matrix_world, self.messages, self.depsgraph, hidden, shine)
            if light is not None:
                group = self._objects.groups.get(thing.lightgroup, 0)
                links = self._linking.links(thing.original.as_pointer())
                if group:
                    light = light.replaced(light_group=group)
                if any(links):
                    light = light.replaced(unlit_sets=links.unlit_sets, clear_sets=links.clear_sets)
                self.lights.append(light)
        elif thing.type not in _SHOWN_AS_MESH and thing.type not in _SHOWS_NOTHING:
            text = f"object '{thing.name}': type {thing.type} is not supported, it is left out"
            self.messages.add(text, f"feature:{thing.type.lower()} object", severity=Severity.LEFT_OUT)

    def _lamp_nodes(self, thing, entry):
        def value(name, messages):
            return self._reader.of_lamp(entry, name, messages)

        def read(messages, images, value):
            return export_lamp_nodes(thing, messages, images, self.depsgraph, value)

        return self._shaders.find(thing.data, self.messages, read, thing.name, value)

    def _check_hair(self, thing):
        key = thing.original.as_pointer()
        if key not in self._checked_hair:
            self._checked_hair.add(key)
            check_hair(thing, self.messages)


def _top_parent(thing):
    """Return the topmost parent of an object, which is the asset that it belongs to; the object itself without one."""
    while thing.parent is not None:
        thing = thing.parent
    return thing
