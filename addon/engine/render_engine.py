"""The RenderEngine that Blender calls: exports, renders range by range, shows the picture, reports its error."""

import contextlib
import dataclasses
import logging
import time

import bpy

from ..bindings.abi import LancerError
from ..bindings.mattes import metadata
from ..bindings.session import Cancelled, Scene, Session
from ..denoise import view_layer as denoise
from ..export.moving_scene import export_picture
from ..export.scene import ExportOptions
from ..export.settings import threads_of
from ..export.shutter import shutter_of
from ..host import main_thread, redraw, shared_scenes
from ..host.priority import lowered
from ..measure.schedule import Schedule, TimeShare
from ..messages.messages import Messages
from ..messages.severity import Severity
from ..viewport.viewport import Viewport
from . import first_look, kept_pictures, many_machines, passes, preview, render_export, render_job, resume, views
from .account import account
from .baking import Baking
from .denoising import Denoising, wishes
from .later import Later
from .picture import Picture
from .progress_text import progress_text
from .results import last_messages, last_missing, last_statistics
from .stepped_session import SteppedSession

# Seconds between polls.
_STEP = 0.05
# Seconds between polls until the first picture is shown.
_FIRST_STEP = 0.01
# Seconds between texts of progress.
_TELL_EVERY = 0.25
# Share of the time for showing: Blender copies and colour-manages the whole picture each time.
_SHOW_SHARE = 0.1
_SHOW_EVERY = 0.3
# Share of the time for reading the error.
_ERROR_SHARE = 0.03
_MAX_REPORTS = 30
# Blender frees more objects in more than some hundredths of a second.
_MANY_OBJECTS = 2000
# Seconds of a sample so short that the picture needs no coarse one before it.
_SHORT = 0.2


