"""Many lamps of unequal power over a floor with blocks: the contribution of each lamp differs from place to place."""

import math
import random

from . import parts

# The power of all lamps together, in watts, for any number of lamps.
_POWER = 6000.0


def build_lights(scene, count):
    """count point lights, the strongest some thousand times as strong as the weakest."""
    source = random.Random(200)
    parts.set_size(scene, 640, 480, 64)
    floor = parts.principled("Floor", base_color=(0.5, 0.5, 0.5), roughness=0.6, ior=1.5)
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 60.0), floor)
    block = parts.cube_mesh("Block", 1.0)
    paint = parts.principled("Paint", base_color=(0.7, 0.6, 0.5), roughness=0.5, ior=1.5)
    for index in range(64):
        x, y = 2.5 * (index % 8 - 3.5), 2.5 * (index // 8 - 3.5)
        height = source.uniform(0.4, 2.4)
        turn = source.uniform(0.0, math.pi)
        parts.place(scene, f"Block {index}", block, paint, (x, y, height / 2), (1.1, 1.1, height), (0, 0, turn))
    # Spread the powers evenly over ten powers of two; of two lamps, one is four times as strong as the other.
    weights = [2.0 ** source.uniform(0.0, 10.0) for _ in range(count)] if count > 2 else [4.0, 1.0]
    for index, weight in enumerate(weights):
        place = source.uniform(-10.0, 10.0), source.uniform(-10.0, 10.0), source.uniform(2.8, 4.5)
        color = [source.uniform(0.6, 1.0) for _ in range(3)]
        energy = _POWER * weight / sum(weights)
        parts.add_light(scene, f"Lamp {index}", "POINT", energy, place, color=color, shadow_soft_size=0.05)
    parts.set_world(scene, (0, 0, 0))
    parts.add_camera(scene, (0, -17, 13), (0, -1, 0), lens=40.0)


def build_lights2(scene):
    build_lights(scene, 2)


def build_lights200(scene):
    build_lights(scene, 200)


def build_lights10k(scene):
    build_lights(scene, 10_000)
