"""Invalid snapshot files, and snapshots of invalid scenes: one clear error for each."""

import io
import json
import os
import subprocess
import sys

import numpy as np
import pytest
from conftest import HERE
from rich_snapshot import rich

from addon.bindings.npz import SnapshotError
from addon.bindings.session import LancerError, Session
from addon.bindings.snapshot import SceneSnapshot

SPOILED = 400


def spoiled_by_chance(tmp_path, first, count, *seconds, **environment):
    """Return {outcome: number of files}. Runs in a separate process, so that a crash fails with its seed."""
    log = str(tmp_path / "seeds.txt")
    script = os.path.join(HERE, "helpers", "broken_files.py")
    command = [sys.executable, script, log, str(tmp_path), str(first), str(count), *seconds]
    done = subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True)
    with open(log, encoding="utf-8") as file:
        said = file.read()
    assert done.returncode == 0, f"seed {said}: exit code {done.returncode}\n{done.stderr[-3000:]}"
    return json.loads(said)


def test_files_spoiled_by_chance(tmp_path):
    outcomes = spoiled_by_chance(tmp_path, 0, SPOILED)
    assert sum(outcomes.values()) == SPOILED
    # All outcomes must occur: else the corruption is too strong or too weak.
    assert all(outcomes.get(end, 0) >= 5 for end in ("refused file", "refused scene", "picture")), outcomes


@pytest.fixture
def parts(tmp_path):
    """Return the tree and the arrays of a valid file, and a function that writes them again."""
    path = str(tmp_path / "scene.npz")
    rich().save(path)
    with np.load(path) as archive:
        arrays = dict(archive)
    tree = json.loads(arrays["tree"].tobytes())

    def write():
        arrays["tree"] = np.frombuffer(json.dumps(tree).encode(), np.uint8)
        np.savez(path, **arrays)
        return path

    return tree, arrays, write


def put(tree, path, value):
    """Set a value in the tree. path: names of fields and indices of lists."""
    for key in path[:-1]:
        tree = tree["fields"][key] if isinstance(key, str) else tree[key]
    if isinstance(path[-1], str):
        tree["fields"][path[-1]] = value
    else:
        tree[path[-1]] = value


# Path of a field, its value in the file, text that the error must contain.
WRONG_FIELDS = [
    (("camera", "width"), "wide", "Camera.width"),
    (("camera", "width"), -1, "Camera.width"),
    (("camera", "region_height"), 2**32, "Camera.region_height"),
    (("camera", "clip_end"), None, "Camera.clip_end"),
    (("settings", "samples"), 0.5, "Settings.samples"),
    (("settings", "mist_falloff"), 10**400, "Settings.mist_falloff"),
    (("settings", "glass_roughness"), -(10**400), "Settings.glass_roughness"),
    (("settings", "passes"), [10**9], "Pass"),
    (("settings", "passes"), 3, "Settings.passes"),
    (("materials", 0, "name"), 5, "Material.name"),
    (("materials", 0, "lobes"), [1, 2], "Material.lobes"),
    (("materials", 0, "emission"), [1, 2], "Material.emission"),
    (("materials", 0, "emission"), "0.5", "Material.emission"),
    (("materials",), [None], "SceneSnapshot.materials"),
    (("lights", 0, "emission"), [1, 2], "emission"),
    (("lights", 0, "radius"), "large", "Light.radius"),
    (("lights", 0, "matrix"), [1, 2], "Light.matrix"),
    (("meshes", 0, "positions"), None, "MeshData.positions"),
    (("meshes", 0, "attributes"), [{"type": "Lobe", "fields": {}}], "MeshData.attributes"),
    (("instances", "names"), [1], "InstanceTable.names"),
    (("world", "nodes"), {"type": "World", "fields": {}}, "World.nodes"),
    (("camera", "colour"), 1, "colour"),
]


@pytest.mark.parametrize("path, value, word", WRONG_FIELDS)
def test_a_field_of_another_kind_is_refused(parts, path, value, word):
    tree, _, write = parts
    put(tree, path, value)
    with pytest.raises(SnapshotError, match="scene.npz holds no scene snapshot: ") as error:
        SceneSnapshot.load(write())
    assert word in str(error.value)


@pytest.mark.parametrize("change", ["unknown type", "missing array", "deep", "no tree", "text", "cut", "empty", "an array"])
def test_a_broken_file_is_refused(parts, change):
    tree, arrays, write = parts
    if change == "unknown type":
        tree["type"] = "os.system"
    elif change == "missing array":
        put(tree, ("meshes", 0, "positions"), {"array": "array_999"})
    path = write()
    if change == "deep":
        arrays["tree"] = np.frombuffer(b"[" * 100000, np.uint8)
        np.savez(path, **arrays)
    elif change == "no tree":
        np.savez(path, array_0=np.zeros(3))
    elif change == "an array":
        out = io.BytesIO()
        np.save(out, np.zeros(3))
    if change in ("text", "cut", "empty", "an array"):
        with open(path, "rb") as file:
            whole = file.read()
        contents = {"text": b"hello", "cut": whole[: len(whole) // 2], "empty": b""}
        with open(path, "wb") as file:
            file.write(contents[change] if change in contents else out.getvalue())
    with pytest.raises(SnapshotError, match="scene.npz holds no scene snapshot"):
        SceneSnapshot.load(path)


def test_a_file_that_is_not_there_is_an_error_of_the_system(tmp_path):
    with pytest.raises(FileNotFoundError):
        SceneSnapshot.load(str(tmp_path / "none.npz"))


def test_truth_in_place_of_a_number_is_one(parts):
    tree, _, write = parts
    for name in ("height", "region_height"):
        put(tree, ("camera", name), True)
    put(tree, ("camera", "y"), False)
    snapshot = SceneSnapshot.load(write())
    assert [type(getattr(snapshot.camera, name)) for name in ("height", "region_height", "y")] == [int] * 3
    with Session.upload(snapshot) as session:
        assert session.render_all(1) and session.read().shape == (1, snapshot.camera.region_width, 4)


def test_half_a_character_in_a_name_is_no_obstacle(parts):
    """Lone surrogates are valid in Python and JSON but not in UTF-8."""
    tree, _, write = parts
    put(tree, ("materials", 0, "name"), "half \ud800")
    put(tree, ("materials", 0, "ambient"), [-1, 0, 0])
    with Session.upload(SceneSnapshot.load(write())) as session:
        assert any("half ?" in line for line in session.messages())


def test_what_the_file_may_hold_and_the_library_not_is_its_error(parts):
    tree, _, write = parts
    put(tree, ("materials", 0, "emission"), {"type": "NodeRef", "fields": {"node": 7}})
    snapshot = SceneSnapshot.load(write())
    with pytest.raises(LancerError, match="node 7"):
        Session.upload(snapshot)
