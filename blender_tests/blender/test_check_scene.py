"""F12 and Check Scene report faults, in the bpy module of this Python and in Debian's Blender 3.4.1."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

EXPECTED = {
    "open glass": ("glass", "WRONG", "Thing", "open at 4 edges"),
    "glass inside out": ("glass", "WRONG", "Thing", "inside out"),
    "two planes": ("coincident", "WRONG", "Plane", "same plane"),
    "glass on glass": ("coincident", "WRONG", "", "touch exactly"),
    "copy in place": ("coincident", "DIFFERENT", "Ball.001", "exactly where object 'Ball' does"),
    "flipped faces": ("normals", "", "Flipped", "point in opposite directions"),
    "far from the origin": ("precision", "WRONG", "Ball", "no larger than a few steps"),
    "tiny in its place": ("precision", "WRONG", "Ball", "hardly more than the step"),
    "light that grows": ("closures", "WRONG", "Ball", "1.6 times the light"),
    "picture beyond white": ("closures", "WRONG", "Ball", "goes up to 2"),
    "invisible glass": ("closures", "WASTE", "Ball", "invisible"),
}


@pytest.fixture(params=[MODULE, PROGRAM])
def case(request, tmp_path):
    return lambda name: blenders.run(request.param, tmp_path, "check_cases", name)


def test_flaws_and_near_misses(case):
    got = case("flaws")
    assert set(got) - {"console"} == set(EXPECTED)
    for name, (kind, severity, thing, words) in EXPECTED.items():
        (findings, told), (none, nothing) = got[name]
        assert len(findings) == 1, (name, findings)
        assert findings[0][0] == kind and severity in findings[0][1] and thing in findings[0][2], (name, findings)
        # F12 says the same by itself, and warns on the terminal.
        assert len(told) == 1 and words in told[0], (name, told)
        assert f"Lancer: {told[0]}" in got["console"], name
        assert none == [] and nothing == [], (name, none, nothing)


def test_switches_and_buttons(case):
    got = case("switches")
    assert len(got["on"]) == 1 and "glass is open" in got["on"][0] and got["off"] == []
    assert got["asked"] == [["glass", "WRONG", "Thing"]] and got["hidden"] == []
    assert got["selected"] == [["Thing", ["Thing"]], ["Camera", ["Camera"]]] and got["nobody"] == ["CANCELLED"]
    # Selecting the edited object keeps its Edit Mode; another object in Edit Mode leaves it.
    assert got["modes"] == ["EDIT", "OBJECT"]
    # A scene that cannot be checked gives an error and keeps the last list.
    assert "camera" in got["without camera"] and got["kept"] == []


def test_a_fault_of_the_check_costs_no_picture(case):
    got = case("failing")
    assert len(got["messages"]) == 1 and "check before the render failed (ValueError: no such edge)" in got["messages"][0]
    assert got["samples"] == 1


def test_smooth_shading_of_folds_is_no_fault(case):
    """Smooth shading of folds, equal in all engines, is a hint in Check Scene and not reported by F12."""
    got = case("smooth")
    for name, thing in (("monkey", "Suzanne"), ("letters", "Text")):
        assert got[name] == {lamp: [[["normals", "HINT", thing]], []] for lamp in ("POINT", "AREA")}
