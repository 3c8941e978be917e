"""Animations with changing and unchanged objects: compare each frame with a separate render; count what is exported anew."""

import os
import tempfile

import bpy
import memory_now
import numpy as np
import stage

import addon

FRAMES = (1, 2, 3)
_COUNTS = ("read_meshes", "kept_meshes", "read_images", "kept_images")


def _write(path, value):
    image = bpy.data.images.new("written", 8, 8)
    image.pixels.foreach_set(np.tile(np.array([value, 0.5, 0.25, 1.0], np.float32), 64))
    image.filepath_raw, image.file_format = path, "PNG"
    image.save()
    bpy.data.images.remove(image)


def _pictured(name, path):
    """Return a material that shows the image in a file."""
    material = stage.shader("ShaderNodeEmission", name)
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.load(path)
    tree.links.new(node.outputs["Color"], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Color"])
    return material


def _row(number, name, material=None):
    item = stage.cube(0.8, material or stage.shader(Color=(0.7, 0.7, 0.7)), location=(number - 3.5, 0, 0))
    item.name = item.data.name = name
    item.data.uv_layers.new()
    return item


def _animate(owner, path, first, last):
    for frame, value in ((FRAMES[0], first), (FRAMES[-1], last)):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def _build(folder):
    """Build a row of boxes that change in different ways. Return the scene, and a handler that makes some of the changes."""
    scene = stage.empty(64, 16, 4)
    still = os.path.join(folder, "still.png")
    changed = os.path.join(folder, "changed.png")
    for path in (still, changed):
        _write(path, 0.5)
    _row(0, "Still", _pictured("Still", still))
    moved = _row(1, "Moved")
    _animate(moved, "location", (-2.5, 0, 0), (-2.5, 0.5, 0))
    keyed = _row(2, "Keyed")
    keyed.shape_key_add(name="Basis")
    key = keyed.shape_key_add(name="Wide")
    key.data[0].co.z += 0.8
    _animate(key, "value", 0.0, 1.0)
    bent = _row(3, "Bent")
    modifier = bent.modifiers.new("Bend", "SIMPLE_DEFORM")
    _animate(modifier, "factor", 0.0, 1.5)
    driven = _row(4, "Driven")
    wave = driven.modifiers.new("Displace", "DISPLACE")
    curve = wave.driver_add("strength")
    curve.driver.expression = "frame * 0.1"
    slotted = _row(5, "Slotted", stage.shader(Color=(0.9, 0.1, 0.1)))
    slotted.data.materials.append(stage.shader(Color=(0.1, 0.1, 0.9)))
    swapped = _row(6, "Swapped")
    swapped.material_slots[0].link = "OBJECT"
    others = [stage.shader(Color=(0.1, 0.2 * frame, 0.1)) for frame in FRAMES]
    _row(7, "Repainted", _pictured("Repainted", changed))
    # A second mesh, equal to the first except for one corner of its UV map.
    twin = _row(0, "Still too", bpy.data.materials["Still"])
    twin.location.z = 1.5
    stage.light("SUN", 3.0, (0, -3, 5), (0.5, 0.3, 0))
    stage.sky()
    stage.camera((0, -8, 3), (0, 0, 0.3), type="ORTHO", ortho_scale=9.0)
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]

    def change(scene, *_):
        frame = scene.frame_current
        slotted.data.polygons.foreach_set("material_index", [int(index < frame) for index in range(6)])
        slotted.data.update()
        swapped.material_slots[0].material = others[frame - 1]
        _write(changed, 0.2 * frame)
        # The system's clock may give two changes within one of its ticks the same time.
        os.utime(changed, ns=(frame * 10**9, frame * 10**9))

    return scene, change


