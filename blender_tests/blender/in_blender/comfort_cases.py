"""Presets, preferences, and links to pages of the manual."""

import os

import bpy
import stage


def _presets(folder):
    """Return the preset files of a folder, without __pycache__."""
    return [name for name in os.listdir(folder) if name.endswith(".py")]


def presets():
    """Save, change, apply and remove a preset of each kind. Return {kind: [saved, changed, applied, file, files left]}."""
    result = {}
    scene = stage.empty()
    changes = {
        "sampling": ({"quality": "GOOD", "time_limit": 7.0}, {"quality": "CUSTOM", "samples": 3, "time_limit": 0.0}),
        "light_paths": ({"max_bounces": 3, "clamp_indirect": 2.0}, {"max_bounces": 9, "clamp_indirect": 0.0}),
    }
    for kind, (wanted, other) in changes.items():
        add, menu = getattr(bpy.ops.render, f"lancer_{kind}_preset_add"), f"LANCER_PT_{kind}_presets"

        def now(kind=kind):
            names = (
                ("target_error", "samples", "quality", "time_limit")
                if kind == "sampling"
                else ("max_bounces", "clamp_indirect")
            )
            return [getattr(scene.lancer, name) for name in names]

        def put(values):
            for name, value in values.items():
                setattr(scene.lancer, name, value)
            return now()

        saved = put(wanted)
        add(name="Mine")
        (folder,) = [path for path in bpy.utils.preset_paths(f"lancer/{kind}") if os.path.exists(path)]
        path = os.path.join(folder, _presets(folder)[0])
        changed = put(other)
        bpy.ops.script.execute_preset(filepath=path, menu_idname=menu)
        result[kind] = [saved, changed, now(), os.path.basename(path)]
        # As the button for removal does: it removes the preset that was applied last.
        add(remove_active=True)
        result[kind].append(_presets(folder))
    return result


def manual():
    """Return {setting or operator: page that Blender would open}, and the pages in Blender's own map."""
    from bl_operators.wm import WM_OT_doc_view_manual

    import addon
    from addon.settings import properties

    def page(name):
        return WM_OT_doc_view_manual._lookup_rna_url(name.lower(), verbose=False)

    found = {}
    for group, _ in properties._GROUPS:
        for item in group.bl_rna.properties:
            if item.identifier not in ("name", "rna_type"):
                name = f"bpy.types.{group.__name__}.{item.identifier}"
                found[name] = page(name)
    for name in (
        "bpy.ops.lancer.check_scene",
        "bpy.ops.render.lancer_sampling_preset_add",
        "bpy.types.CyclesRenderSettings.samples",
    ):
        found[name] = page(name)
    own = [pages for prefix, pages in bpy.utils.manual_map() if len(pages) > 1000]
    known = {suffix.partition("#")[0] for _, suffix in own[0]}
    addon.unregister()
    gone = page("bpy.types.LancerSceneSettings.samples")
    addon.register()
    return {"found": found, "known": sorted(known), "gone": gone}


def without_preferences():
    """Imported by a script the package has no preferences: threads and quality have their defaults."""
    from export_cases import export_told

    from addon.settings import preferences

    scene = stage.room()
    scene.render.threads_mode = "AUTO"
    preferences._start_new_file()
    return {
        "threads": export_told()[0].settings.threads,
        "quality": scene.lancer.quality,
        "found": preferences._found() is not None,
    }
