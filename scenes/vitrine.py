"""Glass and metal under the sun: clear balls, polished and brushed ones, on a matt floor."""

import math

from . import parts


def build(scene):
    parts.set_size(scene, 640, 480, 64)
    sphere = parts.sphere_mesh("Sphere", 96, 48)
    glass = parts.principled("Glass", base_color=(1, 1, 1), transmission_weight=1.0, roughness=0.0, ior=1.5)
    mirror = parts.principled("Mirror", base_color=(0.95, 0.95, 0.96), metallic=1.0, roughness=0.0)
    gold = parts.principled("Gold", base_color=(1.0, 0.72, 0.26), metallic=1.0, roughness=0.3)
    copper = parts.principled("Copper", base_color=(0.93, 0.5, 0.33), metallic=1.0, roughness=0.45)
    lacquer = parts.principled("Lacquer", base_color=(0.5, 0.05, 0.05), roughness=0.25, ior=1.5)
    row = (glass, gold, mirror, copper, lacquer)
    for index in range(15):
        x, y = 1.5 * (index % 5 - 2), 1.6 * (index // 5 - 1)
        material = row[(index + 2 * (index // 5)) % 5]
        parts.place(scene, f"Ball {index}", sphere, material, (x, y, 0.6), 0.6)
    floor = parts.principled("Floor", base_color=(0.55, 0.53, 0.5), roughness=1.0, specular_ior_level=0.0)
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 40.0), floor)
    parts.add_light(scene, "Sun", "SUN", 4.0, (4, -5, 7), (0, 0, 0), color=(1.0, 0.92, 0.8), angle=math.radians(8.0))
    parts.set_world(scene, (0.35, 0.5, 0.8), 0.5)
    parts.add_camera(scene, (0, -8, 4.2), (0, 0, 0.3), lens=42.0)
