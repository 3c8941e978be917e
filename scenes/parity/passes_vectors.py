"""The pass Vector: what moves from the frame before to the frame after, frame 1 being rendered."""

import math

import bpy

from .. import parts
from ..moving import animate
from .catalogue import case, variants
from .nodes import shader
from .stages import camera, displace, sky

_LIMITS = {
    "limit": (0.01, 6e-3),
    "reason": "samples lie up to 0.005 pixels off the middle, and vectors of what turns or comes near change by up to half of "
    "themselves from pixel to pixel: 0.25 %, and noise may be a third of a limit; of the pixels on outlines, a hundredth of "
    "all, some show the object in one picture alone",
}
_PIXELS = {"passes": ("Vector",), "filter_width": 0.01, "bounces": 0, "samples": 64, **_LIMITS}
# From 4.3 to 5.1 Cycles projects the other frames of an orthographic camera as those of a perspective one.
_BROKEN_ORTHO = (4, 3) <= bpy.app.version[:2] < (5, 2)


def _block(scene, size=1.2, location=(0, 0, 0.8)):
    surface = shader("ShaderNodeBsdfDiffuse", Color=(0.85, 0.3, 0.15))
    return parts.place(scene, "Block", parts.cube_mesh("Block", size), surface, location, rotation=(0.1, 0.2, 0.4))


def _slides(thing, first=(-0.6, 0, 0.7), last=(0.6, 0.3, 0.9)):
    animate(thing, "location", first, last)


def _ball(scene, location=(0, 0, 0.8)):
    surface = shader("ShaderNodeBsdfGlossy", Roughness=0.2)
    return parts.place(scene, "Ball", parts.sphere_mesh("Ball", 32, 16, 0.7), surface, location)


def _stage(scene, **fields):
    """Without a floor: Cycles gives what stands still vectors of some 1e-5 pixels, where Lancer's are 0."""
    sky(scene)
    return camera(scene, (0, -5, 2.2), (0, 0, 0.7), **fields)


def _ground(scene):
    """A floor and a block that stand, for cameras that move."""
    surface = shader("ShaderNodeBsdfDiffuse", Color=(0.5, 0.45, 0.4))
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 12.0), surface)
    _block(scene)


def moves(quick=False, **fields):
    """Enters the scene under its name, with the frame that is rendered."""

    def enter(build):
        def at_frame(scene):
            build(scene)
            scene.frame_set(1)

        at_frame.__module__, at_frame.__doc__ = build.__module__, build.__doc__
        case("PIXELS", name=f"vector_{build.__name__}", quick=quick, **{**_PIXELS, **fields})(at_frame)
        return build

    return enter


@moves(quick=True)
def object_slides(scene):
    _stage(scene)
    _slides(_block(scene))


@moves()
def object_turns_and_grows(scene):
    _stage(scene)
    thing = _block(scene)
    animate(thing, "rotation_euler", (0, 0, 0), (0, 1.1, 0.7))
    animate(thing, "scale", (0.8, 1.0, 1.0), (1.3, 1.0, 0.7))


@moves()
def object_of_a_parent(scene):
    _stage(scene)
    pivot = bpy.data.objects.new("Pivot", None)
    scene.collection.objects.link(pivot)
    pivot.location = (0, 0, 0.8)
    thing = _block(scene, 0.8)
    thing.parent, thing.location = pivot, (0.8, 0, 0)
    animate(pivot, "rotation_euler", (0, 0, 0), (0.3, 1.2, 0))


@moves()
def object_switched_off(scene):
    """The switches of motion blur do not count."""
    _stage(scene)
    for thing in (_block(scene, 0.7), _ball(scene)):
        _slides(thing)
        thing.cycles.use_motion_blur = thing.cycles.use_deform_motion = False


