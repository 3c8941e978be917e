"""Scenes of products: clear, polished and brushed balls under the sun; a product between softboxes."""

import math

from . import outdoors, parts, pictures


def build(scene):
    """Glass and metal under the sun, on a matt floor."""
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


def build_product(scene):
    """A bottle, a worn can and a ring on a curved sheet of paper, between three softboxes; a thin lens, Normal and Z passes."""
    parts.set_size(scene, 512, 384, 32)
    parts.add_passes(scene)
    can = outdoors.textured("Can", pictures.cloth("Label", cells=9), 0.4)
    paper = outdoors.textured("Paper", pictures.grain("Paper", (0.8, 0.8, 0.78)), 0.8)
    for material in (can, paper):
        outdoors.wear_out(material)
    glass = parts.principled("Glass", base_color=(0.9, 1.0, 0.95), transmission_weight=1.0, roughness=0.02, ior=1.45)
    gold = parts.principled("Gold", base_color=(1.0, 0.77, 0.34), metallic=1.0, roughness=0.18)
    lacquer = parts.principled("Lacquer", base_color=(0.5, 0.03, 0.03), roughness=0.5, coat_weight=1.0, coat_roughness=0.03)
    bottle = [(0.0, 0.0), (0.5, 0.0), (0.55, 0.1), (0.55, 1.2), (0.4, 1.5), (0.16, 1.7), (0.15, 2.2), (0.0, 2.2)]
    parts.place(scene, "Bottle", parts.lathe_mesh("Bottle", bottle), glass, (-0.8, 0.2, 0.002))
    body = [(0.0, 0.0), (0.42, 0.0), (0.45, 0.05), (0.45, 1.15), (0.4, 1.2), (0.0, 1.2)]
    parts.place(scene, "Can", parts.lathe_mesh("Can", body), can, (0.55, -0.1, 0.002))
    parts.place(scene, "Ring", parts.torus_mesh("Ring", 0.3, 0.07), gold, (-0.1, -0.9, 0.072))
    parts.place(scene, "Ball", parts.sphere_mesh("Ball"), lacquer, (1.3, -0.7, 0.302), 0.3)
    # The paper curves upwards behind the product.
    bend = [
        (-3.0, 0.0),
        (2.0, 0.0),
        *((2.0 + math.sin(a), 1.0 - math.cos(a)) for a in (0.3, 0.6, 0.9, 1.2, math.pi / 2)),
        (3.0, 4.0),
    ]
    corners = [(x, y, z) for y, z in bend for x in (-5.0, 5.0)]
    sweep = parts.mesh_from_points("Sweep", corners, [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(bend) - 1)])
    outdoors.flat_uvs(sweep)
    parts.place(scene, "Sweep", sweep, paper)
    for name, energy, location, width, height in (
        ("Key", 120.0, (-3.0, -2.0, 3.2), 1.6, 1.2),
        ("Fill", 40.0, (3.2, -1.5, 2.0), 0.8, 2.0),
        ("Top", 60.0, (0.0, 1.0, 4.0), 3.0, 0.6),
    ):
        parts.add_light(scene, name, "AREA", energy, location, (0, 0, 0.8), shape="RECTANGLE", size=width, size_y=height)
    parts.set_world(scene, (0.5, 0.5, 0.5), 0.1)
    parts.add_camera(scene, (0.3, -6.2, 2.0), (0.1, 0, 0.95), lens=50.0, fstop=4.0)
