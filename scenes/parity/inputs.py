"""What nodes read of meshes by name: attributes of every domain and type, with names empty, missing and given; and of pictures
with texels that are not finite."""

import bpy
import numpy as np

from .. import parts
from . import image_files, images
from .boards import output_of, set_board, size_of, tile_mesh, uneven
from .catalogue import case, variants

_TYPES = [item.identifier for item in bpy.types.Attribute.bl_rna.properties["data_type"].enum_items]
_LENGTHS = {"FLOAT2": 2, "FLOAT_VECTOR": 3, "FLOAT4": 4}
_OUTPUTS = ("Color", "Vector", "Fac", "Alpha")
_ATTRIBUTE, _COLOR, _MAP = "ShaderNodeAttribute", "ShaderNodeVertexColor", "ShaderNodeUVMap"


def _value(kind, index):
    numbers = uneven(index, 16)
    if kind == "STRING":
        return "word" if bpy.app.version < (4, 0) else b"word"
    if kind == "BOOLEAN":
        return numbers[0] > 0.5
    if kind in ("INT", "INT8"):
        return int(10 * numbers[0])
    if kind in ("INT16_2D", "INT32_2D"):
        return int(10 * numbers[0]), int(10 * numbers[1])
    if kind == "QUATERNION":
        length = sum(x * x for x in numbers[:4]) ** 0.5
        return [x / length for x in numbers[:4]]
    if kind == "FLOAT4X4":
        return [numbers[4 * row : 4 * row + 4] for row in range(4)]
    return numbers[0]


def _with_attribute(kind, domain):
    mesh = tile_mesh()
    for index, item in enumerate(mesh.attributes.new("Given", kind, domain).data):
        if kind in ("FLOAT_COLOR", "BYTE_COLOR"):
            item.color = uneven(index, 4)
        elif kind in _LENGTHS:
            item.vector = uneven(index, _LENGTHS[kind])
        else:
            item.value = _value(kind, index)
    return mesh


@variants(
    values={domain.lower(): domain for domain in ("POINT", "EDGE", "FACE", "CORNER")},
    size=size_of(len(_TYPES) * len(_OUTPUTS)),
    bounces=0,
    quick=True,
)
def attribute_on(scene, domain):
    """Each type by each output, of a square of nine vertices."""
    tiles = []
    for kind in _TYPES:
        mesh = _with_attribute(kind, domain)
        tiles += [(mesh, output_of(_ATTRIBUTE, output, {"attribute_name": "Given"})) for output in _OUTPUTS]
    set_board(scene, tiles)


def _painted(*colors, rendered=0, has_map=True):
    """A mesh with colours of these (name, type, domain)."""
    mesh = tile_mesh(has_map)
    for number, (name, kind, domain) in enumerate(colors):
        for index, item in enumerate(mesh.color_attributes.new(name, kind, domain).data):
            item.color = uneven(index + 5 * number, 4)
    if colors:
        mesh.color_attributes.render_color_index = rendered
        mesh.color_attributes.active_color_index = len(colors) - 1 - rendered
    return mesh


_PAINTED = (
    (),
    (("One", "FLOAT_COLOR", "POINT"),),
    (("One", "FLOAT_COLOR", "CORNER"),),
    (("One", "BYTE_COLOR", "POINT"),),
    (("One", "BYTE_COLOR", "CORNER"),),
    (("One", "FLOAT_COLOR", "POINT"), ("Two", "BYTE_COLOR", "CORNER")),
)


def _color_tiles():
    tiles = []
    for colors in _PAINTED:
        for rendered in range(max(1, len(colors))):
            mesh = _painted(*colors, rendered=rendered)
            names = ("", "Missing", *(name for name, _, _ in colors))
            for name in names:
                tiles += [(mesh, output_of(_COLOR, output, {"layer_name": name})) for output in ("Color", "Alpha")]
            for name in ("Missing", "vertex_color", *names[2:]):
                tiles += [(mesh, output_of(_ATTRIBUTE, output, {"attribute_name": name})) for output in _OUTPUTS]
    return tiles


@case(size=size_of(7 * 12 + 6 * 6 + 2 * 6), bounces=0, quick=True)
def colors_by_name(scene):
    """Color Attribute and Attribute, by names that are empty, missing and given."""
    set_board(scene, _color_tiles())


