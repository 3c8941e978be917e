"""Writes src/bsdf/sheen_table.h: the microfibre sheen of Blender's Cycles, measured in renders; needs a Python with bpy.

python tables/sheen_table.py src/bsdf/sheen_table.h

Cycles interpolates the lobe linearly between nodes that are equally spaced in cos(wo) and in roughness. A small white plate of
cloth under a sun of irradiance 1, with the tilt and the roughness of a node, sends light to the viewer that is a closed form of
the node's a, b and albedo; several suns determine all three."""

import itertools
import math
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

NODES = 32
# In halves of the distance between two nodes. Some ends are excluded: plates seen edge-on are invisible, wo along n leaves the
# lobe's azimuth undefined, and Cycles clamps small roughness.
STEPS = 2 * (NODES - 1)
COSINES = range(1, STEPS)
ROUGHNESSES = range(1, STEPS + 1)
# Only the middle pixel of each plate is used.
PIXELS = 3
UNIT = 1e-5
SUNS = [(0.0, math.radians(lean)) for lean in range(-90, 92, 3)]
SUNS += [(math.radians(aside), math.radians(lean)) for aside in (-60, 30, 80) for lean in (-60, -30, 0, 30)]


def new_stage():
    """Makes a white cloth for every row, with a tilt for every column; the plates exchange no light.

    Returns the scene and, for each column, the matrix from the world to wo over x, y, n."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.samples, cycles.max_bounces, cycles.use_adaptive_sampling = "CYCLES", 1, 0, False
    cycles.pixel_filter_type, cycles.light_sampling_threshold, cycles.use_denoising = "BOX", 0.0, False
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    columns, rows = len(COSINES), len(ROUGHNESSES)
    render.resolution_x, render.resolution_y = PIXELS * columns, PIXELS * rows
    scene.world = bpy.data.worlds.new("Dark")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    eye = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    eye.data.type, eye.data.ortho_scale, eye.data.clip_end = "ORTHO", max(columns, rows), 1e4
    eye.location = (columns / 2, rows / 2, 1e3)
    scene.collection.objects.link(eye)
    scene.camera = eye
    for row, roughness in enumerate(ROUGHNESSES):
        mesh = bpy.data.meshes.new("Plate")
        mesh.from_pydata([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)], [], [(0, 1, 2, 3)])
        mesh.materials.append(cloth(roughness / STEPS))
        plates = []
        for column, cosine in enumerate(COSINES):
            plate = bpy.data.objects.new("Plate", mesh)
            plate.location = (column + 0.5, row + 0.5, 0.0)
            # Stretch the plate by the factor by which its tilt shortens it.
            plate.scale = (1.0, STEPS / cosine, 1.0)
            plate.rotation_euler = (math.acos(cosine / STEPS), 0.0, 0.0)
            plate.visible_shadow = False
            scene.collection.objects.link(plate)
            plates.append(plate)
    bpy.context.view_layer.update()
    return scene, np.array([frame(plate) for plate in plates])


def frame(plate):
    """Returns the plate's frame as rounded by single precision."""
    n = np.cross(*(np.array(plate.matrix_world.col[axis][:3], np.float64) for axis in (0, 1)))
    n /= np.linalg.norm(n)
    y = np.cross(n, (0.0, 0.0, 1.0))
    y /= np.linalg.norm(y)
    return np.array([np.cross(y, n), y, n])


