"""Cases that leave changes behind, or end badly: the next case must not notice."""

import os
import sys
import time

import bpy

import addon
from addon import engine


def _on_load(*_):
    pass


def leave():
    """Change everything that a case can change."""
    bpy.context.scene.render.resolution_x = 77
    bpy.data.objects.new("Left", None).use_fake_user = True
    bpy.context.preferences.filepaths.use_relative_paths = False
    bpy.app.handlers.load_post.append(_on_load)
    os.environ["LANCER_LEFT"] = "1"
    sys.path.insert(0, "/left")
    engine.last_messages[bpy.context.scene.name] = ["left"]
    addon.left = True
    return True


def look():
    """Return the things that leave() has changed and that are still changed."""
    found = {
        "resolution": bpy.context.scene.render.resolution_x == 77,
        "object": "Left" in bpy.data.objects,
        "preference": not bpy.context.preferences.filepaths.use_relative_paths,
        "handler": any(function.__name__ == "_on_load" for function in bpy.app.handlers.load_post),
        "environment": "LANCER_LEFT" in os.environ,
        "path": "/left" in sys.path,
        "messages": any(engine.last_messages.get(scene.name) for scene in bpy.data.scenes),
        "module": hasattr(addon, "left"),
    }
    return [name for name, is_changed in found.items() if is_changed]


def process():
    return os.getpid()


def fails():
    raise RuntimeError("this case fails")


def aborts():
    os.abort()


def hangs():
    time.sleep(600)
