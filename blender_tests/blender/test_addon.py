"""The add-on in Blender: registration leaves no trace, panels draw, settings have an effect, errors have messages."""

import json
import os
import shutil
import subprocess
import sys

import blenders
import pytest
from blenders import MODULE, PROGRAM
from conftest import HERE, ROOT

from addon.bindings.abi import Status

both = pytest.mark.parametrize("which", [MODULE, PROGRAM])

NEVER_UNREGISTERED = """
import sys
sys.path[:0] = [{root!r}, {here!r}]
import addon
addon.register()
import stage
stage.write_exr(stage.room(), {picture!r})
"""


@pytest.fixture
def case(which, tmp_path):
    return lambda name, *arguments, where="addon_cases": blenders.run(which, tmp_path, where, name, *arguments)


@both
def test_blender_ends_with_the_engine_registered(which, tmp_path):
    """Blender as a module can hang or crash at exit while an engine is registered; a timeout of minutes detects a hang."""
    picture = str(tmp_path / "picture.exr")
    script = NEVER_UNREGISTERED.format(root=ROOT, here=os.path.join(HERE, "blender", "in_blender"), picture=picture)
    if which == MODULE:
        command = [sys.executable, "-c", script]
    else:
        command = [blenders.program(), "-b", "--factory-startup", "--python-exit-code", "3", "--python-expr", script]
    done = subprocess.run(
        command, env=blenders.environment(tmp_path), capture_output=True, text=True, errors="replace", timeout=120
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert os.path.getsize(picture) > 500


@both
def test_unregister_leaves_nothing(case):
    got = case("registration")
    assert got["first"]["properties"] == ["Scene", "Object", "Material", "Light"]
    assert "LancerRenderEngine" in got["first"]["engines"] and "LANCER_RENDER_PT_sampling" in got["first"]["panels"]
    # Blender's own panels, such as the output's format, belong to the engine too.
    assert "RENDER_PT_output" in got["first"]["panels"] and "DATA_PT_light" not in got["first"]["panels"]
    without = got["without"]
    assert (without["properties"], without["panels"], without["types"]) == ([], [], [])
    assert "LancerRenderEngine" not in without["engines"]
    assert got["again"] == got["first"] and got["mean"] > 0.05


@both
def test_without_numpy(case):
    """The error names the package to install, and nothing stays registered."""
    got = case("without_numpy")
    assert "numpy" in got["error"] and "install" in got["error"] and "\n" not in got["error"]
    assert (got["without"]["properties"], got["without"]["panels"], got["without"]["types"]) == ([], [], [])
    assert "Scene" in got["with"]["properties"]


@both
@pytest.mark.parametrize("kind, word", [("absent", "missing"), ("truncated", "cut short"), ("text", "not a shared library")])
def test_broken_library(which, kind, word, tmp_path):
    """F12 reports the fault and the remedy. In background mode the program may also end with exit code 1."""
    copy = tmp_path / "broken" / "addon"
    shutil.copytree(os.path.join(ROOT, "addon"), copy, ignore=shutil.ignore_patterns("__pycache__"))
    library = copy / "lib" / "liblancer.so"
    if kind == "absent":
        library.unlink()
    else:
        whole = library.read_bytes()
        library.write_bytes(whole[: len(whole) // 2] if kind == "truncated" else b"This is no library at all." * 1000)
    code, said, value = blenders.attempt(which, tmp_path, "addon_cases", "other_library", copy.parent, alone=True)
    assert code in ((0,) if which == MODULE else (0, 1)), said[-2000:]
    told = value["error"] if value else said
    assert word in told and "install the add-on" in told and str(library) in told, said[-2000:]
    assert "Traceback" not in said


@both
def test_panels(case):
    got = case("panels", where="panel_cases")
    assert got["errors"] == [] and got["foreign"] == []
    shown = got["shown"]
    assert "LANCER_RENDER_PT_sampling" in shown and all(shown.values())
    # Only panels of an object, material, light or world hide, if there is none.
    about = {name for name in shown if name.split("_PT_")[0].endswith(("OBJECT", "MATERIAL", "DATA", "WORLD"))}
    assert set(got["hidden"]) == about
    uses = shown["LANCER_RENDER_PT_uses"]
    assert "lancer.measure_features" in uses["plain"] and "2 objects are meshes" in uses["rendered"]
    assert [text for text in uses["rendered"] if text.startswith(("Geometry", "Acceleration", "Textures", "Film"))]
    assert "3 materials use refraction" in uses["measured"] and "Not measured for lack of time: 1 more" in uses["measured"]
    assert "without it this frame would take 22 % less time for the same samples" in uses["measured"]
    assert uses["measured"].count("3 materials use refraction") == 1
    assert "No feature would save 3 % of the time with certainty" in uses["measured, nothing found"]
    assert any("50 %" in text for text in uses["measuring"]) and "lancer.measure_features" not in uses["measuring"]
    costs = shown["LANCER_MATERIAL_PT_costs"]
    assert costs["plain"] == ["No node computes a value"]
    sampling = shown["LANCER_RENDER_PT_sampling"]
    assert "lancer.measure_quality" in sampling["plain"] and "lancer.measure_quality" in sampling["measuring"]
    assert sampling["measuring quality"][-2:] == ["Measuring, 25 % (Esc stops)", "Equal samples for all pixels"]
    assert "lancer.measure_quality" not in sampling["measuring quality"]
    words = (": about ", ": at most ", ": the time is unknown")
    told = [text.split(":")[0] for text in sampling["quality"] if any(word in text for word in words)]
    assert told == ["Draft", "Good", "Final", "As set", "Classic, 1 sample"]
    old = "Measured before the last changes"
    assert old not in sampling["quality"] and old in sampling["quality of other settings"]
    # The main settings are shown.
    assert {"integrator", "quality", "target_error", "samples", "time_limit"} <= set(sampling["plain"])
    for panel in ("LANCER_RENDER_PT_messages", "LANCER_RENDER_PT_viewport_messages"):
        assert shown[panel]["plain"] != shown[panel]["rendered"]
    assert "nodes" in shown["LANCER_MATERIAL_PT_surface"]["plain"] and "nodes" in shown["LANCER_WORLD_PT_surface"]["plain"]
    assert "kd" in shown["LANCER_MATERIAL_PT_surface"]["PHONG"] and "ior" in shown["LANCER_MATERIAL_PT_surface"]["KD_KS"]
    lamp = shown["LANCER_DATA_PT_light"]
    assert "angle" in lamp["SUN"] and "spot_blend" in shown["LANCER_DATA_PT_beam_shape"]["SPOT"]
    assert "shadow_soft_size" in lamp["POINT"] and "nodes" in shown["LANCER_DATA_PT_light_nodes"]["SUN"]
    assert "size_y" in lamp["RECTANGLE"] and "size_y" not in lamp["DISK"]


# Some panels of each tab in their order, Blender's own panels, and words of panels without effect.
EXPECTED = {
    "render": [
        "sampling",
        "sampling_viewport",
        "denoising",
        "light_paths",
        "simplify",
        "motion_blur",
        "film",
        "performance",
        "messages",
        "uses",
        "check",
    ],
    "view_layer": ["passes", "filter", "override"],
    "world": ["preview", "surface", "mist", "ambient_occlusion", "ray_visibility", "settings"],
    "object of a mesh": ["shading", "shadow_terminator"],
    "material of a mesh": ["surface", "rendered", "displacement", "settings"],
    "data of a light": ["light", "light_settings", "light_nodes", "classic_light"],
}
BLENDERS_OWN = {
    "material of a mesh": {"EEVEE_MATERIAL_PT_context_material", "MATERIAL_PT_preview"},
    "data of a light": {"DATA_PT_preview"},
    "data of a camera": {"DATA_PT_lens", "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture", "DATA_PT_camera"},
    "object of a mesh": {"OBJECT_PT_visibility", "OBJECT_PT_relations"},
    "object of a light": {"OBJECT_PT_visibility"},
    "output": {"RENDER_PT_format", "RENDER_PT_output", "RENDER_PT_post_processing"},
}
WITHOUT_EFFECT = ("freestyle", "eevee", "volume", "hair")


@both
def test_tabs(case):
    """Panels appear in Cycles' order, without panels that have no effect."""
    got = case("tabs", where="panel_cases")
    got.pop("console")
    assert not [name for name in got.pop("other engine") if name.startswith("LANCER_")]
    for tab, names in EXPECTED.items():
        own = [name.split("_PT_")[1] for name in got[tab] if name.startswith("LANCER_")]
        assert [name for name in own if name in names] == names, tab
    for tab, names in BLENDERS_OWN.items():
        assert names <= set(got[tab]), tab
    assert "LANCER_OBJECT_PT_ray_visibility" in got["object of a mesh"] and got["object of a light"]
    everything = {name for names in got.values() for name in names}
    assert not [name for name in everything for word in WITHOUT_EFFECT if word in name.split("_PT_")[1]]


@both
def test_a_material_is_read_once_for_many_drawings(case):
    """The panel lists what a material's nodes lose, reads them again after a change, and leaves no handler if not drawn."""
    got = case("cached", where="panel_cases")
    assert got["first"] == got["again"] == ["Diffuse Kd: 0.8 0.2 0.1"]
    (loss,) = [line for line in got["lossy"] if line not in got["first"] and "(Attribute)" in line]
    assert loss.startswith("Node 'Diffuse BSDF'") and "not supported" in loss
    assert got["reads"] == [1, 2] and got["left"]


@both
def test_time_limit(case):
    """The time limit ends a render of a million samples, with a valid picture."""
    got = case("time_limit")
    assert 0 < got["samples"] < 10**6 and got["mean"] > 0.05


@both
def test_animated_seed(case):
    got = case("animated_seed")
    assert (got["False"], got["True"]) == (True, False)


@both
def test_quality(case):
    got = case("quality")
    got.pop("console")
    assert got == {
        "DRAFT": [0.1, 1024, "DRAFT"],
        "GOOD": [0.03, 8192, "GOOD"],
        "FINAL": [0.01, 65536, "FINAL"],
        "own number": [77, "CUSTOM"],
        "own error": [1024, "CUSTOM"],
    }


@both
def test_threads(case):
    got = case("threads")
    assert got == [[1, 1], [2, 2], [3, 3]]


@both
def test_clamp_indirect(case):
    limit = 1e-3
    got = case("clamp", limit)
    assert got["indirect"] > 10 * limit and got["direct stays"]
    # A sample's indirect light is at most the limit; sums of 16 float samples round to 16 * 2^-24 of the brightest pixel.
    rounding = 16 * 2.0**-24 * got["brightest"]
    assert -rounding <= got["least added"] and 0.0 < got["most added"] <= limit + rounding


# One arena and no caches in glibc's allocator (the module) and jemalloc (Debian's Blender), so that growth is a leak.
FRUGAL = {"MALLOC_ARENA_MAX": "1", "MALLOC_CONF": "narenas:1,tcache:false,dirty_decay_ms:0,muzzy_decay_ms:0"}


@both
def test_many_renders_keep_no_memory(which, tmp_path):
    """A leak of scenes would keep at least 10 times the memory; the limit, half of one scene, allows for the allocator.

    Its arenas give free memory back late, some renders after: the least of five renders counts.
    """
    got = blenders.run(which, tmp_path, "addon_cases", "many_renders", **FRUGAL)
    resident = got["resident"]
    assert got["triangles"] > 60_000 and len(resident) == 20
    assert min(resident[15:]) - min(resident[:5]) <= got["held"] / 2, (got["held"], resident)


# Renders a grid of n x n vertices and limits the memory at one step of the render.
OUT_OF_MEMORY = """
import dataclasses, json, os, resource, sys
sys.path[:0] = [{root!r} + "/addon", {here!r}]
import numpy as np
import tiny_scenes
from addon.bindings.abi import LancerError
from addon.bindings.session import Scene, Session
from addon.bindings.snapshot import Instance, MeshData

step, n, extra = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
x, y = np.meshgrid(np.linspace(0, 1, n, dtype=np.float32), np.linspace(0, 1, n, dtype=np.float32))
corners = np.arange(n * n, dtype=np.uint32).reshape(n, n)
a, b, c, d = (corners[i : n - 1 + i, k : n - 1 + k].ravel() for i, k in ((0, 0), (0, 1), (1, 1), (1, 0)))
triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
mesh = MeshData("Heavy", np.stack([x.ravel(), y.ravel(), x.ravel() * y.ravel()], 1), triangles)
snapshot = tiny_scenes.scene([Instance()], [tiny_scenes.lambert()], meshes=[mesh], world=1.0)
hard = resource.getrlimit(resource.RLIMIT_AS)[1]

def limit():
    with open("/proc/self/statm") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + (extra << 20), hard))

scene = Scene()
result = {{"error": "", "status": None}}
try:
    if step == "fill":
        limit()
    scene.fill(snapshot)
    if step == "commit":
        limit()
    scene.commit(threads=2)
    if step == "late":
        # On one processor a thread begins when another has taken all memory, and has to fail without any.
        os.sched_setaffinity(0, {{min(os.sched_getaffinity(0))}})
    if step in ("film", "late"):
        limit()
    size = dict(width=20000, height=20000, region_width=20000, region_height=20000)
    with Session(scene, dataclasses.replace(snapshot.camera, **size), snapshot.settings) as session:
        session.render_all(1)
except LancerError as error:
    result["error"], result["status"] = str(error), int(error.status)
resource.setrlimit(resource.RLIMIT_AS, (hard, hard))
scene.close()
result["after"] = tiny_scenes.radiance(snapshot).tolist()
print(json.dumps(result))
"""


@pytest.mark.parametrize(
    "step, n, extra",
    # Megabytes left: fewer than needed by the mesh (144), the build of half a million triangles,
    # the stack of the building thread, or the film (6400).
    [("fill", 2000, 64), ("commit", 500, 24), ("commit", 500, 8), ("film", 10, 256)]
    + [("late", 10, left) for left in range(24, 43, 3)],
)
def test_out_of_memory(step, n, extra):
    """Lack of memory is an error with a message; afterwards the process renders the same scene with enough memory."""
    script = OUT_OF_MEMORY.format(root=ROOT, here=os.path.join(HERE, "helpers"))
    command = [sys.executable, "-c", script, step, str(n), str(extra)]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=300)
    assert done.returncode == 0, (done.returncode, done.stderr[-2000:])
    got = json.loads(done.stdout)
    assert "memory" in got["error"] and got["status"] == Status.ERROR_MEMORY, got
    assert min(got["after"]) > 0.0
