"""The panel of renders that continue: what their files hold, and the button that deletes them."""

import bpy

from ..bindings.abi import LancerError
from ..engine import resume, resume_file
from ..measure.render_report import duration
from ..operators.delete_resume_files import LANCER_OT_delete_resume_files
from .panel import LancerRenderPanel
from .sentences import sentence

_WHAT = (
    "The next render of the same scene, camera and settings continues; samples, target error and time limit may grow. After a "
    "change it begins anew."
)


class LANCER_RENDER_PT_resume(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Resume"
    bl_parent_id = "LANCER_RENDER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.active = not context.scene.lancer.use_many_machines
        self.layout.prop(context.scene.lancer, "use_resume", text="")

    def draw(self, context):
        scene = context.scene
        column = self.layout.column(align=True)
        sentence(column, context, _WHAT)
        try:
            files = list(_lines(scene))
        except LancerError as error:
            sentence(column, context, str(error), "ERROR")
            return
        for line in files or ["This frame has no file"]:
            sentence(column, context, line)
        row = self.layout.row()
        row.active = bool(files)
        row.operator(LANCER_OT_delete_resume_files.bl_idname, icon="TRASH")


def _lines(scene):
    """Yield a line for each file of the scene's frame."""
    for layer in scene.view_layers:
        found = resume_file.look(resume.path_of(scene, layer.name))
        if found is not None:
            facts, size = found
            yield f"{layer.name}: {facts['mean']:.4g} samples, {duration(facts['seconds'])}, {size / 2**20:.3g} MB"


CLASSES = (LANCER_RENDER_PT_resume,)
