"""The pictures of a 3D view while it refines, after edits, and with hidden objects."""

import json
import os
import threading

import bpy
import gpu
import numpy as np
import stage
from mathutils import Matrix, Quaternion
from viewport_stage import Record, View, build, finished, left, shown, until

from addon.engine import preview
from addon.export.view import Rectangle
from addon.viewport import viewport
from addon.viewport.canvas import Canvas


def refining(folder):
    """Return the pixel sizes and samples of all pictures from the first to the last, and the texts before and at the end."""
    build(samples=16)
    view = View()
    with Record() as record:
        view.render()
        done = yield from until(finished)
        yield 0.2
    drawn = [(picture.size, picture.samples) for _, picture, _ in record.draws if picture is not None]
    waiting = [text for _, picture, text in record.draws if picture is None]
    return {"done": done, "drawn": drawn, "waiting": waiting, "last": record.draws[-1][2]}


def edits(folder):
    """Return for each edit whether a picture was always shown, never an outdated one, and how much the picture changed."""
    scene = build(samples=4)
    view = View()
    view.render()
    yield from until(finished)
    ball, body = bpy.data.objects["Ball"], bpy.data.objects["Cube"]
    material = ball.active_material.node_tree.nodes

    def color():
        next(node for node in material if node.type == "BSDF_DIFFUSE").inputs["Color"].default_value = (0.9, 0.9, 0.1, 1)

    def mesh():
        body.data.vertices[0].co.x -= 0.5
        body.data.update()

    changes = {
        "moved": lambda: setattr(ball, "location", (1, 1, 0.5)),
        "coloured": color,
        "bent": mesh,
        "brighter": lambda: setattr(bpy.data.objects["Light"].data, "energy", 800.0),
        "film": lambda: setattr(scene.render, "film_transparent", True),
        "bounces": lambda: setattr(scene.lancer, "max_bounces", 0),
        "turned": lambda: setattr(view.data, "view_rotation", Quaternion((0, 0, 1), 0.5) @ view.data.view_rotation),
    }
    result = {}
    for name, change in changes.items():
        before = shown().painter.picture
        with Record() as record:
            change()
            view.area.tag_redraw()
            done = yield from until(lambda before=before: shown()._wanted is not before.wanted and finished())
            yield 0.1
        after = shown().painter.picture
        pictures = [picture for _, picture, _ in record.draws]
        order = [before, *pictures]
        ages = [picture is not before for picture in order]
        result[name] = {
            "done": done,
            "always": all(picture is not None for picture in pictures),
            "ordered": ages == sorted(ages),
            "rebuilt": after.wanted.contents is not before.wanted.contents,
            "change": float(np.abs(after.image - before.image).mean()) if after.image.shape == before.image.shape else 1.0,
        }
    return result


def selects(folder):
    """Return whether a click that selects an object renders anything anew."""
    build(samples=2)
    view = View()
    view.render()
    yield from until(finished)
    before = shown().painter.picture
    bpy.data.objects["Ball"].select_set(True)
    bpy.context.scene.cursor.location = (1, 1, 1)
    yield 0.5
    return {"same": shown().painter.picture is before}


def screen(folder):
    """Show an emissive wall; write its middle, from the screen's top left, to middle.json, and wait for a file named shot."""
    scene = stage.empty(64, 64)
    stage.sky((0.5, 0.25, 0.1))
    stage.camera()
    scene.lancer.preview_samples = 1
    scene.render.dither_intensity = 0.0
    view = View()
    view.render()
    yield from until(finished)
    yield 0.3
    x, y = view.region.x + view.region.width // 2, view.region.y + view.region.height // 2
    with open(f"{folder}/middle.part", "w", encoding="utf-8") as file:
        json.dump([x, view.window.height - 1 - y], file)
    os.rename(f"{folder}/middle.part", f"{folder}/middle.json")
    yield from until(lambda: os.path.exists(f"{folder}/shot"))
    return {}


def filtered(folder):
    """Return [objects, lamps] rendered in local view and under filters, and the picture's size at a preview pixel size of 2."""
    scene = build(samples=1)
    view = View()
    view.render()
    yield from until(finished)

    def rendered():
        return [len(shown()._contents.instances), len(shown()._contents.lights)]

    def changed(before):
        yield from until(lambda: rendered() != before)
        return rendered()

    result = {"all": rendered()}
    ball = bpy.data.objects["Ball"]
    ball.select_set(True)
    bpy.context.view_layer.objects.active = ball
    with view.override():
        bpy.ops.view3d.localview(frame_selected=False)
    result["local"] = yield from changed(result["all"])
    with view.override():
        bpy.ops.view3d.localview(frame_selected=False)
    before = yield from changed(result["local"])
    view.space.show_object_viewport_light = False
    view.area.tag_redraw()
    result["without lamps"] = yield from changed(before)
    scene.render.preview_pixel_size = "2"
    view.area.tag_redraw()
    result["done"] = yield from until(lambda: finished() and shown()._wanted.finest > 1)
    result["size"] = shown().painter.picture.size
    return result


