"""Files of finished pictures, written by OpenImageIO: OpenEXR with all passes under Blender's names, or PNG for a screen."""

import os
import tempfile

import numpy as np

from ..bindings.abi import LancerError
from ..measure import render_report

# Blender's name of a scene's first view layer; a snapshot has no name of its own.
LAYER = "ViewLayer"
ENDINGS = (".exr", ".png")
_COLORS = ("RGB", "RGBA")
_LARGEST_HALF = 65504.0


def fault(path):
    """Return a sentence about why no picture can be written to path, as far as it is known before the render, or None."""
    folder, name = os.path.split(os.path.abspath(path))
    if _ending(name) not in ENDINGS:
        return f"{name}: the name of a picture ends in {' or '.join(ENDINGS)}"
    if not os.path.isdir(folder):
        return f"{folder}: there is no such folder"
    return None


def library():
    """Return the module OpenImageIO; raise LancerError without it."""
    try:
        import OpenImageIO
    except ImportError as error:
        raise LancerError(f"OpenImageIO, which writes pictures, is missing ({error}): pip install OpenImageIO") from None
    return OpenImageIO


def write(rendered, path, half=False):
    """Write a Rendered; raise LancerError or OSError. half: colours with 16 bits, of which 65504 is the largest.

    An unfinished file never has the name.
    """
    what = fault(path)
    if what:
        raise LancerError(what)
    folder, name = os.path.split(os.path.abspath(path))
    module = library()
    spec, pixels = _exr(module, rendered, half) if _ending(name) == ".exr" else _png(module, rendered)
    for field, text in render_report.fields(rendered.statistics, rendered.settings):
        spec.attribute(f"lancer.{LAYER}.{field}", text)
    for field, text in rendered.metadata:
        spec.attribute(field, text)
    spec.attribute("Software", f"Lancer {rendered.statistics['version']}")
    with tempfile.TemporaryDirectory(prefix=f".{name}.", dir=folder) as place:
        whole = os.path.join(place, name)
        output = module.ImageOutput.create(whole)
        written = output is not None and output.open(whole, spec) and output.write_image(pixels)
        if not (written and output.close()):
            raise LancerError(f"{path} could not be written: {output.geterror() if output else module.geterror()}")
        os.replace(whole, path)


def _ending(name):
    return os.path.splitext(name)[1].lower()


def _exr(module, rendered, half):
    """Return (spec, pixels) of all passes; Combined alone has plain channels, as in Blender's OpenEXR without layers."""
    names, kinds, planes = [], [], []
    for name, image in rendered.passes.items():
        channels = rendered.channels[name]
        prefix = f"{LAYER}.{name}." if len(rendered.passes) > 1 else ""
        small = half and channels in _COLORS
        names += [prefix + channel for channel in channels]
        kinds += ["half" if small else "float"] * len(channels)
        planes.append(np.clip(image, -_LARGEST_HALF, _LARGEST_HALF) if small else image)
    pixels = np.concatenate(planes, axis=2)
    height, width, count = pixels.shape
    spec = module.ImageSpec(width, height, count, "float")
    spec.channelnames, spec.channelformats = tuple(names), tuple(kinds)
    camera = rendered.camera
    # Files count rows from the top, cameras from the bottom.
    spec.x, spec.y = camera.x, camera.height - camera.y - camera.region_height
    spec.full_x, spec.full_y, spec.full_width, spec.full_height = 0, 0, camera.width, camera.height
    spec.attribute("compression", "zip")
    return spec, pixels


def _png(module, rendered):
    pixels = on_screen(rendered.picture)
    height, width, count = pixels.shape
    spec = module.ImageSpec(width, height, count, "uint8")
    # PNG's colours are not multiplied by alpha, and these are not: no conversion.
    spec.attribute("oiio:UnassociatedAlpha", 1)
    spec.attribute("oiio:ColorSpace", "sRGB")
    return spec, pixels


def on_screen(picture):
    """Return a linear RGBA picture as (height, width, 4) uint8 for an sRGB screen, with colours not multiplied by alpha."""
    alpha = np.clip(picture[..., 3:], 0.0, 1.0)
    color = np.divide(picture[..., :3], alpha, out=np.zeros_like(picture[..., :3]), where=alpha > 0.0)
    color = np.clip(color, 0.0, 1.0)
    encoded = np.where(color <= 0.0031308, 12.92 * color, 1.055 * color ** (1.0 / 2.4) - 0.055)
    return (255.0 * np.concatenate([encoded, alpha], axis=2) + 0.5).astype(np.uint8)