class LancerRenderEngine(Baking, bpy.types.RenderEngine):
    bl_idname = main_thread.ENGINE
    bl_label = "Lancer"
    bl_use_preview = True
    bl_use_postprocess = True
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    # Blender calls __init__ twice and __del__ at odd times, so the class has neither: initial values are class attributes.
    _snapshot = None
    _prepared = False  # the layer is exported, or has failed to be
    _picture = None
    _gave_up = False
    _metadata = None  # of mattes, by name
    _ahead = None  # the shared_scenes.Ahead of the export
    _following = None  # the kept_pictures.Following
    _later = None  # the Later of the snapshot
    _resume = None  # the Resume of the view layer
    _views = ()  # of the picture
    _shared = None  # the Scene of several views
    _viewport = None

    def update_render_passes(self, scene=None, renderlayer=None):
        passes.register_passes(self, scene, renderlayer)

    def update(self, data=None, depsgraph=None):
        # A bake is no render job, and exports by itself.
        if not self.is_preview and render_job.is_running():
            self._prepare(depsgraph)

    def _prepare(self, depsgraph):
        self._prepared = True
        if render_export.is_wanted():
            render_export.take(self, depsgraph)
            return
        with self._working():
            self._begin(depsgraph)
            self._guarded(depsgraph.scene, self._export, depsgraph)

    def render(self, depsgraph):
        if self.is_preview:
            preview.render(self, depsgraph)
            return
        if not self._prepared:
            # Some script has removed the handlers that tell of render jobs.
            self._prepare(depsgraph)
        self._prepared = False
        if render_export.is_wanted():
            return
        with self._working():
            if self._snapshot is not None:
                scene, view_layer = depsgraph.scene, depsgraph.view_layer_eval
                layer, wanted = view_layer.name, tuple(passes.render_passes(scene, view_layer))
                denoising, machines = wishes(scene, view_layer), many_machines.wanted(scene)
                # The snapshot is complete, and Blender's evaluated data can be larger than the render: free it. Do not read the
                # depsgraph from here on. In a window the first picture comes before that takes long.
                if not bpy.app.background and len(self._snapshot.instances) > _MANY_OBJECTS:
                    self._later.add(self.free_blender_memory)
                else:
                    self.free_blender_memory()
                self._guarded(scene, self._render_views, scene, layer, wanted, denoising, machines)
            self._snapshot = self._ahead = None
            self._later = self._resume = None
            if self._is_over():
                # The remaining layers are not rendered.
                self._picture = None
            redraw.properties_after_render()

    def view_update(self, context, depsgraph):
        self._view().update(context, depsgraph)

    def view_draw(self, context, depsgraph):
        self._view().draw(context, depsgraph)

    def _view(self):
        if self._viewport is None:
            # The viewport ends with the engine, which Blender frees with the view.
            self._viewport = Viewport(self)
        return self._viewport

    @contextlib.contextmanager
    def _working(self):
        with render_job.working():
            yield
            if render_job.is_ending() and not self._gave_up:
                self._gave_up = True
                # Without an error Blender would continue with the next frame.
                self._fail("the add-on was disabled during the render")

    def _is_over(self):
        """Whether the user has cancelled or the add-on is being disabled."""
        return render_job.is_ending() or self.test_break()

    def _begin(self, depsgraph):
        """Reset messages and statistics at the start of a picture.

        One engine renders all view layers of a picture, whose messages add up. With Persistent Data it also renders several
        pictures: a new one begins with another frame, or with a layer that has already been rendered.
        """
        scene, layer = depsgraph.scene, depsgraph.view_layer.name
        key = (scene.name, scene.frame_current_final)
        if self._picture is None or not self._picture.has(key, layer):
            self._picture = Picture(key, self.get_result().layers.keys())
            last_messages.pop(scene, None)
            last_missing.pop(scene, None)
            last_statistics.pop(scene, None)
            kept_pictures.begin(scene, self.is_animation)
        self._picture.begin(layer)

    def _guarded(self, scene, work, *arguments):
        """Run work(*arguments) and return True; False after an exception.

        Exceptions are reported as errors, which end a headless render with exit code 1.
        """
        try:
            work(*arguments)
            return True
        except Cancelled:
            self._snapshot = self._picture = None
            return False
        except LancerError as error:
            text = str(error)
        except KeyboardInterrupt:
            # Ctrl-C in Blender as a Python module.
            text = "interrupted"
        except MemoryError:
            text = "not enough memory for this scene"
        except Exception as error:
            logging.getLogger(__name__).exception("render failed")
            text = f"{type(error).__name__}: {error}"
        # The checks may tell why.
        if self._later is not None:
            with contextlib.suppress(Exception):
                self._later.run()
        self._snapshot = None
        self._picture.messages.add(text, severity=Severity.FAILED)
        last_messages[scene] = self._picture.messages
        self._fail(text)
        return False

    def _fail(self, text):
        self.error_set(f"Lancer: {text}")
        self.report({"ERROR"}, f"Lancer: {text}")

    def _export(self, depsgraph):
        # Drop the snapshot of an earlier failed or cancelled render.
        self._snapshot = None
        self.update_stats("", "Exporting")
        scene, view_layer = depsgraph.scene, depsgraph.view_layer_eval
        if denoise.wanted(scene, view_layer) and denoise.missing():
            # Report it before the render takes its time.
            self._tell(scene, Messages([denoise.missing()]))
        self._resume = resume.wanted(scene, view_layer.name)
        wanted = tuple(passes.render_passes(scene, view_layer))
        self._ahead = shared_scenes.Ahead(threads_of(scene))
        begin = self._ahead.mesh if many_machines.wanted(scene) is None and scene.lancer.accelerator == "BVH" else None
        self._following = self._following or kept_pictures.Following()
        kept, parts = kept_pictures.of(scene), self._following.take(depsgraph, len(self.get_result().layers))
        sources = passes.sources(wanted)
        shutter = shutter_of(scene, view_layer, sources)
        if shutter is not None:
            # The updates of a depsgraph that is evaluated at several times do not tell what has changed.
            parts = begin = None
        sight = views.sight_of(self, depsgraph)
        reuse = {"kept": None if parts else kept, "parts": parts, "on_mesh": begin}
        options = ExportOptions(self.camera_override, sources, **reuse, shutter=shutter, sight_of_views=sight)
        self._snapshot, messages = export_picture(depsgraph, options, self.frame_set, self._is_over)
        if parts is not None:
            self._following.give_back(parts)
            kept.count_parts(self._snapshot, parts)
        self._views = (views.View("", self._snapshot.camera),) if sight is None else sight.views(messages)
        settings = self._snapshot.settings
        time_limit = self._picture.limit(settings.time_limit) / len(self._views)
        settings = dataclasses.replace(settings, time_limit=time_limit)
        if denoise.ready(scene, view_layer):
            settings = denoise.prepared(settings, passes.sources(wanted))
        self._snapshot.set("settings", settings)
        self._metadata = metadata(view_layer.name, self._snapshot, passes.sources(wanted))
        self._tell(scene, messages)
        is_kept = kept_pictures.of(scene) is not None
        self._later = Later(scene, self._snapshot, is_kept, self._is_over, lambda messages: self._tell(scene, messages))

    def _opened(self, scene, layer, machines):
        """Return a context of the session that renders the snapshot: on this machine, or on others."""
        if machines is not None:
            return many_machines.opened(machines, self._snapshot, self._is_over, lambda text: self.update_stats("", text))
        self.update_stats("", "Building the scene")
        return lowered(lambda: self._uploaded(scene, layer))

    def _uploaded(self, scene, layer):
        """Return a Session that owns its scene, unless the scene is kept for the next frame."""
        kept, snapshot = kept_pictures.of(scene), self._snapshot
        kind, digest = (Session, None) if self._resume is None else (SteppedSession, resume.digest_of(snapshot))
        if self._shared is not None:
            return kind(self._shared, snapshot.camera, snapshot.settings)
        before = (kept and kept.scenes.get(layer)) or shared_scenes.nearest(snapshot)
        given = {"poll": self._is_over, "before": before, "stock": shared_scenes.stock}
        if kept is None and len(self._views) == 1:
            session = kind.upload(snapshot, release=True, filled=self._ahead.end, digest=digest, **given)
            shared_scenes.remember(session.scene)
            return session
        uploaded = Scene.upload(snapshot, **given)
        if kept is None:
            self._ahead.end()
            self._shared = uploaded
        else:
            kept.keep_scene(layer, uploaded)
        shared_scenes.remember(uploaded)
        if digest is not None:
            uploaded.set_digest(digest)
        return kind(uploaded, snapshot.camera, snapshot.settings)

    def _render_views(self, scene, layer, wanted, denoising, machines):
        snapshot = self._snapshot
        moves = any(view.keys for view in self._views)
        try:
            for view in self._views:
                if view.name:
                    self.active_view_set(view.name)
                    self._snapshot = view.shown(snapshot)
                    if moves:
                        # The motion of the camera is the scene's.
                        self._close_shared()
                    # Each view has samples of its own.
                    self._resume = self._resume and resume.wanted(scene, f"{layer} {view.name}")
                elif len(self._views) == 1:
                    # Drop this reference: the upload empties the snapshot.
                    snapshot = None
                self._render(scene, layer, wanted, denoising, machines, view.name)
                if self._is_over():
                    break
        finally:
            self._close_shared()

    def _close_shared(self):
        if self._shared is not None:
            self._shared.close()
            self._shared = None

    def _render(self, scene, layer, wanted, denoising, machines, view):
        with self._opened(scene, layer, machines) as session:
            # The library has its own copy.
            self._snapshot = None
            self._tell(scene, Messages.of_library(session.messages()))
            camera = session.camera
            result = self.begin_result(0, 0, camera.region_width, camera.region_height, layer=layer, view=view)
            if (result.resolution_x, result.resolution_y) != (camera.region_width, camera.region_height):
                expected = f"{camera.region_width} x {camera.region_height}"
                self.end_result(result, cancel=True)
                raise LancerError(f"Blender expects {result.resolution_x} x {result.resolution_y} pixels, not {expected}")

            if self._resume is not None:
                self._tell(scene, self._resume.load(session))
            kept = kept_pictures.of(scene)
            has_samples = self._resume is not None and self._resume.is_continued
            is_brief = self.is_animation or has_samples or kept is not None and kept.sample_seconds < _SHORT
            look = None if is_brief else first_look.FirstLook(session, self._is_over)
            if look and look.coarse is not None:
                passes.fill(result.layers[0], lambda _: look.coarse, passes.COMBINED)
                self.update_result(result)

            def fill():
                read = look.read if look and schedule.samples == 0 else session.read
                passes.fill(result.layers[0], read, wanted)

            def show():
                fill()
                self.update_result(result)

            denoiser = denoising and Denoising(session, denoising, self._is_over, lambda text: self.update_stats("", text))
            schedule = Schedule(session, self._picture.started, denoiser.bound if denoiser and denoising.of_target else None)
            if self._resume is not None:
                self._resume.follow(schedule)
            try:
                self._run(schedule, show, is_brief or look.coarse is not None)
                if self._resume is not None:
                    self._tell(scene, self._resume.finish())
                fill()
                denoised = None
                if denoiser and not self._is_over():
                    self.update_result(result)
                    denoised = denoiser.result()
                    if denoiser.failure:
                        self._tell(scene, Messages([denoiser.failure]))
                if denoised is not None:
                    passes.show_denoised(result.layers[0], denoised)
                stamped = self.get_result()
                for name, value in self._metadata.items():
                    stamped.stamp_data_add_field(name, value)
                shown = f"{layer}, {view}" if view else layer
                self._tell(scene, account(self, scene, shown, session, schedule, denoised, self._later.uses))
            finally:
                # Keep the unfinished picture, after Esc too.
                self.end_result(result)

    def _run(self, schedule, show, has_time):
        """Render range by range and show the picture at intervals, until the schedule ends or the user cancels.

        has_time: whether nobody waits for the first picture.
        """
        showing, reading = TimeShare(_SHOW_SHARE, _SHOW_EVERY), TimeShare(_ERROR_SHARE, _TELL_EVERY)
        told = time.monotonic()
        many_machines.prepare(schedule)
        while schedule.start():
            first = not showing.begun
            while True:
                if has_time or showing.begun:
                    self._later.run()
                progress = schedule.wait(_STEP if showing.begun else _FIRST_STEP)
                if not progress.finished and self._is_over():
                    schedule.cancel()
                # Show the first picture as soon as any tile is done, and again when the first sample is complete.
                elif progress.samples > 0 and (showing.due or first and progress.finished) and not schedule.over:
                    showing.spend(show)
                    schedule.reserve = showing.cost + reading.cost
                    schedule.longest = max(schedule.longest, showing.interval)
                if time.monotonic() - told > _TELL_EVERY or progress.finished and schedule.over:
                    told = time.monotonic()
                    if schedule.samples > 1 and reading.due:
                        reading.spend(schedule.look)
                    self.update_progress(schedule.fraction)
                    self.update_stats("", progress_text(schedule, progress))
                if progress.finished:
                    break
            if self._is_over():
                return
        self._later.run()

    def _tell(self, scene, messages):
        """Report new messages as warnings, except hints, and keep all messages for the panel."""
        room = max(0, _MAX_REPORTS - len(self._picture.messages))
        new = [message for message in self._picture.messages.merge(messages).told() if message.severity > Severity.HINT]
        last_messages[scene] = self._picture.messages
        last_missing[scene] = self._picture.messages.missing()
        for message in new[:room]:
            self.report({"WARNING"}, f"Lancer: {message.line}")
        if len(new) > room:
            self.report({"WARNING"}, f"Lancer: {len(new) - room} more messages are in the render properties")


def register():
    bpy.utils.register_class(LancerRenderEngine)


def unregister():
    redraw.forget()
    bpy.utils.unregister_class(LancerRenderEngine)
