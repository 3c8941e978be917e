"""The add-on's preferences, which apply to all files."""

import bpy
from bpy.app.handlers import persistent
from bpy.props import EnumProperty, IntProperty, StringProperty

from ..export import scratch, settings
from ..farm import pipe_pool
from .scene_settings import QUALITIES

# Blender identifies an add-on by its top package, the parent of this one.
_ADDON = __package__.rpartition(".")[0]


def _threads_changed(self, _context):
    # A render thread must not access Blender's context: copy the value.
    settings.default_threads = self.threads


def _image_memory_changed(self, _context):
    scratch.image_memory = self.image_memory << 20


def _python_changed(self, _context):
    pipe_pool.default_python = bpy.path.abspath(self.farm_python)


class LancerPreferences(bpy.types.AddonPreferences):
    bl_idname = _ADDON

    threads: IntProperty(
        name="Threads",
        description="Number of render threads for scenes whose Threads Mode is Auto-Detect; fewer threads than processors "
        "keep the computer responsive. 0 = all",
        min=0,
        max=1024,
        default=0,
        update=_threads_changed,
    )
    image_memory: IntProperty(
        name="Memory for Images (MB)",
        description="Memory for the images of a scene. Images beyond it are read piece by piece from a file in the folder for "
        "temporary files (Preferences > File Paths), which is slower; the file ends with the render. 0 = a quarter of this "
        "computer's memory",
        min=0,
        max=1 << 30,
        default=0,
        update=_image_memory_changed,
    )
    farm_python: StringProperty(
        name="Python with Dask",
        description="Program that speaks to the scheduler of Many Machines: a Python with the packages distributed and numpy, "
        "since Blender's own has no Dask. Empty: the first Python on the system's path",
        subtype="FILE_PATH",
        update=_python_changed,
    )
    quality: EnumProperty(
        name="Quality of New Files",
        description="Quality of new files; saved files keep their own",
        items=(
            ("CUSTOM", "Default", "That of a new scene: Good", 3),
            *(
                (name, name.capitalize(), f"An error of {error * 100:g} %", number)
                for number, (name, (error, _)) in enumerate(QUALITIES.items())
            ),
        ),
        default="CUSTOM",
    )

    def draw(self, _context):
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "threads")
        column.prop(self, "image_memory")
        column.prop(self, "quality")
        column.prop(self, "farm_python")


def _found():
    """Return the preferences; None if Lancer was imported by a script instead of enabled as an add-on."""
    addon = bpy.context.preferences.addons.get(_ADDON)
    return None if addon is None else addon.preferences


@persistent
def _start_new_file(*_):
    """Apply the preferred quality to a new file, unless the startup file contains settings of its own."""
    preferences = _found()
    if preferences is None or preferences.quality == "CUSTOM" or bpy.data.filepath:
        return
    for scene in bpy.data.scenes:
        if not any(scene.lancer.is_property_set(name) for name in ("quality", "samples", "target_error")):
            scene.lancer.quality = preferences.quality


def register():
    bpy.utils.register_class(LancerPreferences)
    preferences = _found()
    if preferences is not None:
        _threads_changed(preferences, None)
        _image_memory_changed(preferences, None)
        _python_changed(preferences, None)
    bpy.app.handlers.load_post.append(_start_new_file)


def unregister():
    bpy.app.handlers.load_post.remove(_start_new_file)
    bpy.utils.unregister_class(LancerPreferences)
    settings.default_threads = 0
    scratch.image_memory = 0
    pipe_pool.default_python = ""
