"""Inside a Blender with extensions: a repository on a web server of this process is added; Lancer is installed from it, used,
updated and removed. ... repository.py -- RESULT.json STATE...: folders that the server serves one after the other, of which the
last has a newer Lancer and the second a newer version of another extension."""

import contextlib
import functools
import json
import os
import shutil
import sys
import threading
from http import server

import bpy

sys.path.append(os.path.dirname(os.path.abspath(__file__)))

from installed import render  # noqa: E402

RESULT, *STATES = sys.argv[sys.argv.index("--") + 1 :]
MODULE = "bl_ext.studio.lancer"
SERVED = os.path.join(os.path.dirname(RESULT), "served")


class Quiet(server.SimpleHTTPRequestHandler):
    asked = []

    def log_message(self, *_):
        self.asked.append(self.path.partition("?")[0])


def serve(state):
    shutil.rmtree(SERVED, ignore_errors=True)
    shutil.copytree(state, SERVED)


def repository(url):
    """Add the repository and return its index."""
    preferences = bpy.context.preferences
    preferences.system.use_online_access = True
    repos = preferences.extensions.repos
    repos.new(name="Studio", module="studio", remote_url=url)
    index = [repo.module for repo in repos].index("studio")
    repos[index].use_remote_url = True
    return index


@contextlib.contextmanager
def libraries_in_use():
    """No library can be removed, as on Windows a loaded one."""
    unlink = os.unlink

    def refuse(path, **how):
        if os.path.basename(os.fsdecode(path)).startswith("liblancer"):
            raise PermissionError(13, "in use", path)
        unlink(path, **how)

    os.unlink = refuse
    try:
        yield
    finally:
        os.unlink = unlink


def used():
    return render(MODULE, os.path.dirname(RESULT)) | {"other": sys.modules["bl_ext.studio.other"].RELEASE}


def main():
    serve(STATES[0])
    http = server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=SERVED))
    threading.Thread(target=http.serve_forever, daemon=True).start()
    index = repository(f"http://127.0.0.1:{http.server_port}/index.json")
    bpy.ops.extensions.repo_sync(repo_index=index)
    for name in ("lancer", "other"):
        bpy.ops.extensions.package_install(repo_index=index, pkg_id=name, enable_on_install=True)
    result = {"blender": bpy.app.version_string, "states": [used()]}
    for state in STATES[1:]:
        serve(state)
        bpy.ops.extensions.repo_sync(repo_index=index)
        with libraries_in_use():
            bpy.ops.extensions.package_upgrade_all()
        result["states"].append(used())
    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="lancer")
    # Blender 4.2.0 keeps the unpacked wheel of the last extension.
    kept = () if bpy.app.version < (4, 2, 1) else (result["states"][-1]["file"],)
    folders = [os.path.join(bpy.utils.user_resource("EXTENSIONS"), *part) for part in (("studio",), (".user", "studio"))]
    result["left"] = [path for path in (*(os.path.join(folder, "lancer") for folder in folders), *kept) if os.path.exists(path)]
    result["enabled"] = MODULE in bpy.context.preferences.addons
    result["asked"] = sorted(set(Quiet.asked))
    http.shutdown()
    with open(RESULT, "w", encoding="utf-8") as file:
        json.dump(result, file)


main()
