"""The scene of a bake: its export and its committed scene, which all images of one object share."""

import numpy as np

from ..bindings.abi import LancerError
from ..bindings.enums import Catchers, InstanceFlag, InstanceKind, Integrator
from ..bindings.session import Scene
from ..export.scene import ExportOptions, export_scene
from ..export.shutter import shutter_of
from ..host import shared_scenes
from ..host.priority import lowered
from ..messages.severity import Severity

# Cycles bakes these of clear surfaces, too.
_PLACES = frozenset({"POSITION", "NORMAL"})


class BakedScene:
    """Blender makes an engine for each object, which owns one of these: the library's scene ends with it.

    It holds neither the engine nor Blender's data. After make(): scene, the library's Scene; settings, the snapshot.Settings;
    row, that of the baked object among the instances.
    """

    def __init__(self):
        self.scene = self.settings = self.row = None
        self._images = 0

    def next_image(self):
        """Return the number of the next image among those of the object."""
        self._images += 1
        return self._images - 1

    def make(self, engine, depsgraph, thing, asked, camera, tell, is_over):
        """Export and upload the scene for the object's first image; camera: as for ExportOptions.picture."""
        if self.scene is not None:
            return
        engine.update_stats("", "Exporting")
        shot, messages = export_scene(depsgraph, ExportOptions(passes=asked.passes, picture=camera), is_over)
        _check(depsgraph, shot.settings, asked.kind, messages)
        self.settings = _settings(shot.settings, asked)
        tell(messages)
        self.row = _row(shot.instances, thing)
        if asked.kind == "SHADOW":
            # As in Cycles, the baked object is one more shadow catcher.
            flags = shot.instances.flags.copy()
            flags[self.row] |= np.uint32(InstanceFlag.CATCHER)
            shot.set("instances", shot.instances.replaced(flags=flags))
        engine.update_stats("", "Building the scene")
        before, stock = shared_scenes.nearest(shot), shared_scenes.stock
        self.scene = lowered(lambda: Scene.upload(shot, poll=is_over, before=before, stock=stock))
        shared_scenes.remember(self.scene)


def _check(depsgraph, settings, kind, messages):
    scene = depsgraph.scene
    if settings.integrator != Integrator.PATH:
        raise LancerError(f"scene '{scene.name}': only the integrator Path bakes, choose it in the render properties")
    if kind == "COMBINED" and scene.lancer.use_denoising:
        messages.add(f"scene '{scene.name}': a bake is not denoised", severity=Severity.HINT)
    shutter, now = shutter_of(scene, depsgraph.view_layer, ()), scene.frame_current + scene.frame_subframe
    if shutter is not None and shutter.middle != now:
        theirs = f"that of Cycles the middle of the shutter, {shutter.middle:g}"
        messages.add(f"scene '{scene.name}': a bake shows the frame {now:g}, {theirs}")


def _settings(settings, asked):
    # The roughness of the first surface alone.
    changes = {"film_transparent": True, "blended_features": True}
    changes["catchers"] = Catchers.APART if asked.kind == "SHADOW" else Catchers.OBJECTS
    if asked.bounces is not None:
        changes["max_bounces"] = asked.bounces
    if asked.kind in _PLACES:
        changes["alpha_threshold"] = 0.0
    return settings.replaced(**changes)


def _row(table, thing):
    """Return the row of the baked object itself, not of its instances."""
    name = thing.original.name
    if name in table.names:
        rows = ((table.name_indices == table.names.index(name)) & (table.kinds == InstanceKind.MESH)).nonzero()[0]
        if len(rows):
            return int(rows[0])
    if thing.lancer.shape != "MESH":
        raise LancerError(f"object '{name}' is shown as an exact shape: set its Shape to Mesh to bake it")
    raise LancerError(f"object '{name}' shows no mesh in the render: enable it for renders, and give it faces")
