"""Inside a Blender: install, enable, render, update the loaded add-on, render, disable and remove it, as a user does:
... install.py -- RESULT.json OLDER.zip NEWER.zip. Classic zips where there are no extensions."""

import json
import os
import sys

import bpy

RESULT, OLDER, NEWER = sys.argv[sys.argv.index("--") + 1 :]
EXTENSIONS = bpy.app.version >= (4, 2, 0)
MODULE = "bl_ext.user_default.lancer" if EXTENSIONS else "lancer"


def install(path):
    if EXTENSIONS:
        bpy.ops.extensions.package_install_files(filepath=path, repo="user_default", enable_on_install=True)
    else:
        bpy.ops.preferences.addon_install(filepath=path, overwrite=True)
        bpy.ops.preferences.addon_enable(module=MODULE)


def remove():
    if EXTENSIONS:
        names = [repo.module for repo in bpy.context.preferences.extensions.repos]
        bpy.ops.extensions.package_uninstall(repo_index=names.index("user_default"), pkg_id="lancer")
    else:
        # The operator needs an area of the preferences, which needs a window: do the same without it.
        import addon_utils

        path = os.path.dirname(sys.modules[MODULE].__file__)
        addon_utils.disable(MODULE, default_set=True)
        if hasattr(bpy.types, "PREFERENCES_OT_addon_remove"):
            import shutil

            shutil.rmtree(path)


def render():
    """Return the release and the library that a render uses now."""
    scene = bpy.context.scene
    scene.render.engine = "LANCER"
    scene.lancer.quality, scene.lancer.samples = "CUSTOM", 1
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.filepath = os.path.join(os.path.dirname(RESULT), "picture.png")
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(scene.render.filepath)
    brightest = max(value for i, value in enumerate(picture.pixels) if i % 4 < 3)
    bpy.data.images.remove(picture)
    os.remove(scene.render.filepath)
    library = sys.modules[MODULE + ".bindings.abi"].load_library()
    return {"release": sys.modules[MODULE].VERSION, "library": library.lancer_version().decode(), "brightest": brightest}


def there():
    return {
        "engine": "LANCER"
        in {getattr(cls, "bl_idname", "") for cls in bpy.types.RenderEngine.__subclasses__() if cls.is_registered},
        "settings": hasattr(bpy.types.Scene, "lancer"),
        "enabled": MODULE in bpy.context.preferences.addons,
    }


def main():
    result = {"blender": bpy.app.version_string, "before": there()}
    install(OLDER)
    result["folder"] = os.path.dirname(sys.modules[MODULE].__file__)
    result["older"] = {**there(), **render()}
    install(NEWER)
    result["newer"] = {**there(), **render()}
    bpy.ops.preferences.addon_disable(module=MODULE)
    result["disabled"] = there()
    remove()
    result["left"] = os.path.exists(result["folder"])
    with open(RESULT, "w", encoding="utf-8") as file:
        json.dump(result, file)


main()
