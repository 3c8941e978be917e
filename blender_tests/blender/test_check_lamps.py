"""Check of area lamps in faces, which occlude part of them in Cycles."""

import dataclasses

import numpy as np
import pytest
from check_scenes import GREY_, found, only, placed, scene, sheet
from tiny_scenes import move, rotate_x, rotate_y

from addon.bindings.enums import AreaShape, LightKind, Ray
from addon.bindings.snapshot import Light, MeshData
from addon.checks.finding import Severity

PANEL = Light("panel", move(0, 0, 3) @ np.eye(4), LightKind.AREA, emission=(1, 1, 1), size=(1.0, 0.5))
IN_A_FACE = [("lights", "DIFFERENT")]


def lit(light, ceiling=None, matrix=None, **fields):
    room = [placed(0, GREY_, name="floor"), placed(1, GREY_, move(0, 0, 3) if matrix is None else matrix, "ceiling", **fields)]
    return scene(room, [sheet(), ceiling or sheet(2.0)], lights=(light,))


@pytest.mark.parametrize("thorough", [True, False])
def test_a_lamp_in_a_ceiling(thorough):
    finding = only(lit(PANEL), thorough)
    assert (finding.light, finding.severity) == ("panel", Severity.DIFFERENT) and "'ceiling'" in finding.what and finding.key
    # A distance of one step of single precision counts as 0, many steps do not.
    assert found(lit(dataclasses.replace(PANEL, matrix=move(0, 0, 3.0 - 1e-7))), thorough) == IN_A_FACE
    assert found(lit(dataclasses.replace(PANEL, matrix=move(0, 0, 3.0 - 1e-4))), thorough) == []


@pytest.mark.parametrize("turn", [np.eye(4), rotate_x(0.7) @ rotate_y(0.4), move(50, -20, 7) @ rotate_y(1.0)])
def test_in_any_position(turn):
    above = turn @ move(0, 0, 3)
    rounded = above.astype(np.float32).astype(float)
    assert found(lit(dataclasses.replace(PANEL, matrix=rounded), matrix=rounded)) == IN_A_FACE
    # A lamp rotated out of the plane intersects it along a line only.
    assert found(lit(dataclasses.replace(PANEL, matrix=rounded @ rotate_x(0.1)), matrix=rounded)) == []


def test_what_hides_nothing_of_it():
    # Beside the ceiling, in its plane.
    assert found(lit(dataclasses.replace(PANEL, matrix=move(1.6, 0, 3)))) == []
    # In a hole: a frame of four sheets around it.
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1), (-0.6, -0.4), (0.6, -0.4), (0.6, 0.4), (-0.6, 0.4)]
    sides = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    faces = [face for a, b, c, d in sides for face in ((a, b, c), (a, c, d))]
    frame = MeshData("frame", np.array([(x, y, 0.0) for x, y in corners]), faces)
    assert found(lit(PANEL, frame)) == []
    assert found(lit(dataclasses.replace(PANEL, size=(1.6, 0.5)), frame)) == IN_A_FACE
    # Without shadow, of the lamp or of the face; without light.
    assert found(lit(dataclasses.replace(PANEL, no_shadow=True))) == []
    assert found(lit(PANEL, hidden_from=int(Ray.SHADOW))) == []
    assert "nothing gives light" in only(lit(dataclasses.replace(PANEL, emission=(0, 0, 0)))).what


def test_every_lamp_is_told_once():
    lamps = [
        dataclasses.replace(PANEL, name=f"panel {k}", matrix=move(0.1 * k, 0, 3), shape=AreaShape.ELLIPSE) for k in range(3)
    ]
    snapshot = dataclasses.replace(lit(PANEL), lights=tuple(lamps))
    assert found(snapshot) == 3 * IN_A_FACE
