"""Render passes: one list for registering and for filling."""

from typing import NamedTuple

import bpy
import numpy as np

from .bindings.enums import Pass


class RenderPass(NamedTuple):
    name: str  # Blender's name: compositors and files look for it
    channels: str
    kind: str  # VALUE, VECTOR or COLOR
    source: Pass


_LONG_NAMES = bpy.app.version >= (5, 0)
_OBJECT_INDEX = "Object Index" if _LONG_NAMES else "IndexOB"
_MATERIAL_INDEX = "Material Index" if _LONG_NAMES else "IndexMA"


def render_passes(scene, view_layer):
    """The passes that a view layer asks for."""
    yield RenderPass("Combined", "RGBA", "COLOR", Pass.COMBINED)
    if view_layer.use_pass_z:
        yield RenderPass("Depth", "Z", "VALUE", Pass.DEPTH)
    if view_layer.use_pass_normal:
        yield RenderPass("Normal", "XYZ", "VECTOR", Pass.NORMAL)
    if view_layer.use_pass_position:
        yield RenderPass("Position", "XYZ", "VECTOR", Pass.POSITION)
    if view_layer.use_pass_object_index:
        yield RenderPass(_OBJECT_INDEX, "X", "VALUE", Pass.OBJECT_INDEX)
    if view_layer.use_pass_material_index:
        yield RenderPass(_MATERIAL_INDEX, "X", "VALUE", Pass.MATERIAL_INDEX)
    if scene.lancer.use_pass_albedo:
        yield RenderPass("Denoising Albedo", "RGB", "COLOR", Pass.ALBEDO)


def register_passes(engine, scene, view_layer):
    for item in render_passes(scene, view_layer):
        engine.register_pass(scene, view_layer, item.name, len(item.channels), item.channels, item.kind)


def fill(layer, read, wanted):
    """Copies the passes of a result's layer; read(Pass) gives (height, width, channels) float32."""
    images = {}
    sources = {item.name: item.source for item in wanted}
    for target in layer.passes:
        source = sources.get(target.name)
        if source is None:
            continue
        if source not in images:
            images[source] = np.ascontiguousarray(read(source), np.float32)
        _upload(target, images[source])


def _upload(target, image):
    # foreach_set of older Blenders compares the length with the number of pixels, and then copies the whole buffer.
    rows = image.reshape(-1, image.shape[2])
    target.rect.foreach_set(rows.ravel() if bpy.app.version >= (4, 0) else rows)