def previews(folder):
    """Return mean colours of the icons of a red material, a blue world and a dim green lamp, and how many Lancer rendered."""
    scene = build()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.1, 0.1, 0.9, 1.0)
    lamp = bpy.data.objects["Light"].data
    lamp.color, lamp.energy = (0.1, 0.9, 0.1), 1.0
    things = {"material": bpy.data.objects["Cube"].active_material, "world": scene.world, "light": lamp}
    rendered, plain = [], preview.render

    def render(engine, depsgraph):
        plain(engine, depsgraph)
        rendered.append(engine.resolution_x)

    preview.render = render
    colors = {}
    for name, thing in things.items():
        before = len(rendered)
        with View().override():
            with bpy.context.temp_override(id=thing):
                bpy.ops.ed.lib_id_generate_preview()
        yield from until(lambda before=before: len(rendered) > before)
        yield 1.0
        colors[name] = np.array(thing.preview.image_pixels_float[:]).reshape(-1, 4)[:, :3].mean(axis=0).tolist()
    preview.render = plain
    return {"colors": colors, "rendered": len(rendered)}


def tells(folder):
    """Return the messages of a scene with unsupported features everywhere, the view's text, and that of a camera of scale 0."""
    scene = build(samples=2)
    tree = bpy.data.objects["Cube"].active_material.node_tree
    body = next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE")
    tree.links.new(stage.unknown(tree).outputs["Fac"], body.inputs["Roughness"])
    stage.mesh("Thin", [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0)], [(0, 1, 2), (0, 1, 3)])
    scene.lancer.use_preview_denoising = True
    view = View()
    view.render()
    yield from until(finished)
    yield 0.3
    with Record() as record:
        view.area.tag_redraw()
        yield from until(lambda: record.draws)
        result = {"lines": viewport.last_messages[scene].lines(), "text": record.draws[-1][2]}
        scene.camera.scale = (0, 0, 0)
        view.data.view_perspective = "CAMERA"
        yield from until(lambda: record.draws[-1][2].startswith("Lancer: "))
        result["blind"] = record.draws[-1][2]
        view.data.view_perspective = "PERSP"
        yield from until(lambda: record.draws[-1][2].startswith("Sample "))
        result["seeing"] = record.draws[-1][2]
    return result


def cleans(folder):
    """Return the text and the difference of neighbouring pixels with denoising, after an edit during denoising, and without."""
    scene = build(samples=4)
    # Denoising takes most of the time of a view without a graphics card.
    scene.render.preview_pixel_size = "4"
    view = View()

    def look():
        done = yield from until(lambda: shown() is not None and shown()._wanted is not wanted and finished())
        # The last picture is denoised after it is shown.
        yield from until(lambda: not shown().painter.is_busy)
        yield 0.2
        picture = shown().painter.picture
        differs = float(np.abs(np.diff(picture.image[..., :3], axis=1)).mean())
        return {"done": done, "denoised": picture.denoised, "text": shown()._text(picture), "differs": differs}

    wanted, result = None, {}
    scene.lancer.use_preview_denoising = True
    view.render()
    result["on"] = yield from look()
    wanted = shown()._wanted
    bpy.data.objects["Ball"].location = (1, 1, 0.5)
    cleaning = yield from until(lambda: any("denoising" in thread.name for thread in threading.enumerate()))
    bpy.data.objects["Ball"].location = (1, 0, 0.5)
    result["edited"] = {"cleaning": cleaning, **(yield from look())}
    wanted = shown()._wanted
    scene.lancer.use_preview_denoising = False
    view.area.tag_redraw()
    result["off"] = yield from look()
    view.space.shading.type = "SOLID"
    yield from until(lambda: not left())
    return {**result, "left": left()}


def plays(folder):
    """Play an animation. Return whether pictures of several frames are shown, and whether only moving objects are read."""
    scene = build(samples=100)
    ball = bpy.data.objects["Ball"]
    for frame, x in ((1, -1.0), (50, 1.0)):
        ball.location.x = x
        ball.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    view = View()
    view.render()
    yield from until(lambda: shown() is not None and shown().painter.picture is not None)
    with Record() as record:

        def frames():
            return len({id(picture.wanted.contents) for _, picture, _ in record.draws})

        with view.override():
            bpy.ops.screen.animation_play()
        yield from until(lambda: frames() > 2 and scene.frame_current > 2)
        with view.override():
            bpy.ops.screen.animation_cancel(restore_frame=False)
    return {"frames": frames(), "read": shown()._parts.counts, "at": scene.frame_current}


def canvas(folder):
    """Draw a picture of 4 x 2 pixels into a framebuffer of 64 x 48. Return its colours inside, at a corner, and outside."""
    yield 0.1
    image = np.zeros((2, 4, 4), np.float32)
    image[..., 3] = 1.0
    image[0, :, 0], image[1, :, 1], image[0, 0] = 0.25, 1e30, (0.125, 0.125, 0.125, 0.5)
    target = gpu.types.GPUOffScreen(64, 48, format="RGBA16F")
    with target.bind():
        framebuffer = gpu.state.active_framebuffer_get()
        framebuffer.clear(color=(0.0, 0.0, 0.0, 0.0))
        with gpu.matrix.push_pop():
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(Matrix(((2 / 64, 0, 0, -1), (0, 2 / 48, 0, -1), (0, 0, -1, 0), (0, 0, 0, 1))))
            Canvas().draw(image, Rectangle(8, 8, 32, 16))
        drawn = np.array(framebuffer.read_color(0, 0, 64, 48, 4, 0, "FLOAT").to_list())
    target.free()
    places = {"low": (9, 30), "high": (23, 30), "corner": (9, 9), "outside": (30, 50), "left": (12, 4)}
    return {name: drawn[place].tolist() for name, place in places.items()}
