"""One 3D view in Rendered shading: passes Blender's updates to a painter and draws the newest picture."""

import logging
import time
import weakref

import bpy
from bpy.app.handlers import persistent

from ..bindings import snapshot
from ..bindings.abi import LancerError
from ..bindings.enums import Pass
from ..denoise import view_layer as denoise
from ..export.catchers import catchers_of
from ..export.parts import Parts
from ..export.scene import ExportOptions, export_scene
from ..export.settings import export_settings, world_of
from ..export.view import export_view
from ..host import redraw
from ..host.by_scene import ByScene
from ..messages.messages import Messages
from ..messages.severity import Severity
from .canvas import Canvas
from .painter import Painter, Wanted
from .sizes import coarsest

# Messages of the newest export for a view, by scene.
last_messages = ByScene()

_TICK = 0.005  # seconds between two steps
# Seconds from an edit for which a drawing waits for the first picture, and between two steps meanwhile. Blender draws a window
# as a whole, which may take longer: the picture of the next drawing would be seen that much later.
_PATIENCE, _NAP = 0.04, 0.001
# Edits without waiting after one that was in vain: doubled each time up to this number.
_MOST_SKIPPED = 16
_MANY = 1 << 24
# Settings that affect the building of the library's scene.
_BUILT_BY = ("accelerator", "threads")
_NO_CAMERA = snapshot.Camera()
_FILTERS = tuple(name for name in bpy.types.SpaceView3D.bl_rna.properties.keys() if name.startswith("show_object_viewport"))

_open = weakref.WeakSet()


