"""Render the same scene by both engines in one Blender. The test compares the means of blocks of 8 x 8 pixels."""

import math

import bpy
import numpy as np
import stage

SIZE, BLOCK = 64, 8


def _unbiased(scene, bounces, samples):
    """Let both engines estimate the same integral: equal bounces, box filter, no clamping, adaptive sampling or denoising."""
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", samples, 1
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy, cycles.light_sampling_threshold = 0.0, 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.max_bounces = bounces
    for kind in ("diffuse", "glossy", "transmission"):
        setattr(cycles, kind + "_bounces", bounces)
    cycles.transparent_max_bounces = 32
    cycles.use_light_tree = False
    scene.lancer.quality, scene.lancer.samples = "CUSTOM", samples
    scene.lancer.max_bounces, scene.lancer.pixel_filter = bounces, "BOX"
    scene.lancer.clamp_indirect = 0.0


def _blocks(picture):
    n = SIZE // BLOCK
    return picture[..., :3].astype(np.float64).reshape(n, BLOCK, n, BLOCK, 3).mean(axis=(1, 3))


def compare(name, bounces, samples):
    scene = stage.empty(SIZE, SIZE)
    # A builder may return a function that changes the scene before Cycles renders it, where Cycles is inconsistent.
    before_cycles = globals()["_" + name]()
    if scene.camera is None:
        stage.camera()
    result = {}
    for engine in ("LANCER", "CYCLES"):
        scene.render.engine = engine
        if engine == "CYCLES" and before_cycles:
            before_cycles()
        _unbiased(scene, int(bounces), int(samples))
        pictures = []
        # Pictures with different seeds give the noise of each block.
        for seed in range(1, 5):
            scene.cycles.seed = scene.lancer.seed = seed
            pictures.append(_blocks(stage.picture(scene)))
        result[engine] = np.mean(pictures, axis=0).tolist()
        result[engine + " noise"] = (np.std(pictures, axis=0, ddof=1) / 2).tolist()
    return result


def _floor(**fields):
    stage.plane(material=stage.shader(Color=(0.8, 0.6, 0.4), **fields))


def _lambert():
    _floor()
    stage.cube(material=stage.shader(Color=(0.2, 0.5, 0.8)), location=(0, 0, 0.5))
    stage.sky((0.6, 0.7, 0.9))


def _emission():
    _floor()
    glow = stage.shader("ShaderNodeEmission", Color=(1.0, 0.8, 0.5), Strength=5.0)
    stage.cube(0.6, glow, location=(0, 0, 1.2), rotation=(0.3, 0.2, 0))
    stage.ball(0.5, stage.shader(Color=(0.9, 0.9, 0.9)), location=(1.7, 0.8, 0.5))


def _point():
    _floor()
    stage.cube(material=stage.shader(), location=(0, 0, 0.5))
    stage.light("POINT", 300.0, (2, -2, 3), shadow_soft_size=0.0)


def _soft_point():
    _floor()
    stage.cube(material=stage.shader(), location=(0, 0, 0.5))
    stage.light("POINT", 300.0, (1.5, -1, 2), shadow_soft_size=0.5)


def _spot():
    _floor()
    stage.cube(material=stage.shader(), location=(0, 0, 0.5))
    stage.light("SPOT", 500.0, (0, -1, 4), (0.25, 0, 0), spot_size=0.9, spot_blend=0.4, shadow_soft_size=0.0)


def _sun():
    _floor()
    stage.cube(material=stage.shader(), location=(0, 0, 0.5))
    stage.light("SUN", 3.0, (0, 0, 5), (0.6, 0.3, 0), angle=0.1)


def _area():
    _floor()
    stage.cube(material=stage.shader(), location=(0, 0, 0.5))
    stage.light("AREA", 100.0, (1, -1, 3), (0.4, 0.3, 0), shape="RECTANGLE", size=1.5, size_y=0.7)


def _ellipse():
    _floor()
    stage.light("AREA", 100.0, (0, 0, 2), (0.4, 0.3, 0), shape="ELLIPSE", size=1.5, size_y=0.7)


def _spread():
    _floor()
    stage.light("AREA", 100.0, (0, 0, 2.5), (0.1, 0.2, 0), shape="DISK", size=0.5, spread=math.radians(70))


