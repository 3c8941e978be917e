"""Motion of objects, meshes and the camera: keys that are read while Blender evaluates the scene at other times.

The times are those of the shutter, or for the pass Vector one frame before the picture and one after. The scene is evaluated
once for each time, for all objects together. Instances are known again by their object, their instancer and Blender's
persistent numbers, as in Cycles; one that another time lacks keeps the place that it has in the middle.
"""

import dataclasses

import numpy as np

from ..bindings.enums import InstanceKind
from ..bindings.snapshot import InstanceMotion
from ..messages.messages import Messages
from ..messages.severity import Severity
from .camera import export_camera
from .flat import is_singular
from .lamp_transforms import is_sheared
from .mesh import read_shape, shown_mesh
from .settings import world_of
from .shutter import as_motion, key_count, relative_times, reshapes
from .vectors import FRAMES, camera_in_frames, instance_vectors, mesh_in_frames

_NUMBERS = 8  # of an entry's persistent id
_MESH = int(InstanceKind.MESH)


class Instant:
    """All entries of a depsgraph as it is evaluated at one time.

    keys: (entries, 6), what tells an entry apart. shapes: Shape of a mesh by the key of an entry that shows it.
    """

    def __init__(self, depsgraph, places):
        """places: the Places of the export."""
        entries = depsgraph.object_instances
        count = len(entries)
        ids = np.empty(_NUMBERS * count, np.int32)
        entries.foreach_get("persistent_id", ids)
        marks = np.empty((count, 2), np.uint64)
        for number, entry in enumerate(entries):
            parent = entry.parent if entry.is_instance else None
            marks[number] = entry.object.original.as_pointer(), 0 if parent is None else parent.original.as_pointer()
        ids = ids.reshape(-1, _NUMBERS)
        ids[marks[:, 1] == 0] = 0
        self.keys = np.concatenate([marks, np.ascontiguousarray(ids).view(np.uint64)], axis=1)
        self.columns = places.columns(depsgraph)
        self.shapes, self.camera, self.views = {}, None, None

    def rows_of(self, keys):
        """Return the number of the entry with each of these keys, -1 where there is none."""
        if len(keys) and np.array_equal(keys, self.keys[: len(keys)]):
            return np.arange(len(keys))
        numbers = {key.tobytes(): number for number, key in enumerate(self.keys)}
        return np.array([numbers.get(key.tobytes(), -1) for key in keys], np.int64)


