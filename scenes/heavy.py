"""Scenes that weigh: one mesh of a million triangles, and 20 000 instances of a smaller one."""

import math
import random

import bpy
from mathutils import Euler, Matrix

from . import parts


def build_million(scene):
    """One mesh of 1 007 616 triangles: the monkey's 500 faces (468 quads, 32 triangles), subdivided five times."""
    parts.set_size(scene, 320, 180, 16)
    grey = parts.principled("Grey", base_color=(0.6, 0.6, 0.6), roughness=0.4, ior=1.5)
    parts.place(scene, "Monkey", parts.monkey_mesh("Monkey", 5), grey)
    parts.add_light(scene, "Area", "AREA", 300.0, (3, -4, 4), size=2.0)
    parts.set_world(scene, (0.4, 0.5, 0.6), 0.4)
    parts.add_camera(scene, (0.6, -4, 0.8), (0, 0, 0))


def build_instances(scene, count=20_000):
    """count instances of one mesh of 15 744 triangles, turned and scaled at random, in a wide field."""
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
