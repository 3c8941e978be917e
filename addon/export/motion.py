"""Motion of objects, meshes and the camera: keys that are read while Blender evaluates the scene at the times of the shutter.

The scene is evaluated once for each time, for all objects together. Instances are known again by their object, their instancer
and Blender's persistent numbers, as in Cycles; one that another time lacks keeps the place that it has in the middle.
"""

import dataclasses

import numpy as np

from ..bindings.snapshot import InstanceMotion
from ..messages.messages import Messages
from .camera import export_camera
from .mesh import read_shape, shown_mesh
from .shutter import as_motion, key_count, relative_times, reshapes

_NUMBERS = 8  # of an entry's persistent id


class MotionReader:
    """Reads the keys of one export."""

    def __init__(self, depsgraph, shutter, messages, obey, camera):
        """obey: is called between steps, and ends the export by an exception. camera: the camera object."""
        self._depsgraph, self._shutter, self._messages, self._obey = depsgraph, shutter, messages, obey
        self._camera = camera
        self._cameras = {}  # snapshot.Camera by relative time
        self._matrices = {}  # of all rows, by relative time
        self._shapes = {}  # by number of the mesh, then by relative time

    def begin(self, table, places, camera):
        """Note what may move in the scene as it is evaluated now, in the middle of the shutter. camera: a snapshot.Camera."""
        self._table, self._places = table, places
        self._keys = _Keys(self._depsgraph, places)
        counts = np.zeros(len(table), np.int64)
        owners = {}  # of meshes that change their shape: the row of the first instance
        known = {}
        for row, entry in self._rows(self._keys):
            thing = entry.instance_object if entry.is_instance else entry.object
            owner = entry.parent if entry.is_instance else thing
            of = thing.original, owner.original
            if of not in known:
                known[of] = key_count(*of, self._shutter), self._changes_shape(thing)
            counts[row], changes = known[of]
            if changes and counts[row] and table.kinds[row] == 0:
                owners.setdefault(int(table.meshes[row]), row)
        self._counts, self._owners = counts, owners
        self._camera_count = key_count(self._camera.original, self._camera.original, self._shutter)
        self._matrices[0.0] = table.matrices
        self._cameras[0.0] = camera

    def _changes_shape(self, thing):
        if thing.type != "MESH" or not reshapes(thing, self._shutter):
            return False
        return thing.is_deform_modified(self._depsgraph.scene, "RENDER")

    def times(self):
        """Return the relative times at which the scene is to be evaluated, in order."""
        counts = {*np.unique(self._counts).tolist(), self._camera_count} - {0}
        return sorted({time for count in counts for time in relative_times(count)})

    def read(self, relative):
        """Read the scene as it is evaluated now, at a relative time."""
        self._obey()
        if relative in relative_times(self._camera_count or 3):
            scratch = Messages()
            self._cameras[relative] = export_camera(self._camera, self._depsgraph, scratch)
        if relative != 0.0:
            self._read_matrices(relative)
        if self._owners:
            self._read_shapes(relative)

    def _read_matrices(self, relative):
        rows = self._keys.rows_in(_Keys(self._depsgraph, self._places))
        matrices = self._places.matrices(self._depsgraph, np.maximum(rows, 0))
        missing = rows < 0
        matrices[missing] = self._table.matrices[missing]
        self._matrices[relative] = matrices

    def _read_shapes(self, relative):
        now = self._keys if relative == 0.0 else _Keys(self._depsgraph, self._places)
        rows = self._keys.rows_in(now)
        wanted = {int(rows[row]): mesh for mesh, row in self._owners.items() if rows[row] >= 0}
        for number, entry in enumerate(self._depsgraph.object_instances):
            mesh = wanted.get(number)
            if mesh is None:
                continue
            self._obey()
            thing = entry.object
            with shown_mesh(thing, entry.instance_object if entry.is_instance else thing) as data:
                self._shapes.setdefault(mesh, {})[relative] = read_shape(data, self._obey)

    def _rows(self, keys):
        """Yield (row, entry) of all rows of the table."""
        row_of = {int(entry): row for row, entry in enumerate(self._places.entries)}
        for number, entry in enumerate(self._depsgraph.object_instances):
            if number in row_of:
                yield row_of[number], entry

    def result(self, snapshot):
        """Return the snapshot with the motion that was read."""
        cameras = ()
        if self._camera_count:
            cameras = tuple(self._cameras[time] for time in relative_times(self._camera_count))
            if all(camera == cameras[0] for camera in cameras):
                cameras = ()
        table = dataclasses.replace(snapshot.instances, motions=tuple(self._motions()))
        meshes = self._meshes(snapshot.meshes)
        return snapshot.replaced(meshes=meshes, instances=table, motion=as_motion(self._shutter, cameras))

    def _motions(self):
        for count in np.unique(self._counts).tolist():
            if count == 0:
                continue
            rows = np.flatnonzero(self._counts == count)
            keys = np.stack([self._matrices[time][rows] for time in relative_times(count)], axis=1)
            moves = (keys != keys[:, :1]).any(axis=(1, 2, 3))
            if moves.any():
                yield InstanceMotion(instances=rows[moves], matrices=keys[moves])

    def _meshes(self, meshes):
        """Return the meshes with the keys of those that change their shape."""
        result = list(meshes)
        for number, row in self._owners.items():
            shapes = self._shapes.get(number, {})
            middle = shapes.get(0.0)
            times = relative_times(int(self._counts[row]))
            # The mesh may have been cut by adaptive subdivision, whose faces follow the camera.
            if middle is None or not middle.fits(meshes[number]):
                self._tell(number, meshes, "its deformation is not blurred: adaptive subdivision")
                continue
            keys = [shapes.get(time, middle) for time in times]
            if not all(key.like(middle) for key in keys):
                self._tell(number, meshes, "its deformation is not blurred: its number of vertices changes within the shutter")
                keys = [key if key.like(middle) else middle for key in keys]
            if all(np.array_equal(key.positions, middle.positions) for key in keys):
                continue
            moved = np.stack([key.positions for key in keys])
            normals = None if middle.normals is None else np.stack([key.normals for key in keys])
            result[number] = dataclasses.replace(meshes[number], moved_positions=moved, moved_normals=normals)
        return tuple(result)

    def _tell(self, number, meshes, text):
        self._messages.add(f"mesh '{meshes[number].name}': {text}")


