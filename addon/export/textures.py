"""Image nodes: the image, its coordinates, interpolation and extension."""

import bpy

from ..bindings.enums import (
    Coordinate,
    Environment,
    Extension,
    Interpolation,
    MappingType,
    NodeKind,
    Projection,
    VectorOperation,
)
from ..messages.severity import Severity
from .arithmetic import divide, each
from .coordinates import coordinate, mapping_matrix
from .maths import transformed
from .missing import HAS_TEXEL, MAGENTA, is_black, missing

_INTERPOLATION = {
    "Linear": Interpolation.LINEAR,
    "Closest": Interpolation.CLOSEST,
    "Cubic": Interpolation.CUBIC,
    "Smart": Interpolation.CUBIC,
}
_STRAIGHT_COLOR = 256
# Cycles projects tile 1001 alone from the sides of a box, before 5.2 as an image without tiles.
_FLAGS_OF_TILED_BOX = 512 if bpy.app.version >= (5, 2) else 0
_AXES = {"NONE": None, "X": 0, "Y": 1, "Z": 2}


def _image_texture(graph, site, output):
    node = site.node
    is_alpha = output.identifier == "Alpha"
    found, flags = _picture(graph, site), 0
    if found is not None and node.projection == "BOX" and node.image.source == "TILED":
        found, flags = _tile_of_boxes(graph, node.image, *found), _FLAGS_OF_TILED_BOX
    if found is None:
        is_even = node.extension != "CLIP" and (node.image is None or not is_black(node.image))
        if is_even or not HAS_TEXEL or graph.images is None:
            return 1.0 if is_alpha else MAGENTA
        found = graph.images.repeat([missing(node.image)]), 1
    first, count = found
    vector = graph.linked(site, ("Vector",), None)
    if vector is None:
        vector = coordinate(graph, Coordinate.UV)
    flags |= Extension[node.extension] | _INTERPOLATION[node.interpolation] << 4
    if node.outputs["Alpha"].is_linked and _has_color_under_alpha(node.image):
        flags |= _STRAIGHT_COLOR
    value = graph.emit(
        NodeKind.IMAGE,
        legacy_mapping(graph, site, vector),
        node.projection_blend if node.projection == "BOX" else 0.0,
        option=Projection[node.projection],
        flags=flags,
        image=first,
        image_count=count,
    )
    return graph.emit(NodeKind.ALPHA, value) if is_alpha else value


def _tile_of_boxes(graph, image, first, count):
    """Return the range of tile 1001 among the tiles of an image; None if it has no such tile."""
    numbers = [picture.tile for picture in graph.images.list[first : first + count]]
    # A set of one tile may be an image without tiles.
    known = [tile.number for tile in image.tiles] if not any(numbers) else numbers
    return (first + known.index(1001), 1) if 1001 in known else None


def _environment_texture(graph, site, output):
    node = site.node
    # Without an image the node is magenta but must not become a constant: Cycles samples a sky with such a node as a light,
    # and objects that cast no shadow then both let its light pass and transmit it themselves.
    first, count = _picture(graph, site) or (0, 0)
    vector = graph.linked(site, ("Vector",), None)
    if vector is None:
        vector = coordinate(graph, Coordinate.POSITION)
    return graph.emit(
        NodeKind.ENVIRONMENT,
        legacy_mapping(graph, site, vector),
        option=Environment[node.projection],
        flags=_INTERPOLATION[node.interpolation] << 4,
        image=first,
        image_count=count,
    )


def _picture(graph, site):
    node = site.node
    if node.image is None or graph.images is None:
        graph.tell(site, "has no image, magenta is used", "", severity=Severity.WRONG)
        return None

    def tell(text, key="", **more):
        graph.tell(site, text, key, **more)

    # The library reads all texels of a sky to sample it.
    return graph.images.numbers(node.image, node.image_user, tell, in_memory=graph.is_of_world)


def _has_color_under_alpha(image):
    return image is not None and not image.colorspace_settings.is_data and image.alpha_mode not in ("CHANNEL_PACKED", "NONE")


def legacy_mapping(graph, site, vector):
    """Apply the texture mapping stored inside nodes of old files: swap axes first, then transform."""
    own = site.node.texture_mapping
    kind, location, scale = MappingType[own.vector_type], tuple(own.translation), tuple(own.scale)
    if kind in (MappingType.VECTOR, MappingType.NORMAL):
        location = (0.0, 0.0, 0.0)
    if kind == MappingType.NORMAL:
        scale = each(lambda x: divide(1.0, x), scale)
    rows = mapping_matrix(kind, location, tuple(own.rotation), scale)
    sources = [_AXES[getattr(own, f"mapping_{axis}")] for axis in "xyz"]
    rows = [(*(sum(row[i] for i in range(3) if sources[i] == axis) for axis in range(3)), row[3]) for row in rows]
    moved = transformed(graph, vector, rows)
    # An identity mapping leaves the length of normals unchanged.
    return graph.vector_op(VectorOperation.NORMALIZE, moved) if kind == MappingType.NORMAL and moved is not vector else moved


READERS = {"TEX_ENVIRONMENT": _environment_texture, "TEX_IMAGE": _image_texture}
