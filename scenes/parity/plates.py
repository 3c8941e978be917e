"""Plates under a uniform white sky: one tile of the picture for each angle (from left) and roughness (from below)."""

import math

from mathutils import Euler, Vector

from .. import parts

ANGLES = (0, 20, 45, 65, 80)
ROUGHNESS = (0.1, 0.3, 0.6, 1.0)
TILES = {roughness: ANGLES for roughness in ROUGHNESS}


def size_of(tiles):
    return 16 * max(len(angles) for angles in tiles.values()), 16 * len(tiles)


SIZE = size_of(TILES)


def set_plates(scene, make, tiles=TILES):
    """make(roughness) returns a material; tiles: the angles of each roughness.

    The plates fill the tiles of an orthographic picture, far enough behind one another that they exchange hardly any light.
    The
    sky fills the tiles that a row lacks."""
    columns, rows = max(len(angles) for angles in tiles.values()), len(tiles)
    for row, (roughness, angles) in enumerate(tiles.items()):
        surface = make(roughness)
        for column, angle in enumerate(angles):
            turn = math.radians(angle)
            # Stretch the plate by the factor by which its tilt shortens it.
            plate = parts.place(
                scene,
                f"Plate {angle} {roughness}",
                parts.plane_mesh("Plate", 1.0),
                surface,
                Vector((column + 0.5, row + 0.5, -50.0 * (column + row * columns))),
                (1.0, 1.0 / math.cos(turn), 1.0),
            )
            plate.rotation_euler = Euler((turn, 0, 0))
    parts.set_world(scene, (1, 1, 1))
    eye = parts.add_camera(scene, (columns / 2, rows / 2, 20), (columns / 2, rows / 2, 0))
    eye.rotation_euler = (0, 0, 0)
    eye.data.type, eye.data.ortho_scale, eye.data.clip_end = "ORTHO", max(columns, rows), 5000.0
