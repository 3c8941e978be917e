"""A 3D view in Rendered shading inside a real window, and actions on it. Actions that wait are generators of seconds."""

import gc
import threading
import time
import traceback

import bpy
import stage

from addon.bindings.session import Scene, Session
from addon.viewport import viewport

_LOOK = 0.05
PATIENCE = 300.0


class View:
    """The first 3D view of the first window."""

    def __init__(self):
        self.window = bpy.context.window_manager.windows[0]
        self.area = next(area for area in self.window.screen.areas if area.type == "VIEW_3D")
        self.region = next(region for region in self.area.regions if region.type == "WINDOW")
        self.space = self.area.spaces.active
        self.data = self.space.region_3d

    def override(self):
        """Return the context override. Use it briefly: Blender's own loop reads such a context without Python's lock."""
        return bpy.context.temp_override(window=self.window, screen=self.window.screen, area=self.area, region=self.region)

    def render(self):
        self.space.shading.type = "RENDERED"
        self.space.overlay.show_overlays = False
        self.space.show_gizmo = False


class _Hands(bpy.types.Operator):
    """Runs the requested actions at the next event, as an operator of a key would."""

    bl_idname = "wm.lancer_hands"
    bl_label = "Hands"
    wanted = []

    def invoke(self, context, event):
        context.window_manager.event_timer_add(_LOOK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        while self.wanted:
            try:
                self.wanted.pop(0)()
            except Exception:
                # Text on the terminal fails the test; the operator goes on, so that the case can end Blender.
                traceback.print_exc()
        return {"PASS_THROUGH"}


def by_hand(action):
    """Call action in the window's own context, at its next event. Loading a file ends the operator that does this.

    A render that a script starts under an overridden context crashes Blender 3.4: the rest of the operator reads that context
    without Python's lock while the render's thread runs handlers. And if the render's thread enters Python during a drawing,
    Blender treats all later scripts as drawings: timers cannot call operators, add-ons cannot unregister.
    """
    if not hasattr(bpy.types, "WM_OT_lancer_hands"):
        bpy.utils.register_class(_Hands)
        with View().override():
            bpy.ops.wm.lancer_hands("INVOKE_DEFAULT")
    _Hands.wanted.append(action)


def build(samples=8):
    """Build three objects of three colours on a floor, under a lamp and a sky."""
    scene = stage.empty(160, 120)
    stage.plane(8.0, stage.shader(Color=(0.6, 0.6, 0.6)))
    stage.cube(0.8, stage.shader(Color=(0.8, 0.1, 0.1)), location=(-1, 0, 0.4))
    stage.ball(0.5, stage.shader(Color=(0.1, 0.8, 0.1)), location=(1, 0, 0.5))
    stage.cube(0.4, stage.shader("ShaderNodeEmission", Color=(0.1, 0.1, 0.9)), location=(0, 1, 1))
    stage.light("POINT", 200.0, (2, -3, 4))
    stage.sky()
    stage.camera()
    scene.lancer.preview_samples = samples
    return scene


def shown():
    """Return the open Viewport, or None."""
    return next(iter(viewport._open), None)


def until(condition, patience=PATIENCE):
    """Wait for a condition. Return whether it became true in time."""
    limit = time.monotonic() + patience
    while not condition():
        if time.monotonic() > limit:
            return False
        yield _LOOK
    return True


def finished():
    """Return whether the shown picture has all its samples."""
    view = shown()
    if view is None or view.painter.picture is None or view._wanted is None:
        return False
    picture = view.painter.picture
    wanted = view._wanted
    return picture.wanted is wanted and picture.size == wanted.finest and picture.samples == wanted.settings.samples


def left():
    """Return the open handles of the library, and the add-on's threads."""
    gc.collect()
    handles = [thing for thing in gc.get_objects() if type(thing) in (Scene, Session)]
    things = [type(handle).__name__ for handle in handles if handle._finalizer.alive]
    return things + [thread.name for thread in threading.enumerate() if "lancer" in thread.name]


class Record:
    """Records each drawing: its time, the generation of the scene, the pixel size, the number of samples."""

    def __init__(self):
        self.draws = []
        self._plain = viewport.Viewport.draw

    def __enter__(self):
        record, plain = self, self._plain

        def draw(self, context, depsgraph):
            plain(self, context, depsgraph)
            picture = self._drawn[0]
            record.draws.append((time.monotonic(), picture, self._text(picture)))

        viewport.Viewport.draw = draw
        return self

    def __exit__(self, *_):
        viewport.Viewport.draw = self._plain
