"""The painter of a view without a window: it shows the pictures of a session, and serves the newest request first."""

import dataclasses
import gc
import threading
import time

import bpy
import numpy as np
import stage

from addon.bindings import snapshot
from addon.bindings.abi import LancerError
from addon.bindings.session import Scene, Session
from addon.denoise import denoiser
from addon.export.scene import export_scene
from addon.export.view import Rectangle, View
from addon.viewport.painter import Painter, Wanted
from addon.viewport.sizes import PixelSizes, coarsest

_PATIENCE = 60.0


def _contents(samples=8):
    stage.room()
    whole, _ = export_scene(bpy.context.evaluated_depsgraph_get())
    return whole.replaced(settings=dataclasses.replace(whole.settings, samples=samples, target_error=0.0, time_limit=0.0))


def _view(whole, width=96, height=64):
    size = {"width": width, "height": height, "region_width": width, "region_height": height, "x": 0, "y": 0}
    return View(Rectangle(0, 0, width, height), whole.camera.replaced(**size))


def _wanted(whole, view, finest=1, denoising=False):
    return Wanted(whole, whole.settings, view, finest, coarsest(view.rectangle, finest, 16), denoising)


def _until(painter, condition):
    limit = time.monotonic() + _PATIENCE
    while not condition():
        assert time.monotonic() < limit
        painter.step()
        time.sleep(0.005)


def _left(painter):
    """Close the painter. Return the number of scenes and sessions of the library that are still open."""
    painter.close()
    gc.collect()
    return sum(type(thing) in (Scene, Session) and thing._finalizer.alive for thing in gc.get_objects())


def bits():
    """Return whether finished pictures of two views, at two pixel sizes, equal those of a session, and their sizes."""
    whole = _contents()
    painter = Painter()
    equal, sizes = [], []
    for width, finest in ((96, 1), (50, 1), (96, 2)):
        wanted = _wanted(whole, _view(whole, width), finest)
        painter.want(wanted)
        _until(painter, lambda: not painter.is_busy)
        picture = painter.picture
        with Session.upload(whole.replaced(camera=wanted.view.coarser(finest))) as session:
            session.render_all(8)
            equal.append(bool(np.array_equal(session.read(), picture.image)) and picture.wanted is wanted)
        sizes.append((picture.size, picture.samples, *picture.image.shape))
    return {"equal": equal, "sizes": sizes, "left": _left(painter), "failure": painter.failure}


def _sphere(rings, segments):
    """Return a mesh of many triangles, made without Blender."""
    theta, phi = np.meshgrid(np.linspace(0.01, 3.13, rings), np.linspace(0.0, 6.28, segments, endpoint=False), indexing="ij")
    places = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=2).reshape(-1, 3)
    first = (np.arange(rings - 1)[:, None] * segments + np.arange(segments)).ravel()
    after = (np.arange(rings - 1)[:, None] * segments + (np.arange(segments) + 1) % segments).ravel()
    faces = np.concatenate(
        [np.stack([first, first + segments, after], 1), np.stack([after, first + segments, after + segments], 1)]
    )
    return snapshot.MeshData("sphere", places, faces)


def newest():
    """Request a heavy scene, then a light one: the heavy one is abandoned. A view that keeps moving is still shown."""
    light = _contents(samples=100000)
    meshes = (_sphere(1200, 1200),)
    heavy = light.replaced(meshes=meshes, instances=snapshot.InstanceTable.build([{"mesh": 0, "name": "sphere"}]))
    painter = Painter()
    view = _view(light)
    painter.want(_wanted(heavy, view))
    painter.step()
    assert painter.is_building
    wanted = _wanted(light, view)
    painter.want(wanted)
    _until(painter, lambda: painter.picture is not None)
    first = painter.picture.wanted is wanted
    # Each step moves the view, however long the painter takes for a picture.
    shown, steps = set(), 0
    limit = time.monotonic() + _PATIENCE
    while len(shown) < 3 and time.monotonic() < limit:
        steps += 1
        matrix = light.camera.matrix.copy()
        matrix[0, 3] += 0.01 * steps
        painter.want(_wanted(light, View(view.rectangle, view.camera.replaced(matrix=matrix))))
        painter.step()
        time.sleep(0.005)
        shown.add(painter.picture.wanted.view.camera.matrix[0, 3])
    return {"first": first, "shown": len(shown), "left": _left(painter)}


