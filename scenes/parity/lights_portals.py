"""Portals of lights: a closed room that the sky lights through windows, which guide the samples and change no light.

Round ones are left out: with one, Cycles' picture is 1.2 % darker than with a rectangle.
"""

from .. import parts
from .catalogue import variants
from .nodes import shader, world
from .stages import ball, camera


def _wall(scene, name, location, rotation, size=4.0):
    matt = shader("ShaderNodeBsdfDiffuse", Color=(0.75, 0.7, 0.65))
    return parts.place(scene, name, parts.plane_mesh(name, size), matt, location, rotation=rotation)


def _frame(scene):
    """A wall of four strips around an opening of 1.6 by 1.2 in x = 2, from y = -0.8 to 0.8 and z = 1 to 2.2."""
    matt = shader("ShaderNodeBsdfDiffuse", Color=(0.75, 0.7, 0.65))
    corners = ((-2, 2, 0, 1), (-2, 2, 2.2, 4), (-2, -0.8, 1, 2.2), (0.8, 2, 1, 2.2))
    for number, (left, right, low, high) in enumerate(corners):
        vertices = [(2, left, low), (2, right, low), (2, right, high), (2, left, high)]
        parts.place(scene, f"Strip {number}", parts.mesh_from_points(f"Strip {number}", vertices, [(0, 1, 2, 3)]), matt)


def _portal(scene, location, rotation, **fields):
    lamp = parts.add_light(scene, "Portal", "AREA", 10.0, location, **fields)
    lamp.rotation_euler = rotation
    lamp.data.cycles.is_portal = True
    return lamp


def _room(scene):
    _wall(scene, "Floor", (0, 0, 0), (0, 0, 0))
    _wall(scene, "Ceiling", (0, 0, 4), (3.14159, 0, 0))
    _wall(scene, "Left", (-2, 0, 2), (0, 1.5708, 0))
    _wall(scene, "Back", (0, 2, 2), (1.5708, 0, 0))
    _wall(scene, "Front", (0, -2, 2), (-1.5708, 0, 0))
    _frame(scene)
    ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.3, 0.5, 0.75)), segments=48, radius=0.6, location=(0, 0.4, 0.6))
    camera(scene, (0, -1.8, 1.6), (0, 0.6, 1.0), lens=24.0)


def _uneven_sky(scene):
    world(scene, lambda nodes: nodes.add("ShaderNodeBackground", Color=nodes.add("ShaderNodeTexGradient"), Strength=6.0))


def _even_sky(scene):
    parts.set_world(scene, (0.7, 0.85, 1.0), 3.0)


_WINDOW = {"shape": "RECTANGLE", "size": 1.2, "size_y": 1.6}


@variants(values={"even": _even_sky, "uneven": _uneven_sky}, bounces=2)
def portal_of_a_room(scene, shine):
    _room(scene)
    _portal(scene, (2, 0, 1.6), (0, 1.5708, 0), **_WINDOW)
    shine(scene)


@variants(values={"behind": "behind", "two": "two"}, bounces=1)
def portal_variants(scene, which):
    """A portal that faces outwards beside one that faces inwards, and two that overlap."""
    _room(scene)
    _portal(scene, (2, 0, 1.6), (0, 1.5708, 0), **_WINDOW)
    if which == "two":
        _portal(scene, (2, 0.3, 1.6), (0, 1.5708, 0), **_WINDOW)
    elif which == "behind":
        _portal(scene, (2, 0, 1.6), (0, -1.5708, 0), **_WINDOW)
    _uneven_sky(scene)
