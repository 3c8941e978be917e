"""The core's rooms: a file includes only files of its own room and of rooms before it in this order."""

import re
from pathlib import Path

import pytest
from conftest import ROOT

CORE = Path(ROOT, "core", "src")
ROOMS = "simd sampling scene bsdf nodes lights accel compile integrator render".split()
# Order within integrator/: shared folders first; the integrators do not include each other.
INTEGRATOR = (("",), ("stages",), ("aov",), ("path", "classic"))
FILES = sorted(path.relative_to(CORE) for end in ("*.h", "*.cpp") for path in CORE.rglob(end))


def includes(file):
    """Yield (line, path) of the project's files that a file includes."""
    for number, line in enumerate((CORE / file).read_text(encoding="utf-8").splitlines(), 1):
        found = re.match(r'\s*#\s*include\s*"([^"]+)"', line)
        if found and found.group(1) not in ("lancer.h", "lancer_probes.h"):
            yield number, Path(found.group(1))


def room_of(file):
    """Return a file's room; None for files outside the rooms, which are the C interface and may include all rooms."""
    return file.parts[0] if len(file.parts) > 1 else None


def test_every_folder_is_a_room():
    assert {room_of(file) for file in FILES} == {None, *ROOMS}


def test_every_include_is_a_file():
    lost = [f"{file}:{number}: {to}" for file in FILES for number, to in includes(file) if not (CORE / to).is_file()]
    assert not lost, "\n".join(lost)


@pytest.mark.parametrize("room", ROOMS)
def test_includes_go_up(room):
    allowed = set(ROOMS[: ROOMS.index(room) + 1])
    wrong = [
        f"core/src/{file}:{number} includes {to}"
        for file in FILES
        if room_of(file) == room
        for number, to in includes(file)
        if room_of(to) not in allowed
    ]
    assert not wrong, "\n".join(wrong)


def test_rooms_below_render_do_not_know_the_interface():
    """The readers of the user's records alone include the C header; the rooms after them have types of their own."""
    for file in FILES:
        if room_of(file) in ROOMS[:-1] and not (room_of(file) == "scene" and file.name.startswith("fill")):
            text = (CORE / file).read_text(encoding="utf-8")
            assert '"lancer.h"' not in text and '"lancer_probes.h"' not in text, file


def test_integrators_do_not_know_each_other():
    rank = {folder: number for number, folders in enumerate(INTEGRATOR) for folder in folders}

    def folder(path):
        return path.parts[1] if len(path.parts) > 2 else ""

    wrong = []
    for file in (file for file in FILES if room_of(file) == "integrator" and folder(file)):
        for number, to in includes(file):
            if room_of(to) == "integrator" and folder(to) != folder(file) and rank[folder(to)] >= rank[folder(file)]:
                wrong.append(f"core/src/{file}:{number} includes {to}")
    assert not wrong, "\n".join(wrong)
