"""Blender's default cube, one triangle, a closed room of indirect light, and a room of a million triangles with windows."""

import math

from . import outdoors, parts, pictures


def build_default_cube(scene):
    """Blender's start-up file, with its own lens, light and grey."""
    parts.set_size(scene, 960, 540, 64)
    grey = parts.principled("Material", base_color=(0.8, 0.8, 0.8), roughness=0.5, ior=1.5)
    parts.place(scene, "Cube", parts.cube_mesh("Cube"), grey)
    parts.add_light(scene, "Light", "POINT", 1000.0, (4.076, 1.005, 5.904), shadow_soft_size=0.1)
    parts.set_world(scene, (0.051, 0.051, 0.051))
    parts.add_camera(scene, (7.359, -6.926, 4.958), (0, 0, 0))


def build_cornell(scene):
    """A closed box: its lamp shines at the ceiling from a shade, so the ceiling's light reaches walls and blocks."""
    parts.set_size(scene, 512, 512, 128)
    white = parts.principled("White", base_color=(0.75, 0.75, 0.75), roughness=1.0, specular_ior_level=0.0)
    red = parts.principled("Red", base_color=(0.6, 0.05, 0.04), roughness=1.0, specular_ior_level=0.0)
    green = parts.principled("Green", base_color=(0.1, 0.45, 0.08), roughness=1.0, specular_ior_level=0.0)
    quarter = math.pi / 2
    sides = [
        ("Floor", white, (0, -1, 0), (1, 2, 1), (0, 0, 0)),
        ("Ceiling", white, (0, -1, 2), (1, 2, 1), (2 * quarter, 0, 0)),
        ("Back", white, (0, 1, 1), (1, 1, 1), (quarter, 0, 0)),
        ("Front", white, (0, -3, 1), (1, 1, 1), (-quarter, 0, 0)),
        ("Left", red, (-1, -1, 1), (1, 2, 1), (0, quarter, 0)),
        ("Right", green, (1, -1, 1), (1, 2, 1), (0, -quarter, 0)),
    ]
    mesh = parts.plane_mesh("Side")
    for name, material, location, scale, rotation in sides:
        parts.place(scene, name, mesh, material, location, scale, rotation)
    block = parts.cube_mesh("Block", 1.0)
    parts.place(scene, "Tall block", block, white, (-0.38, 0.3, 0.6), (0.55, 0.55, 1.2), (0, 0, 0.3))
    parts.place(scene, "Short block", block, white, (0.35, -0.25, 0.3), (0.55, 0.55, 0.6), (0, 0, -0.3))
    parts.add_light(scene, "Lamp", "AREA", 40.0, (0, 0, 1.5), (0, 0, 2), (1.0, 0.85, 0.6), size=0.5)
    parts.set_world(scene, (0, 0, 0))
    parts.add_camera(scene, (0, -2.95, 1), (0, 1, 0.98), lens=38.0)


def build_room(scene):
    """The closed box with a real shade under its lamp, so that no renderer shows the lamp itself, or light behind it."""
    build_cornell(scene)
    shade = parts.principled("Shade", base_color=(0.2, 0.2, 0.2), roughness=1.0, specular_ior_level=0.0)
    parts.place(scene, "Shade", parts.plane_mesh("Shade", 0.54), shade, (0, 0, 1.49))


def build_daylight(scene):
    """A room of a million triangles, lit by large panels before its two windows; worn floor, Normal and Z passes."""
    parts.set_size(scene, 512, 384, 32)
    parts.add_passes(scene)
    wall = parts.principled("Wall", base_color=(0.75, 0.73, 0.7), roughness=0.9, specular_ior_level=0.2)
    floor = outdoors.textured("Floor", pictures.grain("Floor", (0.6, 0.45, 0.3), waves=16), 0.5)
    cloth = outdoors.textured("Cloth", pictures.cloth("Cushion", cells=6), 0.8)
    outdoors.wear_out(floor)
    outdoors.wear_out(cloth)
    clay = parts.principled("Clay", base_color=(0.55, 0.35, 0.25), roughness=0.6, ior=1.5)
    frame = parts.principled("Frame", base_color=(0.8, 0.8, 0.8), metallic=1.0, roughness=0.35)
    cube, ground = parts.cube_mesh("Cube", 1.0), parts.plane_mesh("Ground", 2.0)
    outdoors.flat_uvs(ground)
    parts.place(scene, "Floor", ground, floor, scale=(3, 4, 1))
    boxes = [
        ("Ceiling", (0, 0, 2.85), (6, 8, 0.1)),
        ("Back", (0, 4.05, 1.4), (6.2, 0.1, 2.8)),
        ("Right", (3.05, 0, 1.4), (0.1, 8, 2.8)),
    ]
    boxes += [("Front", (0, -4.05, 1.4), (6.2, 0.1, 2.8)), ("Sill", (-3.05, 0, 0.4), (0.1, 8, 0.8))]
    boxes += [("Lintel", (-3.05, 0, 2.55), (0.1, 8, 0.5))]
    boxes += [
        (f"Pier {k}", (-3.05, y, 1.55), (0.1, width, 1.5)) for k, (y, width) in enumerate(((-3.25, 1.5), (0, 1.4), (3.25, 1.5)))
    ]
    for name, location, size in boxes:
        parts.place(scene, name, cube, wall, location, size)
    for k, y in enumerate((-1.6, 1.6)):
        parts.place(scene, f"Bar {k}", cube, frame, (-3.05, y, 1.55), (0.06, 0.06, 1.5))
        parts.add_light(
            scene, f"Panel {k}", "AREA", 250.0, (-3.6, y, 1.6), (0, y, 1.2), shape="RECTANGLE", size=1.8, size_y=1.5
        )
    parts.place(scene, "Monkey", parts.monkey_mesh("Monkey", 5), clay, (0.8, 2.0, 0.95), 0.8, (0.0, 0.0, 0.4))
    parts.place(scene, "Plinth", cube, wall, (0.8, 2.0, 0.15), (1.2, 1.2, 0.3))
    for k, (x, y) in enumerate(((-1.2, 2.6), (-1.6, 1.4), (2.2, 0.6))):
        pillow = parts.lathe_mesh(f"Cushion {k}", [(0.0, 0.0), (0.4, 0.02), (0.5, 0.15), (0.4, 0.28), (0.0, 0.3)])
        parts.place(scene, f"Cushion {k}", pillow, cloth, (x, y, 0.002), rotation=(0, 0, k))
    parts.set_world(scene, (0.5, 0.65, 0.9), 0.5)
    parts.add_camera(scene, (0.6, -3.7, 1.5), (-0.2, 2, 1.0), lens=24.0)


def build_triangle(scene):
    """One grey triangle before a grey sky: the time of this scene is the fixed cost of a sample."""
    parts.set_size(scene, 640, 480, 64)
    grey = parts.principled("Grey", base_color=(0.6, 0.6, 0.6), roughness=1.0, specular_ior_level=0.0)
    parts.place(scene, "Triangle", parts.mesh_from_points("Triangle", [(-1, 0, -1), (1, 0, -1), (0, 0, 1)], [(0, 1, 2)]), grey)
    parts.set_world(scene, (0.5, 0.6, 0.7))
    parts.add_camera(scene, (0, -4, 0), (0, 0, 0))
