"""Motion blur: what moves within the shutter, and how the shutter opens."""

import math

import bpy

from .. import parts
from ..moving import animate, open_shutter
from .catalogue import case, variants
from .nodes import material, shader
from .stages import camera, floor, lamp, sky


def _block(scene, size=1.2):
    surface = shader("ShaderNodeBsdfDiffuse", Color=(0.85, 0.3, 0.15))
    return parts.place(scene, "Block", parts.cube_mesh("Block", size), surface, (0, 0, 0.8))


def _stage(scene):
    floor(scene)
    lamp(scene)
    sky(scene)
    return camera(scene, (0, -5, 2.2), (0, 0, 0.7))


def _slides(thing):
    animate(thing, "location", (-1.5, 0, 0.8), (1.5, 0.4, 1.1))


@case(quick=True)
def motion_object_slides(scene):
    """With its shadow and its reflected light."""
    _stage(scene)
    _slides(_block(scene))
    open_shutter(scene)


@case()
def motion_object_turns(scene):
    _stage(scene)
    animate(_block(scene), "rotation_euler", (0, 0, 0), (0, 2.6, 1.4))
    open_shutter(scene)


@case()
def motion_object_turns_in_steps(scene):
    """More than a full turn: 17 keys."""
    _stage(scene)
    thing = _block(scene)
    animate(thing, "rotation_euler", (0, 0, 0), (0, 9.0, 0))
    thing.cycles.motion_steps = 4
    open_shutter(scene)


@case()
def motion_object_grows(scene):
    _stage(scene)
    animate(_block(scene), "scale", (0.4, 1.0, 1.0), (2.0, 1.0, 0.3))
    open_shutter(scene)


@case()
def motion_object_of_a_parent(scene):
    _stage(scene)
    pivot = bpy.data.objects.new("Pivot", None)
    scene.collection.objects.link(pivot)
    pivot.location = (0, 0, 0.8)
    thing = _block(scene, 0.8)
    thing.parent, thing.location = pivot, (1.2, 0, 0)
    animate(pivot, "rotation_euler", (0, 0, 0), (0.3, 2.4, 0))
    open_shutter(scene)


