"""Hilly meshes with fins that show their shading normals as colours: the difference between the pictures of both engines."""

import math
import random

import bpy
import numpy as np
import stage

_SIDE = 5  # vertices along each side
_SEEDS = (1, 2, 3)
_STEP = 1.0 / 255.0

KINDS = {
    "smooth": {},
    "flat": {"flat": 1.0},
    "flat beside smooth": {"flat": 0.4},
    "hard edges": {"hard": 0.3},
    "hard edges alone": {"hard": 1.0},
    "flat, hard edges": {"flat": 0.3, "hard": 0.2},
    "user's": {"custom": "turned"},
    "user's, flat, hard edges": {"custom": "turned", "flat": 0.3, "hard": 0.2},
    "divided": {"flat": 0.4, "divided": True},
    "divided, hard edges": {"flat": 0.3, "hard": 0.2, "divided": True},
}
if bpy.app.version < (4, 1):
    KINDS |= {f"{name}, auto smooth": {**fields, "auto": True} for name, fields in KINDS.items()}
if bpy.app.version >= (4, 5):
    KINDS |= {f"user's, of each {domain.lower()}": {"custom": domain, "flat": 0.3} for domain in ("CORNER", "POINT", "FACE")}


def _hills(chance, fins):
    """Return vertices, and faces of three and four corners, no four in a plane; fins share an edge with two faces each."""
    vertices = [(x, y, chance.uniform(0.0, 0.6)) for y in range(_SIDE) for x in range(_SIDE)]
    faces = []
    for y in range(_SIDE - 1):
        for x in range(_SIDE - 1):
            a = y * _SIDE + x
            quad = (a, a + 1, a + _SIDE + 1, a + _SIDE)
            faces += [quad] if chance.random() < 0.6 else [quad[:3], (quad[0], *quad[2:])]
    edges = [(a, a + 1) for a in range(_SIDE, _SIDE * (_SIDE - 1)) if (a + 1) % _SIDE]
    for a, b in chance.sample(edges, 5) if fins else ():
        n = len(vertices)
        vertices += [(vertices[a][0] + 0.2, vertices[a][1] + 0.9, 1.0), (vertices[b][0] + 0.2, vertices[b][1] + 0.9, 1.2)]
        faces.append((a, b, n + 1, n))
    chance.shuffle(faces)
    return vertices, faces


def _near_up(chance):
    """Return a unit vector on the front side of every face here."""
    vector = np.array([chance.uniform(-0.3, 0.3), chance.uniform(-0.3, 0.3), 1.0])
    return tuple(vector / np.linalg.norm(vector))


def _add(seed, material, fins, flat=0.0, hard=0.0, custom=None, divided=False, auto=False):
    chance = random.Random(seed)
    vertices, faces = _hills(chance, fins)
    item = stage.mesh(f"Hills {seed}", vertices, faces, material, location=(5.0 * seed, 0, 0))
    mesh = item.data
    mesh.polygons.foreach_set("use_smooth", [chance.random() >= flat for _ in faces])
    for edge in mesh.edges:
        if chance.random() < hard:
            edge.use_edge_sharp = True
    if auto or (custom and hasattr(mesh, "use_auto_smooth")):
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(40.0)
    if custom == "turned":
        mesh.normals_split_custom_set([_near_up(chance) for _ in mesh.loops])
    elif custom:
        for value in mesh.attributes.new("custom_normal", "FLOAT_VECTOR", custom).data:
            value.vector = _near_up(chance)
    mesh.update()
    if divided:
        modifier = item.modifiers.new("Subdivision", "SUBSURF")
        modifier.levels = modifier.render_levels = 2


def _shown():
    """Return a material that emits its normal, halved and raised so that no component is negative."""
    material = stage.shader("ShaderNodeEmission")
    tree = material.node_tree
    geometry, halved = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeVectorMath")
    halved.operation = "MULTIPLY_ADD"
    halved.inputs[1].default_value = halved.inputs[2].default_value = (0.5, 0.5, 0.5)
    tree.links.new(geometry.outputs["Normal"], halved.inputs[0])
    tree.links.new(halved.outputs[0], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Color"])
    return material


def _difference(kind, fins):
    """Return [share of the pixels of hills that differ by more than a step of 8 bits, number of pixels of hills]."""
    scene = stage.empty(180, 60, 1)
    material = _shown()
    for seed in _SEEDS:
        _add(seed, material, fins, **KINDS[kind])
    # No centre of a pixel, through which its only ray passes, lies on an edge of the grid.
    camera = stage.camera((12.0137, 2.0291, 20), (0, 0, 0), type="ORTHO", ortho_scale=14.8731)
    camera.rotation_euler = (0, 0, 0)
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.pixel_filter_type, cycles.filter_width = 1, False, "BLACKMAN_HARRIS", 0.01
    scene.lancer.pixel_filter, scene.lancer.filter_width = "BLACKMAN_HARRIS", 0.01
    pictures = []
    for engine in ("CYCLES", "LANCER"):
        scene.render.engine = engine
        pictures.append(stage.picture(scene)[:, :, :3])
    seen = pictures[0].max(axis=2) > 0.0
    far = np.abs(pictures[0] - pictures[1]).max(axis=2)[seen] > _STEP
    return [float(far.mean()), int(seen.sum())]


def shaded(fins):
    """Return {kind: result of _difference}; fins: "yes" or "no"."""
    return {kind: _difference(kind, fins == "yes") for kind in KINDS}
