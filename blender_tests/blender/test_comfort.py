"""Presets, preferences and pages of the manual, in the bpy module of this Python and in Debian's Blender 3.4.1."""

import json
import os
import shutil
import subprocess
import sys

import blenders
import pytest
from blenders import MODULE, PROGRAM
from conftest import ROOT

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "comfort_cases", name)


def test_presets_are_saved_applied_and_removed(case):
    got = case("presets")
    for kind in ("sampling", "light_paths"):
        saved, changed, applied, name, left = got[kind]
        assert applied == saved != changed and name == "Mine.py" and left == [], (kind, got[kind])
    assert got["sampling"][0][1:] == [8192, "GOOD", 7.0]


def test_every_setting_has_a_page_of_the_manual(case):
    got = case("manual")
    found = got["found"]
    assert len(found) > 40
    for name, url in found.items():
        assert url is not None, name
        prefix, _, page = url.partition("/render/")
        assert prefix.startswith("https://docs.blender.org/manual/"), url
        # The page exists in Blender's own map of this version.
        assert f"render/{page}".partition("#")[0] in got["known"], (name, url)
    pages = {name.rpartition(".")[2]: url.rpartition("/")[2] for name, url in found.items()}
    assert (
        pages["max_bounces"] == "light_paths.html"
        and pages["target_error"] == pages["samples"].partition("#")[0] == "sampling.html"
    )
    assert pages["film_transparent_glass"] == "film.html" and pages["use_pass_error"] == "passes.html"
    assert got["gone"] is None


def test_a_script_needs_no_preferences(case):
    got = case("without_preferences")
    assert (got["threads"], got["quality"], got["found"]) == (0, "CUSTOM", False)


@pytest.fixture
def installed(which, tmp_path):
    """Return a function that runs Python code in a Blender with the add-on installed and returns its results."""
    place = tmp_path / "scripts" / "addons" / "lancer"
    shutil.copytree(os.path.join(ROOT, "addon"), place, ignore=shutil.ignore_patterns("__pycache__"))

    def run(text):
        script, result = tmp_path / "script.py", tmp_path / "told.json"
        script.write_text(f"import bpy, json\nresult = []\n{text}\nopen({str(result)!r}, 'w').write(json.dumps(result))\n")
        command = [sys.executable, script] if which == MODULE else [
            blenders.program(), "-b", "--python-exit-code", "3", "-P", script
        ]  # fmt: skip
        done = subprocess.run(
            command,
            env=blenders.environment(tmp_path),
            cwd=tmp_path,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=120,
        )
        assert done.returncode == 0 and result.exists(), done.stdout + done.stderr
        return json.loads(result.read_text())

    return run


def test_preferences_are_obeyed_and_change_no_file(installed, tmp_path):
    """New files start with the preferred quality; saved files keep theirs, and a fixed number of threads has priority."""
    got = installed(f"""
path = {str(tmp_path / "saved.blend")!r}
bpy.ops.preferences.addon_enable(module="lancer")
import lancer
from lancer.export.scene import export_scene
scene = bpy.context.scene

def threads(mode):
    render = bpy.context.scene.render
    render.threads_mode = mode
    if mode == "FIXED":
        render.threads = 5
    return export_scene(bpy.context.evaluated_depsgraph_get())[0].settings.threads

def own():
    settings = bpy.context.scene.lancer
    return [settings.quality, settings.samples]

result.append(own())
bpy.ops.wm.save_as_mainfile(filepath=path)
preferences = bpy.context.preferences.addons["lancer"].preferences
preferences.threads, preferences.quality = 3, "FINAL"
result.append([threads("AUTO"), threads("FIXED")])
bpy.ops.wm.read_homefile()
result.append(own())
bpy.ops.wm.open_mainfile(filepath=path)
result.append(own())
""")
    assert got == [["GOOD", 8192], [3, 5], ["FINAL", 65536], ["GOOD", 8192]]


def test_preferences_outlast_the_session(installed, which):
    """The program starts with saved preferences and add-ons; the module starts with factory settings."""
    session = """
own = bpy.context.scene.lancer if hasattr(bpy.types.Scene, "lancer") else None
if own is None:
    bpy.ops.preferences.addon_enable(module="lancer")
preferences = bpy.context.preferences.addons["lancer"].preferences
result += [own is not None and own.quality, preferences.threads]
preferences.threads, preferences.quality = 3, "FINAL"
bpy.ops.wm.save_userpref()
"""
    assert installed(session) == [False, 0]
    assert installed(session) == (["FINAL", 3] if which == PROGRAM else [False, 0])
