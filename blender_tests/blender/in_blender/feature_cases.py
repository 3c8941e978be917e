"""The project's scenes with the kernel made for each, and with the one that can do everything."""

import dataclasses

import bpy
import numpy as np

import scenes
from addon.bindings.enums import Features, Integrator
from addon.bindings.session import Session
from addon.export.scene import export_scene


def both_kernels(name):
    """(kernels, largest difference) of both pictures of a scene, for each integrator."""
    scene = scenes.load(name)
    scene.render.engine = "LANCER"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 48, 27, 100
    scene.lancer.quality, scene.lancer.samples = "CUSTOM", 2
    snapshot, _ = export_scene(bpy.context.evaluated_depsgraph_get())
    result = {}
    for integrator in (Integrator.PATH, Integrator.CLASSIC):
        pictures, kernels = [], []
        for features in (Features.SCENE, Features.ALL):
            settings = dataclasses.replace(snapshot.settings, features=features, integrator=integrator)
            with Session.upload(dataclasses.replace(snapshot, settings=settings)) as session:
                session.render_all(2)
                pictures.append(session.read(0))
                kernels.append(session.statistics().kernel)
        result[integrator.name] = [kernels, float(np.abs(pictures[0] - pictures[1]).max()), float(pictures[0].mean())]
    return result