class _Keys:
    """What tells the entries of an evaluated scene apart."""

    def __init__(self, depsgraph, places):
        entries = depsgraph.object_instances
        self.count = len(entries)
        ids = np.empty(_NUMBERS * self.count, np.int32)
        entries.foreach_get("persistent_id", ids)
        marks = np.empty((self.count, 2), np.uint64)
        for number, entry in enumerate(entries):
            parent = entry.parent if entry.is_instance else None
            marks[number] = entry.object.original.as_pointer(), 0 if parent is None else parent.original.as_pointer()
        ids = ids.reshape(-1, _NUMBERS)
        ids[marks[:, 1] == 0] = 0
        self._keys = np.concatenate([marks, np.ascontiguousarray(ids).view(np.uint64)], axis=1)
        self._entries = places.entries

    def rows_in(self, other):
        """Return the number of the entry in another _Keys for each row, -1 where it has none."""
        own = self._keys[self._entries]
        if other is self:
            return self._entries.astype(np.int64)
        if other.count == self.count and np.array_equal(other._keys, self._keys):
            return self._entries.astype(np.int64)
        numbers = {key.tobytes(): number for number, key in enumerate(other._keys)}
        return np.array([numbers.get(key.tobytes(), -1) for key in own], np.int64)


def read_motion(snapshot, depsgraph, camera, places, shutter, set_frame, messages, obey):
    """Return the snapshot with the motion within the shutter, in whose middle the depsgraph is evaluated.

    camera: the camera object. set_frame: evaluates the depsgraph at a time in frames. The other arguments: see MotionReader.
    """
    reader = MotionReader(depsgraph, shutter, messages, obey, camera)
    reader.begin(snapshot.instances, places, snapshot.camera)
    for time in reader.times():
        if time != 0.0:
            set_frame(shutter.frame_at(time))
        else:
            set_frame(shutter.middle)
        reader.read(time)
    return reader.result(snapshot)
