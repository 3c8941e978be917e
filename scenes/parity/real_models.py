"""Real assets: scanned and modelled meshes, glTF, Blender's start-up file and templates."""

import os
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .. import parts
from .catalogue import case, variants
from .nodes import principled
from .stages import camera, floor, lamp, sky

# This folder lies beside the project and is not part of it.
MODELS = Path(__file__).resolve().parents[3] / "shared" / "models"
_NAMES = ("stanford-bunny", "spot", "teapot", "fandisk", "rocker-arm", "cheburashka")


def _with_models():
    return "" if MODELS.is_dir() else "there is no folder shared/models beside the project"


@variants("LOBES", values={name: name for name in _NAMES}, needs=_with_models)
def real_model(scene, name):
    bpy.ops.wm.obj_import(filepath=str(MODELS / f"{name}.obj"))
    _show(scene, [thing for thing in scene.objects if thing.type == "MESH"])


def _show(scene, things):
    """Places the objects on a floor in a small studio, scaled to a height of about 2."""
    bpy.context.view_layer.update()
    corners = [thing.matrix_world @ Vector(corner) for thing in things for corner in thing.bound_box]
    low, high = (Vector(pick(corner[axis] for corner in corners) for axis in range(3)) for pick in (min, max))
    scale = 2.0 / max(high - low)
    middle = (low + high) / 2
    for thing in things:
        thing.matrix_world.translation -= Vector((middle.x, middle.y, low.z))
        thing.matrix_world = Matrix.Scale(scale, 4) @ thing.matrix_world
        if not any(slot.material for slot in thing.material_slots):
            thing.data.materials.clear()
            thing.data.materials.append(principled(Base_Color=(0.7, 0.5, 0.35), Roughness=0.4))
    floor(scene)
    lamp(scene)
    sky(scene)
    camera(scene, (0.6, -4.2, 2.2), (0, 0, 0.8))


def _with_gltf():
    """Returns "" or why this Blender lacks glTF: the importer of Blender 3 uses a name of bool that numpy removed in 1.24."""
    works = bpy.app.version >= (4, 0) or hasattr(np, "bool")
    return "" if works else f"this Blender's glTF importer does not run with numpy {np.__version__}"


@case("LOBES", needs=_with_gltf)
def real_gltf(scene):
    """Export and import by glTF: its conversion of materials, lamps and camera."""
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    for index in range(4):
        surface = principled(Base_Color=(0.8, 0.3 + 0.15 * index, 0.2), Metallic=float(index % 2), Roughness=0.2 + 0.2 * index)
        parts.place(scene, f"Ball {index}", parts.sphere_mesh("Ball", 48, 24), surface, (1.1 * index - 1.6, 0, 0.5), 0.5)
    floor(scene)
    parts.add_light(scene, "Sun", "SUN", 3.0, (1, -1, 2))
    parts.add_light(scene, "Point", "POINT", 100.0, (-1, -2, 2), shadow_soft_size=0.2)
    camera(scene)
    path = os.path.join(bpy.app.tempdir, "round_trip.glb")
    bpy.ops.export_scene.gltf(filepath=path, export_cameras=True, export_lights=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.import_scene.gltf(filepath=path)
    scene = bpy.context.scene
    scene.camera = next(thing for thing in scene.objects if thing.type == "CAMERA")
    sky(scene)


@variants(
    "LOBES",
    values={name.lower(): name for name in ("General", "Sculpting", "VFX", "Video_Editing", "2D_Animation", "Storyboarding")},
    bounces=4,
)
def real_startup(scene, template):
    """Blender's start-up file or template; if that has no objects, a lit cube and a camera are added."""
    bpy.ops.wm.read_homefile(app_template="" if template == "General" else template, use_factory_startup=True)
    scene = bpy.context.scene
    if not any(thing.type == "MESH" for thing in scene.objects):
        cube = parts.cube_mesh("Lit cube", 1.5)
        parts.place(scene, "Lit cube", cube, principled(Base_Color=(0.7, 0.4, 0.2), Roughness=0.4), rotation=(0.3, 0.2, 0.5))
    if not any(thing.type == "LIGHT" for thing in scene.objects):
        parts.add_light(scene, "Lamp", "AREA", 300.0, (2.5, -2.5, 4), size=2.0)
    if scene.camera is None or template != "General":
        parts.add_camera(scene, (4, -5, 3), (0, 0, 0))
