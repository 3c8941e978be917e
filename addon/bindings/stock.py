"""Records of snapshots as objects of the library, each made once however many scenes have it.

An object lives as long as a scene holds its Part. A record is known again by its identity; a mesh or an image, which take
memory, also by its value.
"""

import ctypes
import weakref

import numpy as np

from . import marshal
from .abi import NodeKind, ObjectKind, check
from .blocks import Blocks

_PICTURES = {NodeKind.IMAGE, NodeKind.ENVIRONMENT}
_TABLES = {NodeKind.CURVES, NodeKind.IES, NodeKind.SKY, NodeKind.VOXELS}


class Part:
    """A handle of the library that is destroyed with this object. images: Parts that its nodes read, by number."""

    def __init__(self, library, handle, key, record, images):
        """key: see key_of; record: None if it is not kept."""
        self.handle, self.key, self.record, self.images = handle, key, record, images
        weakref.finalize(self, library.lancer_object_destroy, handle)

    def reads(self, images):
        return all(number < len(images) and images[number] is part for number, part in self.images.items())


class Stock:
    """The Parts of all scenes that share it. Any thread may use it."""

    def __init__(self):
        self._by_identity = {}  # weak references to the Parts of each record, by its address
        self._by_key = {}  # weak references to Parts of meshes and images, by key_of

    def part(self, library, kind, record, number=0, images=(), keeps=True, threads=None):
        """Return (Part, whether it was made). images: Parts of all images that nodes name by number.

        keeps: whether the Part keeps the record, by which it is known again.
        threads: for the tree of a new mesh, which the library begins at once, 0 = all; None leaves the tree to the commit.
        """
        key = key_of(kind, record)
        found = self._find(record, key, images)
        if found is not None:
            return found, False
        used = {n: images[n] for n in _numbers(record) if n < len(images)}
        part = Part(library, _make(library, kind, record, number, images), key, record if keeps else None, used)
        if threads is not None:
            check(library.lancer_object_prepare(part.handle, threads), library)
        if keeps:
            _add(self._by_identity, id(record), part)
            if key is not None:
                _add(self._by_key, key, part)
        return part, True

    def known(self, kind, record):
        """Return the equal record of a Part of a mesh or an image; the record itself if there is none."""
        # Another thread may take the record out of a Part.
        records = (part.record for part in _living(self._by_key, key_of(kind, record)))
        return next((other for other in records if other is not None and other == record), record)

    def _find(self, record, key, images):
        for part in _living(self._by_identity, id(record)):
            if part.record is record and part.reads(images):
                return part
        if key is not None:
            for part in _living(self._by_key, key):
                if part.record == record:
                    return part
        return None


_SIZES = {
    ObjectKind.MESH: lambda mesh: (len(mesh.positions), len(mesh.triangles)),
    ObjectKind.IMAGE: lambda image: image.texels.shape,
}


def key_of(kind, record):
    """Return kind, name and size of a mesh or an image; None for other records."""
    return (kind, record.name, _SIZES[kind](record)) if kind in _SIZES else None


def _add(known, key, part):
    known[key] = [*(other for other in known.get(key, ()) if other() is not None), weakref.ref(part)]


def _living(known, key):
    references = known.get(key)
    if references is None:
        return ()
    parts = [part for part in (reference() for reference in references) if part is not None]
    if not parts:
        known.pop(key, None)
    return parts


def _numbers(record):
    """Return the numbers of the images that a record's nodes read."""
    numbers = set()
    for node in getattr(record, "nodes", ()):
        if node.kind in _PICTURES:
            numbers.update(range(node.image, node.image + node.image_count))
        elif node.kind in _TABLES:
            numbers.add(node.image)
    return numbers


def _make(library, kind, record, number, images):
    handle = ctypes.c_uint64()
    result = ctypes.byref(handle)
    if kind in (ObjectKind.IMAGE, ObjectKind.MESH):
        check(_CREATE[kind](library)(ctypes.byref(_STRUCTS[kind](record)), number, result), library)
        return handle.value
    handles = np.array([part.handle for part in images], np.uint64)
    seen = len(handles), handles.ctypes.data
    numbers = () if kind == ObjectKind.WORLD else (number,)
    check(_CREATE[kind](library)(ctypes.byref(_STRUCTS[kind](record)), *numbers, *seen, result), library)
    return handle.value


_STRUCTS = {
    ObjectKind.IMAGE: marshal.image,
    ObjectKind.MESH: marshal.mesh,
    ObjectKind.MATERIAL: marshal.material,
    ObjectKind.LIGHT: marshal.light,
    ObjectKind.WORLD: marshal.world,
}
_CREATE = {
    ObjectKind.IMAGE: lambda library: library.lancer_object_create_image,
    ObjectKind.MESH: lambda library: library.lancer_object_create_mesh,
    ObjectKind.MATERIAL: lambda library: library.lancer_object_create_material,
    ObjectKind.LIGHT: lambda library: library.lancer_object_create_light,
    ObjectKind.WORLD: lambda library: library.lancer_object_create_world,
}


def file_of(record):
    """Return the MappedFile that an image is read from in place; None for another one."""
    return record.texels.file if isinstance(record.texels, Blocks) else None
