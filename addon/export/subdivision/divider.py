"""Which objects of a depsgraph are divided adaptively, by which camera, and their meshes."""

import bpy

from ...messages.messages import Messages
from ..camera import export_camera
from .divided import export_divided
from .memory import BYTES_OF_TRIANGLE
from .modifier import adaptive, cage_of

# Cycles before 4.5 splits patches by another order, into more segments.
PLACES_OTHERWISE = bpy.app.version < (4, 5)


class Divider:
    def __init__(self, depsgraph, camera):
        """camera: the snapshot.Camera of the picture; None for a window, whose meshes the scene's camera divides.

        The meshes of a window do not follow its view, as in Cycles: else each move of the view would divide them again.
        """
        self._depsgraph, self._in_view = depsgraph, camera is None
        scene = depsgraph.scene
        chosen = getattr(getattr(scene, "cycles", None), "dicing_camera", None) or (scene.camera if self._in_view else None)
        if chosen is not None and chosen.type == "CAMERA":
            # Drop its messages: the export of the picture's camera tells them.
            camera = export_camera(chosen, depsgraph, Messages())
        self._camera = camera

    def settings(self, thing, owner):
        """Return the Adaptive of an object with its own mesh; None if its mesh is shown as Blender divides it."""
        # Instances made by Geometry Nodes have other meshes. In Edit Mode the mesh before the modifier is the edited one.
        if not owner.modifiers or owner.data != thing.data or owner.data.is_editmode:
            return None
        found = adaptive(owner, self._depsgraph.scene, self._in_view)
        return None if found is not None and found.in_pixels and self._camera is None else found

    def key(self, settings):
        """Return what the mesh depends on besides Blender's data."""
        camera = self._camera
        if camera is None or not settings.in_pixels:
            return settings
        return settings, camera.matrix.tobytes(), camera.window, camera.width, camera.height, camera.kind, camera.panorama

    def mesh(self, owner, settings, name, wanted, poll):
        """Return the MeshData of an evaluated object. As in Cycles, its own transform counts, not those of its instances."""
        with cage_of(owner, self._depsgraph) as mesh:
            return export_divided(mesh, name, poll, wanted, settings, self._camera, owner.matrix_world)


def size_in_words(mesh):
    count = len(mesh.triangles)
    return f"adaptive subdivision makes {count} triangles, which need {count * BYTES_OF_TRIANGLE / 2**20:.0f} MB"
