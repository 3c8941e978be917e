"""Which objects of a depsgraph are divided adaptively, by which camera, and their meshes."""

import functools

import bpy

from ...bindings.abi import LancerError
from ...messages.messages import Messages
from ..attributes import GENERATED
from ..camera import export_camera
from .divided import export_divided
from .memory import BYTES_OF_TRIANGLE
from .modifier import adaptive, cage_of, may_make_instances, undeformed_cage

# Cycles before 4.5 splits patches by another order, into more segments.
PLACES_OTHERWISE = bpy.app.version < (4, 5)


class Divider:
    def __init__(self, depsgraph, camera, messages, in_view=False, is_off=False):
        """camera: the snapshot.Camera of the picture, or of a window's view as it is now; None for a view without pixels.
        is_off: no object is divided.

        The meshes of a window do not follow its view, as in Cycles: else each move of the view would divide them again.
        """
        self._depsgraph, self._own_camera, self._messages, self._in_view = depsgraph, camera, messages, in_view
        self._is_off = is_off
        self._settings = {}  # by the address of the object
        chosen = getattr(getattr(depsgraph.scene, "cycles", None), "dicing_camera", None)
        self._chosen = chosen if chosen is not None and chosen.type == "CAMERA" else None

    @functools.cached_property
    def _camera(self):
        """The camera by whose pixels meshes are divided; read for the first of them, as it may have no frame."""
        if self._chosen is None:
            return self._own_camera
        try:
            # Drop its messages: the export of the picture's camera tells them.
            return export_camera(self._chosen, self._depsgraph, Messages())
        except LancerError as error:
            self._messages.add(f"the dicing camera is not used: {error}")
            return self._own_camera

    def settings(self, owner):
        """Return the Adaptive of an evaluated object; None if its mesh is shown as Blender divides it."""
        if self._is_off or not owner.modifiers:
            return None
        key = owner.original.as_pointer()
        if key not in self._settings:
            self._settings[key] = self._read_settings(owner)
        return self._settings[key]

    def _read_settings(self, owner):
        found = adaptive(owner, self._depsgraph.scene, self._in_view)
        # In Edit Mode the mesh before the modifier is the edited one.
        if found is None or owner.type == "MESH" and owner.original.data.is_editmode:
            return None
        if found.in_pixels and self._camera is None:
            self._messages.add(f"object '{owner.name}': adaptive subdivision by pixels needs a camera, Blender's mesh is shown")
            return None
        return found

    def shows_own_mesh(self, entry, thing):
        """Whether an entry of the depsgraph shows the own mesh of an object that is divided, not one that its nodes made.

        Do not read the data of such an object: since 4.5, Blender would divide it by the levels of the modifier for that.
        """
        if thing.type != "MESH" or self.settings(thing) is None:
            return False
        if not entry.is_instance:
            return True
        owner, maker = entry.instance_object, entry.parent
        if owner.type != "MESH":
            return False
        if not may_make_instances(owner):
            return True
        return maker.original != owner.original and thing.data == owner.data

    @property
    def depends_on_places(self):
        """Whether an object is divided anew once its place or that of the camera changes."""
        follows = not self._in_view or self._chosen is not None
        return follows and any(found is not None and found.in_pixels for found in self._settings.values())

    def key(self, settings, owner):
        """Return what the mesh of an evaluated object depends on besides Blender's data."""
        if not settings.in_pixels or self._in_view and self._chosen is None:
            return settings
        camera = self._camera
        place = None if self._in_view else tuple(map(tuple, owner.matrix_world))
        return (
            settings,
            place,
            camera.matrix.tobytes(),
            camera.window,
            camera.width,
            camera.height,
            camera.kind,
            camera.panorama,
        )

    def mesh(self, owner, made, settings, name, wanted, poll):
        """Return the MeshData of an evaluated object, or of a mesh that its Geometry Nodes made for its instances.

        As in Cycles, the object's own transform counts, not those of its instances.
        """
        camera, matrix = self._camera, owner.matrix_world
        if made is not None:
            return export_divided(made, name, poll, wanted, settings, camera, matrix)
        places = undeformed_cage(owner, self._depsgraph) if GENERATED in wanted else None
        with cage_of(owner, self._depsgraph) as mesh:
            return export_divided(mesh, name, poll, wanted, settings, camera, matrix, places)


def size_in_words(mesh):
    count = len(mesh.triangles)
    return f"adaptive subdivision makes {count} triangles, which need {count * BYTES_OF_TRIANGLE / 2**20:.0f} MB"