def cloth(roughness):
    material = bpy.data.materials.new("Cloth")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new("ShaderNodeBsdfSheen"), tree.nodes.new("ShaderNodeOutputMaterial")
    node.distribution = "MICROFIBER"
    node.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    node.inputs["Roughness"].default_value = roughness
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def picture(scene, folder):
    """Returns [roughness, cosine] of the plates' middle pixels."""
    scene.render.filepath = str(folder / "plates.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    width, height = image.size
    bpy.data.images.remove(image)
    return values.reshape(height, width, 4)[PIXELS // 2 :: PIXELS, PIXELS // 2 :: PIXELS, 0].astype(np.float64)


def measure(scene, frames, folder):
    """Returns the directions [sun, column, xyz] to the suns, and the light [sun, row, column] of the plates under each sun."""
    lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    lamp.data.energy, lamp.data.angle, lamp.rotation_mode = 1.0, 0.0, "QUATERNION"
    scene.collection.objects.link(lamp)
    directions, lights = [], []
    for aside, lean in SUNS:
        towards = Vector((math.cos(lean) * math.sin(aside), math.sin(lean), math.cos(lean) * math.cos(aside)))
        lamp.rotation_quaternion = towards.to_track_quat("Z", "Y")
        bpy.context.view_layer.update()
        seen = np.array(lamp.matrix_world.col[2][:3], np.float64)
        directions.append(frames @ (seen / np.linalg.norm(seen)))
        lights.append(picture(scene, folder))
    return np.array(directions), np.array(lights)


def solve(wi, light):
    """Returns a, b and albedo of one plate; NaN where it is black.

    light = albedo wi.z / pi (a / ((a x + b z)^2 + (a y)^2 + z^2))^2, so sqrt(wi.z / (pi light)) is linear in
    (a, 2 b, (1 + b^2) / a) / sqrt(albedo)."""
    # For a sun along the plate, single precision has too few digits of the cosine.
    lit = (wi[:, 2] > 1e-3) & (light > 0.0)
    if lit.sum() < 8:
        return np.full(3, np.nan)
    (x, y, z), light = wi[lit].T, light[lit]
    root = np.sqrt(z / (math.pi * light))
    rows = np.stack([x * x + y * y, x * z, z * z], axis=-1)
    # Weight by relative error: the rounding of the light, and of the direction over the cosine.
    weight = 1.0 / (root * (1.0 + 0.5 / z))
    p, *_ = np.linalg.lstsq(rows * weight[:, None], root * weight, rcond=None)
    # About ten roundings of single precision, without the factor of the cosine.
    error = np.max(np.abs(rows @ p / root - 1.0) * z)
    assert error < 1e-6, f"no such lobe: off by {error}"
    albedo = 1.0 / (p[0] * p[2] - 0.25 * p[1] ** 2)
    return np.array([p[0] * math.sqrt(albedo), 0.5 * p[1] * math.sqrt(albedo), albedo])


def nodes_of(fit):
    """Returns every second entry of fit, [half, half, (a, b, albedo)].

    Unknown entries are extrapolated from those beyond, because all values are linear between two nodes."""
    size, found = len(fit), True
    while found:
        found = False
        for i, j, di, dj in itertools.product(range(0, size, 2), range(0, size, 2), (-1, 0, 1), (-1, 0, 1)):
            # Step along a row or a column, or over the middle of four nodes.
            around = [(i + 2 * di, j), (i, j + 2 * dj), (i + 2 * di, j + 2 * dj)]
            if np.isfinite(fit[i, j, 0]) or not all(0 <= p < size and 0 <= q < size for p, q in around):
                continue
            middle = fit[i + di, j + dj]
            fit[i, j] = 4.0 * middle - sum(fit[p, q] for p, q in around) if di and dj else 2.0 * middle - fit[around[2]]
            found |= bool(np.isfinite(fit[i, j, 0]))
    return np.nan_to_num(fit[::2, ::2])


HEAD = """// Written by tables/sheen_table.py.
// clang-format off
#pragma once

#include <cstdint>

namespace lancer {{

// The microfibre sheen as Cycles' pictures show it, in 1/{per}: a, b and albedo at roughness = j/{last} (rows) and
// cos(wo) = i/{last} (three columns each). A node that no picture can show, as the lobe is black around it, is 0.
inline constexpr int kSheenNodes = {nodes};
constexpr int32_t kSheen[kSheenNodes][kSheenNodes][3] = {{
"""


def write(path, nodes):
    whole = np.rint(nodes / UNIT).astype(int)
    lines = [" {" + ",".join(f"{{{a},{b},{albedo}}}" for a, b, albedo in row) + "}," for row in whole]
    head = HEAD.format(per=round(1 / UNIT), last=NODES - 1, nodes=NODES)
    path.write_text(head + "\n".join(lines) + "\n};\n\n} // namespace lancer\n", encoding="utf-8")


def main():
    scene, frames = new_stage()
    with tempfile.TemporaryDirectory() as folder:
        wi, light = measure(scene, frames, Path(folder))
    fit = np.full((STEPS + 1, STEPS + 1, 3), np.nan)
    for (row, roughness), (column, cosine) in itertools.product(enumerate(ROUGHNESSES), enumerate(COSINES)):
        fit[roughness, cosine] = solve(wi[:, column], light[:, row, column])
    write(Path(sys.argv[1]), nodes_of(fit))


if __name__ == "__main__":
    main()
