"""The choice of the library's file, and the list of the process's libraries. Runs on every system."""

import os
import sys

import pytest

from addon.bindings import abi, library_file
from addon.denoise import loaded_libraries

NAMES = {"win32": ("lancer.dll", "lancer-0a1b2c.dll"), "darwin": ("liblancer.dylib", "liblancer-0a1b2c.dylib")}


def test_the_process_names_it(library):
    path = abi.library_path()
    assert any(os.path.isfile(found) and os.path.samefile(found, path) for found in loaded_libraries.files())
    # Each file is listed once, and other libraries too.
    assert len(loaded_libraries.files()) == len(set(loaded_libraries.files())) > 3


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return the folder of an installed add-on's library, which is not there yet."""
    monkeypatch.setattr(library_file, "__file__", str(tmp_path / "lancer" / "bindings" / "library_file.py"))
    monkeypatch.setattr(library_file, "providers", [])
    return tmp_path / "lancer" / "lib"


def test_a_name_with_a_mark_is_found_and_the_newest_taken(folder):
    plain, marked = NAMES.get(sys.platform, ("liblancer.so", "liblancer-0a1b2c.so"))
    assert abi.library_path() == str(folder / plain)
    folder.mkdir(parents=True)
    for age, name in enumerate(("liblancer.pdb", "other.so", marked, plain)):
        (folder / name).touch()
        os.utime(folder / name, (1e9 - age, 1e9 - age))
    assert abi.library_path() == str(folder / marked)
    os.utime(folder / plain, (2e9, 2e9))
    assert abi.library_path() == str(folder / plain)


def test_a_packed_add_on_takes_the_library_of_its_own_build(folder, tmp_path, monkeypatch):
    folder.mkdir(parents=True)
    (folder / "library.txt").write_text("liblancer-new.so\n")
    # Newer files of other builds do not count: here, in a wheel before its own, and in the current folder.
    wheels = [tmp_path / place / "lancer" / "lib" for place in ("first", "second", "here")]
    for place in (folder, *wheels):
        place.mkdir(parents=True, exist_ok=True)
        (place / "liblancer-old.so").touch()
    (wheels[2] / "liblancer-new.so").touch()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setattr(sys, "path", ["", "lancer.zip", *(str(place.parent.parent) for place in wheels[:2])])
    assert abi.library_path() == str(folder / "liblancer-new.so")
    asked = []
    library_file.providers.append(lambda name: asked.append(name))
    library_file.providers.append(lambda name: f"/unpacked/{name}")
    assert abi.library_path() == "/unpacked/liblancer-new.so" and asked == ["liblancer-new.so"]
    # As soon as Blender has unpacked the wheel, its file is used.
    (wheels[1] / "liblancer-new.so").touch()
    assert abi.library_path() == str(wheels[1] / "liblancer-new.so") and len(asked) == 1
    # A classic add-on has it beside its name.
    (folder / "liblancer-new.so").touch()
    assert abi.library_path() == str(folder / "liblancer-new.so")


def test_the_name_of_the_library_leads_to_no_other_folder(folder, tmp_path):
    folder.mkdir(parents=True)
    (tmp_path / "liblancer-new.so").touch()
    (folder / "library.txt").write_text("../../liblancer-new.so\n")
    assert abi.library_path() == str(folder / "liblancer-new.so")
