"""Boards: a square tile of the picture for each value that a node gives, shining by itself."""

import bpy

from .. import parts
from .nodes import material

# A block of the judge, in the small pictures of `make test` too.
TILE = 16
_COLUMNS = 8
# Columns and rows of unequal width, and a square beside two triangles in each row.
_PLACES = (-0.5, 0.1, 0.5)
_FACES = ((0, 1, 4, 3), (1, 2, 5), (1, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7))


def size_of(count):
    return TILE * _COLUMNS, TILE * -(-count // _COLUMNS)


def tile_mesh(has_map=True):
    """Nine vertices on a square of side 1, with a map of it."""
    mesh = bpy.data.meshes.new("Tile")
    mesh.from_pydata([(x, y, 0.0) for y in _PLACES for x in _PLACES], [], _FACES)
    mesh.update()
    if has_map:
        layer = mesh.uv_layers.new(name="UVMap")
        for loop, item in zip(mesh.loops, layer.data, strict=True):
            place = mesh.vertices[loop.vertex_index].co
            item.uv = place.x + 0.5, place.y + 0.5
    return mesh


def uneven(index, count):
    """Numbers between 0 and 1 that differ from one index to the next."""
    return [(37 * index + 17 * k) % 23 / 23 for k in range(count)]


def set_board(scene, tiles):
    """tiles: (mesh, value) each; value(nodes) gives the output that is shown, brought to 0 ... 1 where it is a vector.

    Returns the objects of the tiles."""
    columns = size_of(len(tiles))[0] // TILE
    things = []
    for number, (mesh, value) in enumerate(tiles):
        place = number % columns + 0.5, number // columns + 0.5, 0.0
        things.append(parts.place(scene, f"Tile {number}", mesh, shining(value), place))
    view_board(scene, len(tiles))
    return things


def shining(value):
    """Returns a material that shines in a value; a shader stays as it is."""

    def surface(nodes):
        output = value(nodes)
        return output if output.type == "SHADER" else nodes.add("ShaderNodeEmission", Color=_positive(nodes, output))

    return material(surface)


def view_board(scene, count):
    columns, rows = (side // TILE for side in size_of(count))
    parts.set_world(scene, (0.5, 0.5, 0.5))
    eye = parts.add_camera(scene, (columns / 2, rows / 2, 5), (columns / 2, rows / 2, 0))
    eye.rotation_euler = (0, 0, 0)
    eye.data.type, eye.data.ortho_scale = "ORTHO", max(columns, rows)


def _positive(nodes, output):
    if output.type != "VECTOR":
        return output
    half = (0.5, 0.5, 0.5)
    return nodes.add("ShaderNodeVectorMath", output, half, half, props={"operation": "MULTIPLY_ADD"}).outputs[0]


def output_of(kind, identifier, props=None, **inputs):
    """value of a tile: an output of a node of that kind."""

    def value(nodes):
        node = nodes.add(kind, props=props, **inputs)
        return next(output for output in node.outputs if output.identifier == identifier)

    return value
