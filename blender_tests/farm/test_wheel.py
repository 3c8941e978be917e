"""The wheel: by the rules of Python's packages, installed without a network into an empty environment, used without Blender."""

import glob
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from packaging.metadata import Metadata
from tiny_scenes import showroom, with_settings
from wheel.wheelfile import WheelFile
from zips import contents, dotted, python_wheel, release

from addon.bindings.enums import Pass
from addon.bindings.pass_names import NAMES
from addon.bindings.session import Session
from addon.farm.picture_file import LAYER

SCENE = showroom(16)


def build():
    library = contents.library_of(contents.ADDON / "lib", contents.this_platform())
    return python_wheel.bytes_of(contents.read_version(), contents.this_wheel_tag(), library, {"GLM.txt": b"a notice\n"})


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Return the path of the wheel: of `make addons` in LANCER_TEST_ZIPS, or built from the sources."""
    found = glob.glob(os.path.join(os.environ.get("LANCER_TEST_ZIPS") or "-", "wheels", "lancer-*_x86_64.whl"))
    found = [path for path in found if "manylinux" in path]
    if found:
        return found[0]
    name, data = build()
    path = tmp_path_factory.mktemp("wheel") / name
    path.write_bytes(data)
    return str(path)


@pytest.fixture(scope="module")
def place(wheel, tmp_path_factory):
    """Return a folder with the scene, and below it an environment with the wheel that sees this environment's packages."""
    folder = tmp_path_factory.mktemp("installed")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder / "venv"], check=True)
    packages = next((folder / "venv").glob("lib/python*/site-packages"))
    (packages / "others.pth").write_text(f"{os.path.dirname(os.path.dirname(np.__file__))}\n")
    pip(folder, "install", "--quiet", "--no-index", wheel)
    SCENE.save(folder / "scene.npz")
    return folder


def pip(folder, *arguments):
    command = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", folder / "venv" / "bin" / "python"]
    subprocess.run([*command, *arguments], check=True, capture_output=True, text=True)


def python(folder, code):
    """Run code in the environment, in a folder without the project, and return what it says as JSON."""
    command = [folder / "venv" / "bin" / "python", "-I", "-c", code]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True, cwd=folder).stdout)


def lancer(folder, *arguments):
    """Run the installed command; return (exit code, lines of stdout, lines of stderr)."""
    done = subprocess.run([folder / "venv" / "bin" / "lancer", *arguments], capture_output=True, text=True, cwd=folder)
    return done.returncode, done.stdout.splitlines(), done.stderr.splitlines()


def files(path):
    """Return {channel: pixels} of an EXR file, and its spec."""
    file = oiio.ImageInput.open(str(path))
    pixels = file.read_image("float")
    return {name: pixels[..., number] for number, name in enumerate(file.spec().channelnames)}, file.spec()


def test_it_keeps_the_rules_of_wheels(wheel, place):
    with WheelFile(wheel) as archive:
        # Reading compares each file with its hash in RECORD, which must name every file.
        content = {name: archive.read(name) for name in archive.namelist()}
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    told = Metadata.from_email(content[f"lancer-{dotted(release())}.dist-info/METADATA"], validate=True)
    assert (told.name, str(told.version)) == ("lancer", dotted(release()))
    assert set(told.provides_extra) == {"farm", "pictures"} and "3.10" in told.requires_python
    assert {f"lancer-{told.version}.dist-info/licenses/{name}" for name in told.license_files} <= set(content)
    named = content["lancer/lib/library.txt"].decode().strip()
    assert [name for name in content if name.endswith(".so")] == [f"lancer/lib/{named}"]
    assert not any("/engine/" in name or "/export/" in name or name.endswith(".md") for name in content)
    pip(place, "check")


def test_the_same_files_give_the_same_bytes(tmp_path, monkeypatch):
    first = build()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert build() == first


CODE = """
import json, sys, lancer
rendered = lancer.render("scene.npz")
with lancer.Session.upload(lancer.load("scene.npz")) as session:
    session.render_all()
    same = (rendered.picture[::-1] == session.read(lancer.Pass.COMBINED)).all()
print(json.dumps([lancer.VERSION, lancer.__file__, "bpy" in sys.modules, bool(same), rendered.statistics["samples"]]))
"""


