"""The course's first scene: coloured spheres on planes under point lights, traced by recursive ray tracing."""

import math

from . import parts


def build(scene):
    parts.set_size(scene, 640, 480, 1)
    sphere = parts.sphere_mesh("Sphere")
    plane = parts.plane_mesh("Plane", 24.0)
    spheres = [
        ("Red", (0.7, 0.08, 0.06), 0.02, 1.5, (-1.5, 0.4, 1.0), 1.0),
        ("Gold", (0.6, 0.4, 0.08), 0.2, 2.0, (0.6, 1.2, 0.8), 0.8),
        ("Blue", (0.07, 0.15, 0.65), 0.005, 1.8, (1.7, -0.4, 0.6), 0.6),
        ("Green", (0.1, 0.5, 0.15), 0.5, 1.4, (-0.1, -0.9, 0.4), 0.4),
    ]
    for name, kd, roughness, ior, location, radius in spheres:
        material = parts.course_material(name, kd, (1, 1, 1), roughness, ior)
        parts.place(scene, name, sphere, material, location, radius, shape="SPHERE")
    floor = parts.course_material("Floor", (0.5, 0.5, 0.5), (0.6, 0.6, 0.6), 0.05, 1.5)
    wall = parts.course_material("Wall", (0.35, 0.45, 0.55), (0.1, 0.1, 0.1), 0.5, 1.4)
    parts.place(scene, "Floor", plane, floor, shape="PLANE")
    parts.place(scene, "Wall", plane, wall, (0, 6, 0), rotation=(math.pi / 2, 0, 0), shape="PLANE")
    parts.add_light(scene, "Left", "POINT", 900.0, (-4, -4, 5), color=(1.0, 0.9, 0.8), shadow_soft_size=0.0)
    parts.add_light(scene, "Right", "POINT", 500.0, (4, -3, 4), color=(0.8, 0.9, 1.0), shadow_soft_size=0.0)
    parts.set_world(scene, (0.1, 0.15, 0.25))
    parts.add_camera(scene, (0, -8, 2.6), (0, 0, 0.9), lens=45.0)
    if hasattr(scene, "lancer"):
        scene.lancer.integrator = "CLASSIC"
