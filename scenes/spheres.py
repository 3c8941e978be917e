"""Many spheres on a plane: `balls` and `coated` of the comparison with Cycles, and `spheres600`, the course's own benchmark."""

import colorsys
import math
import random

import bpy

from . import parts


def scatter(random_source, count, half_width, radii, clearance=1.02):
    """Returns count circles (x, y, radius) inside a square that do not touch; a draw is repeated until its circle fits."""
    circles = []
    while len(circles) < count:
        radius = random_source.uniform(*radii)
        x, y = (random_source.uniform(-half_width, half_width) for _ in range(2))
        if all(math.hypot(x - a, y - b) > clearance * (radius + r) for a, b, r in circles):
            circles.append((x, y, radius))
    return circles


def build_balls_exact(scene):
    """The same balls as exact spheres; the plane stays a mesh."""
    build_balls(scene, shape="SPHERE")


def build_balls(scene, shape="MESH"):
    """60 smooth UV spheres, 64 x 32, of mixed Principled materials on a plane, an area light, a point light, a dim sky."""
    _place_balls(scene, shape, lambda index: {})


def build_coated(scene):
    """The same balls in three groups: brushed metal, cloth with sheen, varnish with a tint."""
    tint = {"coat_tint": (0.9, 0.6, 0.4)} if bpy.app.version >= (4, 0) else {}
    looks = (
        {"metallic": 1.0, "anisotropic": 0.7, "anisotropic_rotation": 0.1},
        {"metallic": 0.0, "sheen_weight": 0.8},
        {"metallic": 0.0, "coat_weight": 0.9, "coat_roughness": 0.1, "sheen_weight": 0.3} | tint,
    )
    _place_balls(scene, "MESH", lambda index: looks[index % 3])


def _place_balls(scene, shape, look):
    source = random.Random(60)
    parts.set_size(scene, 640, 480, 16)
    for index, (x, y, radius) in enumerate(scatter(source, 60, 6.0, (0.4, 0.7))):
        color = colorsys.hsv_to_rgb(source.random(), source.uniform(0.2, 0.8), source.uniform(0.5, 0.9))
        inputs = {"base_color": color, "metallic": float(index % 2), "roughness": source.uniform(0.1, 0.8), "ior": 1.5}
        material = parts.principled(f"Ball {index}", **(inputs | look(index)))
        mesh = parts.sphere_mesh(f"Ball {index}")
        parts.place(scene, f"Ball {index}", mesh, material, (x, y, radius), radius, shape=shape)
    ground = parts.principled("Ground", base_color=(0.5, 0.5, 0.5), roughness=0.6, ior=1.5)
    parts.place(scene, "Ground", parts.plane_mesh("Ground", 40.0), ground)
    parts.add_light(scene, "Area", "AREA", 1200.0, (5, -4, 8), size=3.0)
    parts.add_light(scene, "Point", "POINT", 300.0, (-6, -3, 5), shadow_soft_size=0.2)
    parts.set_world(scene, (0.6, 0.75, 1.0), 0.15)
    parts.add_camera(scene, (0, -14, 7), (0, -0.5, 0.3), lens=45.0)


def build_spheres600(scene):
    """600 exact spheres on an exact plane under two point lights, traced as in the course, every surface reflecting."""
    source = random.Random(600)
    parts.set_size(scene, 640, 480, 1)
    mesh = parts.sphere_mesh("Sphere", 16, 8)
    palette = [colorsys.hsv_to_rgb(index / 12, 0.6, 0.8) for index in range(12)]
    materials = [
        parts.course_material(f"Color {index}", color, (0.4, 0.4, 0.4), 0.1, 1.5) for index, color in enumerate(palette)
    ]
    for index, (x, y, radius) in enumerate(scatter(source, 600, 20.0, (0.25, 0.6))):
        material = materials[source.randrange(len(materials))]
        parts.place(scene, f"Sphere {index}", mesh, material, (x, y, radius), radius, shape="SPHERE")
    ground = parts.course_material("Ground", (0.5, 0.5, 0.5), (0.2, 0.2, 0.2), 0.2, 1.5)
    parts.place(scene, "Ground", parts.plane_mesh("Ground", 60.0), ground, shape="PLANE")
    parts.add_light(scene, "Left", "POINT", 12000.0, (-15, -15, 18), shadow_soft_size=0.0)
    parts.add_light(scene, "Right", "POINT", 9000.0, (16, -12, 14), shadow_soft_size=0.0)
    parts.set_world(scene, (0.35, 0.5, 0.7), 0.5)
    parts.add_camera(scene, (0, -30, 14), (0, -2, 0), lens=40.0)
    if hasattr(scene, "lancer"):
        scene.lancer.integrator = "CLASSIC"
