"""Render passes: one list for registration and for filling."""

from typing import NamedTuple

import bpy
import numpy as np

from ..bindings.enums import Pass, PassKind
from ..bindings.numbered_pass import NumberedPass
from ..bindings.pass_names import NAMES
from ..denoise import view_layer as denoise
from ..export import catchers
from ..export.named_passes import named_passes


class RenderPass(NamedTuple):
    name: str  # Blender's name, by which compositors and files refer to the pass
    channels: str
    kind: str  # VALUE, VECTOR or COLOR
    source: Pass | NumberedPass | None  # None: the engine fills it after denoising


# Name of the view layer's switch use_pass_*, source, kind.
_TABLE = (
    ("z", Pass.DEPTH, "VALUE"),
    ("mist", Pass.MIST, "VALUE"),
    ("position", Pass.POSITION, "VECTOR"),
    ("normal", Pass.NORMAL, "VECTOR"),
    ("vector", Pass.VECTOR, "VECTOR"),
    ("uv", Pass.UV, "VECTOR"),
    ("object_index", Pass.OBJECT_INDEX, "VALUE"),
    ("material_index", Pass.MATERIAL_INDEX, "VALUE"),
    ("diffuse_direct", Pass.DIFFUSE_DIRECT, "COLOR"),
    ("diffuse_indirect", Pass.DIFFUSE_INDIRECT, "COLOR"),
    ("diffuse_color", Pass.DIFFUSE_COLOR, "COLOR"),
    ("glossy_direct", Pass.GLOSSY_DIRECT, "COLOR"),
    ("glossy_indirect", Pass.GLOSSY_INDIRECT, "COLOR"),
    ("glossy_color", Pass.GLOSSY_COLOR, "COLOR"),
    ("transmission_direct", Pass.TRANSMISSION_DIRECT, "COLOR"),
    ("transmission_indirect", Pass.TRANSMISSION_INDIRECT, "COLOR"),
    ("transmission_color", Pass.TRANSMISSION_COLOR, "COLOR"),
    ("emit", Pass.EMISSION, "COLOR"),
    ("environment", Pass.ENVIRONMENT, "COLOR"),
    ("ambient_occlusion", Pass.AMBIENT_OCCLUSION, "COLOR"),
)
_SAMPLE_COUNT, _RENDER_TIME = NumberedPass(PassKind.SAMPLES), NumberedPass(PassKind.RENDER_TIME)
_DENOISED_ERROR = "Lancer Denoised Error"
_LONG_NAMES = bpy.app.version >= (5, 0)
_ALL_GUIDES = bpy.app.version >= (5, 2)


def _pass(source, kind):
    named = NAMES[source]
    return RenderPass(named.name if _LONG_NAMES else named.short, named.channels, kind, source)


# The passes of a picture alone.
COMBINED = (_pass(Pass.COMBINED, "COLOR"),)


def render_passes(scene, view_layer):
    """Yield the passes that a view layer requests."""
    yield _pass(Pass.COMBINED, "COLOR")
    for switch, source, kind in _TABLE:
        if getattr(view_layer, "use_pass_" + switch):
            yield _pass(source, kind)
    # These switches belong to Cycles, an add-on that may be disabled.
    cycles = getattr(view_layer, "cycles", None)
    if getattr(cycles, "pass_debug_sample_count", False):
        yield RenderPass("Debug Sample Count", "X", "VALUE", _SAMPLE_COUNT)
    if getattr(cycles, "pass_render_time", False):
        yield RenderPass("Render Time", "X", "VALUE", _RENDER_TIME)
    for named in named_passes(view_layer):
        yield RenderPass(named.name, named.channels, "VALUE" if named.channels == "X" else "COLOR", named.source)
    if denoise.wanted(scene, view_layer):
        yield RenderPass("Noisy Image", "RGBA", "COLOR", Pass.COMBINED)
    denoising = getattr(cycles, "denoising_store_passes", False)
    if denoising:
        yield _pass(Pass.DENOISING_NORMAL, "VECTOR")
    if denoising or scene.lancer.use_pass_albedo:
        yield _pass(Pass.ALBEDO, "COLOR")
    if denoising and _ALL_GUIDES:
        yield _pass(Pass.SPECULAR_ALBEDO, "COLOR")
        yield _pass(Pass.ROUGHNESS, "VALUE")
    if denoising:
        yield _pass(Pass.DENOISING_DEPTH, "VALUE")
    if scene.lancer.use_pass_error:
        yield _pass(Pass.ERROR, "VALUE")
        if denoise.wanted(scene, view_layer):
            yield RenderPass(_DENOISED_ERROR, "X", "VALUE", None)


def sources(wanted):
    """Return the core's passes of RenderPasses."""
    return tuple(item.source for item in wanted if item.source is not None)


def register_passes(engine, scene, view_layer):
    for item in render_passes(scene, view_layer):
        engine.register_pass(scene, view_layer, item.name, len(item.channels), item.channels, item.kind)


def fill(layer, read, wanted):
    """Fill the passes of a result's layer; read(source) returns (height, width, channels) float32."""
    sources = {item.name: item.source for item in wanted}
    for target in layer.passes:
        source = sources.get(target.name)
        if source is not None:
            image = np.ascontiguousarray(read(source), np.float32)
            # As in Cycles, samples are counted as a share of those of the pixel with the most.
            _upload(target, image / max(1.0, float(image.max())) if source == _SAMPLE_COUNT else image)


def show_denoised(layer, denoised):
    """Replace Combined, of all views with stereoscopy, and Shadow Catcher by a Denoised; fill the pass of its error."""
    for target in layer.passes:
        if target.name == "Combined":
            _upload(target, denoised.image)
        elif target.name == catchers.TITLE and denoised.catcher is not None:
            _upload(target, np.ascontiguousarray(denoised.catcher))
        elif target.name == _DENOISED_ERROR and denoised.combined is not None:
            _upload(target, np.ascontiguousarray(denoised.combined.bars[..., None]))


def _upload(target, image):
    # Before 4.0 foreach_set compares the length with the number of pixels and then copies the whole buffer: pass one row per
    # pixel.
    rows = image.reshape(-1, image.shape[2])
    target.rect.foreach_set(rows.ravel() if bpy.app.version >= (4, 0) else rows)