class MotionReader:
    """Reads the keys of one export; the depsgraph is evaluated in the middle of the shutter when it is made."""

    def __init__(self, depsgraph, table, places, camera, options):
        """table, places: of the instances as they are now. camera: the camera object. options: the ExportOptions."""
        self._depsgraph, self._table, self._places, self._shutter = depsgraph, table, places, options.shutter
        self._camera, self._options = camera, options
        middle = Instant(depsgraph, places)
        self._keys = middle.keys[places.entries]  # of the table's rows
        self._counts = np.zeros(len(table), np.int64)  # of keys, by row
        self._owners = {}  # the row of the first instance of each mesh that changes its shape
        self._lamps = {}  # name by key
        self._instants = {}
        self._find_movers(middle)
        self._camera_count = key_count(camera.original, camera.original, options.shutter)
        self._sight = options.sight_of_views
        owners = () if self._sight is None else self._sight.owners
        self._view_counts = [key_count(owner.original, owner.original, options.shutter) for owner in owners]

    def _find_movers(self, middle):
        row_of = {int(entry): row for row, entry in enumerate(self._places.entries)}
        known = {}
        for number, entry in enumerate(self._depsgraph.object_instances):
            row = row_of.get(number)
            thing = entry.instance_object if entry.is_instance else entry.object
            if row is None:
                if thing.type == "LIGHT":
                    self._lamps[middle.keys[number].tobytes()] = thing.name
                continue
            owner = entry.parent if entry.is_instance else thing
            of = thing.original, owner.original
            if of not in known:
                known[of] = key_count(*of, self._shutter), self._changes_shape(thing)
            self._counts[row], changes = known[of]
            if changes and self._counts[row] and self._table.kinds[row] == _MESH:
                self._owners.setdefault(int(self._table.meshes[row]), row)

    def _changes_shape(self, thing):
        if thing.type != "MESH" or not reshapes(thing.original, self._shutter):
            return False
        return thing.is_deform_modified(self._depsgraph.scene, "RENDER")

    def times(self):
        """Return the relative times at which something is to be read, the middle first."""
        counts = {*np.unique(self._counts).tolist(), self._camera_count, *self._view_counts} - {0}
        return sorted({time for count in counts for time in relative_times(count)}, key=lambda time: (time != 0.0, time))

    def take(self, relative, instant):
        """Take an Instant that an earlier picture has read; return whether it has all that this one needs."""
        wanted = {self._keys[row].tobytes() for row in self._owners.values()}
        if instant is None or not wanted <= instant.shapes.keys() or instant.camera is None:
            return False
        if self._sight is not None and instant.views is None:
            return False
        self._instants[relative] = instant
        return True

    def read(self, relative, obey):
        """Return the Instant of the scene as it is evaluated now. obey: ends the export by an exception."""
        obey()
        instant = self._instants[relative] = Instant(self._depsgraph, self._places)
        instant.camera = export_camera(self._camera, self._depsgraph, Messages())
        if self._sight is not None:
            instant.views = self._sight.cameras()
        wanted = {self._keys[row].tobytes() for row in self._owners.values()}
        if not wanted:
            return instant
        for number, entry in enumerate(self._depsgraph.object_instances):
            key = instant.keys[number].tobytes()
            if key not in wanted:
                continue
            obey()
            thing = entry.object
            with shown_mesh(thing, entry.instance_object if entry.is_instance else thing) as data:
                instant.shapes[key] = read_shape(data, obey)
        return instant

    def result(self, snapshot, messages):
        """Return the snapshot with the motion that was read."""
        return self._blurred(snapshot, messages) if self._shutter.blurs else self._with_vectors(snapshot, messages)

    def _with_vectors(self, snapshot, messages):
        frames = [self._instants[time] for time in FRAMES]
        vectors = instance_vectors(self._table.matrices, [self._matrices(time) for time in FRAMES])
        meshes = list(snapshot.meshes)
        for number, _, (before, _, after) in self._shapes(meshes, messages):
            meshes[number] = mesh_in_frames(meshes[number], (before, after))
        if self._sight is not None:
            self._sight.frames = tuple(zip(*(frame.views for frame in frames), strict=True))
        camera = camera_in_frames(snapshot.camera, [frame.camera for frame in frames], self._camera, messages)
        table = dataclasses.replace(snapshot.instances, vectors=vectors)
        return snapshot.replaced(meshes=tuple(meshes), instances=table, camera=camera)

    def _blurred(self, snapshot, messages):
        cameras = self._camera_keys(self._camera_count, lambda instant: instant.camera)
        if self._sight is not None:
            counts = enumerate(self._view_counts)
            self._sight.keys = tuple(self._camera_keys(count, lambda instant, i=i: instant.views[i]) for i, count in counts)
        self._tell_lamps(messages)
        self._tell_world(messages)
        table = dataclasses.replace(snapshot.instances, motions=tuple(self._motions(messages)))
        meshes = list(snapshot.meshes)
        for number, middle, shapes in self._shapes(meshes, messages):
            moved = np.stack([shape.positions for shape in shapes])
            normals = None if middle.normals is None else np.stack([shape.normals for shape in shapes])
            meshes[number] = dataclasses.replace(meshes[number], moved_positions=moved, moved_normals=normals)
        return snapshot.replaced(meshes=tuple(meshes), instances=table, motion=as_motion(self._shutter, cameras))

    def _camera_keys(self, count, camera_of):
        """Return the snapshot.Cameras at so many keys; none of a camera that stands still."""
        cameras = tuple(camera_of(self._instants[time]) for time in relative_times(count)) if count else ()
        return () if all(camera == cameras[0] for camera in cameras) else cameras

    def _tell_lamps(self, messages):
        """Name the lamps that move, of which Cycles blurs none."""
        moving = set()
        keys = np.array([np.frombuffer(key, np.uint64) for key in self._lamps])
        here = self._instants[0.0].columns[self._instants[0.0].rows_of(keys)] if self._lamps else ()
        for instant in self._instants.values() if self._lamps else ():
            entries = instant.rows_of(keys)
            moves = (entries >= 0) & (instant.columns[entries] != here).any(axis=(1, 2))
            moving |= {name for name, is_moving in zip(self._lamps.values(), moves, strict=True) if is_moving}
        for name in sorted(moving):
            messages.add(f"light '{name}': moves within the shutter, as in Cycles it shines from its place in the middle of it")

    def _tell_world(self, messages):
        """Name a world with animated nodes, which Cycles reads once."""
        world = world_of(self._depsgraph)
        animation = world.node_tree.animation_data if world is not None and world.node_tree is not None else None
        if animation is not None and (animation.action is not None or len(animation.drivers)):
            text = "its nodes are animated, as in Cycles it shines as in the middle of the shutter"
            messages.add(f"world '{world.name}': {text}", severity=Severity.HINT)

    def _motions(self, messages):
        for count in np.unique(self._counts).tolist():
            if count == 0:
                continue
            rows = np.flatnonzero(self._counts == count)
            keys = np.stack([self._matrices(time)[rows] for time in relative_times(count)], axis=1)
            moves = (keys != keys[:, :1]).any(axis=(1, 2, 3))
            rows, keys = rows[moves], keys[moves]
            flat = is_singular(keys[..., :3].reshape(-1, 3, 3)).reshape(len(rows), count).any(axis=1)
            for name in np.unique(self._table.name_indices[rows[flat]]):
                messages.add(f"object '{self._table.names[name]}': a scale is 0 within the shutter; its motion is not blurred")
            leaning = (is_sheared(keys) & (np.linalg.det(keys[..., :3]) < 0.0)).any(axis=1) & ~flat
            for name in np.unique(self._table.name_indices[rows[leaning]]):
                messages.add(
                    f"object '{self._table.names[name]}': moves while it is mirrored and sheared, "
                    "Cycles shears it another way, here it keeps its shape"
                )
            if not flat.all():
                yield InstanceMotion(instances=rows[~flat], matrices=keys[~flat])

    def _matrices(self, relative):
        instant = self._instants[relative]
        entries = instant.rows_of(self._keys)
        matrices = self._places.placed(instant.columns, np.maximum(entries, 0))
        missing = entries < 0
        matrices[missing] = self._table.matrices[missing]
        return matrices

    def _shapes(self, meshes, messages):
        """Yield (number, Shape in the middle, Shapes at the keys) of each mesh that changes its shape."""
        blurs = self._shutter.blurs
        for number, row in self._owners.items():
            key = self._keys[row].tobytes()
            middle = self._instants[0.0].shapes.get(key)
            who = f"mesh '{meshes[number].name}'"
            # The mesh may have been cut by adaptive subdivision, whose faces follow the camera.
            if middle is None or not middle.fits(meshes[number]):
                left_out = "not blurred" if blurs else "not in the pass Vector"
                text = f"{who}: with adaptive subdivision its change of shape is {left_out}"
                messages.add(text, "feature:deformation motion of adaptive subdivision")
                continue
            shapes = [self._instants[time].shapes.get(key, middle) for time in relative_times(int(self._counts[row]))]
            if not all(shape.like(middle) for shape in shapes):
                changes = (
                    "within the shutter, as in Cycles it is not blurred then"
                    if blurs
                    else "from frame to frame, as in Cycles the pass Vector shows it as if it kept its shape"
                )
                messages.add(f"{who}: the number of its vertices changes {changes}")
                shapes = [shape if shape.like(middle) else middle for shape in shapes]
            if all(np.array_equal(shape.positions, middle.positions) for shape in shapes):
                continue
            yield number, middle, shapes


def read_motion(snapshot, depsgraph, camera, places, options, messages, obey):
    """Return the snapshot with the motion within the shutter, in whose middle the depsgraph is evaluated, or that of vectors.

    camera: the camera object. options: the ExportOptions, with shutter and set_frame.
    """
    shutter, kept = options.shutter, options.kept
    layer = depsgraph.view_layer.name
    known = kept.instants.get(layer, {}) if kept is not None else {}
    reader = MotionReader(depsgraph, snapshot.instances, places, camera, options)
    found = {}
    for relative in reader.times():
        frame = shutter.frame_at(relative)
        # The shutter of one frame may close when that of the next one opens.
        if relative == 0.0 or not reader.take(relative, known.get(frame)):
            if relative != 0.0:
                options.set_frame(frame)
            found[frame] = reader.read(relative, obey)
    if kept is not None:
        kept.instants[layer] = found
    return reader.result(snapshot, messages)