def fails():
    """A scene that cannot be rendered is reported, and the next request is rendered."""
    whole = _contents()
    painter = Painter()
    view = _view(whole)
    wrong = whole.replaced(meshes=(snapshot.MeshData("bad", np.zeros((3, 3)), [[0, 1, 7]]),))
    painter.want(_wanted(wrong, view))
    _until(painter, lambda: painter.failure)
    told = painter.failure
    wanted = _wanted(whole, view)
    painter.want(wanted)
    _until(painter, lambda: painter.picture is not None and not painter.is_busy)
    return {"told": told, "failure": painter.failure, "right": painter.picture.wanted is wanted, "left": _left(painter)}


def denoiser_fails():
    """If denoising fails, the picture stays noisy, and the reason is reported once."""

    def broken(*_, **__):
        raise LancerError("Open Image Denoise: out of order")

    whole = _contents(samples=4)
    painter = Painter()
    plain, denoiser.denoise = denoiser.denoise, broken
    try:
        painter.want(_wanted(whole, _view(whole), denoising=True))
        _until(painter, lambda: not painter.is_busy)
    finally:
        denoiser.denoise = plain
    picture = painter.picture
    return {
        "told": [line for line in painter.messages if "out of order" in line],
        "denoised": picture.denoised,
        "samples": picture.samples,
        "failure": painter.failure,
        "left": _left(painter),
    }


def denoises():
    """Return the share of the noise that is left in a finished picture after denoising, and whether alpha is unchanged."""
    whole = _contents(samples=4)
    painter = Painter()
    view = _view(whole, 192, 128)
    pictures, coarse = [], {}

    def is_done():
        # The rendered sizes of the pixels, and whether a picture of this size was denoised.
        if painter.picture is not None and painter.picture.size > 1:
            coarse[painter.picture.size] = painter.picture.denoised
        return not painter.is_busy

    for denoising in (False, True):
        painter._sizes = PixelSizes()
        painter.want(_wanted(whole, view, denoising=denoising))
        _until(painter, is_done)
        pictures.append(painter.picture)
    noisy, clean = (picture.image for picture in pictures)
    roughness = [float(np.abs(np.diff(image[:, :, :3], n=2, axis=1)).mean()) for image in (noisy, clean)]
    return {
        "denoised": [picture.denoised for picture in pictures],
        "coarse": sorted(coarse.items()),
        "roughness": roughness,
        "alpha": bool(np.array_equal(noisy[:, :, 3], clean[:, :, 3])),
        "failure": painter.failure,
        "left": _left(painter),
        "threads": [thread.name for thread in threading.enumerate() if "lancer" in thread.name],
    }


def slow_denoiser():
    """Let denoising take as long as the samples: pictures go on, and the last one is denoised."""
    release, calls = threading.Event(), []
    plain = denoiser.denoise

    def slow(color, *_, **__):
        calls.append(len(calls))
        release.wait(_PATIENCE)
        return denoiser.Denoised(color, 0.0, 0, "")

    whole = _contents(samples=64)
    painter = Painter()
    denoiser.denoise = slow
    try:
        painter.want(_wanted(whole, _view(whole), denoising=True))
        _until(painter, lambda: painter.picture is not None and painter.picture.samples == 64)
        meanwhile = {"denoised": painter.picture.denoised, "calls": len(calls), "busy": painter.is_busy}
        release.set()
        _until(painter, lambda: not painter.is_busy)
    finally:
        denoiser.denoise = plain
        release.set()
    picture = painter.picture
    return {"meanwhile": meanwhile, "last": [picture.samples, picture.denoised], "calls": len(calls), "left": _left(painter)}
