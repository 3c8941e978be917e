"""Frames as a farm's job renders them."""

import os
import sys

import bpy
import stage

from addon.farm.in_blender import CHECK, PREPARE


def animation(pattern, frames):
    """Render frames 1 to 3 with the job's code, as if the command line were `-o pattern -f frames`; return the files."""
    stage.room(samples=1)
    scene = bpy.context.scene
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = pattern
    scene.frame_start, scene.frame_end = 1, 3
    arguments, sys.argv = sys.argv, ["blender", "-f", frames]
    try:
        exec(PREPARE, {})
    finally:
        sys.argv = arguments
    bpy.ops.render.render(animation=True)
    try:
        exec(CHECK, {})
        code = 0
    except SystemExit as end:
        code = end.code
    folder = os.path.dirname(pattern)
    return {"code": code, "sizes": {name: os.path.getsize(os.path.join(folder, name)) for name in os.listdir(folder)}}
