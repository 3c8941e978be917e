"""Delete Resume Files removes the files from which the renders of a scene continue."""

import bpy

from ..bindings.abi import LancerError
from ..engine.resume import path_of


class LANCER_OT_delete_resume_files(bpy.types.Operator):
    """Delete the files beside the output from which renders continue, of all frames and view layers of this scene"""

    bl_idname = "lancer.delete_resume_files"
    bl_label = "Delete Resume Files"

    def invoke(self, context, event):
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, context):
        scene = context.scene
        frames = {scene.frame_current, *range(scene.frame_start, scene.frame_end + 1)}
        try:
            paths = [path_of(scene, layer.name, frame) for frame in frames for layer in scene.view_layers]
        except LancerError as error:
            self.report({"ERROR"}, f"Lancer: {error}")
            return {"CANCELLED"}
        deleted = 0
        for path in filter(lambda path: path.exists(), paths):
            try:
                path.unlink()
                deleted += 1
            except OSError as error:
                self.report({"WARNING"}, f"Lancer: '{path}' cannot be deleted: {error.strerror}")
        self.report({"INFO"}, f"Lancer: {deleted} resume file{'s' * (deleted != 1)} deleted")
        return {"FINISHED"}


def register():
    bpy.utils.register_class(LANCER_OT_delete_resume_files)


def unregister():
    bpy.utils.unregister_class(LANCER_OT_delete_resume_files)