def test_it_renders_without_blender(place):
    version, path, blender, same, samples = python(place, CODE)
    assert version == dotted(release()) and Path(path).is_relative_to(place)
    assert not blender and same and samples == SCENE.settings.samples


def test_the_command_writes_all_passes(place):
    code, said, errors = lancer(place, "render", "scene.npz", "--samples", "8", "--threads", "2")
    assert code == 0 and not errors and said[-1] == "scene.exr", errors
    got, spec = files(place / "scene.exr")
    with Session.upload(with_settings(SCENE, samples=8)) as session:
        session.render_all()
        expected = {}
        for which, (name, _, channels) in NAMES.items():
            image = session.read(which)[::-1]
            expected |= {f"{LAYER}.{name}.{letter}": image[..., number] for number, letter in enumerate(channels)}
        assert set(Pass) - set(NAMES) == {Pass.HALVES, Pass.ALBEDO_HALVES, Pass.NORMAL_HALVES}
    assert set(got) == set(expected)
    for name, image in expected.items():
        np.testing.assert_array_equal(got[name], image, name)
    assert spec["lancer.ViewLayer.samples"] == "8" and float(spec["lancer.ViewLayer.error"]) > 0.0


def test_the_command_writes_a_picture_for_screens(place):
    assert lancer(place, "render", "scene.npz", "-o", "scene.png")[0] == 0
    file = oiio.ImageInput.open(str(place / "scene.png"))
    assert file.spec().format == "uint8" and file.spec()["lancer.ViewLayer.samples"] == str(SCENE.settings.samples)
    with Session.upload(SCENE) as session:
        session.render_all()
        linear = np.clip(session.read()[::-1].astype(np.float64), 0.0, 1.0)
    # The sky is opaque. The inverse of the curve is another formula; rounding moves a value by half a step.
    shown = file.read_image("uint8")[..., :3]
    low, high = (decoded((shown + half) / 255.0) for half in (-0.502, 0.502))
    assert (linear[..., 3] == 1.0).all()
    assert (low <= linear[..., :3]).all() and (linear[..., :3] <= high).all()


def decoded(shown):
    """Return linear values of sRGB ones."""
    return np.where(shown <= 0.04045, shown / 12.92, ((np.maximum(shown, 0.0) + 0.055) / 1.055) ** 2.4)


@pytest.mark.parametrize(
    "arguments, code, sentence",
    [
        (["broken.zip"], 2, "lancer: broken.zip holds no scene snapshot: it is no .zip or .npz"),
        (["cut.npz"], 2, "lancer: cut.npz holds no scene snapshot: "),
        (["nothing.npz"], 2, "lancer: nothing.npz: there is no such file"),
        (["scene.npz", "-o", "picture.tga"], 2, "lancer: picture.tga: the name of a picture ends in .exr or .png"),
        (["scene.npz", "-o", "nowhere/picture.png"], 2, "there is no such folder"),
        (["wrong.npz"], 1, "lancer: mesh"),
    ],
)
def test_faults_are_one_sentence(place, arguments, code, sentence):
    (place / "broken.zip").write_bytes(b"no archive")
    (place / "cut.npz").write_bytes((place / "scene.npz").read_bytes()[:-3000])
    mesh = SCENE.meshes[0]
    # The index is valid for the record and not for the library.
    wrong = type(mesh)(name=mesh.name, positions=mesh.positions, triangles=mesh.triangles + 100)
    type(SCENE)(**{**vars(SCENE), "meshes": (wrong,)}).save(place / "wrong.npz")
    got = lancer(place, "render", *arguments)
    assert (got[0], got[1], len(got[2])) == (code, [], 1) and sentence in got[2][0]


def test_wrong_options_are_refused(place):
    for arguments in (["scene.npz", "--samples", "0"], ["scene.npz", "--samples", "many"], []):
        assert lancer(place, "render", *arguments)[0] == 2


def test_a_missing_library_for_pictures_is_told_before_the_render(place):
    code = """
import sys
sys.modules["OpenImageIO"] = None
import lancer.farm.render_snapshot
lancer.farm.render_snapshot.Session = None
from lancer.farm.__main__ import main
sys.exit(main(["render", "scene.npz"]))
"""
    done = subprocess.run([place / "venv/bin/python", "-I", "-c", code], capture_output=True, text=True, cwd=place)
    assert done.returncode == 1 and done.stderr.endswith("pip install OpenImageIO\n") and done.stderr.count("\n") == 1
