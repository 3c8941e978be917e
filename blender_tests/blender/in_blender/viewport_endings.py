"""End a rendering 3D view in every way, many times, and look for leftovers."""

import threading

import bpy
from viewport_stage import PATIENCE, View, build, by_hand, left, shown, until

import addon
from addon.engine import render_engine as engine
from addon.viewport import viewport


def _toggle(view):
    view.space.shading.type = "SOLID"
    yield 0.05
    view.render()


def _undo(view):
    with view.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.data.objects["Ball"].location.x += 0.1
        bpy.ops.ed.undo_push(message="after")
    yield 0.02
    with view.override():
        bpy.ops.ed.undo()
    yield 0.02
    with view.override():
        bpy.ops.ed.redo()


def _mode(view):
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    with view.override():
        bpy.ops.object.mode_set(mode="EDIT")
    yield 0.05
    with view.override():
        bpy.ops.object.mode_set(mode="OBJECT")


def _engine(view):
    scene = bpy.context.scene
    scene.render.engine = "BLENDER_WORKBENCH"
    yield 0.05
    scene.render.engine = "LANCER"


def _load(view):
    bpy.ops.wm.open_mainfile(filepath=_load.path)
    yield 0.05


def _addon(view):
    addon.unregister()
    yield 0.05
    addon.register()
    bpy.context.scene.render.engine = "LANCER"


def _quad(view):
    with view.override():
        bpy.ops.screen.region_quadview()
    yield 0.1
    with view.override():
        bpy.ops.screen.region_quadview()


def _window(view):
    """Open another window with a 3D view, and close it while it renders."""
    with view.override():
        bpy.ops.wm.window_new_main()
    yield 0.1
    other = bpy.context.window_manager.windows[-1]
    area = next(area for area in other.screen.areas if area.type == "VIEW_3D")
    area.spaces.active.shading.type = "RENDERED"
    yield 0.2
    with bpy.context.temp_override(window=other):
        bpy.ops.wm.window_close()


def _f12(view):
    """Press F12 while the view renders."""
    begun, entered, plain = [], threading.Event(), engine.LancerRenderEngine.render

    def render(self, depsgraph):
        entered.set()
        plain(self, depsgraph)

    def press():
        begun.append(bpy.ops.render.render("INVOKE_DEFAULT"))
        # No drawing may run Python when the render's thread starts to: see by_hand().
        assert entered.wait(PATIENCE), "the render's thread does not come"

    engine.LancerRenderEngine.render = render
    by_hand(press)
    yield from until(lambda: begun and not bpy.app.is_job_running("RENDER"))
    engine.LancerRenderEngine.render = plain


KINDS = {
    "toggle": _toggle, "undo": _undo, "mode": _mode, "engine": _engine, "load": _load, "addon": _addon, "quad": _quad,
    "window": _window, "f12": _f12,
}  # fmt: skip


def stress(folder, kind, count):
    """Repeat the same ending while the view renders. Return how often it succeeded, and the threads that are left."""
    build(samples=0)
    view = View()
    _load.path = f"{folder}/scene.blend"
    view.render()
    bpy.ops.wm.save_as_mainfile(filepath=_load.path)
    went = 0
    for number in range(int(count)):
        yield from KINDS[kind](View())
        # At a different moment each time.
        yield 0.01 * (number % 12)
        View().render()
        went += yield from until(lambda: shown() is not None and shown().painter.picture is not None)
    views = len(viewport._open)
    View().space.shading.type = "SOLID"
    yield from until(lambda: not left(), 5.0)
    return {"went": went, "views": views, "left": left()}


def leave(folder):
    """Quit the program while the view renders; Blender unregisters the add-on at its exit."""
    build(samples=0)
    view = View()
    view.render()
    rendered = yield from until(lambda: shown() is not None and shown().painter.picture is not None)
    return {"rendered": rendered, "quits": False}