@case()
def motion_instances(scene):
    """A collection instance that turns, of two objects of which one moves by itself."""
    _stage(scene)
    hidden = bpy.data.collections.new("Pair")
    for index in range(2):
        thing = _block(scene, 0.7)
        scene.collection.objects.unlink(thing)
        hidden.objects.link(thing)
        thing.location = (1.4 * index - 0.7, 0, 0)
        if index:
            animate(thing, "location", (0.7, 0, -0.4), (0.7, 0, 0.8))
    empty = bpy.data.objects.new("Both", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", hidden
    scene.collection.objects.link(empty)
    empty.location = (0, 0, 0.9)
    animate(empty, "rotation_euler", (0, 0, 0), (0, 0, 1.2))
    open_shutter(scene)


@case()
def motion_particles(scene):
    """Particles that fall; Blender's cache keeps the frames around."""
    _stage(scene)
    block = _block(scene, 0.5)
    block.location = (40, 0, 0)
    source = parts.place(scene, "Source", parts.plane_mesh("Source", 2.0), None, (0, 0, 2.2))
    source.modifiers.new("Rain", "PARTICLE_SYSTEM")
    settings = source.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 12, 1, 1, 50
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", block, 0.8
    settings.physics_type = "NEWTON"
    settings.normal_factor = 1.0
    for frame in range(1, 9):
        scene.frame_set(frame)
    open_shutter(scene)
    scene.frame_set(6)


@case()
def motion_deformation(scene):
    """Shape keys, with smooth normals that turn."""
    _stage(scene)
    thing = parts.place(
        scene, "Ball", parts.sphere_mesh("Ball", 32, 16, 0.7), shader("ShaderNodeBsdfGlossy", Roughness=0.4), (0, 0, 0.8)
    )
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Bent")
    for point in key.data:
        point.co.x += 1.2 * point.co.z * abs(point.co.z) + 0.4
    animate(key, "value", 0.0, 1.0)
    open_shutter(scene)


@case()
def motion_deformation_off(scene):
    _stage(scene)
    thing = _block(scene)
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Bent")
    for point in key.data:
        point.co.x += point.co.z
    animate(key, "value", 0.0, 1.0)
    thing.cycles.use_deform_motion = False
    animate(thing, "location", (0, 0, 0.8), (0.6, 0, 0.8))
    open_shutter(scene)


@case()
def motion_deformation_by_armature(scene):
    _stage(scene)
    thing = parts.place(
        scene, "Column", parts.cube_mesh("Column", 0.5), shader("ShaderNodeBsdfDiffuse", Color=(0.2, 0.6, 0.8)), (0, 0, 0)
    )
    mesh = thing.data
    for vertex in mesh.vertices:
        vertex.co.z = 0.25 if vertex.co.z < 0 else 2.0
    bones = bpy.data.objects.new("Bones", bpy.data.armatures.new("Bones"))
    scene.collection.objects.link(bones)
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.mode_set(mode="EDIT")
    bone = bones.data.edit_bones.new("Top")
    bone.head, bone.tail = (0, 0, 0.5), (0, 0, 2.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    group = thing.vertex_groups.new(name="Top")
    group.add([v.index for v in mesh.vertices if v.co.z > 1.0], 1.0, "REPLACE")
    thing.modifiers.new("Bones", "ARMATURE").object = bones
    pose = bones.pose.bones["Top"]
    pose.rotation_mode = "XYZ"
    for frame, angle in ((0, -0.6), (2, 0.8)):
        pose.rotation_euler = (0, 0, 0)
        pose.rotation_euler[2] = angle
        pose.rotation_euler[0] = angle
        pose.keyframe_insert("rotation_euler", frame=frame)
    open_shutter(scene)


@case()
def motion_object_switched_off(scene):
    _stage(scene)
    thing = _block(scene)
    _slides(thing)
    thing.cycles.use_motion_blur = False
    open_shutter(scene)


@variants(values={"start": "START", "end": "END"})
def motion_position(scene, position):
    _stage(scene)
    _slides(_block(scene))
    open_shutter(scene, position=position)


@case()
def motion_shutter_curve(scene):
    _stage(scene)
    _slides(_block(scene))
    open_shutter(scene)
    mapping = scene.render.motion_blur_shutter_curve
    mapping.initialize()
    points = mapping.curves[0].points
    points[0].location, points[len(points) - 1].location = (0, 0), (1, 1)
    mapping.update()


@variants(values={"": 0.3, "alone": 0.0})
def motion_rolling_shutter(scene, duration):
    _stage(scene)
    _slides(_block(scene))
    open_shutter(scene)
    scene.cycles.rolling_shutter_type, scene.cycles.rolling_shutter_duration = "TOP", duration


@case(quick=True)
def motion_camera_flies(scene):
    eye = _stage(scene)
    _block(scene)
    animate(eye, "location", (-0.7, -5, 2.0), (0.7, -4.5, 2.4))
    open_shutter(scene)


@case()
def motion_camera_turns(scene):
    eye = _stage(scene)
    _block(scene)
    turn = eye.rotation_euler.copy()
    animate(eye, "rotation_euler", (turn.x, turn.y, turn.z - 0.2), (turn.x, turn.y + 0.15, turn.z + 0.2))
    open_shutter(scene)


@case()
def motion_camera_zooms(scene):
    eye = _stage(scene)
    _block(scene)
    animate(eye.data, "lens", 35.0, 80.0)
    open_shutter(scene)


@case()
def motion_camera_with_lens(scene):
    """Depth of field and motion use different numbers of a sample."""
    eye = _stage(scene)
    _slides(_block(scene))
    eye.data.dof.use_dof, eye.data.dof.focus_distance, eye.data.dof.aperture_fstop = True, 3.0, 0.3
    animate(eye, "location", (-0.3, -5, 2.2), (0.3, -5, 2.2))
    open_shutter(scene)


@case()
def motion_panorama(scene):
    eye = _stage(scene)
    _block(scene)
    eye.location = (0, -1.5, 1.0)
    eye.data.type = "PANO"
    owner = eye.data if hasattr(eye.data, "panorama_type") else eye.data.cycles
    owner.panorama_type = "EQUIRECTANGULAR"
    animate(eye, "location", (-0.4, -1.8, 1.0), (0.4, -1.8, 1.0))
    open_shutter(scene)


@case()
def motion_emitter(scene):
    """A shining block that turns and slides: its light is that of all its places."""
    floor(scene)
    camera(scene, (0, -5, 2.2), (0, 0, 0.7))
    glow = shader("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=12.0)
    thing = parts.place(scene, "Glow", parts.cube_mesh("Glow", 0.6), glow, (0, 0, 1.0))
    _slides(thing)
    animate(thing, "rotation_euler", (0, 0, 0), (1.0, 2.0, 0.5))
    open_shutter(scene)


@case()
def motion_coordinates(scene):
    """Object and generated coordinates move with the object, those of the world do not."""
    _stage(scene)
    thing = _block(scene)

    def paint(nodes):
        place, where = nodes.add("ShaderNodeNewGeometry"), nodes.add("ShaderNodeTexCoord")
        of_world = nodes.add("ShaderNodeTexChecker", Scale=2.0, Vector=place.outputs["Position"])
        return nodes.add(
            "ShaderNodeBsdfDiffuse",
            Color=nodes.add("ShaderNodeTexChecker", Scale=3.0, Vector=where.outputs["Object"], Color1=of_world),
        )

    thing.data.materials[0] = material(paint)
    _slides(thing)
    animate(thing, "rotation_euler", (0, 0, 0), (0, 1.0, 0.8))
    open_shutter(scene)


@case()
def motion_mirrored(scene):
    """A mirrored object turns without passing through a flat one."""
    _stage(scene)
    thing = _block(scene)
    thing.scale = (-1.0, 1.0, 0.7)
    animate(thing, "rotation_euler", (0.3, 0, 0), (0.3, 0, math.pi * 0.8))
    open_shutter(scene)


@case()
def motion_glass(scene):
    """Refraction, reflection and shadow of a ball that moves, before a striped wall."""
    floor(scene)
    sky(scene, (0.7, 0.8, 1.0), 1.0)
    camera(scene, (0, -5, 2.2), (0, 0, 0.7))
    ball = parts.place(
        scene, "Ball", parts.sphere_mesh("Ball", 48, 24, 0.7), shader("ShaderNodeBsdfGlass", Roughness=0.0), (0, 0, 0.8)
    )
    for index in range(4):
        stripe = shader("ShaderNodeBsdfDiffuse", Color=(0.9 - 0.2 * index, 0.2 + 0.2 * index, 0.3))
        parts.place(scene, f"Stripe {index}", parts.cube_mesh("Stripe", 0.8), stripe, (1.5 * index - 2.2, 2.2, 0.7))
    ball.visible_diffuse = False
    _slides(ball)
    open_shutter(scene)
