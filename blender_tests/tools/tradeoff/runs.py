"""Renders for `make tradeoff`: Lancer's sessions and Cycles' F12, timed, with their pictures."""

import dataclasses
import time

import bpy
import numpy as np

from addon.bindings.enums import InstanceKind, Integrator, Pass
from addon.bindings.session import Scene, Session
from addon.export.scene import export_scene
from addon.measure.schedule import Schedule
from tools.bench import worker
from tools.harness.f12 import press_f12

_DEEPEST_CLASSIC = 16


class Lancer:
    """One scene in Lancer; figures have the seconds since the first sample."""

    def __init__(self, scene):
        scene.render.engine = "LANCER"
        started = time.perf_counter()
        self.snapshot, self.messages = export_scene(bpy.context.evaluated_depsgraph_get())
        exported = time.perf_counter()
        self.scene = Scene.upload(self.snapshot)
        self.seconds = {"export": exported - started, "build": time.perf_counter() - exported}
        self.camera = self.snapshot.camera
        self.exact = bool((np.asarray(self.snapshot.instances.kinds) != InstanceKind.MESH).any())

    def session(self, integrator, seed, **settings):
        if integrator == Integrator.CLASSIC:
            settings["max_bounces"] = min(_DEEPEST_CLASSIC, self.snapshot.settings.max_bounces)
        fields = {"integrator": integrator, "seed": seed, "passes": (Pass.COMBINED,), **settings}
        return Session(self.scene, self.camera, dataclasses.replace(self.snapshot.settings, **fields))

    def doublings(self, integrator, seed, most):
        """Return [(samples, seconds, picture)] at 1, 2, 4 ... most samples of one render."""
        found, done = [], 0
        with self.session(integrator, seed, samples=most) as session:
            while done < most:
                session.render(done, max(1, done))
                while not session.wait(1.0).finished:
                    pass
                done += max(1, done)
                found.append((done, session.statistics().render_seconds, _picture(session)))
        return found

    def converged(self, seed, samples):
        with self.session(Integrator.PATH, seed, samples=samples) as session:
            session.render_all(samples)
            return _picture(session)

    def preset(self, seed, target, most):
        """Return (samples on average, seconds, picture, reported error, reason of the render's end)."""
        with self.session(Integrator.PATH, seed, samples=most, target_error=target) as session:
            schedule = Schedule(session)
            while schedule.start():
                while not schedule.wait(1.0).finished:
                    pass
            statistics = session.statistics()
            samples = statistics.samples / schedule.pixels
            return samples, statistics.render_seconds, _picture(session), session.error().error, schedule.reason


def _picture(session):
    return session.read(Pass.COMBINED)[..., :3]


class Cycles:
    """The same scene, rendered by F12 in Cycles, whose clock counts hundredths of a second."""

    def __init__(self, scene):
        self.scene = scene

    def render(self, seed, samples):
        """(seconds, picture)."""
        self.scene.render.engine = "CYCLES"
        worker.set_samples(self.scene, samples, seed)
        rendered = press_f12(self.scene)
        return rendered.seconds, rendered.picture[..., :3]


def without_exact_shapes(scene):
    """Return a context in which every object is traced as its mesh."""
    return _Meshes(scene)


class _Meshes:
    def __init__(self, scene):
        self.shapes = {item: item.lancer.shape for item in scene.objects if item.lancer.shape != "MESH"}

    def __enter__(self):
        self._set(dict.fromkeys(self.shapes, "MESH"))

    def __exit__(self, *_):
        self._set(self.shapes)

    @staticmethod
    def _set(shapes):
        for item, shape in shapes.items():
            item.lancer.shape = shape
            # Blender does not tag the object when an add-on's property changes.
            item.update_tag()
        bpy.context.view_layer.update()
