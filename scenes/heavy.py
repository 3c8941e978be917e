"""Large scenes: one mesh of a million triangles, or of ten million, and 20 000 or 100 000 instances of a smaller mesh."""

import math
import random

import bpy
import numpy as np
from mathutils import Euler, Matrix

from . import parts


def build_million(scene, subdivisions=5):
    """One mesh of 1 007 616 triangles: the monkey's 500 faces (468 quads, 32 triangles), subdivided five times."""
    parts.set_size(scene, 320, 180, 16)
    grey = parts.principled("Grey", base_color=(0.6, 0.6, 0.6), roughness=0.4, ior=1.5)
    parts.place(scene, "Monkey", parts.monkey_mesh("Monkey", subdivisions), grey)
    parts.add_light(scene, "Area", "AREA", 300.0, (3, -4, 4), size=2.0)
    parts.set_world(scene, (0.4, 0.5, 0.6), 0.4)
    parts.add_camera(scene, (0.6, -4, 0.8), (0, 0, 0))


def build_head(scene):
    """One mesh of 251 904 triangles."""
    build_million(scene, 4)


def build_instances(scene, count=20_000):
    """Adds count instances of one mesh of 15 744 triangles, with random rotations and scales, in a wide field."""
    source = random.Random(count)
    parts.set_size(scene, 320, 180, 16)
    grey = parts.principled("Grey", base_color=(0.6, 0.5, 0.4), roughness=0.4, ior=1.5)
    mesh = parts.monkey_mesh("Monkey", 2)
    mesh.materials.append(grey)
    side = math.ceil(math.sqrt(count))
    for index in range(count):
        thing = bpy.data.objects.new("Monkey", mesh)
        x, y = (2.5 * (index % side - side / 2), 2.5 * (index // side - side / 2))
        turn = Euler([source.uniform(0, 2 * math.pi) for _ in range(3)]).to_matrix().to_4x4()
        size = source.uniform(0.6, 1.2)
        thing.matrix_world = Matrix.Translation((x, y, size)) @ turn @ Matrix.Scale(size, 4)
        scene.collection.objects.link(thing)
    ground = parts.principled("Ground", base_color=(0.4, 0.4, 0.4), roughness=0.8, ior=1.5)
    parts.place(scene, "Ground", parts.plane_mesh("Ground", 800.0), ground)
    parts.add_light(scene, "Sun", "SUN", 3.0, (60, -80, 100), angle=0.05)
    parts.set_world(scene, (0.5, 0.6, 0.8), 0.5)
    parts.add_camera(scene, (0, -190, 40), (0, -120, 0), lens=35.0)


def build_crowd(scene):
    build_instances(scene, 100_000)


def build_terrain(scene, side=2240):
    """One smooth mesh of 2 * side * side triangles, 10 035 200 by default: hills under a sun."""
    parts.set_size(scene, 320, 180, 16)
    x, y = np.meshgrid(*[np.linspace(-10.0, 10.0, side + 1, dtype=np.float32)] * 2)
    height = sum(0.6 / f * np.sin(f * x + f) * np.cos(1.3 * f * y) for f in (1.0, 2.7, 7.1, 19.0))
    number = np.arange((side + 1) ** 2, dtype=np.int32).reshape(side + 1, side + 1)
    corners = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1)
    # Fill arrays: a list of ten million faces would need gigabytes.
    mesh = bpy.data.meshes.new("Hills")
    mesh.vertices.add(number.size)
    mesh.vertices.foreach_set("co", np.stack([x, y, height], axis=-1).astype(np.float32).ravel())
    mesh.loops.add(corners.size)
    mesh.loops.foreach_set("vertex_index", corners.ravel())
    mesh.polygons.add(side * side)
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(side * side, bool))
    mesh.update(calc_edges=True)
    parts.place(scene, "Hills", mesh, parts.principled("Earth", base_color=(0.3, 0.25, 0.2), roughness=0.8, ior=1.5))
    parts.add_light(scene, "Sun", "SUN", 3.0, (60, -80, 100), angle=0.05)
    parts.set_world(scene, (0.5, 0.6, 0.8), 0.5)
    parts.add_camera(scene, (0, -12, 5), (0, -3, 0), lens=35.0)
