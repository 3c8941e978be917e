"""Render passes: one list for registration and for filling."""

from typing import NamedTuple

import bpy
import numpy as np

from ..bindings.enums import Pass
from ..denoise import view_layer as denoise


class RenderPass(NamedTuple):
    name: str  # Blender's name, by which compositors and files refer to the pass
    channels: str
    kind: str  # VALUE, VECTOR or COLOR
    source: Pass | None  # None: the engine fills it after denoising


# Name of the view layer's switch use_pass_*, name of the pass from Blender 5 on and before, channels, kind, source.
_TABLE = (
    ("z", "Depth", "Depth", "Z", "VALUE", Pass.DEPTH),
    ("mist", "Mist", "Mist", "Z", "VALUE", Pass.MIST),
    ("position", "Position", "Position", "XYZ", "VECTOR", Pass.POSITION),
    ("normal", "Normal", "Normal", "XYZ", "VECTOR", Pass.NORMAL),
    ("uv", "UV", "UV", "UVA", "VECTOR", Pass.UV),
    ("object_index", "Object Index", "IndexOB", "X", "VALUE", Pass.OBJECT_INDEX),
    ("material_index", "Material Index", "IndexMA", "X", "VALUE", Pass.MATERIAL_INDEX),
    ("diffuse_direct", "Diffuse Direct", "DiffDir", "RGB", "COLOR", Pass.DIFFUSE_DIRECT),
    ("diffuse_indirect", "Diffuse Indirect", "DiffInd", "RGB", "COLOR", Pass.DIFFUSE_INDIRECT),
    ("diffuse_color", "Diffuse Color", "DiffCol", "RGB", "COLOR", Pass.DIFFUSE_COLOR),
    ("glossy_direct", "Glossy Direct", "GlossDir", "RGB", "COLOR", Pass.GLOSSY_DIRECT),
    ("glossy_indirect", "Glossy Indirect", "GlossInd", "RGB", "COLOR", Pass.GLOSSY_INDIRECT),
    ("glossy_color", "Glossy Color", "GlossCol", "RGB", "COLOR", Pass.GLOSSY_COLOR),
    ("transmission_direct", "Transmission Direct", "TransDir", "RGB", "COLOR", Pass.TRANSMISSION_DIRECT),
    ("transmission_indirect", "Transmission Indirect", "TransInd", "RGB", "COLOR", Pass.TRANSMISSION_INDIRECT),
    ("transmission_color", "Transmission Color", "TransCol", "RGB", "COLOR", Pass.TRANSMISSION_COLOR),
    ("emit", "Emission", "Emit", "RGB", "COLOR", Pass.EMISSION),
    ("environment", "Environment", "Env", "RGB", "COLOR", Pass.ENVIRONMENT),
    ("ambient_occlusion", "Ambient Occlusion", "AO", "RGB", "COLOR", Pass.AMBIENT_OCCLUSION),
)
_DENOISED_ERROR = "Lancer Denoised Error"
_NAME = 1 if bpy.app.version >= (5, 0) else 2


def render_passes(scene, view_layer):
    """Yield the passes that a view layer requests."""
    yield RenderPass("Combined", "RGBA", "COLOR", Pass.COMBINED)
    for row in _TABLE:
        if getattr(view_layer, "use_pass_" + row[0]):
            yield RenderPass(row[_NAME], *row[3:])
    if denoise.wanted(scene, view_layer):
        yield RenderPass("Noisy Image", "RGBA", "COLOR", Pass.COMBINED)
    # The switch belongs to Cycles, an add-on that may be disabled.
    denoising = getattr(getattr(view_layer, "cycles", None), "denoising_store_passes", False)
    if denoising:
        yield RenderPass("Denoising Normal", "XYZ", "VECTOR", Pass.DENOISING_NORMAL)
    if denoising or scene.lancer.use_pass_albedo:
        yield RenderPass("Denoising Albedo", "RGB", "COLOR", Pass.ALBEDO)
    if denoising:
        yield RenderPass("Denoising Depth", "Z", "VALUE", Pass.DENOISING_DEPTH)
    if scene.lancer.use_pass_error:
        yield RenderPass("Lancer Error", "X", "VALUE", Pass.ERROR)
        if denoise.wanted(scene, view_layer):
            yield RenderPass(_DENOISED_ERROR, "X", "VALUE", None)


def sources(wanted):
    """Return the core's passes of RenderPasses."""
    return tuple(item.source for item in wanted if item.source is not None)


def register_passes(engine, scene, view_layer):
    for item in render_passes(scene, view_layer):
        engine.register_pass(scene, view_layer, item.name, len(item.channels), item.channels, item.kind)


def fill(layer, read, wanted):
    """Fill the passes of a result's layer; read(Pass) returns (height, width, channels) float32."""
    sources = {item.name: item.source for item in wanted}
    for target in layer.passes:
        source = sources.get(target.name)
        if source is not None:
            _upload(target, np.ascontiguousarray(read(source), np.float32))


def show_denoised(layer, denoised):
    """Replace Combined, of all views with stereoscopy, by the image of a Denoised, and fill the pass of its error."""
    for target in layer.passes:
        if target.name == "Combined":
            _upload(target, denoised.image)
        elif target.name == _DENOISED_ERROR and denoised.combined is not None:
            _upload(target, np.ascontiguousarray(denoised.combined.bars[..., None]))


def _upload(target, image):
    # Before 4.0 foreach_set compares the length with the number of pixels and then copies the whole buffer: pass one row per
    # pixel.
    rows = image.reshape(-1, image.shape[2])
    target.rect.foreach_set(rows.ravel() if bpy.app.version >= (4, 0) else rows)
