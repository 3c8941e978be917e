"""Render one picture after the other, and measure the memory of the process."""

import gc

import bpy
import stage
from memory_now import held


class Empty(bpy.types.RenderEngine):
    """Renders a black picture."""

    bl_idname = "EMPTY"
    bl_label = "Empty"

    def render(self, depsgraph):
        scene = depsgraph.scene
        result = self.begin_result(0, 0, scene.render.resolution_x, scene.render.resolution_y)
        self.end_result(result)


def renders(engine, count):
    """Return [bytes after the tenth, bytes after the last render] of each kind of memory."""
    bpy.utils.register_class(Empty)
    scene = stage.room(samples=2)
    scene.render.engine = engine
    after = []
    for _ in range(int(count)):
        bpy.ops.render.render()
        gc.collect()
        after.append(held())
    bpy.utils.unregister_class(Empty)
    return {kind: [after[9][kind], after[-1][kind]] for kind in after[0]}
