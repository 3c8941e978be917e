"""Save Bug Report, and pictures that a replay must equal."""

import os

import bpy
import exr
import numpy as np
import stage


def _room():
    scene = stage.room(width=48, height=27, samples=16)
    bpy.data.objects["Cube"].data.materials.clear()
    bpy.data.objects["Cube"].data.materials.append(None)
    return scene


def saved(folder):
    """Save a whole report, one without the scene, one of a scene that cannot be exported, and one that cannot be written."""
    scene = _room()
    scene.render.filepath = "/secret/place"
    bpy.ops.render.render()

    def save(name, **options):
        return sorted(bpy.ops.lancer.save_bug_report(filepath=os.path.join(folder, name), **options))

    result = [save("whole.zip"), save("without.zip", use_scene=False)]
    camera, scene.camera = scene.camera, None
    result.append(save("failed.zip"))
    scene.camera = camera
    try:
        result.append(save(os.path.join("no", "such", "place.zip")))
        error = ""
    except RuntimeError as problem:
        result.append(["CANCELLED"])
        error = str(problem)
    return {
        "result": result,
        "error": error,
        "version": bpy.app.version_string,
        "button": bpy.types.LANCER_RENDER_PT_bug_report.bl_parent_id == "LANCER_RENDER_PT_messages",
    }


def rendered(folder):
    """Save F12's picture, and a report of the same scene."""
    scene = _room()
    exr.write_settings(scene, os.path.join(folder, "picture.exr"))
    bpy.ops.render.render(write_still=True)
    bpy.ops.lancer.save_bug_report(filepath=os.path.join(folder, "report.zip"))
    return {"mean": float(exr.read(os.path.join(folder, "picture.exr"))["Combined"][..., :3].mean())}


def _pixels(path):
    image = bpy.data.images.load(path)
    pixels = np.array(image.pixels[:], np.float32).reshape(image.size[1], image.size[0], -1)
    bpy.data.images.remove(image)
    return pixels


def same(one, other):
    # exr.read returns the top row first, _pixels the bottom row.
    first, second = exr.read(one)["Combined"][::-1], _pixels(other)
    return {"shape": list(second.shape), "same": bool(np.array_equal(first, second))}
