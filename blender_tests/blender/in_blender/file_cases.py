"""Write .blend files for `blender -b`."""

import bpy
import stage


def room(path, samples):
    stage.room(samples=int(samples))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return {}


def room_without_a_camera(path):
    stage.room()
    bpy.context.scene.camera = None
    bpy.data.objects.remove(bpy.data.objects["Camera"])
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return {}


def long_render(path):
    stage.room(width=640, height=480, samples=100000)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return {}
