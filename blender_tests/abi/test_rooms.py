"""The add-on's rooms: imports go only to lower ranks, and some rooms run without Blender."""

import ast
from pathlib import Path

import pytest
from conftest import ROOT

ADDON = Path(ROOT, "addon")
# A file imports only from its own room and from rooms of lower ranks. The top level has only __init__.py.
RANKS = (
    "bindings messages",
    "host",
    "measure denoise checks export",
    "farm",
    "viewport settings bake",
    "engine",
    "operators",
    "ui",
    "__init__",
)
RANK = {name: rank for rank, names in enumerate(RANKS) for name in names.split()}
WITHOUT_BLENDER = ("bindings", "messages", "checks", "measure", "farm")


def place_of(path):
    return path.relative_to(ADDON).parts[0].removesuffix(".py")


def imported(path):
    """Yield the names that a file imports: rooms of the add-on, and other modules with a dot before the name."""
    depth = len(path.relative_to(ADDON).parts)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ("." + alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield "." + node.module.split(".")[0]
        elif isinstance(node, ast.ImportFrom) and node.level == depth:
            # In `from .. import x`, x is a room or a name defined in __init__.
            names = [node.module.split(".")[0]] if node.module else [alias.name for alias in node.names]
            yield from (name if name in RANK else "__init__" for name in names)


FILES = sorted(path for path in ADDON.rglob("*.py"))
PLACES = sorted({place_of(path) for path in FILES})


def test_every_place_has_a_rank():
    assert PLACES == sorted(RANK)


@pytest.mark.parametrize("place", PLACES)
def test_imports_go_down(place):
    for path in (path for path in FILES if place_of(path) == place):
        wanted = {name for name in imported(path) if not name.startswith(".")} - {place}
        if path.name == "bug_report.py":
            # The version is defined in __init__.py only.
            wanted.discard("__init__")
        higher = {name for name in wanted if RANK[name] > RANK[place]}
        assert not higher, f"{path.relative_to(ADDON)} imports {sorted(higher)} from above"
        beside = {name for name in wanted if RANK[name] == RANK[place]}
        assert not beside, f"{path.relative_to(ADDON)} imports {sorted(beside)} from beside"


@pytest.mark.parametrize("place", WITHOUT_BLENDER)
def test_rooms_without_blender(place):
    for path in (ADDON / place).rglob("*.py"):
        names = set(imported(path))
        assert not names & {".bpy", ".bpy_extras", ".mathutils", ".gpu", ".blf"}, path
        # Indirect imports must not reach Blender either.
        assert {name for name in names if not name.startswith(".")} <= {*WITHOUT_BLENDER}, path