@moves()
def instances(scene):
    """A collection instance that turns, of two objects of which one moves by itself."""
    _stage(scene)
    hidden = bpy.data.collections.new("Pair")
    for index in range(2):
        thing = _block(scene, 0.7)
        scene.collection.objects.unlink(thing)
        hidden.objects.link(thing)
        thing.location = (1.4 * index - 0.7, 0, 0)
        if index:
            animate(thing, "location", (0.7, 0, -0.4), (0.7, 0, 0.5))
    empty = bpy.data.objects.new("Both", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", hidden
    scene.collection.objects.link(empty)
    empty.location = (0, 0, 0.9)
    animate(empty, "rotation_euler", (0, 0, 0), (0, 0, 0.6))


@moves()
def particles(scene):
    """Particles that fall, none of which begins or ends in a frame around."""
    _stage(scene)
    block = _block(scene, 0.5)
    block.location = (40, 0, 0)
    source = parts.place(scene, "Source", parts.plane_mesh("Source", 2.0), None, (0, 0, 1.0))
    source.show_instancer_for_render = False
    source.modifiers.new("Rain", "PARTICLE_SYSTEM")
    source.particle_systems[0].point_cache.frame_start = -5
    settings = source.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 12, -4, -4, 50
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", block, 0.8
    settings.physics_type = "NEWTON"
    settings.normal_factor = 1.0
    for frame in range(-5, 3):
        scene.frame_set(frame)


def _bent(scene):
    thing = _ball(scene)
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Bent")
    for point in key.data:
        point.co.x += 0.6 * point.co.z * abs(point.co.z) + 0.2
    animate(key, "value", 0.0, 1.0)
    return thing


@moves(quick=True)
def shape(scene):
    """Shape keys of a ball that also slides."""
    _stage(scene)
    _slides(_bent(scene))


@moves()
def shape_by_modifier(scene):
    _stage(scene)
    thing = _ball(scene)
    bend = thing.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.deform_axis = "TWIST", "Z"
    animate(bend, "factor", -0.2, 0.3)


@moves()
def shape_displaced(scene):
    """The places before and after are displaced as the place now."""
    _stage(scene)
    thing = _bent(scene)
    _slides(thing)

    surface = shader("ShaderNodeBsdfDiffuse", Color=(0.4, 0.5, 0.6))
    tree = surface.node_tree
    lift = tree.nodes.new("ShaderNodeDisplacement")
    lift.inputs["Height"].default_value = 0.7
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(lift.outputs["Displacement"], output.inputs["Displacement"])
    displace(surface, "DISPLACEMENT")
    thing.data.materials[0] = surface


@moves(announced="the number of its vertices changes from frame to frame")
def shape_of_other_vertices(scene):
    """Another number of vertices one frame after: there the ball keeps its shape, and before it does not."""
    _stage(scene)
    thing = _bent(scene)
    _slides(thing)
    copies = thing.modifiers.new("Copies", "ARRAY")
    copies.use_relative_offset, copies.use_constant_offset = False, True
    copies.constant_offset_displace = (0, 0, 0.3)
    for frame, count in ((0, 1), (1, 1), (2, 2)):
        copies.count = count
        copies.keyframe_insert("count", frame=frame)


@moves(quick=True)
def camera_flies(scene):
    """Since Blender 5.2 the sky has vectors too."""
    eye = _stage(scene)
    _ground(scene)
    turn = eye.rotation_euler.copy()
    animate(eye, "location", (-0.4, -5, 2.0), (0.4, -4.7, 2.3))
    animate(eye, "rotation_euler", (turn.x - 0.02, turn.y, turn.z - 0.06), (turn.x, turn.y + 0.05, turn.z + 0.06))


@moves()
def camera_zooms(scene):
    """Counted since Blender 4.3, with a shift; the block moves in every Blender."""
    eye = _stage(scene, shift_x=0.1)
    _slides(_block(scene))
    animate(eye.data, "lens", 45.0, 60.0)


@moves()
def camera_shifts(scene):
    """A shift counts in no Blender."""
    eye = _stage(scene)
    _slides(_block(scene))
    animate(eye.data, "shift_x", -0.1, 0.1)


@moves()
def camera_switched_off(scene):
    eye = _stage(scene)
    _slides(_block(scene))
    animate(eye, "location", (-0.4, -5, 2.0), (0.4, -4.7, 2.3))
    eye.cycles.use_motion_blur = False


@moves()
def camera_border(scene):
    eye = _stage(scene)
    _ground(scene)
    animate(eye, "location", (-0.4, -5, 2.0), (0.4, -4.7, 2.3))
    render = scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.125, 0.875


# Since 5.0 Blender cannot write two passes of pixels that are not square.
@moves(until=(5, 0))
def camera_of_oblong_pixels(scene):
    _stage(scene)
    _slides(_block(scene))
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1.0, 1.7


@moves()
def orthographic(scene):
    """Neither its scale nor the object's switches count."""
    eye = _stage(scene, type="ORTHO", ortho_scale=4.0)
    thing = _block(scene)
    _slides(thing)
    animate(thing, "rotation_euler", (0, 0, 0), (0, 1.1, 0.7))
    animate(eye.data, "ortho_scale", 3.9, 4.1)


@moves(needs=lambda: "Cycles shows a perspective view of the frames around" if _BROKEN_ORTHO else "")
def orthographic_camera_flies(scene):
    eye = _stage(scene, type="ORTHO", ortho_scale=4.0)
    _ground(scene)
    turn = eye.rotation_euler.copy()
    animate(eye, "location", (-0.4, -5, 2.0), (0.4, -4.7, 2.3))
    animate(eye, "rotation_euler", (turn.x, turn.y, turn.z - 0.06), (turn.x, turn.y, turn.z + 0.06))


@variants(
    "PIXELS",
    values={
        "equirectangular": ("EQUIRECTANGULAR", {}),
        "fisheye_equidistant": ("FISHEYE_EQUIDISTANT", {}),
        "fisheye_equisolid": ("FISHEYE_EQUISOLID", {}),
        "fisheye_polynomial": ("FISHEYE_LENS_POLYNOMIAL", {}),
        "mirror_ball": ("MIRRORBALL", {}),
        "cylindrical": ("CENTRAL_CYLINDRICAL", {"since": (4, 1)}),
    },
    **_PIXELS,
    size=(192, 128),
)
def vector_panorama(scene, kind):
    """A block moves before a camera that flies and turns."""
    eye = _stage(scene)
    _slides(_block(scene))
    eye.data.type = "PANO"
    owner = eye.data if hasattr(eye.data, "panorama_type") else eye.data.cycles
    owner.panorama_type = kind
    owner.fisheye_fov, owner.fisheye_lens = math.radians(160), 10.5
    owner.fisheye_polynomial_k1 = -0.06
    turn = eye.rotation_euler.copy()
    animate(eye, "location", (-0.2, -1.9, 1.0), (0.2, -1.7, 1.2))
    animate(eye, "rotation_euler", (turn.x, turn.y, turn.z - 0.06), (turn.x, turn.y + 0.04, turn.z + 0.06))
    scene.frame_set(1)


@moves(transparent_bounces=8)
def through_panes(scene):
    """A pane of alpha 0 shows the ball behind, one of alpha 1 itself, a mirror itself."""
    _stage(scene)
    _slides(_ball(scene))
    solid = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.7, 0.3), Alpha=1.0)
    clear = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.7, 0.3), Alpha=0.0)
    for surface, x in ((clear, -0.3), (solid, 0.9), (shader("ShaderNodeBsdfGlossy", Roughness=0.0), -1.2)):
        thing = parts.place(scene, "Pane", parts.plane_mesh("Pane", 0.6), surface, (x, -2, 1.1), rotation=(1.3, 0, 0.3))
        animate(thing, "location", (x, -2, 1.05), (x, -2, 1.2))


@moves(transparent_bounces=8)
def through_a_veil(scene):
    """Surfaces count from the alpha threshold on."""
    _stage(scene)
    _slides(_ball(scene))
    bpy.context.view_layer.pass_alpha_threshold = 0.3
    for alpha, x in ((0.25, -0.4), (0.35, 0.4)):
        surface = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.7, 0.3), Alpha=alpha)
        thing = parts.place(scene, "Veil", parts.plane_mesh("Veil", 0.7), surface, (x, -2, 1.1), rotation=(1.3, 0, 0.3))
        animate(thing, "location", (x, -2, 1.05), (x, -2, 1.2))


@case(passes=("Vector",), name="vector_lens", limit=(0.005, 0.02), reason="the kind's own limits, for a pass of signed numbers")
def _lens(scene):
    """Out of focus, a pixel has the mean of what its samples see."""
    eye = _stage(scene)
    eye.data.dof.use_dof, eye.data.dof.focus_distance, eye.data.dof.aperture_fstop = True, 3.0, 0.3
    _ground(scene)
    _slides(bpy.data.objects["Block"])
    animate(eye, "location", (-0.4, -5, 2.0), (0.4, -4.7, 2.3))
    scene.frame_set(1)
