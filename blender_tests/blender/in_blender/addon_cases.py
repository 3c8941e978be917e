"""The add-on inside Blender: registration, preferences, limits. Each function returns the numbers that its test compares."""

import ctypes
import sys

import bpy
import numpy as np
import stage

_OWNERS = ("Scene", "Object", "Material", "Light")


def _traces():
    """Return everything that the add-on registers with Blender and that is still there."""
    panels = [cls for cls in bpy.types.Panel.__subclasses__() if cls.is_registered]
    return {
        "properties": [name for name in _OWNERS if "lancer" in getattr(bpy.types, name).bl_rna.properties],
        "panels": [cls.__name__ for cls in panels if "LANCER" in getattr(cls, "COMPAT_ENGINES", ())],
        "engines": [cls.__name__ for cls in bpy.types.RenderEngine.__subclasses__() if cls.is_registered],
        "types": [name for name in dir(bpy.types) if "lancer" in name.lower()],
    }


def registration():
    """Return the traces while registered, after unregister and after register again; each call is made twice."""
    import addon

    result = {"first": _traces()}
    addon.unregister()
    addon.unregister()
    result["without"] = _traces()
    addon.register()
    addon.register()
    result["again"] = _traces()
    result["mean"] = float(stage.picture(stage.room())[..., :3].mean())
    return result


def _forget():
    """Unregister the add-on and drop its modules, as if it had never been imported."""
    import addon

    addon.unregister()
    for name in [name for name in sys.modules if name.split(".")[0] == "addon"]:
        del sys.modules[name]


def without_numpy():
    """Register while numpy cannot be imported, then with it."""
    _forget()
    numpy = sys.modules["numpy"]
    sys.modules["numpy"] = None
    import addon

    try:
        addon.register()
        text = ""
    except RuntimeError as error:
        text = str(error)
    sys.modules["numpy"] = numpy
    result = {"error": text, "without": _traces()}
    addon.register()
    result["with"] = _traces()
    addon.unregister()
    return result


def other_library(folder):
    """Render with the copy of the add-on in folder. Return the error's text, and whether that copy was imported."""
    _forget()
    sys.path.insert(0, folder)
    import addon

    addon.register()
    stage.room()
    try:
        bpy.ops.render.render()
        text = ""
    except RuntimeError as error:
        text = str(error)
    addon.unregister()
    return {"error": text, "from": addon.__file__}


def _statistics(scene):
    from addon.engine import render_engine as engine

    return engine.last_statistics[scene.name]


def time_limit():
    scene = stage.room(samples=10**6)
    scene.lancer.time_limit = 1.0
    mean = float(stage.picture(scene)[..., :3].mean())
    return {"samples": _statistics(scene)["samples"], "mean": mean}


def animated_seed():
    """Return whether frames 1 and 2 have the same noise: with the setting off, and on."""
    scene = stage.room(samples=1)
    result = {}
    for on in (False, True):
        scene.lancer.use_animated_seed = on
        frames = []
        for frame in (1, 2):
            scene.frame_set(frame)
            frames.append(stage.picture(scene))
        result[str(on)] = bool((frames[0] == frames[1]).all())
    return result


def quality():
    own = stage.empty().lancer
    result = {}
    for name in ("DRAFT", "GOOD", "FINAL"):
        own.quality = name
        result[name] = [round(own.target_error, 6), own.samples, own.quality]
    own.samples = 77
    result["own number"] = [own.samples, own.quality]
    own.quality = "DRAFT"
    own.target_error = 0.2
    result["own error"] = [own.samples, own.quality]
    return result


def threads():
    scene = stage.room(samples=1)
    result = []
    for count in (1, 2, 3):
        scene.render.threads = count
        bpy.ops.render.render()
        result.append([count, _statistics(scene)["threads"]])
    return result


def clamp(limit):
    """Render a white corner under a point lamp: all light, all light clamped, direct light alone, direct light clamped."""
    scene = stage.empty(16, 16, 16)
    white = stage.shader(Color=(1.0, 1.0, 1.0))
    stage.plane(material=white)
    stage.plane(material=white, location=(0, 2, 0), rotation=(np.pi / 2, 0, 0))
    stage.light("POINT", 500.0, (0, 0, 2), shadow_soft_size=0.0)
    stage.camera((0, -4, 2), (0, 2, 0.5))
    pictures = {}
    for name, bounces, at_most in (
        ("all", 4, 0.0),
        ("clamped", 4, float(limit)),
        ("direct", 0, 0.0),
        ("direct clamped", 0, float(limit)),
    ):
        scene.lancer.max_bounces, scene.lancer.clamp_indirect = bounces, at_most
        pictures[name] = stage.picture(scene)[..., :3].astype(np.float64)
    added = pictures["clamped"] - pictures["direct"]
    return {
        "brightest": float(pictures["direct"].max()),
        "indirect": float((pictures["all"] - pictures["direct"]).min()),
        "least added": float(added.min()),
        "most added": float(added.max()),
        "direct stays": bool((pictures["direct"] == pictures["direct clamped"]).all()),
    }


def _resident():
    """Return the resident bytes, without the free pages that glibc keeps for later allocations."""
    ctypes.CDLL(None).malloc_trim(0)
    with open("/proc/self/status", encoding="ascii") as file:
        return next(int(line.split()[1]) * 1024 for line in file if line.startswith("VmRSS:"))


def many_renders():
    """Return the resident bytes after each of 20 renders, and the bytes that the library held for one of them."""
    scene = stage.empty(32, 32, 1)
    stage.ball(segments=248)
    stage.light()
    stage.camera()
    resident = []
    for _ in range(20):
        bpy.ops.render.render()
        resident.append(_resident())
    last = _statistics(scene)
    held = sum(last[name] for name in ("geometry_bytes", "accelerator_bytes", "texture_bytes", "film_bytes"))
    return {"resident": resident, "held": held, "triangles": last["triangles"]}
