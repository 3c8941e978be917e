"""Scenes of the library: filled with the records of a snapshot, committed, and taken over in parts by later scenes.

poll is a function without arguments that is called at least every 0.1 s while waiting; it returns True to cancel.
"""

import ctypes

import numpy as np

from . import abi, marshal
from .abi import ObjectKind, Status, check, load_library
from .handle import Handle
from .mapped_file import MappedPages
from .probes import SceneProbes
from .snapshot import InstanceTable
from .stock import Stock, file_of, key_of

STEP = 0.05  # seconds between two polls


class Cancelled(Exception):
    """The user cancelled: poll returned True before there was a result."""


class Scene(Handle, SceneProbes):
    """A scene in the library: create, fill, commit; upload() does all three.

    before: a committed scene that differs little; the commit makes only the parts that differ. Both may be closed in any order,
    also by another thread: a scene that is closed already is as none.
    stock: the Stock of the scenes that share objects; a scene without one shares those of before, or none.
    """

    def __init__(self, library=None, before=None, stock=None):
        handle = ctypes.c_uint64()
        library = before.library if before is not None else library or load_library()
        if before is not None:
            status = library.lancer_scene_edit(before.handle, ctypes.byref(handle))
            if status == Status.ERROR_HANDLE:
                before = None
            else:
                check(status, library)
        if before is None:
            check(library.lancer_scene_create(ctypes.byref(handle)), library)
        self._own(library, library.lancer_scene_destroy, handle.value, MappedPages())
        self._stock = stock or (Stock() if before is None else before._stock)
        self._parts = []
        self._instances = None if before is None else before._instances

    @classmethod
    def upload(cls, snapshot, library=None, poll=None, release=False, before=None, stock=None, filled=None):
        """Return a committed scene with the accelerator and threads of the snapshot's settings.

        release: see fill. filled: is called when all records are copied, before the commit.
        """
        scene = cls(library, before, stock)
        try:
            scene.fill(snapshot, poll, release)
            if filled is not None:
                filled()
            scene.commit(snapshot.settings.accelerator, snapshot.settings.threads, poll)
        except BaseException:
            scene.close()
            raise
        return scene

    def fill(self, snapshot, poll=None, release=False):
        """Copy the snapshot into the library, which reads Blocks in place.

        release: remove each part from the snapshot when copied, to save memory; it is not known again.
        """
        for _ in self.filling(snapshot, release):
            _obey(poll)

    def filling(self, snapshot, release=False):
        """Run fill() in steps: yield after each record that was copied, so that the caller can poll."""
        images = yield from self._set(ObjectKind.IMAGE, snapshot, "images", (), release)
        yield from self._set(ObjectKind.MESH, snapshot, "meshes", (), release)
        yield from self._set(ObjectKind.MATERIAL, snapshot, "materials", images, release)
        yield from self._set(ObjectKind.LIGHT, snapshot, "lights", images, release)
        world, made = self._stock.part(self.library, ObjectKind.WORLD, snapshot.world, 0, images, not release)
        self._give(ObjectKind.WORLD, [world])
        if made:
            yield
        if snapshot.instances is not self._instances:
            self._set_instances(snapshot.instances)
            self._instances = snapshot.instances
            yield
        motion = marshal.motion(snapshot.motion)
        self._check(self.library.lancer_scene_set_motion(self.handle, ctypes.byref(motion)))
        if release:
            snapshot.set("instances", InstanceTable())
            self._instances = None

    def _set(self, kind, snapshot, name, images, release):
        """Give the scene the objects of one kind; yield after each that was made, and return all Parts."""
        records = list(reversed(getattr(snapshot, name)))
        if release:
            snapshot.set(name, ())
        parts = []
        while records:
            # The struct holds addresses of the record's arrays: keep the record until it is copied.
            record = records.pop()
            if kind == ObjectKind.IMAGE and file_of(record) is not None:
                self.pages.add(file_of(record))
            part, made = self._stock.part(self.library, kind, record, len(parts), images, not release)
            parts.append(part)
            if made:
                yield
        self._give(kind, parts)
        return parts

    def _give(self, kind, parts):
        handles = np.array([part.handle for part in parts], np.uint64)
        self._check(self.library.lancer_scene_set_objects(self.handle, int(kind), len(handles), handles.ctypes.data))
        self._parts.extend(parts)

    def _set_instances(self, table):
        self._check(self.library.lancer_scene_clear_instances(self.handle))
        if not len(table):
            return
        self._check(self.library.lancer_scene_add_instances(self.handle, *marshal.instances(table)))
        if table.infos is not None:
            self._check(self.library.lancer_scene_set_object_infos(self.handle, len(table.infos), table.infos.ctypes.data))
        for attribute in table.attributes:
            self._check(self.library.lancer_scene_add_object_attribute(self.handle, *marshal.object_attribute(attribute)))
        for motion in table.motions:
            self._check(self.library.lancer_scene_move_instances(self.handle, *marshal.instance_motion(motion)))
        if table.vectors is not None:
            self._check(self.library.lancer_scene_set_vectors(self.handle, *marshal.instance_vectors(table.vectors)))

    def likeness(self, snapshot):
        """Return how many meshes of a snapshot may be those of this scene, by name and size."""
        known = {part.key for part in self._parts}
        return sum(key_of(ObjectKind.MESH, mesh) in known for mesh in snapshot.meshes)

    def set_digest(self, digest):
        """Name the scene in parts of pictures: 32 bytes of bindings.digest.scene_digest."""
        if len(digest) != 32:
            raise ValueError(f"a digest has 32 bytes, not {len(digest)}")
        self._check(self.library.lancer_scene_set_digest(self.handle, bytes(digest)))

    def commit(self, accelerator=abi.Accelerator.BVH, threads=0, poll=None):
        self.begin_commit(accelerator, threads)
        while not self.is_committed(STEP):
            if poll is not None and poll():
                self._check(self.library.lancer_scene_cancel(self.handle))
                while not self.is_committed(STEP):
                    pass
                raise Cancelled

    def begin_commit(self, accelerator=abi.Accelerator.BVH, threads=0):
        self._check(self.library.lancer_scene_commit(self.handle, int(accelerator), int(threads)))

    def is_committed(self, seconds=0.0):
        """Wait at most that long and return whether the commit has ended; raise LancerError if it failed."""
        status = self._check(self.library.lancer_scene_wait(self.handle, int(seconds * 1000)))
        self.pages.keep_under()
        return status is not Status.RUNNING

    def messages(self):
        """Return one line for each part of the scene that the library left out or replaced."""
        needed = ctypes.c_size_t()
        self._check(self.library.lancer_scene_messages(self.handle, None, 0, ctypes.byref(needed)))
        text = ctypes.create_string_buffer(max(1, needed.value))
        self._check(self.library.lancer_scene_messages(self.handle, text, len(text), None))
        return text.value.decode("utf-8", "replace").splitlines()


def _obey(poll):
    if poll is not None and poll():
        raise Cancelled