@case(size=size_of(4 * 6), bounces=0, quick=True, since=(4, 2))
def rendered_colors_of_faces_and_edges(scene):
    """The first colours of a mesh are its rendered ones, whatever their domain. Blender 3 knows none of faces and edges."""
    tiles = []
    for kind in ("FLOAT_COLOR", "BYTE_COLOR"):
        for domain in ("FACE", "EDGE"):
            mesh = tile_mesh(True)
            for index, item in enumerate(mesh.attributes.new("One", kind, domain).data):
                item.color = uneven(index, 4)
            tiles += [(mesh, output_of(_COLOR, output, {"layer_name": ""})) for output in ("Color", "Alpha")]
            tiles += [(mesh, output_of(_ATTRIBUTE, output, {"attribute_name": "vertex_color"})) for output in _OUTPUTS]
    set_board(scene, tiles)


def _with_maps(rendered):
    mesh = tile_mesh()
    for index, item in enumerate(mesh.uv_layers.new(name="Second").data):
        item.uv = uneven(index, 2)
    mesh.uv_layers[rendered].active_render = True
    return mesh


def _map_tiles():
    tiles = []
    bare = _painted(("Paint", "FLOAT_COLOR", "POINT"), has_map=False)
    for mesh in (_with_maps(0), _with_maps(1), bare):
        for name in ("", "Missing", "UVMap", "Second", "Paint"):
            tiles.append((mesh, output_of(_MAP, "UV", {"uv_map": name})))
            tiles += [(mesh, output_of(_ATTRIBUTE, output, {"attribute_name": name})) for output in _OUTPUTS]
        tiles += [(mesh, output_of(_ATTRIBUTE, output, {"attribute_name": "uv"})) for output in _OUTPUTS]
    return tiles


@case(size=size_of(3 * (5 + 20 + 4)), bounces=0, quick=True)
def maps_by_name(scene):
    """UV Map and Attribute, by names that are empty, missing and given, of maps and of colours."""
    set_board(scene, _map_tiles())


def _plain_ball():
    """Without a UV map, off its own origin and stretched."""
    mesh = parts.sphere_mesh("Ball", 24, 16, 0.4)
    for layer in list(mesh.uv_layers):
        mesh.uv_layers.remove(layer)
    for vertex in mesh.vertices:
        x, y, z = vertex.co
        vertex.co = x + 0.1, y - 0.05, 1.3 * z + 0.2
    return mesh


@case("EXACT", size=size_of(4), bounces=0, quick=True)
def tangents_without_maps(scene):
    """Round the z axis of the mesh as it was before modifiers."""
    ball = _plain_ball()
    tangent = ("ShaderNodeTangent", "Tangent", {"direction_type": "UV_MAP"})
    mapped = ("ShaderNodeNormalMap", "Normal", {"space": "TANGENT"})
    tiles = [
        (ball, output_of(*tangent)),
        (ball, output_of(*mapped, Color=(0.8, 0.4, 0.9))),
        (ball, output_of(*mapped, Color=(0.3, 0.9, 0.7))),
        (_painted(("Paint", "FLOAT_COLOR", "POINT"), has_map=False), output_of(*mapped, Color=(0.8, 0.4, 0.9))),
    ]
    set_board(scene, tiles)


def _picture_with_gaps(kind, channels, number):
    """Seven by six texels, of which every third is that number."""
    y, x = np.mgrid[0:6, 0:7]
    pixels = np.stack([0.2 + 0.1 * x, 0.3 + 0.1 * y, 0.5 + 0.0 * x, 1.0 + 0.0 * x], axis=-1)[..., :channels].astype(np.float32)
    pixels[(7 * y + x) % 3 == 0, :3] = number
    if kind:
        return image_files.from_file(kind, pixels, images.LINEAR, f"gaps {kind} {channels} {number}")
    return images.image("Gaps", pixels, images.LINEAR, is_float=True, pack=False)


def _set_pictures(scene, kinds, channels, numbers):
    tiles = []
    for kind in kinds:
        for count in channels:
            for number in numbers:
                picture = _picture_with_gaps(kind, count, number)
                for interpolation in ("Closest", "Linear", "Cubic"):
                    props = {"image": picture, "interpolation": interpolation}
                    tiles.append((tile_mesh(), output_of("ShaderNodeTexImage", "Color", props)))
    set_board(scene, tiles)


_NUMBERS = (float("nan"), float("inf"), float("-inf"))


