"""Cycles' values of shader nodes: under a white sky, and exactly under suns, cell by cell of one picture.

Each cell is a small plane turned about y, seen from straight above; its shading frame is tangent (cos, 0, -sin), bitangent y
and normal (sin, 0, cos) of that angle. Only camera rays hit the planes, so that no plane lights or shades another.
"""

import json
import math

import bpy
import numpy as np
import stage
from mathutils import Vector

PIXELS = 6


def _socket(node, name):
    """Return the enabled socket of that name; disabled sockets may have the same name."""
    found = [s for s in node.inputs if s.name == name and s.enabled]
    assert found, f"{node.bl_idname} has no input {name}: {[s.name for s in node.inputs if s.enabled]}"
    return found[0]


def _material(spec):
    material = bpy.data.materials.new("Cell")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new(spec["node"]), tree.nodes.new("ShaderNodeOutputMaterial")
    for name, value in spec.get("properties", {}).items():
        setattr(node, name, value)
    for name, value in spec.get("inputs", {}).items():
        _socket(node, name).default_value = (*value, 1.0) if isinstance(value, list) else value
    if spec.get("tangent"):
        tangent = tree.nodes.new("ShaderNodeTangent")
        tangent.direction_type, tangent.uv_map = "UV_MAP", "UV"
        tree.links.new(tangent.outputs[0], _socket(node, "Tangent"))
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def _cells(specs, angles):
    vertices, faces, uvs = [], [], []
    for row in range(len(specs)):
        for column, angle in enumerate(angles):
            first = len(vertices)
            for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
                vertices.append((column + x, row + y, -(x - 0.5) * math.tan(math.radians(angle))))
                uvs += [x, y]
            faces.append(range(first, first + 4))
    item = stage.mesh("Cells", vertices, faces)
    item.data.uv_layers.new(name="UV").data.foreach_set("uv", uvs)
    for spec in specs:
        item.data.materials.append(_material(spec))
    item.data.polygons.foreach_set("material_index", [i // len(angles) for i in range(len(faces))])
    for ray in ("diffuse", "glossy", "transmission", "shadow", "volume_scatter"):
        setattr(item, "visible_" + ray, False)


def _cell_means(scene, rows, columns):
    picture = stage.picture(scene)[..., :3].astype(np.float64)
    return picture.reshape(rows, PIXELS, columns, PIXELS, 3).mean(axis=(1, 3))


def version():
    return list(bpy.app.version[:2])


def _open(path):
    """The scene of a file with specs (node, inputs, properties, tangent) and angles in degrees; the file; rows and columns."""
    with open(path, encoding="utf-8") as file:
        asked = json.load(file)
    specs, angles = asked["specs"], asked["angles"]
    rows, columns = len(specs), len(angles)
    scene = stage.empty(columns * PIXELS, rows * PIXELS, engine="CYCLES")
    cycles = scene.cycles
    cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", False, False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.1
    cycles.use_light_tree = False
    _cells(specs, angles)
    eye = stage.camera((columns / 2, rows / 2, 100.0), (columns / 2, rows / 2, 0.0), type="ORTHO", clip_end=1000.0)
    eye.rotation_euler = (0.0, 0.0, 0.0)
    eye.data.ortho_scale = max(rows, columns)
    return scene, asked, rows, columns


def suns(path):
    """Returns f cos under irradiance 1, [sun][spec][angle][rgb], of the file's suns, which are unit vectors to them."""
    scene, asked, rows, columns = _open(path)
    # Suns without a disk: one sample has the exact value.
    scene.cycles.samples, scene.cycles.max_bounces = 1, 0
    sun = stage.light("SUN", 1.0, angle=0.0)
    sun.rotation_mode = "QUATERNION"
    found = []
    for direction in asked["suns"]:
        sun.rotation_quaternion = Vector(direction).to_track_quat("Z", "Y")
        found.append(_cell_means(scene, rows, columns).tolist())
    return {"sun": found}


def sky(path):
    """Returns the light under a white sky, [spec][angle][rgb], and its standard error, of the file's samples."""
    scene, asked, rows, columns = _open(path)
    stage.sky((1.0, 1.0, 1.0))
    scene.cycles.samples, scene.cycles.max_bounces = asked["samples"], 1
    skies = []
    for seed in range(4):
        scene.cycles.seed = seed
        skies.append(_cell_means(scene, rows, columns))
    noise = np.std(skies, axis=0, ddof=1) / 2
    return {"sky": np.mean(skies, axis=0).tolist(), "noise": noise.tolist()}
