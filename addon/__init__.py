"""Lancer: a render engine for Blender. This file only registers and unregisters the rooms of the add-on."""

bl_info = {
    "name": "Lancer",
    "author": "The Lancer authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Render properties > Render Engine",
    "description": "Ray tracing with global illumination, and the classic recursive ray tracer",
    "category": "Render",
}
# Blender 4.2 and newer remove bl_info from an extension or replace it.
VERSION = ".".join(map(str, bl_info["version"]))

_registered = []


def register():
    """Register the engine, its settings and its panels; a second call has no effect. Raise RuntimeError without numpy."""
    if _registered:
        return
    import atexit

    import bpy

    try:
        import numpy  # noqa: F401
    except ImportError:
        raise RuntimeError(
            "Lancer needs numpy in Blender's Python: install the package python3-numpy (Debian, Ubuntu) or numpy (pip)"
        ) from None
    from . import ui
    from .engine import kept_pictures, preview, render_engine, render_job, results
    from .host import main_thread, own_library
    from .host.registering import add_all
    from .operators import (
        bug_report,
        check_scene,
        course_groups,
        delete_resume_files,
        measure_features,
        measure_quality,
        measuring,
        take_over_cycles,
    )
    from .settings import manual, preferences, presets, properties
    from .viewport import viewport

    modules = (own_library, properties, preferences, main_thread, results, kept_pictures, render_engine, measuring)
    modules += (measure_features, measure_quality, check_scene, course_groups, take_over_cycles, presets)
    modules += (delete_resume_files,)
    # render_job unregisters first: it ends a running render while the rest of the add-on is still registered.
    modules += (ui, bug_report, manual, viewport, preview, render_job)
    add_all(modules, lambda module: module.register(), lambda module: module.unregister())
    _registered.extend(modules)
    # Blender as a Python module hangs (4.5) or crashes (4.2) at exit while an engine class is registered. The program itself
    # disables add-ons at exit, before atexit functions run.
    if not bpy.app.binary_path:
        atexit.register(unregister)


def unregister():
    """Undo register(); without a preceding register() it has no effect."""
    import atexit

    atexit.unregister(unregister)
    while _registered:
        _registered.pop().unregister()
