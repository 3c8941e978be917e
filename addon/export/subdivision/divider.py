"""Which objects of a depsgraph are divided adaptively, by which camera, and their meshes."""

import functools

import bpy

from ...bindings.abi import LancerError
from ...messages.messages import Messages
from ..camera import export_camera
from .divided import export_divided
from .memory import BYTES_OF_TRIANGLE
from .modifier import adaptive, cage_of

# Cycles before 4.5 splits patches by another order, into more segments.
PLACES_OTHERWISE = bpy.app.version < (4, 5)


class Divider:
    def __init__(self, depsgraph, camera, messages, in_view=False):
        """camera: the snapshot.Camera of the picture, or of a window's view as it is now; None for a view without pixels.

        The meshes of a window do not follow its view, as in Cycles: else each move of the view would divide them again.
        """
        self._depsgraph, self._own_camera, self._messages, self._in_view = depsgraph, camera, messages, in_view
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

    def settings(self, thing, owner):
        """Return the Adaptive of an object with its own mesh; None if its mesh is shown as Blender divides it."""
        # Instances made by Geometry Nodes have other meshes. In Edit Mode the mesh before the modifier is the edited one.
        if not owner.modifiers or owner.data != thing.data or owner.data.is_editmode:
            return None
        found = adaptive(owner, self._depsgraph.scene, self._in_view)
        if found is not None and found.in_pixels and self._camera is None:
            self._messages.add(f"object '{thing.name}': adaptive subdivision by pixels needs a camera, Blender's mesh is shown")
            return None
        return found

    def key(self, settings):
        """Return what the mesh depends on besides Blender's data."""
        if not settings.in_pixels or self._in_view and self._chosen is None:
            return settings
        camera = self._camera
        return settings, camera.matrix.tobytes(), camera.window, camera.width, camera.height, camera.kind, camera.panorama

    def mesh(self, owner, settings, name, wanted, poll):
        """Return the MeshData of an evaluated object. As in Cycles, its own transform counts, not those of its instances."""
        with cage_of(owner, self._depsgraph) as mesh:
            return export_divided(mesh, name, poll, wanted, settings, self._camera, owner.matrix_world)


def size_in_words(mesh):
    count = len(mesh.triangles)
    return f"adaptive subdivision makes {count} triangles, which need {count * BYTES_OF_TRIANGLE / 2**20:.0f} MB"
