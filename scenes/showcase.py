"""The picture of the README: exact spheres, cylinder and cone beside meshes; glass, mirror, metal, plastic; a thin lens."""

import colorsys
import math
import random

from . import parts
from .spheres import scatter


def build(scene):
    parts.set_size(scene, 960, 540, 64)
    add_figures(scene)
    add_pearls(scene)
    ground = parts.principled("Ground", base_color=(0.32, 0.30, 0.29), roughness=0.28, ior=1.45)
    parts.place(scene, "Ground", parts.plane_mesh("Ground", 60.0), ground, shape="PLANE")
    # A warm key light from the left, a cool fill light from the right, and a rim light for the outlines.
    parts.add_light(scene, "Key", "AREA", 1400.0, (-6.0, -4.0, 6.5), (0, 0, 0.8), (1.0, 0.80, 0.58), size=3.0)
    parts.add_light(scene, "Fill", "AREA", 260.0, (7.0, -4.0, 4.0), (0, 0, 0.8), (0.55, 0.75, 1.0), size=5.0)
    parts.add_light(scene, "Rim", "AREA", 700.0, (3.5, 7.0, 5.0), (0, 0, 1.0), (1.0, 0.9, 0.8), size=2.5)
    parts.set_world(scene, (0.36, 0.52, 0.80), 0.40)
    parts.add_camera(scene, (0.3, -9.6, 2.5), (0.1, 0.0, 0.98), lens=46.0, fstop=0.8, focus=(0.0, -0.7, 1.0))
    parts.set_look(scene, "AgX - Punchy", "High Contrast")
    if hasattr(scene, "lancer"):
        scene.lancer.clamp_indirect = 12.0


def add_figures(scene):
    """Adds the large objects, from left to right."""
    sphere = parts.sphere_mesh("Sphere")
    cylinder = parts.cone_mesh("Cylinder", 1.0, 1.0)
    cone = parts.cone_mesh("Cone", 1.0, 0.0)

    teal = parts.course_material("Teal Kd Ks", (0.02, 0.30, 0.32), (1, 1, 1), 0.05, 1.6)
    parts.place(scene, "Cylinder", cylinder, teal, (-3.15, 0.9, 0.95), (0.62, 0.62, 0.95), shape="CYLINDER")
    pearl = parts.principled("Ivory", base_color=(0.85, 0.80, 0.70), roughness=0.25, ior=1.5)
    parts.place(scene, "Ivory ball", sphere, pearl, (-3.15, 0.9, 2.32), 0.42, shape="SPHERE")

    glass = parts.principled("Glass", base_color=(1, 1, 1), transmission_weight=1.0, roughness=0.0, ior=1.5)
    parts.place(scene, "Glass ball", sphere, glass, (-1.55, -0.75, 0.85), 0.85, shape="SPHERE")

    copper = parts.principled("Copper", base_color=(0.93, 0.50, 0.33), metallic=1.0, roughness=0.32)
    monkey = parts.monkey_mesh("Monkey", 3)
    parts.place(scene, "Monkey", monkey, copper, (0.25, 0.55, 1.12), 1.15, (-0.28, 0, 0.12))

    mirror = parts.principled("Mirror", base_color=(0.95, 0.95, 0.96), metallic=1.0, roughness=0.0)
    parts.place(scene, "Mirror ball", sphere, mirror, (2.35, -0.1, 0.8), 0.8, shape="SPHERE")
    gold = parts.principled("Gold", base_color=(1.0, 0.72, 0.26), metallic=1.0, roughness=0.18)
    parts.place(scene, "Torus", parts.torus_mesh("Torus", 0.62, 0.17), gold, (1.25, -1.75, 0.17))

    red = parts.course_material("Red Kd Ks", (0.55, 0.03, 0.03), (1, 1, 1), 0.12, 1.5)
    parts.place(scene, "Cone", cone, red, (3.55, 1.1, 1.1), (0.75, 0.75, 1.1), shape="CONE")


def add_pearls(scene):
    """Adds small spheres between and behind the figures; distant ones are out of focus."""
    source = random.Random(7)
    sphere = parts.sphere_mesh("Pearl", 32, 16)
    keep_out = [
        (-3.15, 0.9, 0.9),
        (-1.55, -0.75, 1.15),
        (0.25, 0.55, 1.5),
        (2.35, -0.1, 1.1),
        (1.25, -1.75, 1.0),
        (3.55, 1.1, 1.0),
    ]
    for index, (x, y, radius) in enumerate(scatter(source, 170, 7.0, (0.09, 0.26))):
        y = 1.5 * y + 3.0
        if y < -3.2 or any(math.hypot(x - a, y - b) < r + radius for a, b, r in keep_out):
            continue
        color = colorsys.hsv_to_rgb(source.choice((0.0, 0.04, 0.09, 0.50, 0.55, 0.62)), source.uniform(0.3, 0.85), 0.75)
        metallic = float(index % 4 == 0)
        material = parts.principled(f"Pearl {index}", base_color=color, metallic=metallic, roughness=source.uniform(0.05, 0.5))
        parts.place(scene, f"Pearl {index}", sphere, material, (x, y, radius), radius, shape="SPHERE")
