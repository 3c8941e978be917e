"""Images beyond the limit of memory, in a file that the library maps."""

import errno
import gc
import io
import os
import tempfile

import bpy
import numpy as np
import stage
from export_cases import ExportProbe, export_told
from image_cases import SIZE, image, show

from addon import engine
from addon.bindings.blocks import Blocks
from addon.bindings.enums import AlphaMode, Pass
from addon.bindings.session import Cancelled, Session
from addon.bindings.snapshot import SceneSnapshot
from addon.export import image_sources, scratch
from scenes.parity import image_files

WIDTH, HEIGHT = 1030, 517


def _build():
    """Show large images of each depth, with and without alpha, and a small one; a sky with a large image."""
    scene = stage.empty(48, 32, 4)
    random = np.random.default_rng(1)
    texels = random.integers(0, 256, (HEIGHT, WIDTH, 4))
    fields_of = {"straight": {}, "opaque": {}, "packed": {"alpha_mode": "CHANNEL_PACKED"}, "bright": {"is_float": True}}
    for number, (name, fields) in enumerate(fields_of.items()):
        channels = 3 if name == "opaque" else 4
        values = texels[..., :channels] / (1.0 if name != "bright" else 64.0)
        known = set(bpy.data.objects)
        show(image(name, values, **fields), name)
        (cube,) = set(bpy.data.objects) - known
        cube.location.x = 1.5 * number - 2.25
        cube.data.uv_layers.new()
    show(image("small", texels[:8, :8, :3]), "small")
    world = scene.world or bpy.data.worlds.new("World")
    scene.world = world
    world.use_nodes = True
    node = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = image("sky", texels[..., :3])
    world.node_tree.links.new(node.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])
    return scene


def _open_files():
    """Return the number of scratch files that this process has open, with or without a name."""
    links = (os.path.join("/proc/self/fd", name) for name in os.listdir("/proc/self/fd"))
    named = [os.readlink(link) for link in links if os.path.lexists(link)]
    folder = os.path.realpath(bpy.app.tempdir)
    return sum(os.path.dirname(name) == folder for name in named) + len(_names())


def _names():
    return [name for name in os.listdir(bpy.app.tempdir) if name.startswith("lancer_")]


def _exported():
    told = export_told()
    ExportProbe.caught = None
    return told


def _picture(snapshot):
    with Session.upload(snapshot) as session:
        assert session.render_all(4)
        return session.read(Pass.COMBINED), session.statistics()


def bits():
    """Render with all images in memory and with those beyond one byte in a file, and from a saved snapshot of the latter."""
    _build()
    # Files end with their last user, not with the next collection of cycles.
    gc.disable()
    plain, told = _exported()
    scratch.image_memory = 1
    moved, told_moved = _exported()
    (want, before), (got, after) = _picture(plain), _picture(moved)
    saved = io.BytesIO()
    moved.save(saved)
    saved.seek(0)
    loaded = SceneSnapshot.load(saved)
    again, _ = _picture(loaded)
    answer = {
        "images": {
            picture.name: [isinstance(picture.texels, Blocks), AlphaMode(picture.alpha).name] for picture in moved.images
        },
        "rows": [np.asarray(a.texels).nbytes == b.texels.nbytes for a, b in zip(moved.images, plain.images, strict=True)],
        "equal": want.tobytes() == got.tobytes(),
        "loaded": want.tobytes() == again.tobytes() and loaded == moved,
        "varied": float(want.std()),
        "before": [before.texture_bytes, before.mapped_bytes],
        "after": [after.texture_bytes, after.mapped_bytes],
        "messages": [told.lines(), told_moved.lines()],
        "open": _open_files(),
    }
    # The snapshot owns the file.
    del moved, loaded
    gc.enable()
    return {**answer, "left": _open_files()}


def ends():
    """Render with a file: to the end, cancelled, failed; return the statistics and the files that are left."""
    scene = _build()
    scratch.image_memory = 1
    scene.render.engine = "LANCER"
    stage.camera()
    bpy.ops.render.render()
    left, statistics = [_open_files()], engine.last_statistics[scene.name]
    snapshot, _ = _exported()
    try:
        Session.upload(snapshot, poll=lambda: True, release=True)
    except Cancelled:
        pass
    del snapshot
    left.append(_open_files())
    scene.render.engine = "LANCER"
    scene.render.resolution_x = scene.render.resolution_y = 65536
    try:
        bpy.ops.render.render()
        failed = False
    except RuntimeError:
        failed = True
    left.append(_open_files())
    return {"left": left, "failed": failed, "mapped": statistics["mapped_bytes"]}


def full():
    """Export when the disk has no room."""
    _build()
    scratch.image_memory = 1

    class Full(io.BytesIO):
        def write(self, data):
            raise OSError(errno.ENOSPC, "No space left on device")

    made = scratch.tempfile.TemporaryFile
    scratch.tempfile.TemporaryFile = lambda **_: Full()
    try:
        snapshot, told = _exported()
    finally:
        scratch.tempfile.TemporaryFile = made
    return {"moved": sum(isinstance(picture.texels, Blocks) for picture in snapshot.images), "messages": told.lines()}


def full_for_layers():
    """Export a file of layers, of which one is copied to a temporary file, when the disk has no room."""
    stage.empty()
    planes = {f"{part}.Pass.{shade}": np.full((SIZE, SIZE), 0.5) for part in "AB" for shade in "RGB"}
    show(bpy.data.images.load(image_files.write_layers(os.path.join(tempfile.mkdtemp(), "layers"), planes)))

    def refuse(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    made, image_sources.tempfile.mkstemp = image_sources.tempfile.mkstemp, refuse
    try:
        snapshot, told = _exported()
    finally:
        image_sources.tempfile.mkstemp = made
    return {"sizes": [list(picture.texels.shape) for picture in snapshot.images], "messages": told.lines()}


def changed_limit():
    """Return whether a Scratch moves images after the preference has become smaller."""
    _build()
    scratch.image_memory = 1 << 40
    kept = scratch.Scratch()
    pictures = _exported()[0].images
    results = []
    for scratch.image_memory in (1 << 40, 1):
        found = kept.stored(pictures, 0, lambda *_, **__: None)
        results.append(sum(isinstance(picture.texels, Blocks) for picture in found))
    return results
