"""The choice of the library's file, and the list of the process's libraries. Runs on every system."""

import os
import sys

from addon.bindings import abi
from addon.denoise import loaded_libraries

NAMES = {"win32": ("lancer.dll", "lancer-0a1b2c.dll"), "darwin": ("liblancer.dylib", "liblancer-0a1b2c.dylib")}


def test_the_process_names_it(library):
    path = abi.library_path()
    assert any(os.path.isfile(found) and os.path.samefile(found, path) for found in loaded_libraries.files())
    # Each file is listed once, and other libraries too.
    assert len(loaded_libraries.files()) == len(set(loaded_libraries.files())) > 3


def test_a_name_with_a_mark_is_found_and_the_newest_taken(tmp_path, monkeypatch):
    plain, marked = NAMES.get(sys.platform, ("liblancer.so", "liblancer-0a1b2c.so"))
    monkeypatch.setattr(abi, "__file__", str(tmp_path / "lancer" / "bindings" / "abi.py"))
    folder = tmp_path / "lancer" / "lib"
    assert abi.library_path() == str(folder / plain)
    folder.mkdir(parents=True)
    for age, name in enumerate(("liblancer.pdb", "other.so", marked, plain)):
        (folder / name).touch()
        os.utime(folder / name, (1e9 - age, 1e9 - age))
    assert abi.library_path() == str(folder / marked)
    os.utime(folder / plain, (2e9, 2e9))
    assert abi.library_path() == str(folder / plain)
