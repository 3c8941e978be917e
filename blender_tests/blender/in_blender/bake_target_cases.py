"""Object > Bake: where the texels go. Each case bakes places, which have no noise, by both engines."""

import os
import signal

import bpy
import numpy as np
import stage
from bake_stage import SIZE, bake, by_both, choose, compared, fill, image, pixels, room, run

from scenes import parts


def _beside(ours, theirs):
    """Return the largest difference of two bakes, and how many values each of them has filled."""
    return {
        "apart": float(np.abs(ours - theirs).max()),
        "filled": [int((picture != 0.0).any(axis=-1).sum()) for picture in (ours, theirs)],
        "all": int(np.prod(ours.shape[:-1])),
    }


def _places(scene, picture, **options):
    """Return what _beside tells of the places that both engines bake into an image."""
    return _beside(*by_both(lambda engine: bake(scene, picture, engine, "POSITION", 1, **options)[..., :3]))


def _painted(block, material):
    """Give two faces of the block a second material, which has an image of its own size; return that image."""
    second = material.copy()
    second.name = "Second"
    for node in [node for node in second.node_tree.nodes if node.type == "TEX_IMAGE"]:
        second.node_tree.nodes.remove(node)
    block.data.materials.append(second)
    for polygon in block.data.polygons[:2]:
        polygon.material_index = 1
    return second


def _tile(picture, number, folder, engine):
    """Return the pixels of a tile, which only files show."""
    pattern = os.path.join(folder, f"{engine}.<UDIM>.exr")
    picture.filepath_raw, picture.file_format = pattern, "OPEN_EXR"
    picture.save()
    return stage.pixels(pattern.replace("<UDIM>", str(number)))


def tiles(folder):
    """Return how both engines fill two tiles, and whether one tile of the bake is that of an image without tiles."""
    scene, block, material = room()
    layer = block.data.uv_layers[0].data
    plain = bake(scene, image(material, "Plain"), "LANCER", "POSITION", 1)
    for polygon in block.data.polygons[3:]:
        for loop in polygon.loop_indices:
            layer[loop].uv.x += 1.0
    picture = image(material, "Tiled", tiled=True)
    picture.tiles.new(1002)
    with bpy.context.temp_override(edit_image=picture):
        picture.tiles.active = picture.tiles[1]
        bpy.ops.image.tile_fill(color=(0, 0, 0, 1), width=SIZE, height=SIZE, float=True)
    found = {}
    for engine in ("LANCER", "CYCLES"):
        run(scene, engine, "POSITION", 1)
        found[engine] = [_tile(picture, number, folder, engine)[..., :3] for number in (1001, 1002)]
    ours, theirs = found["LANCER"], found["CYCLES"]
    beside = [_beside(*both) for both in zip(ours, theirs, strict=True)]
    half = SIZE // 2
    whole = np.concatenate([ours[0][:half], ours[1][half:]])
    return {"tiles": beside, "apart from one": float(np.abs(whole - plain[..., :3]).max())}


def _ball_and_block():
    """Return the scene, a ball around the centre of the block, the block and its image."""
    scene, block, material = room()
    ball = stage.ball(0.75, parts.principled("Of the ball", base_color=(0.1, 0.8, 0.2)))
    ball.location = block.location
    return scene, ball, block, image(material)


def onto_another():
    """Return how both engines bake from a ball onto the block, by cage, extrusion and distance."""
    scene, ball, block, picture = _ball_and_block()
    cage = parts.place(scene, "Cage", block.data.copy(), None, block.location, rotation=block.rotation_euler)
    cage.scale, cage.hide_render = (1.9, 1.9, 1.9), True
    found = {}
    for name, options in (
        ("extrusion", {"cage_extrusion": 0.6}),
        ("short extrusion", {"cage_extrusion": 0.1}),
        ("distance", {"cage_extrusion": 0.6, "max_ray_distance": 0.5}),
        ("cage", {"use_cage": True, "cage_object": cage.name}),
        ("extruded cage", {"use_cage": True, "cage_extrusion": 0.6}),
    ):
        choose(ball, block)
        found[name] = _places(scene, picture, use_selected_to_active=True, **options)
    return found


def lit():
    """Return how far the light that both engines bake from the ball onto the block is apart."""
    scene, ball, block, picture = _ball_and_block()
    choose(ball, block)
    options = {"use_selected_to_active": True, "cage_extrusion": 0.6, "max_ray_distance": 0.5}
    return compared(*by_both(lambda engine: bake(scene, picture, engine, "COMBINED", 128, **options)))


