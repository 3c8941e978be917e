"""Presets of Sampling and Light Paths: a button in the header of each panel, files in Blender's folder of presets."""

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ..host.registering import add_all

_DENOISING = ("use_denoising", "use_denoising_samples", "use_denoised_target")
_SAMPLING = ("target_error", "samples", "quality", "time_limit", *_DENOISING)
_LIGHT_PATHS = (
    "max_bounces",
    "transparent_bounces",
    "clamp_indirect",
    "contribution_threshold",
    "environment_reflections",
)


def _draw(panel, context):
    """Draw the presets as Blender does, but without its warning about missing paths if none was saved yet."""
    if bpy.utils.preset_paths(panel.preset_subdir):
        PresetPanel.draw(panel, context)
        return
    column, manager = panel.layout.column(), context.window_manager
    column.label(text="No presets yet")
    row = column.row()
    row.prop(manager, "preset_name", text="")
    row.operator(panel.preset_add_operator, text="", icon="ADD").name = manager.preset_name


def _made(name, label, settings):
    """Return the popover of presets and the operator that adds and removes them."""
    folder, operator, menu = f"lancer/{name}", f"render.lancer_{name}_preset_add", f"LANCER_PT_{name}_presets"
    panel = type(
        menu,
        (PresetPanel, bpy.types.Panel),
        {
            "bl_label": f"{label} Presets",
            "preset_subdir": folder,
            "preset_operator": "script.execute_preset",
            "preset_add_operator": operator,
            "draw": _draw,
        },
    )
    add = type(
        f"LANCER_OT_{name}_preset_add",
        (AddPresetBase, bpy.types.Operator),
        {
            "__doc__": f"Add or remove a preset of {label}",
            "bl_idname": operator,
            "bl_label": f"Add {label} Preset",
            "preset_menu": menu,
            "preset_subdir": folder,
            "preset_defines": ["lancer = bpy.context.scene.lancer"],
            "preset_values": [f"lancer.{setting}" for setting in settings],
        },
    )
    return panel, add


_SAMPLING_PANEL, _SAMPLING_ADD = _made("sampling", "Sampling", _SAMPLING)
_LIGHT_PATHS_PANEL, _LIGHT_PATHS_ADD = _made("light_paths", "Light Paths", _LIGHT_PATHS)
_CLASSES = (_SAMPLING_PANEL, _SAMPLING_ADD, _LIGHT_PATHS_PANEL, _LIGHT_PATHS_ADD)


def draw_sampling(panel, _context):
    """The draw_header_preset of the panel Sampling."""
    _SAMPLING_PANEL.draw_panel_header(panel.layout)


def draw_light_paths(panel, _context):
    """The draw_header_preset of the panel Light Paths."""
    _LIGHT_PATHS_PANEL.draw_panel_header(panel.layout)


def register():
    add_all(_CLASSES, bpy.utils.register_class, bpy.utils.unregister_class)


def unregister():
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
