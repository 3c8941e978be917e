"""Scenes that move while the shutter is open: a running figure, and the camera's flight through the wood."""

import math

import bpy
import numpy as np
from mathutils import Vector

from . import outdoors, parts, pictures

_FIRST, _RENDERED, _LAST = 0, 1, 2
# Bones of the figure: head, tail, radius, parent, and the angles about x in the first and in the last frame.
_BONES = {
    "Hip": ((0, 0, 1.0), (0, 0, 1.25), 0.22, None, (0.1, 0.2)),
    "Chest": ((0, 0, 1.25), (0, 0, 1.75), 0.27, "Hip", (-0.1, 0.05)),
    "Head": ((0, 0, 1.85), (0, 0, 2.2), 0.2, "Chest", (0.0, -0.15)),
    "Thigh.L": ((-0.15, 0, 1.0), (-0.15, 0, 0.55), 0.13, "Hip", (-0.9, 0.3)),
    "Shin.L": ((-0.15, 0, 0.55), (-0.15, 0, 0.08), 0.1, "Thigh.L", (0.4, 1.1)),
    "Thigh.R": ((0.15, 0, 1.0), (0.15, 0, 0.55), 0.13, "Hip", (0.6, -0.6)),
    "Shin.R": ((0.15, 0, 0.55), (0.15, 0, 0.08), 0.1, "Thigh.R", (1.2, 0.3)),
    "Arm.L": ((-0.3, 0, 1.65), (-0.38, 0, 1.25), 0.08, "Chest", (0.7, -0.5)),
    "Hand.L": ((-0.38, 0, 1.25), (-0.4, 0, 0.9), 0.07, "Arm.L", (-0.9, -0.6)),
    "Arm.R": ((0.3, 0, 1.65), (0.38, 0, 1.25), 0.08, "Chest", (-0.6, 0.6)),
    "Hand.R": ((0.38, 0, 1.25), (0.4, 0, 0.9), 0.07, "Arm.R", (-0.6, -0.9)),
}


def animate(owner, path, first, last):
    """Moves a property from one value to another within the frames 0 to 2, at constant speed."""
    for frame, value in ((_FIRST, first), (_LAST, last)):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)
    for curve in _curves(owner.id_data.animation_data.action):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def _curves(action):
    if bpy.app.version < (4, 4):
        return action.fcurves
    return action.layers[0].strips[0].channelbags[0].fcurves


def open_shutter(scene, frames=1.0, position=None):
    """Blurs frame 1. position: CENTER, START or END."""
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = frames
    if position is not None:
        owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
        owner.motion_blur_position = position
    scene.frame_set(_RENDERED)


def build_runner(scene):
    """A figure of 146 432 triangles that an armature bends, running past columns under an image of a sky."""
    parts.set_size(scene, 512, 384, 32)
    figure = _figure(scene)
    animate(figure, "location", (-0.25, 0, 0), (0.25, 0, 0))
    stone = outdoors.textured("Stone", pictures.grain("Stone", (0.6, 0.58, 0.55)), 0.8)
    outdoors.wear_out(stone)
    column = parts.lathe_mesh("Column", [(0.0, 0.0), (0.4, 0.0), (0.35, 0.2), (0.3, 0.4), (0.27, 3.4), (0.4, 3.6), (0.0, 3.6)])
    for index in range(7):
        parts.place(scene, "Column", column, stone, (2.0 * index - 6.0, 2.2, 0))
    floor = parts.plane_mesh("Floor", 30.0)
    outdoors.flat_uvs(floor)
    parts.place(scene, "Floor", floor, outdoors.textured("Tiles", pictures.cloth("Tiles", cells=24), 0.6))
    outdoors.set_sky(scene, pictures.sky())
    parts.add_light(scene, "Sun", "SUN", 2.5, (4, -5, 6), (0, 0, 1), angle=math.radians(2.0))
    parts.add_camera(scene, (1.2, -4.6, 1.5), (0, 0, 1.1), lens=38.0)
    open_shutter(scene, 0.5)


def _figure(scene):
    """Returns the rig, whose object carries the figure."""
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, (head, tail, _, parent, _) in _BONES.items():
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = head, tail
        if parent:
            bone.parent = rig.data.edit_bones[parent]
    bpy.ops.object.mode_set(mode="OBJECT")
    body = parts.place(scene, "Body", _body(), outdoors.textured("Cloth", pictures.cloth(), 0.5))
    start = 0
    for name, (head, tail, radius, _, _) in _BONES.items():
        count = len(_limb(head, tail, radius)[0])
        body.vertex_groups.new(name=name).add(list(range(start, start + count)), 1.0, "REPLACE")
        start += count
    body.parent = rig
    body.modifiers.new("Rig", "ARMATURE").object = rig
    for name, (*_, angles) in _BONES.items():
        pose = rig.pose.bones[name]
        pose.rotation_mode = "XYZ"
        animate(pose, "rotation_euler", (angles[0], 0, 0), (angles[1], 0, 0))
    rig.rotation_euler = (0, 0, math.radians(90))
    return rig


def _body():
    points, faces, uvs = [], [], []
    for head, tail, radius, *_ in _BONES.values():
        own, corners, places = _limb(head, tail, radius)
        faces += (corners + sum(map(len, points))).tolist()
        points.append(own)
        uvs.append(places)
    mesh = parts.mesh_from_points("Body", np.concatenate(points).tolist(), faces)
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), True))
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", np.concatenate(uvs).astype(np.float32).ravel())
    return mesh


def _limb(head, tail, radius, segments=104, rings=64):
    """Returns (points, quads, UVs of corners) of a spindle along a bone, open at its thin ends."""
    turns, along = np.arange(segments) * (2 * math.pi / segments), np.linspace(0.0, 1.0, rings + 1)
    axis = Vector(tail) - Vector(head)
    length = axis.length + radius
    # Across the bone: x, and the direction upright to both.
    side = Vector((1, 0, 0))
    across = axis.cross(side).normalized()
    side = across.cross(axis).normalized()
    width = radius * np.sqrt(np.maximum(1.0 - (2.0 * along - 1.0) ** 4, 1e-4))
    ring = np.cos(turns)[:, None] * np.array(side) + np.sin(turns)[:, None] * np.array(across)
    way = np.array(head) + ((along * length - radius / 2) / axis.length)[:, None] * np.array(axis)
    points = way[:, None, :] + width[:, None, None] * ring
    i, j = np.meshgrid(np.arange(rings), np.arange(segments), indexing="ij")
    after = (j + 1) % segments
    quads = np.stack([i * segments + j, i * segments + after, (i + 1) * segments + after, (i + 1) * segments + j], -1)
    u, v = np.stack([j, j + 1, j + 1, j], -1) / segments, np.stack([i, i, i + 1, i + 1], -1) / rings
    return points.reshape(-1, 3), quads.reshape(-1, 4), np.stack([u, v], -1).reshape(-1, 2)


def build_flight(scene):
    """The wood of foliage while the camera flies and turns."""
    outdoors.build_foliage(scene)
    camera = scene.camera
    turn = camera.rotation_euler.copy()
    animate(camera, "location", camera.location - Vector((0.3, 0.6, 0.0)), camera.location + Vector((0.3, 0.6, 0.1)))
    animate(camera, "rotation_euler", (turn.x, turn.y, turn.z + 0.05), (turn.x, turn.y, turn.z - 0.05))
    open_shutter(scene, 0.5)
