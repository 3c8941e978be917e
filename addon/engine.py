"""The engine that Blender calls: export, render in waves, show, account."""

import dataclasses
import logging
import time

import bpy

from . import passes
from .bindings.abi import LancerError
from .bindings.session import Cancelled, Session
from .bindings.uses import used_features
from .export import main_thread
from .export.messages import Messages
from .export.scene import ExportOptions, export_scene
from .waves import Waves

# Of the last render of each scene, by its name, for the panel and for scripts.
last_statistics = {}
last_messages = {}
# Of the last measurement of each scene: a hints.Costs.
last_costs = {}
# What the library holds, by kind: names of last_statistics.
MEMORY = ("geometry_bytes", "accelerator_bytes", "texture_bytes", "film_bytes")

_STEP = 0.05
# As long as there is nothing to see.
_FIRST_STEP = 0.01
_TELL_EVERY = 0.25
_MAX_REPORTS = 30


class LancerRenderEngine(bpy.types.RenderEngine):
    bl_idname = "LANCER"
    bl_label = "Lancer"
    bl_use_preview = False
    bl_use_postprocess = True
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    # Blender runs __init__ twice and __del__ at odd times, so the class has neither; what lives longer than a call starts here.
    _snapshot = None
    _messages = None
    _exported = None
    _uses = ()

    def update_render_passes(self, scene=None, renderlayer=None):
        passes.register_passes(self, scene, renderlayer)

    def update(self, data=None, depsgraph=None):
        self._begin(depsgraph)
        self._guarded(depsgraph.scene, self._export, depsgraph)

    def render(self, depsgraph):
        if self._snapshot is not None:
            scene, view_layer = depsgraph.scene, depsgraph.view_layer_eval
            layer, wanted = view_layer.name, tuple(passes.render_passes(scene, view_layer))
            # The snapshot has all of it, and what Blender evaluated may be larger than the render. From here on there is no
            # depsgraph, unless Blender wants to keep it.
            self.free_blender_memory()
            self._guarded(scene, self._render, scene, layer, wanted)
        self._snapshot = None
        if self.test_break():
            # The layers that were to follow do not come any more.
            self._exported = None

    def _begin(self, depsgraph):
        """Starts the account anew with each picture.

        One engine serves all view layers of a picture, one after the other, whose messages add up; with Persistent Data it
        serves one picture after the other too, which tell themselves by another frame, or by a layer that is there again.
        """
        scene, layer = depsgraph.scene, depsgraph.view_layer.name
        picture = (scene.name, scene.frame_current_final)
        if self._exported is None or self._exported[0] != picture or layer in self._exported[1]:
            self._exported = picture, set()
            self._messages = Messages()
            last_messages.pop(scene.name, None)
            last_statistics.pop(scene.name, None)
        self._exported[1].add(layer)

    def _guarded(self, scene, work, *arguments):
        """Whatever goes wrong becomes an error that Blender shows, and that ends a headless render with failure."""
        try:
            work(*arguments)
            return
        except Cancelled:
            self._snapshot = self._exported = None
            return
        except LancerError as error:
            text = str(error)
        except KeyboardInterrupt:
            # Python's own Ctrl-C, in Blender as a module: what runs the render should end too.
            text = "interrupted"
        except MemoryError:
            text = "not enough memory for this scene"
        except Exception as error:
            logging.getLogger(__name__).exception("render failed")
            text = f"{type(error).__name__}: {error}"
        self._snapshot = None
        self._messages.add(text)
        last_messages[scene.name] = self._messages.lines()
        self.error_set(f"Lancer: {text}")
        self.report({"ERROR"}, f"Lancer: {text}")

    def _export(self, depsgraph):
        # What a failed or cancelled export left behind must not be rendered by the next call.
        self._snapshot = None
        self.update_stats("", "Exporting")
        wanted = passes.render_passes(depsgraph.scene, depsgraph.view_layer_eval)
        options = ExportOptions(camera=self.camera_override, passes=tuple(item.source for item in wanted))
        self._snapshot, messages = export_scene(depsgraph, options, self.test_break)
        self._uses = [dataclasses.asdict(feature) for feature in used_features(self._snapshot)]
        self._tell(depsgraph.scene, messages)

    def _render(self, scene, layer, wanted):
        self.update_stats("", "Building the scene")
        with Session.upload(self._snapshot, poll=self.test_break, release=True) as session:
            # The library holds its own copy from here on.
            self._snapshot = None
            self._tell(scene, Messages(session.messages()))
            camera = session.camera
            result = self.begin_result(0, 0, camera.region_width, camera.region_height, layer=layer)
            if (result.resolution_x, result.resolution_y) != (camera.region_width, camera.region_height):
                expected = f"{camera.region_width} x {camera.region_height}"
                self.end_result(result, cancel=True)
                raise LancerError(f"Blender wants {result.resolution_x} x {result.resolution_y} pixels, not {expected}")

            def show():
                passes.fill(result.layers[0], session.read, wanted)
                self.update_result(result)

            try:
                self._run(session, session.settings.samples, scene.lancer.time_limit, show)
                passes.fill(result.layers[0], session.read, wanted)
            finally:
                # Keep the picture as far as it is, after Esc too.
                self.end_result(result)
            self._account(scene, session)

    def _run(self, session, samples, time_limit, show):
        """Renders samples in waves, shows each, and stops for Esc or for the time limit."""
        waves = Waves(samples)
        started = told = time.monotonic()
        shown = None
        while not waves.done:
            first, count = waves.next()
            session.render(first, count)
            wave_started = time.monotonic()
            while True:
                progress = session.wait(_FIRST_STEP if shown is None else _STEP)
                now = time.monotonic()
                if progress.finished:
                    break
                if now - told > _TELL_EVERY:
                    told = now
                    self._show_progress(first + progress.fraction * count, samples, progress, now - started)
                late = 0.0 < time_limit <= now - started and first > 0
                # At first whatever there is, tiles of the first sample too.
                due = progress.samples > 0 if shown is None else now - shown > waves.interval
                if self.test_break() or late:
                    session.cancel()
                elif due:
                    shown = self._timed(waves, show)
            waves.took(count, now - wave_started)
            if waves.done or now - told > _TELL_EVERY:
                told = now
                self._show_progress(waves.first, samples, progress, now - started)
            if progress.cancelled or self.test_break() or 0.0 < time_limit <= now - started:
                return
            if not waves.done and (first == 0 or now - shown > waves.interval):
                shown = self._timed(waves, show)

    @staticmethod
    def _timed(waves, show):
        before = time.monotonic()
        show()
        after = time.monotonic()
        waves.showing_took(after - before)
        return after

    def _show_progress(self, done, samples, progress, elapsed):
        self.update_progress(min(1.0, done / samples))
        rate = progress.rays / progress.seconds / 1e6 if progress.seconds > 0.0 else 0.0
        remaining = elapsed * (samples - done) / done if done > 0.0 else 0.0
        self.update_stats("", f"Sample {int(done)}/{samples} | {rate:.2f} M rays/s | Remaining {_clock(remaining)}")

    def _tell(self, scene, messages):
        """Reports what was left out or replaced, each thing once, and keeps all of it for the panel."""
        room = max(0, _MAX_REPORTS - len(self._messages))
        new = self._messages.merge(messages).lines()
        last_messages[scene.name] = self._messages.lines()
        for line in new[:room]:
            self.report({"WARNING"}, f"Lancer: {line}")
        if len(new) > room:
            self.report({"WARNING"}, f"Lancer: {len(new) - room} more messages are in the render properties")

    def _account(self, scene, session):
        statistics = session.statistics()
        if statistics.invalid_samples:
            place = f"({statistics.invalid_x}, {statistics.invalid_y}), sample {statistics.invalid_sample}"
            count = statistics.invalid_samples
            text = f"{count} samples were not finite and are left out, the first at pixel {place}"
            self._tell(scene, Messages([text]))
        numbers = dataclasses.asdict(statistics)
        pixels = session.camera.region_width * session.camera.region_height
        numbers["pixel_samples"] = numbers["samples"]
        numbers["samples"] = round(statistics.samples / pixels)
        numbers["seconds"] = statistics.render_seconds
        numbers["rays"] = statistics.rays
        numbers["rays_per_second"] = statistics.rays_per_second
        held = sum(numbers[name] for name in MEMORY) / 2**20
        self.update_memory_stats(memory_used=held, memory_peak=held)
        numbers["uses"] = self._uses
        last_statistics[scene.name] = numbers
        if scene.name in last_costs:
            keep_costs(scene.name, last_costs[scene.name])


def keep_costs(name, costs):
    """Keeps what the features of a scene were measured to cost, among its statistics, too."""
    last_costs[name] = costs
    if name in last_statistics:
        last_statistics[name]["feature_costs"] = {cost.name: dataclasses.asdict(cost) for cost in costs.measured}


def _clock(seconds):
    minutes, seconds = divmod(int(seconds + 0.5), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes:02}:{seconds:02}"


def register():
    bpy.utils.register_class(LancerRenderEngine)
    main_thread.register()


def unregister():
    main_thread.unregister()
    bpy.utils.unregister_class(LancerRenderEngine)
    last_statistics.clear()
    last_messages.clear()
    last_costs.clear()
