"""Every setting that the export reads is shown in a panel, and no setting without effect is shown."""

import ast
import pathlib

import blenders
import pytest
from blenders import MODULE, PROGRAM
from conftest import ROOT

from addon.export.controls import CONTROLS, OWN

# Settings with an effect that are not shown in the Properties editor, and why.
ELSEWHERE = {
    "Camera.angle_x": "Camera.angle stands for it",
    "Camera.angle_y": "Camera.angle stands for it",
    "CyclesVisibilitySettings.scatter": "light of volumes, which are not supported",
    "CyclesVisibilitySettings.shadow": "worlds cast none, and Cycles does not show it either",
    "Object.dimensions": "the scale, in the sidebar of the view",
    "RenderSettings.frame_map_new": "stretches Blender's own time",
    "RenderSettings.frame_map_old": "stretches Blender's own time",
    "Object.visible_volume_scatter": "light of volumes, which are not supported",
    "RenderSettings.border_max_x": "drawn in the view, with Ctrl+B",
    "RenderSettings.border_max_y": "drawn in the view, with Ctrl+B",
    "RenderSettings.border_min_x": "drawn in the view, with Ctrl+B",
    "RenderSettings.border_min_y": "drawn in the view, with Ctrl+B",
}
# Names in the export's source that are also names of settings without effect on this test's scene.
OF_OTHERS = {
    "use_multiview": "of views with stereoscopy, where nothing is culled",
    "use_pole_merge": "of views with stereoscopy, which the engine places",
    "pole_merge_angle_to": "of views with stereoscopy, which the engine places",
    "pole_merge_angle_from": "of views with stereoscopy, which the engine places",
    "interocular_distance": "of views with stereoscopy, which the engine places",
    "convergence_mode": "of views with stereoscopy, which the engine places",
    "convergence_distance": "of views with stereoscopy, which the engine places",
    "ao_bounces": "of Fast GI in views",
    "action": "of animated objects; of the display of a camera's safe areas",
    "clip_max_y": "of curves of nodes",
    "clip_min_y": "of curves of nodes",
    "data": "the data-block itself",
    "denoising_pass_follow_reflections": "told as not supported, with passes for denoising",
    "denoising_pass_use_albedo_roughness_weighting": "told as not supported, with passes for denoising",
    "denoiser": "of the library that denoises",
    "exclude": "of collections, in the Outliner",
    "exposure": "of lamps; of the display in Blenders whose lamps have none",
    "extend": "a list's method; of curves' display",
    "feature_set": "without effect since 5.0",
    "fps": "of the Scene Time node",
    "fps_base": "of the Scene Time node",
    "frame_current": "chosen in the timeline",
    "frame_start": "of the images of nodes",
    "frame_subframe": "chosen in the timeline, for the ages of particles",
    "grease_pencil": "of passes that Blender draws",
    "height": "of regions and pictures; of mist, which EEVEE alone has",
    "hide_render": "of an instancer's children, of which nodes read attributes; in the Outliner",
    "holdout": "of materials; of collections, in the Outliner",
    "indirect_only": "of collections, in the Outliner",
    "instance_collection": "of instancers, of which nodes read attributes",
    "instance_type": "of instancers, of which nodes read attributes",
    "look": "of an object's table row; of the display",
    "pass_cryptomatte_depth": "the number of passes, which the engine registers",
    "preview_dicing_rate": "divides meshes in views",
    "matrix": "of cameras and lamps in a snapshot",
    "matrix_world": "the result of location, rotation and scale",
    "metallic": "a socket of a shader node",
    "shading_system": "of scripts, told as not supported",
    "show_instancer_for_render": "of instancers, whose own surface the depsgraph leaves out",
    "show_instancer_for_viewport": "of instancers, whose own surface the depsgraph leaves out",
    "shadow_terminator_offset": "told as not supported, in the Blenders that keep it in Cycles",
    "title": "a string's method; of the display's safe areas",
    "texture_limit": "of views",
    "texture_resolution": "of views, and without effect before 5.2",
    "use_adaptive_subdivision": "of the modifier since 5.0",
    "use_light_tree": "acts on flattened area lamps alone",
    "use_clip": "of curves of nodes",
    "use_custom_distance": "told as not supported before 4.2",
    "use_shadow": "acts before 4.2 where the Cycles add-on is off",
    "use_shadows": "of a sky that varies, told as not supported; of EEVEE",
}
# The export, without its list of all of Cycles' settings, and the other files that read settings of passes.
ADDON = pathlib.Path(ROOT, "addon")
EXPORT = sorted({*ADDON.glob("export/**/*.py")} - {ADDON / "export" / "cycles_properties.py"})
READERS = (*EXPORT, ADDON / "engine" / "passes.py", ADDON / "denoise" / "view_layer.py")


@pytest.fixture(scope="module", params=[MODULE, PROGRAM])
def found(request, tmp_path_factory):
    got = blenders.run(request.param, tmp_path_factory.mktemp("controls"), "control_cases", "controls")
    return {what: set(names) for what, names in got.items() if what not in ("version", "console")} | {"version": got["version"]}


def acts_in(entry, version):
    return list(entry.since) <= version < list(entry.before)


def listed(version):
    """Return the settings in the export's list for a version of Blender."""
    return {f"{entry.owner}.{name}" for entry in CONTROLS if acts_in(entry, version) for name in entry.names}


def test_the_export_reads_what_it_lists(found):
    others = {name for name in found["act"] if not name.startswith(OWN)}
    assert others - set(ELSEWHERE) == listed(found["version"])


def test_what_the_export_reads_is_shown(found):
    # The mark of the defaults that a file was saved with is no choice of the user.
    own = {name for name in found["known"] if name.startswith(OWN)} - {"LancerSceneSettings.defaults"}
    assert listed(found["version"]) | own | {"RenderSettings.use_persistent_data"} <= found["shown"]
    assert found["act"] - found["shown"] <= set(ELSEWHERE)


def test_what_is_not_supported_is_hidden(found):
    """Settings that change only messages have no effect and are hidden."""
    assert found["tell"] and not found["tell"] & found["shown"]


def test_nothing_is_shown_twice(found):
    """No setting is shown twice, except three in Blender's panel Viewport Display, which is shown for every engine."""
    also = {"Material.diffuse_color", "Material.pass_index", "World.color"}
    assert {name.rpartition(".")[0] for name in found["twice"]} & found["act"] <= also


def test_no_name_in_the_export_is_a_setting_that_nothing_is_known_of(found):
    """A setting may be read without effect on this test's scene: its name in the export's source must be known."""
    nodes = [node for path in READERS for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    names = {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    names |= {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    acting = {name.split(".")[1] for name in found["act"] | found["tell"]}
    in_others = {name for entry in CONTROLS if not acts_in(entry, found["version"]) for name in entry.names}
    unknown = {name for name in found["known"] if name.split(".")[1] in names - acting - in_others - set(OF_OTHERS)}
    assert not {name for name in unknown if not name.startswith(OWN)}
