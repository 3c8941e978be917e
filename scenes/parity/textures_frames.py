"""Movies and image sequences: the frame that a node shows, by its own start, offset, length and repetition."""

import os

import bpy
import numpy as np

from . import avi, images, png
from .boards import set_board, size_of, tile_mesh
from .catalogue import case, variants

_COUNT = 6
_NOW = 14  # the scene's frame
# (length, start, offset, cyclic, Auto Refresh): inside, the last frame, before the start, behind the end, repeated from the
# front and from behind, beyond the file's frames on both sides, without length, and not refreshed.
_USERS = (
    (6, 12, 0, False, True),
    (6, 9, 0, False, True),
    (6, 12, 2, False, True),
    (6, 20, 0, False, True),
    (3, 1, 1, False, True),
    (4, 1, 0, True, True),
    (4, 20, 0, True, True),
    (5, 12, -2, True, True),
    (0, 12, 0, False, True),
    (6, 13, 0, False, False),
)


def _frames():
    """Returns frames that differ everywhere; all are square, so that they can be turned."""
    return [np.rot90(images.gradient_pixels(12, 12)[..., :3], number) * (0.4 + 0.1 * number) for number in range(_COUNT)]


def movie():
    path = os.path.join(bpy.app.tempdir, "movie.avi")
    with open(path, "wb") as file:
        file.write(avi.encode(_frames()))
    return bpy.data.images.load(path)


def sequence(first=0):
    """Returns a sequence of files with digits before and after those that count, from number `first` on."""
    for number, frame in enumerate(_frames(), first):
        with open(os.path.join(bpy.app.tempdir, f"take2_{number:04}_left.png"), "wb") as file:
            file.write(png.encode(frame[::-1]))
    image = bpy.data.images.load(os.path.join(bpy.app.tempdir, f"take2_{first + 2:04}_left.png"))
    image.source = "SEQUENCE"
    return image


def _framed(image, kind="ShaderNodeTexImage", user=_USERS[0]):
    def value(nodes):
        node = nodes.add(kind, props={"image": image})
        own = node.image_user
        own.frame_duration, own.frame_start, own.frame_offset, own.use_cyclic, own.use_auto_refresh = user
        return node.outputs["Color"]

    return value


@variants(values={"movie": movie, "sequence": sequence}, size=size_of(len(_USERS)), bounces=0, quick=True)
def image_frames(scene, make):
    image = make()
    mesh = tile_mesh()
    set_board(scene, [(mesh, _framed(image, user=user)) for user in _USERS])
    scene.frame_set(_NOW)


@case(size=size_of(4), bounces=0)
def image_movie_settings(scene):
    """Colour spaces and alpha modes of a movie."""
    plain, data, packed, none = (movie() for _ in range(4))
    data.colorspace_settings.name = "Non-Color"
    packed.alpha_mode, none.alpha_mode = "CHANNEL_PACKED", "NONE"
    mesh = tile_mesh()
    set_board(scene, [(mesh, _framed(image)) for image in (plain, data, packed, none)])
    scene.frame_set(_NOW)
