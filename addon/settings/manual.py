"""Pages of Blender's manual for F1 over Lancer's settings: those of Cycles' corresponding settings."""

import bpy

_SETTINGS = "render/cycles/render_settings"
# Blender takes the first pattern that matches the name in lower case.
_PAGES = (
    *((f"bpy.types.lancerscenesettings.{name}", f"{_SETTINGS}/{page}.html")
      for page, names in {
          "light_paths": ("*bounces", "clamp_*", "contribution_threshold", "environment_reflections"),
          "film": ("film_*", "pixel_filter", "filter_width"),
          "performance": ("accelerator", "features"),
          "sampling": ("samples", "target_error", "time_limit", "quality", "*seed", "use_denoising"),
      }.items()
      for name in names),
    ("bpy.types.lancerscenesettings.use_pass_*", "render/layers/passes.html"),
    ("bpy.types.lancerscenesettings*", "render/cycles/index.html"),
    ("bpy.types.lancerobjectsettings*", "render/cycles/object_settings/object_data.html"),
    ("bpy.types.lancermaterialsettings*", "render/cycles/material_settings.html"),
    ("bpy.types.lancerlightsettings*", "render/cycles/light_settings.html"),
    ("bpy.types.lancerworldsettings*", "render/cycles/world_settings.html"),
    ("bpy.ops.render.lancer_*", "render/cycles/index.html"),
    ("bpy.ops.lancer.*", "render/cycles/index.html"),
)  # fmt: skip


def pages():
    """Return (prefix, ((pattern, page), ...)) for bpy.utils.register_manual_map."""
    return "https://docs.blender.org/manual/en/{}.{}/".format(*bpy.app.version[:2]), _PAGES


def register():
    bpy.utils.register_manual_map(pages)


def unregister():
    bpy.utils.unregister_manual_map(pages)
