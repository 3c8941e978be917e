"""Cameras: each scene is judged as a picture, and a second time by the Position of every pixel's centre."""

import math

import bpy

from .. import parts
from .catalogue import case
from .nodes import shader
from .stages import sky


def _surroundings(scene):
    """Adds a floor and blocks of different colours all around the origin."""
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 12.0), shader("ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.45)))
    cube = parts.cube_mesh("Block", 1.0)
    for index in range(9):
        turn = 2 * math.pi * index / 9
        color = (0.5 + 0.4 * math.cos(turn), 0.5, 0.5 + 0.4 * math.sin(turn))
        place = ((2.2 + 0.15 * index) * math.sin(turn), (2.2 + 0.15 * index) * math.cos(turn), 0.5)
        surface = shader("ShaderNodeBsdfDiffuse", Color=color)
        parts.place(scene, f"Block {index}", cube, surface, place, (0.7, 0.7, 1.0 + 0.2 * index), (0, 0, 0.5 * index))
    sky(scene, (0.7, 0.8, 1.0), 1.0)


def _look(scene, location=(0, -6, 2.5), target=(0, 0, 0.6), **fields):
    _surroundings(scene)
    eye = parts.add_camera(scene, location, target)
    for name, value in fields.items():
        setattr(eye.data, name, value)
    return eye


def seen(quick=False, position=True, position_until=(99, 0), finer=12, **fields):
    """Enters the scene twice: its picture, and its positions in a picture many times finer.

    Cycles keeps the position of one sample, which lies within 0.005 pixels of the middle: in a coarse picture this offset
    alone
    is 1e-4 of the distance where a floor is seen at a grazing angle; in the finer one it is less than a third of that."""

    def enter(build):
        case(name=f"camera_{build.__name__}", quick=quick, bounces=1, **fields)(build)
        if position:
            case(
                "PIXELS",
                name=f"camera_{build.__name__}_position",
                passes=("Position",),
                filter_width=0.01,
                bounces=0,
                samples=1,
                until=position_until,
                **{**fields, "size": tuple(finer * side for side in fields.get("size", (96, 64)))},
            )(build)
        return build

    return enter


@seen(quick=True)
def perspective(scene):
    _look(scene)


@seen()
def wide(scene):
    _look(scene, (0, -2, 1.5), lens=14.0)


@seen(size=(64, 96))
def portrait(scene):
    _look(scene)


@seen(size=(64, 96))
def sensor_horizontal(scene):
    _look(scene, sensor_fit="HORIZONTAL", sensor_width=24.0)


@seen()
def sensor_vertical(scene):
    _look(scene, sensor_fit="VERTICAL", sensor_height=30.0)


@seen(quick=True)
def orthographic(scene):
    _look(scene, type="ORTHO", ortho_scale=7.0)


@seen()
def shift(scene):
    _look(scene, shift_x=0.2, shift_y=-0.15)


@seen()
def orthographic_shift(scene):
    _look(scene, type="ORTHO", ortho_scale=7.0, shift_x=0.2, shift_y=-0.15)


# Since 5.0 Blender cannot write the positions of pixels that are not square: "Conflicting attributes ... pixelAspectRatio".
@seen(position_until=(5, 0))
def pixel_aspect(scene):
    _look(scene)
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1.0, 1.7


@seen()
def border(scene):
    _look(scene)
    _set_border(scene, False)


@seen()
def border_cropped(scene):
    _look(scene)
    _set_border(scene, True)


def _set_border(scene, crop):
    render = scene.render
    render.use_border, render.use_crop_to_border = True, crop
    render.border_min_x, render.border_max_x = 0.25, 0.75
    render.border_min_y, render.border_max_y = 0.125, 0.875


@seen()
def clipping(scene):
    _look(scene, clip_start=4.5, clip_end=7.5)


@seen()
def clipping_orthographic(scene):
    _look(scene, type="ORTHO", ortho_scale=7.0, clip_start=4.5, clip_end=7.5)


@seen()
def scaled_object(scene):
    """The scale of the camera object must not change the picture."""
    eye = _look(scene)
    eye.scale = (2.0, 3.0, 0.5)


def _panorama(scene, kind, **fields):
    eye = _look(scene, (0.2, -0.3, 2.2), (1, 2, 1.7), type="PANO")
    # In newer versions these settings belong to the camera instead of Cycles.
    owner = eye.data if hasattr(eye.data, "panorama_type") else eye.data.cycles
    owner.panorama_type = kind
    for name, value in fields.items():
        setattr(owner, name, value)


@seen(quick=True, finer=16)
def equirectangular(scene):
    _panorama(scene, "EQUIRECTANGULAR")


@seen()
def equirectangular_part(scene):
    _panorama(
        scene,
        "EQUIRECTANGULAR",
        latitude_min=-0.9,
        latitude_max=0.6,
        longitude_min=-1.2,
        longitude_max=2.0,
    )


@seen(size=(72, 72), finer=16)
def fisheye_equidistant(scene):
    _panorama(scene, "FISHEYE_EQUIDISTANT", fisheye_fov=math.radians(200))


@seen(finer=16)
def fisheye_equidistant_wide_picture(scene):
    _panorama(scene, "FISHEYE_EQUIDISTANT", fisheye_fov=math.radians(150))


@seen(finer=16)
def fisheye_equisolid(scene):
    _panorama(scene, "FISHEYE_EQUISOLID", fisheye_fov=math.radians(180), fisheye_lens=10.5)


# The rim contains half of all directions: no picture is fine enough there for the position of one sample.
@seen(position=False)
def mirror_ball(scene):
    _panorama(scene, "MIRRORBALL")


@seen(finer=16)
def fisheye_polynomial(scene):
    fields = {f"fisheye_polynomial_k{i}": k for i, k in enumerate((0.0, -0.06, 0.0, 0.0, 0.0))}
    _panorama(scene, "FISHEYE_LENS_POLYNOMIAL", fisheye_fov=math.radians(160), **fields)


# From 4.1 on.
@seen(finer=16, since=(4, 1))
def cylindrical(scene):
    _panorama(scene, "CENTRAL_CYLINDRICAL", central_cylindrical_range_v_min=-0.8, central_cylindrical_range_v_max=0.9)


def _glows(scene):
    """Adds small bright squares before and behind the focus, whose blur has the shape of the aperture, before a plain wall."""
    wall = shader("ShaderNodeEmission", Color=(0.5, 0.7, 0.9), Strength=2.0)
    parts.place(scene, "Wall", parts.plane_mesh("Wall", 200.0), wall, (0, 20, 0), rotation=(math.pi / 2, 0, 0))
    for index, (x, depth, side) in enumerate(((-1.7, 8.0, 0.9), (0.35, 2.0, 0.16))):
        glow = shader("ShaderNodeEmission", Color=(1.0, 0.7 - 0.4 * index, 0.3 + 0.6 * index), Strength=10.0)
        square = parts.plane_mesh("Glow", side)
        parts.place(scene, f"Glow {index}", square, glow, (x, depth, 0), rotation=(math.pi / 2, 0, 0))


def _focus(scene, **fields):
    """Adds the squares and a camera focused at 3, with a lens of nearly 2 in diameter: blur of half the picture's height."""
    _glows(scene)
    eye = parts.add_camera(scene, (0, 0, 0), (0, 1, 0))
    return _open(eye, focus_distance=3.0, **fields)


def _open(eye, **fields):
    lens = eye.data.dof
    lens.use_dof, lens.aperture_fstop = True, 0.03
    for name, value in fields.items():
        setattr(lens, name, value)
    return eye


def blurred(quick=False):
    """Enters the scene by its picture alone: places out of focus have no single position."""
    return seen(quick=quick, position=False)


@blurred()
def focus_round(scene):
    _focus(scene)


@blurred()
def focus_blades(scene):
    _focus(scene, aperture_blades=3)


@blurred()
def focus_blades_turned(scene):
    _focus(scene, aperture_blades=3, aperture_rotation=0.5)


@blurred()
def focus_ratio(scene):
    _focus(scene, aperture_ratio=2.0)


@blurred(quick=True)
def focus_orthographic(scene):
    eye = _focus(scene)
    eye.data.type, eye.data.ortho_scale = "ORTHO", 5.0


@blurred()
def focus_object(scene):
    """Focuses on an object instead of a distance."""
    target = bpy.data.objects.new("Target", None)
    target.location = (0.5, 3.0, 0.3)
    scene.collection.objects.link(target)
    _focus(scene, focus_object=target).data.dof.focus_distance = 20.0


@blurred()
def focus_panorama(scene):
    _glows(scene)
    eye = parts.add_camera(scene, (0, 0, 0), (0, 1, 0))
    eye.data.type = "PANO"
    # In newer versions these settings belong to the camera instead of Cycles.
    owner = eye.data if hasattr(eye.data, "panorama_type") else eye.data.cycles
    owner.panorama_type = "EQUIRECTANGULAR"
    owner.latitude_min, owner.latitude_max = -0.25, 0.25
    owner.longitude_min, owner.longitude_max = -0.375, 0.375
    _open(eye, focus_distance=3.0)
