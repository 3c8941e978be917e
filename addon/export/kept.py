"""A cache of meshes and images for the frames of an animation, and for pictures of several layers with Persistent Data.

Each entry keeps its sources, all data from which it was computed, and is reused only if the sources are equal bit by bit. So
each frame reads Blender's data again, but computes nothing from equal data and decodes no file twice. An entry that a frame
does not use is dropped at the next frame.
"""

import math

import bpy
import numpy as np

from ..bindings.record import bytes_of
from .arrays import built_in, corner_vertices, look
from .attributes import attribute_sources, color_attribute, read_uv_map, render_uv_map
from .image_state import image_state
from .mesh import face_slots, read_positions

_NEW_NORMALS = bpy.app.version >= (4, 1)


class _Entry:
    """sources: arrays and other values in a fixed order. value: the result computed from them."""

    def __init__(self, sources, value):
        self.sources, self.value, self.used = sources, value, True

    @property
    def bytes(self):
        return bytes_of(self.sources, self.value)


class Kept:
    """The cache. counts holds the numbers of meshes and images read and reused in the current frame."""

    def __init__(self):
        self._entries = {}
        self.scenes = {}  # the library's Scene of each view layer, from which the next picture takes what is the same
        self.sample_seconds = math.inf  # of one sample of the picture before
        self.counts = {}
        self.instants = {}  # the Instants of the picture before, by view layer and by their time in frames
        self._others = ()
        self.next_picture()

    def next_picture(self):
        """Drop entries that the frame before did not use. All view layers of a frame share the entries."""
        for key, entries in list(self._entries.items()):
            left = self._entries[key] = [entry for entry in entries if entry.used]
            for entry in left:
                entry.used = False
            if not left:
                del self._entries[key]
        self._others = ()
        self.counts = {"read_meshes": 0, "kept_meshes": 0, "read_images": 0, "kept_images": 0}

    def keep_scene(self, layer, scene):
        """Keep the library's Scene of a view layer instead of that of the picture before."""
        before = self.scenes.get(layer)
        self.scenes[layer] = scene
        if before is not None:
            before.close()

    def count_parts(self, snapshot, parts):
        """Count the meshes and images that a Parts keeps, instead of entries of this cache."""
        self._others = snapshot.meshes, snapshot.images
        for kind, records in zip(("meshes", "images"), self._others, strict=True):
            read = parts.counts[kind]
            self.counts |= {f"read_{kind}": read, f"kept_{kind}": max(0, len(records) - read)}

    @property
    def bytes(self):
        return bytes_of(self._others) + sum(entry.bytes for entries in self._entries.values() for entry in entries)

    def meshes(self, export_mesh):
        """Return an export_mesh that looks in the cache first."""

        def export(mesh, name, poll, wanted):
            sources = _sources_of_mesh(mesh, wanted, poll)
            return self._get("meshes", (name, wanted), sources, lambda: export_mesh(mesh, name, poll, wanted))

        return export

    def pictures(self, read_all, has_mipmaps):
        """Return a _read_all of images.py that looks in the cache first and repeats the messages of cached images."""

        def read_again(image, seen, tell):
            def make():
                told = []
                return read_all(image, seen, lambda *given, **named: told.append((given, named))), told

            key = image.name_full, has_mipmaps, image.has_data
            found, told = self._get("images", key, image_state(image, seen), make)
            for given, named in told:
                tell(*given, **named)
            return found

        return read_again

    def _get(self, kind, key, sources, make):
        entries = self._entries.setdefault((kind, key), [])
        for entry in entries:
            if sources is not None and _same(entry.sources, sources):
                entry.used = True
                self.counts[f"kept_{kind}"] += 1
                return entry.value
        self.counts[f"read_{kind}"] += 1
        if sources is not None:
            # Copy the arrays: Blender's own end with the frame, and computing normals may move them.
            sources = tuple(np.array(source) if isinstance(source, np.ndarray) else source for source in sources)
        value = make()
        if sources is not None:
            entries.append(_Entry(sources, value))
        return value


def _same(a, b):
    """Whether two tuples hold the same bits."""
    if len(a) != len(b):
        return False
    for x, y in zip(a, b, strict=True):
        if isinstance(x, np.ndarray) and isinstance(y, np.ndarray):
            if x.dtype != y.dtype or x.shape != y.shape or not np.array_equal(_bits(x), _bits(y)):
                return False
        elif isinstance(x, np.ndarray) or isinstance(y, np.ndarray) or x != y:
            return False
    return True


def _bits(array):
    return array.view(np.uint32) if array.dtype.itemsize == 4 else array


def _sources_of_mesh(mesh, wanted, poll):
    """Return all data that export_mesh reads; None if Blender does not expose all of it."""
    if not _NEW_NORMALS and mesh.has_custom_normals:
        return None
    places, corners = built_in(mesh, "position", "POINT"), built_in(mesh, ".corner_vert", "CORNER")
    sources = [
        len(mesh.edges),
        read_positions(mesh) if places is None else look(places, "vector", np.float32, 3),
        corner_vertices(mesh) if corners is None else look(corners, "value", np.int32, 1),
        look(mesh.polygons, "loop_start", np.int32, 1),
    ]
    poll()
    sources += _sources_of_normals(mesh)
    poll()
    layer, color = render_uv_map(mesh), color_attribute(mesh)
    if layer is not None:
        sources.append(look(layer.uv, "vector", np.float32, 2) if hasattr(layer, "uv") else read_uv_map(layer))
    if color is not None:
        sources += [color.domain, look(color.data, "color", np.float32, 4)]
    sources.append(face_slots(mesh))
    poll()
    sources += attribute_sources(mesh, wanted)
    return tuple(sources)


def _sources_of_normals(mesh):
    """Yield the data besides faces and positions that normals depend on: sharp edges, flat faces, custom normals."""
    if not _NEW_NORMALS:
        yield mesh.use_auto_smooth
        yield mesh.auto_smooth_angle
        yield look(mesh.polygons, "use_smooth", bool, 1)
        if mesh.use_auto_smooth:
            yield look(mesh.loops, "edge_index", np.int32, 1)
            yield look(mesh.edges, "use_edge_sharp", bool, 1)
        return
    yield mesh.normals_domain
    yield mesh.has_custom_normals
    for name, domain in (("sharp_face", "FACE"), ("sharp_edge", "EDGE")):
        data = built_in(mesh, name, domain)
        yield None if data is None else look(data, "value", bool, 1)
    if built_in(mesh, "sharp_edge", "EDGE") is not None or mesh.has_custom_normals:
        yield look(mesh.loops, "edge_index", np.int32, 1)
    if mesh.has_custom_normals:
        custom = mesh.attributes.get("custom_normal")
        yield None if custom is None else custom.data_type
        yield look(mesh.vertex_normals, "vector", np.float32, 3)
        yield look(mesh.corner_normals, "vector", np.float32, 3)
