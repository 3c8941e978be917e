"""Image nodes: what picture, where on it, and how it is read."""

from ..bindings.enums import Coordinate, Environment, Extension, Interpolation, MappingType, NodeKind, Projection
from .coordinates import coordinate, mapping_matrix
from .maths import transformed

_INTERPOLATION = {
    "Linear": Interpolation.LINEAR,
    "Closest": Interpolation.CLOSEST,
    "Cubic": Interpolation.CUBIC,
    "Smart": Interpolation.CUBIC,
}
_STRAIGHT_COLOR = 256
_MAGENTA = (1.0, 0.0, 1.0)


def _image_texture(graph, site, output):
    node = site.node
    is_alpha = output.identifier == "Alpha"
    found = _picture(graph, site)
    if found is None:
        return 1.0 if is_alpha else _MAGENTA
    first, count = found
    vector = graph.linked(site, ("Vector",), None)
    if vector is None:
        vector = coordinate(graph, Coordinate.UV)
    flags = Extension[node.extension] | _INTERPOLATION[node.interpolation] << 4
    if node.outputs["Alpha"].is_linked and _has_color_under_alpha(node.image):
        flags |= _STRAIGHT_COLOR
    value = graph.emit(
        NodeKind.IMAGE,
        _legacy_mapping(graph, site, vector),
        node.projection_blend if node.projection == "BOX" else 0.0,
        option=Projection[node.projection],
        flags=flags,
        image=first,
        image_count=count,
    )
    return graph.emit(NodeKind.ALPHA, value) if is_alpha else value


def _environment_texture(graph, site, output):
    node = site.node
    found = _picture(graph, site)
    if found is None:
        return _MAGENTA
    first, count = found
    vector = graph.linked(site, ("Vector",), None)
    if vector is None:
        vector = coordinate(graph, Coordinate.POSITION)
    return graph.emit(
        NodeKind.ENVIRONMENT,
        _legacy_mapping(graph, site, vector),
        option=Environment[node.projection],
        flags=_INTERPOLATION[node.interpolation] << 4,
        image=first,
        image_count=count,
    )


def _picture(graph, site):
    node = site.node
    if node.image is None or graph.images is None:
        graph.tell(site, "has no image, magenta is used")
        return None
    return graph.images.numbers(node.image, node.image_user, lambda text: graph.tell(site, text))


def _has_color_under_alpha(image):
    return not image.colorspace_settings.is_data and image.alpha_mode not in ("CHANNEL_PACKED", "NONE")


def _legacy_mapping(graph, site, vector):
    """The mapping that nodes of old files carry within themselves."""
    own = site.node.texture_mapping
    kind = MappingType[own.vector_type]
    return transformed(graph, vector, mapping_matrix(kind, tuple(own.translation), tuple(own.rotation), tuple(own.scale)))


READERS = {"TEX_ENVIRONMENT": _environment_texture, "TEX_IMAGE": _image_texture}