@case(size=size_of(3 * 3 * 3), bounces=0, quick=True, announced="not finite")
def image_gaps(scene):
    """As files of single precision store them."""
    _set_pictures(scene, ("EXR 32",), (1, 3, 4), _NUMBERS)


@case(size=size_of(3 * 3), bounces=0, announced="not finite")
def image_gaps_held(scene):
    """As Blender holds them."""
    _set_pictures(scene, ("",), (4,), _NUMBERS)


@case(size=size_of(3 * 3 * 3), bounces=0, announced="not finite")
def image_gaps_half(scene):
    """As files of half precision store them: before Blender 5.2 numbers of up to 98304."""
    _set_pictures(scene, ("EXR 16",), (1, 3, 4), _NUMBERS)


def _relief(joined=True, loose=False, cuts=6):
    """A square with hills and dales, in one piece or of strips that meet in equal vertices."""
    mesh = bpy.data.meshes.new("Relief")
    points, faces, edges = [], [], []
    width = cuts + 1
    for strip in (range(width),) if joined else (range(0, cuts // 2 + 1), range(cuts // 2, width)):
        start = len(points)
        for row in strip:
            heights = (0.1 * uneven(7 * row + column, 1)[0] for column in range(width))
            points += [(row / cuts - 0.5, column / cuts - 0.5, height) for column, height in enumerate(heights)]
        corners = [start + row * width + column for row in range(len(strip) - 1) for column in range(cuts)]
        faces += [(i, i + width, i + width + 1, i + 1) for i in corners]
    if loose:
        end = len(points)
        points += [(0.1, 0.1, 0.3), (0.2, 0.1, 0.4), (0.0, 0.0, 0.5)]
        edges = [(24, end), (end, end + 1)]
    mesh.from_pydata(points, edges, faces)
    mesh.update()
    return mesh


def _islands():
    """Squares of their own, whose edges are given in an order of no rule."""
    mesh = bpy.data.meshes.new("Islands")
    places = [(column / 4 - 0.5, row / 4 - 0.5) for row in range(4) for column in range(4)]
    points = [(x + a, y + b, 0.0) for x, y in places for a, b in ((0, 0), (0.2, 0), (0.2, 0.2), (0, 0.2))]
    faces = [tuple(4 * k + (j + k) % 4 for j in range(4)) for k in range(16)]
    edges = [(4 * k + a, 4 * k + b) for k in range(15, -1, -1) for a, b in ((2, 3), (1, 0), (3, 0))]
    mesh.from_pydata(points, edges, faces)
    mesh.update()
    return mesh


_SHAPES = (_relief, lambda: _relief(False), lambda: _relief(True, True), lambda: _relief(cuts=2), _islands)
_COMPUTED = (("Pointiness", "pointiness"), ("Random Per Island", "random_per_island"))


def _sharpness(nodes):
    """Pointiness, of which 0.44 is black and 0.56 white."""
    output = nodes.add("ShaderNodeNewGeometry").outputs["Pointiness"]
    return nodes.add("ShaderNodeMath", output, 8.0, -3.5, props={"operation": "MULTIPLY_ADD", "use_clamp": True}).outputs[0]


@case(size=size_of(4), bounces=0, quick=True)
def pointiness_of_seams(scene):
    """Vertices of one place count as one."""
    set_board(scene, [(_relief(joined, cuts=cuts), _sharpness) for cuts in (2, 4) for joined in (False, True)])


@case(size=size_of(len(_SHAPES) * 12 + 2), bounces=0, quick=True)
def computed_of_edges(scene):
    """Pointiness and Random Per Island, by Geometry, Attribute and Color Attribute, of one and more pieces and loose edges."""
    tiles = []
    for make in _SHAPES:
        mesh = make()
        for output, name in _COMPUTED:
            tiles.append((mesh, output_of("ShaderNodeNewGeometry", output)))
            tiles += [(mesh, output_of(_ATTRIBUTE, shown, {"attribute_name": name})) for shown in _OUTPUTS]
            tiles.append((mesh, output_of(_COLOR, "Color", {"layer_name": name})))
    named = _painted(("pointiness", "FLOAT_COLOR", "CORNER"))
    tiles += [(named, output_of(_COLOR, output, {"layer_name": "pointiness"})) for output in ("Color", "Alpha")]
    set_board(scene, tiles)
