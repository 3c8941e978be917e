"""What a 3D view costs: time that a drawing waits, memory that several views share, and memory after changes of size."""

import bpy
import memory_now
import numpy as np
import stage
from viewport_stage import Record, View, build, by_hand, finished, shown, until

from addon.host import shared_scenes
from addon.viewport import viewport


def waits(folder):
    """Return whether the first drawing after an edit shows it, and how many edits are drawn without waiting after it.

    In the second of four edits the drawing is told that its picture does not come.
    """
    build(samples=0)
    view = View()
    view.render()
    yield from until(lambda: shown() is not None and shown().painter.picture is not None)
    result = {}
    for name, patience in (("long", 60.0), ("in vain", 0.5), ("skipped", 60.0), ("long again", 60.0)):
        viewport._PATIENCE = patience
        before = shown().painter.picture.wanted.contents
        if name == "in vain":
            shown()._shows_edits = lambda: False
        with Record() as record:
            bpy.data.objects["Ball"].location.x -= 0.1
            view.area.tag_redraw()
            yield from until(lambda before=before: shown().painter.picture.wanted.contents is not before and record.draws)
            yield 0.1
        if name == "in vain":
            del shown()._shows_edits
        first = next(picture for _, picture, _ in record.draws)
        result[name] = [first.wanted.contents is not before, shown()._skip]
    return result


def _heavy():
    """Add a mesh of half a million triangles."""
    data = bpy.data.meshes.new("Heavy")
    side = 500
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, side), np.linspace(-1.0, 1.0, side))
    places = np.stack([x, y, np.sin(9.0 * x) * np.sin(9.0 * y)], axis=2).reshape(-1, 3)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    data.from_pydata(places.tolist(), [], np.stack([first, first + 1, first + side + 1, first + side], 1).tolist())
    stage.link("Heavy", data)


def shared(folder):
    """Open a second view of a scene, and then press F12.

    Return the mebibytes that one view takes and the second adds, and whether both views and the render have the same meshes.
    """
    scene = build(samples=1)
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.lancer.samples = 1
    _heavy()
    yield 0.5
    held = [memory_now.held()["given"]]
    View().render()
    yield from until(finished)
    held.append(memory_now.held()["given"])
    with View().override():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    # Blender gives the new view Solid shading, whose first drawing would fill buffers for the GPU.
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "VIEW_3D":
            area.spaces.active.shading.type = "RENDERED"
    yield 0.3

    def all_finished():
        views = list(viewport._open)
        return len(views) == 2 and all(view.painter.picture is not None and not view.painter.is_busy for view in views)

    yield from until(all_finished)
    held.append(memory_now.held()["given"])
    used = [{id(part) for part in view.painter._scene._parts} for view in viewport._open]
    records = [{id(mesh) for mesh in view._contents.meshes} for view in viewport._open]
    remember = shared_scenes.remember

    def watch(committed):
        used.append({id(part) for part in committed._parts})
        remember(committed)

    shared_scenes.remember = watch
    by_hand(bpy.ops.render.render)
    yield from until(lambda: len(used) > 2)
    shared_scenes.remember = remember
    return {
        "scene": (held[1] - held[0]) / 2**20,
        "second": (held[2] - held[1]) / 2**20,
        "common": [len(found) for found in (set.intersection(*used), set.intersection(*records))],
    }


def resized(folder):
    """Return the mebibytes by which allocated memory grows over ten changes of the view's size, and those of one scene.

    The old and the new picture exist side by side for a while after a change, so the minimum of six changes is taken. Resident
    memory would include free memory that the allocator keeps.
    """
    build(samples=0)
    _heavy()
    View().render()
    held = []
    for _ in range(22):
        before = View().region.width
        with View().override():
            bpy.ops.screen.screen_full_area(use_hide_panels=True)
        yield 0.3
        assert View().region.width != before
        View().render()
        yield from until(lambda: shown() is not None and shown().painter.picture is not None)
        held.append(memory_now.held()["given"])
    copy = sum(array.nbytes for mesh in shown()._contents.meshes for array in vars(mesh).values() if hasattr(array, "nbytes"))
    return {"growth": (min(held[-6:]) - min(held[6:12])) / 2**20, "copy": copy / 2**20}
