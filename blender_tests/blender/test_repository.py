"""The extension repository of `make addons` on a web server: installed, rendered, updated beside other extensions, removed; and
the extension in a system repository that users cannot write to. In this Python's bpy module or that of LANCER_TEST_PYTHON, and
in the Blender that LANCER_TEST_BLENDER names; Debian's 3.4 has no extensions."""

import json
import os
import shutil
import subprocess
import zipfile

import blenders
import pytest
from blenders import MODULE, PROGRAM
from conftest import HERE
from zips import OLDER, contents, dotted, newest_zip, older, package, python_wheel, release

BLENDERS = [MODULE, PROGRAM] if os.environ.get("LANCER_TEST_BLENDER") else [MODULE]
MANIFEST = """schema_version = "1.0.0"
id = "{id}"
version = "{version}"
name = "Other"
tagline = "Has no wheel"
maintainer = "Tests"
type = "add-on"
blender_version_min = "4.2.0"
license = ["SPDX:GPL-3.0-or-later"]
{more}
"""


def inside(which, folder, script, *arguments, **variables):
    """Run a script of in_blender/ with the path of its result first, and return the result."""
    path, result = os.path.join(HERE, "blender", "in_blender", script), folder / "result.json"
    start = [blenders.module_python(), path]
    if which == PROGRAM:
        start = [blenders.program(), "-b", "--factory-startup", "--python-exit-code", "3", "-P", path]
    places = {"BLENDER_USER_EXTENSIONS": str(folder / "extensions"), "BLENDER_USER_RESOURCES": str(folder / "resources")}
    done = subprocess.run(
        [*start, "--", result, *arguments],
        env=blenders.environment(folder, **places, **variables),
        capture_output=True,
        text=True,
        errors="replace",
        timeout=300,
    )
    assert done.returncode == 0 and result.exists(), (done.stdout + done.stderr)[-3000:]
    return json.loads(result.read_text())


def repository(folder, lancer, other):
    """Make a repository with a zip of Lancer, a newer one for another system, and that version of another extension."""
    folder.mkdir()
    shutil.copy(lancer, folder)
    put(folder / "other.zip", other, id="other", more="")
    put(folder / "foreign.zip", "9.9.9", id="lancer", more='platforms = ["windows-x64"]')
    package.index(folder)
    return folder


def put(path, version, **fields):
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("blender_manifest.toml", MANIFEST.format(version=version, **fields))
        archive.writestr("__init__.py", f'RELEASE = "{version}"\ndef register(): pass\ndef unregister(): pass\n')


@pytest.mark.parametrize("which", BLENDERS)
def test_install_update_remove_from_a_server(which, tmp_path):
    newer = newest_zip(which)
    old = older(newer, str(tmp_path))
    # Give the second release another length: Python takes a file of the same second and size for the one that it has compiled.
    plan = [(old, "1.0.0"), (old, "1.10.0"), (newer, "1.10.0")]
    got = inside(which, tmp_path, "repository.py", *(repository(tmp_path / str(i), *item) for i, item in enumerate(plan)))
    for told, (zip_, other) in zip(got["states"], plan, strict=True):
        text = dotted(OLDER if zip_ == old else release())
        assert told.pop("file").startswith(str(tmp_path / "extensions"))
        # A library of the other version would tell its own.
        assert told == {"release": text, "library": text, "lit": True, "other": other}
    assert not got["left"] and not got["enabled"]
    assert "/index.json" in got["asked"] and f"/{os.path.basename(newer)}" in got["asked"]


def state_of(folder):
    return {path: (path.stat().st_mtime_ns, path.stat().st_mode) for path in sorted(folder.rglob("*"))}


@pytest.mark.parametrize("which", BLENDERS)
def test_a_system_repository_is_only_read(which, tmp_path):
    extension = tmp_path / "shared" / "system" / "lancer"
    with zipfile.ZipFile(newest_zip(which)) as archive:
        archive.extractall(extension)
    for path in (*extension.rglob("*"), extension):
        # Root may write all the same: compare as well.
        path.chmod(path.stat().st_mode & ~0o222)
    before = state_of(extension)
    got = inside(which, tmp_path, "system_repository.py", BLENDER_SYSTEM_EXTENSIONS=str(tmp_path / "shared"))
    assert state_of(extension) == before and got.pop("folder") == str(extension)
    assert got.pop("file").startswith(str(tmp_path / "extensions"))
    assert got == {"release": dotted(release()), "library": dotted(release()), "lit": True}


WHEEL_TAGS = {
    "linux-x64": "manylinux_2_28_x86_64",
    "linux-arm64": "manylinux_2_28_aarch64",
    "windows-x64": "win_amd64",
    "macos-arm64": "macosx_11_0_arm64",
    "macos-x64": "macosx_11_0_x86_64",
}


def test_the_repository_has_one_extension_for_each_platform(tmp_path, monkeypatch):
    monkeypatch.setattr(contents, "BUILD", tmp_path)
    monkeypatch.setattr(contents, "notices", lambda tag, zig: {"GLM.txt": b"a notice"})
    monkeypatch.setenv("LANCER_ZIG", "zig")
    for tag in WHEEL_TAGS:
        library = tmp_path / "built" / tag / "lib" / contents.LIBRARIES[tag.split("-")[0]]
        library.parent.mkdir(parents=True)
        library.write_bytes(tag.encode())
    version, folder = dotted(release()), tmp_path / "addons"
    package.package_all(version, tmp_path / "built", WHEEL_TAGS)
    names = {tag: f"lancer-{version}-{tag}.zip" for tag in WHEEL_TAGS}
    wheels = {tag: f"lancer-{version}-py3-none-{wheel}.whl" for tag, wheel in WHEEL_TAGS.items()}
    index = json.loads((folder / "index.json").read_text())["data"]
    assert {item["archive_url"]: item["platforms"] for item in index} == {f"./{names[tag]}": [tag] for tag in names}
    assert {path.name for path in folder.iterdir()} == {*names.values(), "index.json", "index.html", "blender3", "wheels"}
    assert {path.name for path in (folder / "wheels").iterdir()} == set(wheels.values())
    for tag, name in names.items():
        with zipfile.ZipFile(folder / name) as archive, zipfile.ZipFile(folder / "wheels" / wheels[tag]) as wheel:
            inside = archive.namelist()
            assert archive.read(f"wheels/{wheels[tag]}") == (folder / "wheels" / wheels[tag]).read_bytes()
            library = archive.read(python_wheel.NAME_FILE).decode().strip()
            # Blender's own platform refuses libraries beside the wheel.
            assert not [path for path in inside if path.endswith((".so", ".dll", ".dylib"))]
            assert wheel.read(f"lancer/lib/{library}") == tag.encode()
        with zipfile.ZipFile(folder / "blender3" / name.replace(".zip", "-blender3.zip")) as archive:
            inside = archive.namelist()
            assert archive.read(f"lancer/lib/{library}") == tag.encode()
            assert not [path for path in inside if path.endswith((".whl", "blender_manifest.toml"))]
