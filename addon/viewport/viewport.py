"""One 3D view in Rendered shading: what Blender tells of its scene goes to a painter, and the newest picture to the screen."""

import logging
import weakref

import bpy
from bpy.app.handlers import persistent

from ..bindings import snapshot
from ..bindings.abi import LancerError
from ..bindings.enums import Pass
from ..denoise import view_layer as denoise
from ..export.parts import Parts
from ..export.scene import ExportOptions, export_scene
from ..export.settings import export_settings
from ..export.view import export_view
from ..host import redraw
from ..host.by_scene import ByScene
from ..messages.messages import Messages
from ..messages.severity import Severity
from .canvas import Canvas
from .painter import Painter, Wanted
from .sizes import coarsest

# What the newest export for a view of each scene could not show as it is: Messages.
last_messages = ByScene()

_TICK = 0.005  # seconds between two steps
_MANY = 1 << 24
# Of settings, what the scene in the library is built by.
_BUILT_BY = ("accelerator", "threads")
_NO_CAMERA = snapshot.Camera()
_FILTERS = tuple(name for name in bpy.types.SpaceView3D.bl_rna.properties.keys() if name.startswith("show_object_viewport"))

_open = weakref.WeakSet()


class Viewport:
    """Belongs to one engine of Blender's, and ends with it: nothing else may hold it for long."""

    def __init__(self, engine):
        self._engine = weakref.ref(engine)
        self._parts, self._canvas = Parts(), Canvas()
        self._contents = self._wanted = None
        self._sight = None
        self._failure = self._blindness = ""  # why nothing could be read of the scene, of the camera
        self._messages = Messages()  # those in last_messages
        self._library = None  # what of the painter's messages is among them
        self._drawn = None  # the Picture that is on the screen, and why there is none of what is wanted
        self.painter = Painter()
        weakref.finalize(self, self.painter.close)
        _open.add(self)

    def update(self, context, depsgraph):
        """Reads what has changed."""
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
            # Blender tells of no update where a view starts, or shows other objects than before.
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
        """Goes on, and has the view drawn where there is something new. Whether there may be more to come."""
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
        options = ExportOptions(view=_NO_CAMERA, passes=(Pass.COMBINED,), space=context.space_data, parts=self._parts)
        contents, messages = export_scene(depsgraph, options)
        self._set_contents(contents, contents.settings)
        before, self._messages, self._library = self._messages, messages, None
        last_messages[depsgraph.scene] = messages
        if before.lines() != messages.lines():
            redraw.properties()

    def _tell(self, messages):
        """Adds what is not there yet: each drawing meets the same again."""
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
        """The part of the region to be rendered and its camera; None where there is none."""
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
        # Of add-ons' settings Blender tells no update.
        settings = export_settings(depsgraph, (Pass.COMBINED,), None, Messages())
        self._set_contents(self._contents, settings)
        settings = settings.replaced(
            samples=own.preview_samples or _MANY, target_error=0.0, time_limit=0.0, split_lights=1, split_paths=1
        )
        finest = max(1, engine.get_preview_pixel_size(depsgraph.scene))
        denoising = own.use_preview_denoising and own.integrator != "NORMALS"
        if denoising and denoise.missing():
            self._tell(Messages([denoise.missing()]))
            denoising = False
        most = coarsest(view.rectangle, finest, own.preview_start_resolution)
        wanted = Wanted(self._contents, settings, view, finest, most, denoising)
        if self._wanted is None or not _same(wanted, self._wanted):
            self._wanted = wanted
            self.painter.want(wanted)
            self.painter.step()

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
    """Whether two Wanted ask for the same picture."""
    return a.contents is b.contents and a[1:] == b[1:]


def _sight(space):
    """What a view leaves out of the scene by itself."""
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
    """Another file's scenes may have the same names."""
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
