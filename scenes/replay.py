"""Renders a snapshot, alone or in a bug report, as the engine would; Blender only writes the image file."""

import os
import sys

import bpy
import numpy as np

from addon.bindings import bug_report
from addon.bindings.abi import LancerError
from addon.bindings.npz import SnapshotError
from addon.farm import render_snapshot


def load(path):
    """Returns (snapshot, facts) of a file; ends the program with a message if the file has no snapshot."""
    try:
        return bug_report.load(path)
    except FileNotFoundError:
        sys.exit(f"{path}: there is no such file.")
    except (OSError, SnapshotError) as error:
        sys.exit(str(error))


def write(picture, path, kind):
    """Writes the picture. kind: one of Blender's file formats. Formats of 8 bits get the view transform Standard."""
    height, width = picture.shape[:2]
    image = bpy.data.images.new("Replay", width, height, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709" if bpy.app.version >= (4, 0) else "Linear"
    # Blender's images begin with the bottom row.
    image.pixels.foreach_set(np.ascontiguousarray(picture[::-1], np.float32).ravel())
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_depth = kind, "32" if kind in ("OPEN_EXR", "HDR") else "8"
    settings.color_mode = "RGB" if kind in ("JPEG", "HDR") else "RGBA"
    image.save_render(str(path), scene=scene)
    bpy.data.images.remove(image)


def replay(path, samples, output, kind, progress):
    """Renders the file to output; returns the lines of its report. progress(text) is called during the render."""
    snapshot, facts = load(path)
    snapshot = render_snapshot.adjusted(snapshot, samples)
    try:
        rendered = render_snapshot.render(snapshot, tell=lambda _, text: progress(text))
    except LancerError as error:
        sys.exit(f"Lancer: {error}")
    write(rendered.picture, output, kind)
    return [*render_snapshot.report(snapshot, facts, rendered), os.path.relpath(output)]
