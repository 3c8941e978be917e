"""What an artist sets for all files, in Blender's preferences of the add-on."""

import bpy
from bpy.app.handlers import persistent
from bpy.props import EnumProperty, IntProperty

from ..export import settings
from .scene_settings import QUALITIES

# Blender knows an add-on by its top package, above this room.
_ADDON = __package__.rpartition(".")[0]


def _threads_changed(self, _context):
    # A render may not ask Blender's context.
    settings.default_threads = self.threads


class LancerPreferences(bpy.types.AddonPreferences):
    bl_idname = _ADDON

    threads: IntProperty(
        name="Threads",
        description="How many threads render where a scene's Threads Mode is Auto-Detect; fewer than the computer has leave "
        "it usable meanwhile. 0 = all",
        min=0,
        max=1024,
        default=0,
        update=_threads_changed,
    )
    quality: EnumProperty(
        name="Quality of New Files",
        description="What the render settings of a new file start with; files that were saved keep their own",
        items=(
            ("CUSTOM", "As Lancer Comes", "256 samples, without a target error", 3),
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
        column.prop(self, "quality")


def _found():
    """The preferences; None where this is no add-on that was switched on, but a module that a script has imported."""
    addon = bpy.context.preferences.addons.get(_ADDON)
    return None if addon is None else addon.preferences


@persistent
def _start_new_file(*_):
    """A file that was never saved has none of the artist's own settings, unless the startup file brought them."""
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
    bpy.app.handlers.load_post.append(_start_new_file)


def unregister():
    bpy.app.handlers.load_post.remove(_start_new_file)
    bpy.utils.unregister_class(LancerPreferences)
    settings.default_threads = 0