def _long(count):
    """Build meshes, a material and particles that change in each frame, up to that frame."""
    scene = stage.empty(8, 8, 1)
    ground = stage.plane(4.0, stage.shader(Color=(0.6, 0.6, 0.6)))
    bent = stage.ball(0.8, stage.shader(name="Tinted", Color=(0.8, 0.2, 0.2)), segments=96, location=(0, 0, 1))
    wave = bent.modifiers.new("Wave", "DISPLACE")
    curve = wave.driver_add("strength")
    curve.driver.expression = "0.1 * sin(frame)"
    color = next(n for n in bpy.data.materials["Tinted"].node_tree.nodes if n.type == "BSDF_DIFFUSE").inputs["Color"]
    for frame, value in ((1, 0.1), (count, 0.9)):
        color.default_value = (value, 0.2, 1.0 - value, 1.0)
        color.keyframe_insert("default_value", frame=frame)
    moved = stage.cube(0.3, stage.shader(Color=(0.2, 0.8, 0.2)), location=(1, 0, 0.5))
    for frame, x in ((1, -1.0), (count, 1.0)):
        moved.location.x = x
        moved.keyframe_insert("location", frame=frame)
    ground.modifiers.new("Particles", "PARTICLE_SYSTEM")
    particles = ground.particle_systems[0].settings
    particles.count, particles.frame_start, particles.frame_end, particles.lifetime = 40, 1, count, 30
    particles.render_type, particles.instance_object, particles.particle_size = "OBJECT", moved, 0.3
    stage.light("SUN", 3.0, (0, -3, 5), (0.5, 0.3, 0))
    stage.sky()
    stage.camera((0, -6, 3), (0, 0, 0.5))
    scene.frame_start, scene.frame_end = 1, count
    return scene


def long(persistent, count):
    """Return the bytes that are allocated after each frame of an animation, and how some frames differ from separate renders.

    The particles of a frame need all frames before it: a separate render follows them too.
    """
    folder = tempfile.mkdtemp()
    count = int(count)
    scene = _long(count)
    some, alone, given = (2, count // 2, count), {}, []
    for frame in range(1, count + 1):
        scene.frame_set(frame)
        if frame in some:
            alone[frame] = _read(stage.write_exr(scene, os.path.join(folder, f"alone_{frame}.exr")))

    def count_bytes(scene, *_):
        given.append(memory_now.held()["given"])

    scene.frame_set(1)
    scene.render.use_persistent_data = persistent == "yes"
    scene.render.filepath = os.path.join(folder, "frame_")
    bpy.app.handlers.render_post.append(count_bytes)
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_post.remove(count_bytes)
    together = {frame: _read(os.path.join(folder, f"frame_{frame:04d}.exr")) for frame in some}
    return {
        "given": given,
        "differences": [float(np.abs(alone[frame] - together[frame]).max()) for frame in some],
        "changes": [float(np.abs(together[a] - together[b]).max()) for a, b in zip(some, some[1:], strict=False)],
    }


def _read(path):
    return stage.pixels(path)[:, :, :3]


def frames(persistent):
    """Return the counts and kept bytes of each frame, its difference from a separate render, and what is kept at the end."""
    folder = tempfile.mkdtemp()
    scene, change = _build(folder)
    counts, sizes = [], []

    def count(scene, *_):
        numbers = addon.engine.last_statistics[scene.name]
        counts.append([numbers.get(name) for name in _COUNTS])
        sizes.append(numbers.get("kept_bytes"))

    bpy.app.handlers.frame_change_pre.append(change)
    bpy.app.handlers.render_post.append(count)
    try:
        alone = []
        for frame in FRAMES:
            scene.frame_set(frame)
            alone.append(_read(stage.write_exr(scene, os.path.join(folder, f"alone_{frame}.exr"))))
        plain = counts[:]
        counts.clear(), sizes.clear()
        scene.render.use_persistent_data = persistent == "yes"
        scene.frame_set(FRAMES[0])
        scene.render.filepath = os.path.join(folder, "frame_")
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.frame_change_pre.remove(change)
        bpy.app.handlers.render_post.remove(count)
    left = len(addon.engine.kept_pictures._kept)
    together = [_read(os.path.join(folder, f"frame_{frame:04d}.exr")) for frame in FRAMES]
    changes = [float(np.abs(a - b).max()) for a, b in zip(together, together[1:], strict=False)]
    differences = [float(np.abs(a - b).max()) for a, b in zip(alone, together, strict=True)]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return {
        "alone": plain,
        "counts": counts,
        "bytes": sizes,
        "differences": differences,
        "changes": changes,
        "left": left,
        "after another file": len(addon.engine.kept_pictures._kept),
    }
