"""Renders a snapshot, alone or in a bug report, as the engine would; Blender only writes the image file."""

import dataclasses
import math
import os
import sys

import bpy
import numpy as np

from addon.bindings import bug_report
from addon.bindings.abi import LancerError
from addon.bindings.npz import SnapshotError
from addon.bindings.session import Session
from addon.measure import render_report
from addon.measure.scene_features import kernel_in_words, used_features
from addon.measure.schedule import Schedule
from addon.messages.messages import Messages


def load(path, samples=None):
    """Returns (snapshot, facts) of a file; ends the program with a message if the file has no snapshot."""
    try:
        snapshot, facts = bug_report.load(path)
    except FileNotFoundError:
        sys.exit(f"{path}: there is no such file.")
    except (OSError, SnapshotError) as error:
        sys.exit(str(error))
    if samples is not None:
        settings = dataclasses.replace(snapshot.settings, samples=samples, target_error=0.0, time_limit=0.0)
        snapshot = dataclasses.replace(snapshot, settings=settings)
    return snapshot, facts


def render(snapshot, show):
    """Returns (picture as (height, width, 4) float32, the library's Messages, statistics); show(text) receives the progress."""
    try:
        with Session.upload(snapshot) as session:
            schedule = Schedule(session)
            while schedule.start():
                while True:
                    progress = schedule.wait(0.25)
                    show(f"Sample {progress.samples // schedule.pixels}/{schedule.settings.samples}")
                    if progress.finished:
                        break
            numbers = render_report.account(session, schedule) | {"denoised": ""}
            return session.read(), Messages.of_library(session.messages()), numbers
    except LancerError as error:
        sys.exit(f"Lancer: {error}")


def write(picture, path, kind):
    """Writes the picture. kind: one of Blender's file formats. Formats of 8 bits get the view transform Standard."""
    height, width = picture.shape[:2]
    image = bpy.data.images.new("Replay", width, height, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709" if bpy.app.version >= (4, 0) else "Linear"
    image.pixels.foreach_set(np.ascontiguousarray(picture, np.float32).ravel())
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_depth = kind, "32" if kind in ("OPEN_EXR", "HDR") else "8"
    settings.color_mode = "RGB" if kind in ("JPEG", "HDR") else "RGBA"
    image.save_render(str(path), scene=scene)
    bpy.data.images.remove(image)


def report(snapshot, facts, messages, numbers):
    """Yields lines about the render."""
    for name, version in facts.get("versions", {}).items():
        yield f"reported with {name}: {version}"
    for message in facts.get("exported", ()):
        yield f"reported: {message['text']}"
    yield from messages.lines()
    yield from render_report.lines(numbers, snapshot.settings)
    before = (facts.get("statistics") or {}).get("error", math.inf)
    if math.isfinite(before):
        yield f"reported error: {render_report.percent(before)}"
    yield f"{numbers['rays_per_second'] / 1e6:.2f} million rays/s, {numbers['threads']} threads, {numbers['instruction_set']}"
    yield from (feature.text for feature in used_features(snapshot))
    yield f"shaded by the code for {kernel_in_words(numbers['kernel'])}"


def replay(path, samples, output, kind, progress):
    """Renders the file to output; returns the lines of its report."""
    snapshot, facts = load(path, samples)
    picture, messages, numbers = render(snapshot, progress)
    write(picture, output, kind)
    return [*report(snapshot, facts, messages, numbers), os.path.relpath(output)]