def margins():
    """Return how both engines fill the texels around faces."""
    scene, _, material = room()
    picture = image(material)
    found = {"none": _places(scene, picture)}
    for kind in ("EXTEND", "ADJACENT_FACES"):
        found[kind] = _places(scene, picture, margin=2, margin_type=kind)
    return found


def attributes():
    """Return how both engines fill colour attributes, and whether threads change the colours of light."""
    scene, block, _ = room()
    # Places from 0 to 1, which bytes hold.
    block.location = (0.5, 0.5, 0.8)
    block.scale = (0.3, 0.3, 0.3)
    found, lit = {}, []

    def colors(attribute, engine, kind, samples):
        attribute.data.foreach_set("color", np.zeros(len(attribute.data) * 4, np.float32))
        run(scene, engine, kind, samples, target="VERTEX_COLORS")
        return np.array([tuple(item.color) for item in block.data.color_attributes.active_color.data])[:, :3]

    for domain in ("POINT", "CORNER"):
        for kind in ("FLOAT_COLOR", "BYTE_COLOR"):
            attribute = block.data.color_attributes.new(f"{domain} {kind}", kind, domain)
            block.data.color_attributes.active_color = attribute
            found[f"{domain} {kind}"] = _beside(*by_both(lambda engine, at=attribute: colors(at, engine, "POSITION", 1)))
    for threads in (1, 3):
        scene.render.threads_mode, scene.render.threads = "FIXED", threads
        lit.append(colors(attribute, "LANCER", "COMBINED", 16).tobytes())
    return {"attributes": found, "same": lit[0] == lit[1]}


def several_images():
    """Return how both engines fill two images of one object, one image of two materials, and the exports that this takes."""
    from addon.bake import baked_scene
    from addon.host import shared_scenes

    scene, block, material = room()
    first, second = image(material, "First"), _painted(block, material)
    exports, export_scene = [], baked_scene.export_scene

    def counted(*arguments):
        exports.append(len(arguments))
        return export_scene(*arguments)

    baked_scene.export_scene = counted
    try:
        node = second.node_tree.nodes.new("ShaderNodeTexImage")
        node.image, second.node_tree.nodes.active = first, node
        shared = _places(scene, first)
        counts = [len(exports)]
        other = bpy.data.images.new("Other", SIZE // 2, SIZE, float_buffer=True)
        other.colorspace_settings.name = "Non-Color"
        node.image = other

        def both(engine):
            fill(other)
            return bake(scene, first, engine, "POSITION", 1)[..., :3], pixels(other)[..., :3]

        ours, theirs = by_both(both)
        counts.append(len(exports))
    finally:
        baked_scene.export_scene = export_scene
    opened = [scene for scene in shared_scenes._committed if scene.is_open]
    apart = {"first": _beside(ours[0], theirs[0]), "other": _beside(ours[1], theirs[1])}
    return {"images": {"shared": shared, **apart}, "exports": counts, "open": len(opened)}


def interrupted():
    """Return what a bake leaves that Ctrl-C ends after its first range."""
    from addon.bake import bake as job
    from addon.engine import render_job
    from addon.host import shared_scenes

    scene, block, material = room()
    first, second = image(material, "First"), _painted(block, material)
    other = image(second, "Other")
    for picture in (first, other):
        fill(picture, -1.0)
    waits, schedule, result = [], job.Schedule, {}

    class Interrupted(schedule):
        def wait(self, seconds):
            progress = super().wait(seconds)
            waits.append(progress)
            if progress.samples and len(waits) > 1 and "sent" not in result:
                result["sent"] = len(waits)
                os.kill(os.getpid(), signal.SIGINT)
            return progress

    if not bpy.app.binary_path:
        # The module has no handler of its own, and a process that a shell starts in the background ignores Ctrl-C.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    job.Schedule = Interrupted
    try:
        scene.render.engine, scene.lancer.samples = "LANCER", 1 << 14
        result["end"] = sorted(bpy.ops.object.bake(type="COMBINED", margin=0))
    except RuntimeError as error:
        result["error"] = str(error)
    finally:
        job.Schedule = schedule
    result |= {
        "waits after": len(waits) - result.get("sent", 0),
        "finite": all(bool(np.isfinite(pixels(picture)).all()) for picture in (first, other)),
        "running": render_job.is_running(),
        "open": len([shared for shared in shared_scenes._committed if shared.is_open]),
    }
    scene.lancer.samples = 4
    result["level"] = float(bake(scene, first, "LANCER", "COMBINED", 4)[..., :3].max())
    return result
