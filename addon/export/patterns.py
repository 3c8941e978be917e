"""Textures of cells and waves. Each reader takes (graph, site, output) and returns a value."""

import bpy

from ..bindings.enums import NodeKind, NoiseFlag, Profile, VectorOperation, Wave
from .arithmetic import THIRDS
from .procedural import REPEATS, dimensions, mapped_vector, noise_roughness, packed

_SCALES_BEFORE = bpy.app.version >= (5, 2)  # Magic Texture: the scale moves the place instead of stretching the waves


def _wave(graph, site, output):
    node = site.node
    direction = f"BANDS_{node.bands_direction}" if node.wave_type == "BANDS" else f"RINGS_{node.rings_direction}"
    return graph.emit(
        NodeKind.WAVE,
        mapped_vector(graph, site),
        packed(graph, site, ("Scale", 5.0), ("Distortion", 0.0), ("Phase Offset", 0.0)),
        graph.combine(
            graph.parameter(site, ("Detail",), 2.0),
            graph.parameter(site, ("Detail Scale",), 1.0),
            noise_roughness(graph, site, "Detail Roughness"),
        ),
        option=Profile[node.wave_profile],
        flags=Wave[direction] | (NoiseFlag.REPEATS if REPEATS else 0),
    )


def _magic(graph, site, output):
    color = graph.emit(
        NodeKind.MAGIC,
        mapped_vector(graph, site),
        packed(graph, site, ("Scale", 5.0), ("Distortion", 1.0)),
        option=site.node.turbulence_depth,
        flags=int(_SCALES_BEFORE),
    )
    return color if output.identifier == "Color" else graph.vector_op(VectorOperation.DOT_PRODUCT, color, THIRDS)


def _checker(graph, site, output):
    scale = graph.parameter(site, ("Scale",), 5.0)
    share = graph.emit(NodeKind.CHECKER, mapped_vector(graph, site), scale)
    if output.identifier != "Color":
        return share
    return graph.mix(share, *(graph.parameter(site, (name,), kind="vector") for name in ("Color2", "Color1")))


def _brick(graph, site, output):
    node = site.node
    shares = graph.emit(
        NodeKind.BRICK,
        mapped_vector(graph, site),
        packed(graph, site, ("Scale", 5.0), ("Mortar Size", 0.02), ("Mortar Smooth", 0.1)),
        packed(graph, site, ("Bias", 0.0), ("Brick Width", 0.5), ("Row Height", 0.25)),
        (node.offset, node.squash, 0.0),
        (float(node.offset_frequency), float(node.squash_frequency), 0.0),
    )
    mortar = graph.component(shares, 1)
    if output.identifier != "Color":
        return mortar
    first, second, between = (graph.parameter(site, (name,), kind="vector") for name in ("Color1", "Color2", "Mortar"))
    return graph.mix(mortar, graph.mix(graph.component(shares, 0), first, second), between)


def _white_noise(graph, site, output):
    flags = dimensions(site.node.noise_dimensions) | (NoiseFlag.COLOR if output.identifier == "Color" else 0)
    vector, w = graph.parameter(site, ("Vector",), (0.0,) * 3, kind="vector"), graph.parameter(site, ("W",), 0.0)
    return graph.emit(NodeKind.WHITE_NOISE, vector, w, flags=int(flags))


_GABOR_OUTPUTS = ("Value", "Phase", "Intensity")


def _gabor(graph, site, output):
    in_space = site.node.gabor_type == "3D"
    if in_space:
        orientation = graph.parameter(site, ("Orientation 3D",), (0.0,) * 3, kind="vector")
    else:
        orientation = graph.parameter(site, ("Orientation 2D",), 0.0)
    value = graph.emit(
        NodeKind.GABOR,
        mapped_vector(graph, site),
        packed(graph, site, ("Scale", 5.0), ("Frequency", 2.0), ("Anisotropy", 1.0)),
        orientation,
        option=int(in_space),
    )
    return graph.component(value, _GABOR_OUTPUTS.index(output.identifier))


def _radial_tiling(graph, site, output):
    vector = graph.parameter(site, ("Vector",), (0.0,) * 3, kind="vector")
    shape = packed(graph, site, ("Sides", 5.0), ("Roundness", 0.0))
    if output.identifier == "Segment ID":
        return graph.emit(NodeKind.RADIAL_TILING, vector, shape, option=1)
    tile = graph.emit(NodeKind.RADIAL_TILING, vector, shape, flags=int(site.node.normalize))
    if output.identifier == "Segment Coordinates":
        return graph.combine(graph.component(tile, 0), graph.component(tile, 1), 0.0)
    return graph.component(tile, 2) if output.identifier == "Segment Width" else graph.emit(NodeKind.ALPHA, tile)


READERS = {
    "ShaderNodeRadialTiling": _radial_tiling,
    "TEX_BRICK": _brick,
    "TEX_CHECKER": _checker,
    "TEX_GABOR": _gabor,
    "TEX_MAGIC": _magic,
    "TEX_WAVE": _wave,
    "TEX_WHITE_NOISE": _white_noise,
}
