"""Inside a Blender: install, enable, render, update the loaded add-on, render, disable and remove it, as a user does:
... install.py -- RESULT.json OLDER.zip NEWER.zip. Classic zips where there are no extensions."""

import json
import os
import sys

import bpy

sys.path.append(os.path.dirname(os.path.abspath(__file__)))

from installed import render  # noqa: E402

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
    result["older"] = {**there(), **render(MODULE, os.path.dirname(RESULT))}
    install(NEWER)
    result["newer"] = {**there(), **render(MODULE, os.path.dirname(RESULT))}
    bpy.ops.preferences.addon_disable(module=MODULE)
    result["disabled"] = there()
    remove()
    # Blender 4.2.0 keeps the unpacked wheel of the last extension.
    paths = (result["folder"], result["newer"]["file"] if bpy.app.version >= (4, 2, 1) else "")
    result["left"] = [path for path in paths if os.path.exists(path)]
    with open(RESULT, "w", encoding="utf-8") as file:
        json.dump(result, file)


main()