class Viewport:
    """The view of one RenderEngine instance, which holds the only lasting reference to it."""

    def __init__(self, engine):
        self._engine = weakref.ref(engine)
        self._parts, self._canvas = Parts(), Canvas()
        self._contents = self._wanted = None
        self._sight = None
        self._failure = self._blindness = ""  # why the export of the scene, or of the camera, failed
        self._messages = Messages()  # the entry in last_messages
        self._library = None  # the painter's messages that are already in _messages
        self._drawn = None  # (ViewPicture, failure) on the screen
        self._edited = 0.0  # time of the last update
        self._skip = 0  # edits after the last one, for which no drawing waits
        self._skipped = 0  # of these, the edits so far
        self.painter = Painter()
        weakref.finalize(self, self.painter.close)
        _open.add(self)

    def update(self, context, depsgraph):
        """Export the changes of the depsgraph."""
        self._edited = time.monotonic()
        try:
            self._export(context, depsgraph)
            self._failure = ""
        except LancerError as error:
            self._failure = str(error)
        except Exception as error:
            logging.getLogger(__name__).exception("the viewport's export failed")
            self._failure = f"{type(error).__name__}: {error}"

    def draw(self, context, depsgraph):
        engine = self._engine()
        sight = _sight(context.space_data)
        if self._contents is None or sight != self._sight:
            # Blender sends no update when a view starts, or when its own filters change.
            self.update(context, depsgraph)
        view = self._view(context, depsgraph)
        if self._contents is not None and view is not None:
            self._want(engine, depsgraph, view)
        self._drawn = self.painter.picture, self.painter.failure
        picture = self._drawn[0]
        if picture is not None and view is not None:
            self._canvas.draw(picture.image, view.rectangle)
        engine.update_stats("", self._text(picture))
        _watch()

    def step(self):
        """Let the painter work and request a redraw if there is a new picture; return whether work is left."""
        self.painter.step()
        if not self.painter.is_building and self.painter.messages is not self._library:
            self._library = self.painter.messages
            self._tell(Messages.of_library(self._library))
        picture, failure = self.painter.picture, self.painter.failure
        if self._drawn is None or picture is not self._drawn[0] or failure != self._drawn[1]:
            engine = self._engine()
            if engine is not None:
                engine.tag_redraw()
        return self.painter.is_busy

    def _export(self, context, depsgraph):
        self._sight = _sight(context.space_data)
        view = self._view(context, depsgraph)
        options = ExportOptions(
            view=_NO_CAMERA,
            dicing=None if view is None else view.camera,
            passes=(Pass.COMBINED,),
            space=context.space_data,
            sight=self._sight,
            parts=self._parts,
        )
        contents, messages = export_scene(depsgraph, options)
        self._set_contents(contents, contents.settings)
        before, self._messages, self._library = self._messages, messages, None
        last_messages[depsgraph.scene] = messages
        if before.lines() != messages.lines():
            redraw.properties()

    def _tell(self, messages):
        """Add new messages only: each redraw repeats the same ones."""
        known = {message.text for message in self._messages.told()}
        new = [message for message in messages.told() if message.text not in known]
        for message in new:
            self._messages.add(message.text, message.key, message.severity)
        if new:
            redraw.properties()

    def _set_contents(self, contents, settings):
        contents = contents.replaced(settings=snapshot.Settings(**{name: getattr(settings, name) for name in _BUILT_BY}))
        if self._contents is None or contents != self._contents:
            self._contents = contents

    def _view(self, context, depsgraph):
        """Return the View to render; None if the export of the camera fails or no pixel is visible."""
        told = Messages()
        try:
            view = export_view(context.region, context.region_data, context.space_data, depsgraph, told)
        except LancerError as error:
            self._blindness = str(error)
            return None
        self._blindness = ""
        self._tell(told)
        return view

    def _want(self, engine, depsgraph, view):
        own = depsgraph.scene.lancer
        # Blender sends no update for properties of add-ons: read them at each redraw.
        settings = export_settings(depsgraph, (Pass.COMBINED,), world_of(depsgraph), Messages(), in_view=True)
        self._set_contents(self._contents, settings)
        settings = settings.replaced(
            catchers=catchers_of(self._contents.instances, depsgraph.view_layer, settings.integrator),
            samples=own.preview_samples or _MANY,
            target_error=0.0,
            time_limit=0.0,
            split_lights=1,
            split_paths=1,
        )
        finest = max(1, engine.get_preview_pixel_size(depsgraph.scene))
        denoising = own.use_preview_denoising and own.integrator != "NORMALS"
        if denoising and denoise.missing():
            self._tell(Messages([denoise.missing()]))
            denoising = False
        most = coarsest(view.rectangle, finest, own.preview_start_resolution)
        wanted = Wanted(self._contents, settings, view, finest, most, denoising)
        if self._wanted is None or not _same(wanted, self._wanted):
            edited = self._wanted is not None and self._wanted.contents is not wanted.contents
            self._wanted = wanted
            self.painter.want(wanted)
            self.painter.step()
            if edited:
                self._wait()

    def _wait(self):
        """Wait a moment for the first picture of an edited scene, unless the pictures of the last edits took longer."""
        if self.painter.picture is None or self.painter.waits:
            return
        if self._skipped < self._skip:
            self._skipped += 1
            return
        end = self._edited + _PATIENCE
        if time.monotonic() > end:
            return
        while not (shows := self._shows_edits()) and self.painter.is_busy and time.monotonic() < end:
            time.sleep(_NAP)
            self.painter.step()
        in_vain = not shows and self.painter.is_busy
        self._skip, self._skipped = min(_MOST_SKIPPED, 2 * self._skip + 1) if in_vain else 0, 0

    def _shows_edits(self):
        return self.painter.picture.wanted.contents is self._wanted.contents

    def _text(self, picture):
        failure = self._failure or self._blindness or self.painter.failure
        if failure:
            return f"Lancer: {failure}"
        if self.painter.is_building:
            return "Building the scene"
        if picture is None:
            return ""
        own = picture.wanted.settings.samples
        samples = f"Sample {picture.samples}" + (f"/{own}" if own != _MANY else "")
        if picture.size > picture.wanted.finest:
            return f"{samples} of 1 in {picture.size**2} pixels"
        parts = [samples]
        if picture.error is not None and picture.error.known:
            parts.append(f"Error {picture.error.error:.1%}")
        if picture.denoised:
            parts.append("denoised")
        losses = sum(message.severity > Severity.HINT for message in self._messages.told())
        if losses:
            parts.append(f"{losses} message{'s' if losses > 1 else ''} in the render properties")
        return " | ".join(parts)


def _same(a, b):
    """Whether two Wanted request the same picture."""
    return a.contents is b.contents and a[1:] == b[1:]


def _sight(space):
    """Return a view's own filters of objects."""
    return space.local_view is not None, *(getattr(space, name) for name in _FILTERS)


def _watch():
    if not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=_TICK, persistent=True)


def _tick():
    rendering = bpy.app.is_job_running("RENDER")
    busy = False
    for viewport in list(_open):
        viewport.painter.waits = rendering
        busy = viewport.step() or busy
    return _TICK if busy else None


@persistent
def _forget(*_):
    """Drop all messages before another file is loaded."""
    last_messages.clear()


def register():
    bpy.app.handlers.load_pre.append(_forget)


def unregister():
    for viewport in list(_open):
        viewport.painter.close()
    bpy.app.handlers.load_pre.remove(_forget)
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    last_messages.clear()