def _sheared(kind, **fields):
    """A lamp turned under an empty that is scaled unevenly and turned."""
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.location, parent.scale, parent.rotation_euler = (0.4, -0.3, 2.6), (1.0, 2.5, 0.6), (0.2, 0.3, 0.1)
    lamp = stage.light(kind, 150.0, (0, 0, 0), (0.3, -0.4, 0.9), **fields)
    lamp.parent = parent
    lamp.visible_camera = False
    bpy.context.view_layer.update()
    return lamp


def _glowing_face(lamp, corners):
    """Put a mesh that shines to the lamp's front, with its power, in the lamp's place."""
    matrix = np.array(lamp.matrix_world)
    points = np.array([(x, y, 0.0, 1.0) for x, y in corners]) @ matrix[:3].T
    areas = np.cross(points[1:-1] - points[0], points[2:] - points[0])
    if areas[0] @ matrix[:3, 2] > 0.0:
        points = points[::-1]
    mesh = bpy.data.meshes.new("Face")
    mesh.from_pydata(points.tolist(), [], [list(range(len(points)))])
    strength = lamp.data.energy / (math.pi * 0.5 * np.linalg.norm(areas, axis=1).sum())
    material = stage.shader("ShaderNodeEmission", Color=(1.0, 1.0, 1.0), Strength=strength)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    mix, clear, geometry = (nodes.new("ShaderNode" + kind) for kind in ("MixShader", "BsdfTransparent", "NewGeometry"))
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    links.new(geometry.outputs["Backfacing"], mix.inputs[0])
    links.new(output.inputs["Surface"].links[0].from_socket, mix.inputs[1])
    links.new(clear.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], output.inputs["Surface"])
    mesh.materials.append(material)
    face = bpy.data.objects.new("Face", mesh)
    bpy.context.scene.collection.objects.link(face)
    face.visible_camera = face.visible_shadow = False
    bpy.data.objects.remove(lamp)


def _sheared_rectangle():
    _floor()
    lamp = _sheared("AREA", shape="RECTANGLE", size=1.5, size_y=0.7)
    corners = [(0.75 * x, 0.35 * y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return lambda: _glowing_face(lamp, corners)


def _sheared_ellipse():
    _floor()
    lamp = _sheared("AREA", shape="ELLIPSE", size=1.5, size_y=0.7)
    turns = [2.0 * math.pi * i / 128 for i in range(128)]
    return lambda: _glowing_face(lamp, [(0.75 * math.cos(turn), 0.35 * math.sin(turn)) for turn in turns])


def _sheared_spot():
    """Cycles' light tree misses a part of the cone; the tree is off here."""
    _floor()
    _sheared("SPOT", spot_size=1.2, spot_blend=0.3, shadow_soft_size=0.1)


def _mirror():
    _floor()
    stage.ball(
        0.9, stage.shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.7), Roughness=0.0), location=(0, 0, 0.9), segments=128
    )
    stage.cube(0.7, stage.shader(Color=(0.9, 0.2, 0.2)), location=(-1.6, -0.8, 0.35))
    stage.sky((0.5, 0.6, 0.8))


def _glass():
    _floor()
    stage.ball(
        0.9,
        stage.shader("ShaderNodeBsdfGlass", Color=(1.0, 1.0, 1.0), Roughness=0.0, IOR=1.45),
        location=(0, 0, 1.0),
        segments=128,
    )
    stage.cube(0.7, stage.shader(Color=(0.9, 0.2, 0.2)), location=(-1.4, 1.2, 0.35))
    stage.sky((0.7, 0.7, 0.7))


def _depth_of_field():
    _floor()
    for i in range(3):
        stage.cube(0.8, stage.shader(Color=(0.9, 0.3 * i, 0.2)), location=(i - 1.0, 1.5 * i, 0.4))
    stage.sky((0.8, 0.8, 0.8))
    eye = stage.camera()
    eye.data.dof.use_dof = True
    eye.data.dof.focus_distance, eye.data.dof.aperture_fstop = 5.0, 0.1


def _orthographic():
    _lambert()
    stage.camera(type="ORTHO", ortho_scale=5.0)


def _background():
    stage.sky((0.2, 0.4, 0.8), 2.0)
    stage.plane(2.0, stage.shader(Color=(0.5, 0.5, 0.5)))
