"""F12 with denoising: the passes in the file, which of them are unchanged, and the messages."""

import hashlib
import os
import signal
import tempfile
import threading

import bpy
import exr
import numpy as np
import stage

from addon.denoise import view_layer as denoise
from addon.engine import render_engine as engine


def _scene(width=64, height=48, samples=4):
    """Build diffuse, mirror, glass and transparent objects before a sky."""
    scene = stage.empty(width, height, samples)
    stage.plane(material=stage.shader(Color=(0.6, 0.5, 0.4)))
    stage.cube(material=stage.shader(Color=(0.8, 0.2, 0.1)), location=(-1.2, 0, 0.5))
    stage.cube(material=stage.shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.8, 0.7), Roughness=0.0), location=(1.2, 0.5, 0.5))
    stage.ball(0.5, stage.shader("ShaderNodeBsdfGlass", IOR=1.4), segments=16, location=(0, -1, 0.5))
    for step in range(3):
        clear = stage.shader("ShaderNodeBsdfTransparent", Color=(0.9, 0.7, 0.8))
        stage.plane(1.0, clear, location=(-0.8, -1.5 - 0.2 * step, 0.6), rotation=(1.5, 0, 0))
    stage.light(energy=300.0)
    stage.sky()
    stage.camera((0, -5, 1.6), (0, 0, 0.7))
    return scene


def _render(scene, denoising, layer=None):
    """Return {pass: picture} of a view layer, the messages, the statistics, and the file's bytes."""
    scene.lancer.use_denoising = denoising
    path = os.path.join(tempfile.mkdtemp(), "passes.exr")
    exr.write_settings(scene, path)
    bpy.ops.render.render(write_still=True)
    with open(path, "rb") as file:
        data = file.read()
    return exr.read(path, layer), list(engine.last_messages[scene.name]), engine.last_statistics[scene.name], data


def _compare(scene, layer=None):
    """Render the scene without and with denoising. Return which passes are equal, and facts of the others."""
    raw, _, _, data = _render(scene, False, layer)
    pictures, messages, statistics, stamped = _render(scene, True, layer)
    combined = pictures["Combined"]
    declaration = denoise.DECLARATION.encode()
    return {
        "version": list(bpy.app.version),
        "passes": sorted(pictures),
        "passes without": sorted(raw),
        "noisy is raw": np.array_equal(pictures.get("Noisy Image"), raw["Combined"]),
        "alpha is raw": np.array_equal(combined[..., 3], raw["Combined"][..., 3]),
        "combined is raw": np.array_equal(combined, raw["Combined"]),
        "others are raw": all(np.array_equal(pictures[name], raw[name]) for name in raw if name != "Combined"),
        "alphas": [float(combined[..., 3].min()), float(combined[..., 3].max())],
        "finite": bool(np.isfinite(combined).all()),
        "size": list(combined.shape),
        "picture": hashlib.sha256(combined.tobytes()).hexdigest(),
        "messages": messages,
        "statistics": {name: value for name, value in statistics.items() if name.startswith("denois")},
        "stamped": [declaration in data, declaration in stamped],
    }


def plain():
    return _compare(_scene())


def classic():
    scene = _scene()
    scene.lancer.integrator = "CLASSIC"
    return _compare(scene)


def passes():
    """Denoise beside other passes, those for denoising among them."""
    scene = _scene()
    layer = scene.view_layers[0]
    layer.use_pass_normal = layer.use_pass_diffuse_direct = True
    layer.cycles.denoising_store_passes = True
    return _compare(scene)


def border():
    scene = _scene()
    render = scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.25, 1.0
    return _compare(scene)


def transparent():
    scene = _scene()
    scene.render.film_transparent = True
    return _compare(scene)


def view_layers():
    """Two view layers; the second has denoising off."""
    scene = _scene()
    names = [scene.view_layers[0].name, scene.view_layers.new("Raw").name]
    scene.view_layers["Raw"].cycles.use_denoising = False
    return [_compare(scene, name) for name in names]


def normals():
    scene = _scene()
    scene.lancer.integrator = "NORMALS"
    return _compare(scene)


_OF_PICTURES = (plain, classic, passes, border, transparent, view_layers, normals)


def several():
    """Run many cases in one process."""
    return {case.__name__: case() for case in (*_OF_PICTURES, failing, as_cycles, nearer, told, once, target)} | {
        how: stopped(how) for how in ("poll", "at once")
    }


def _noisy(samples):
    """Build the scene in the light of a large lamp."""
    scene = _scene(96, 64, samples)
    next(item.data for item in bpy.data.objects if item.type == "LIGHT").shadow_soft_size = 3.0
    scene.lancer.use_pass_error = True
    return scene


def told():
    """Return the error of a denoised picture as it is told, and its pass, with the samples in the picture and without."""
    scene = _noisy(16)
    found = []
    for combines in (True, False):
        scene.lancer.use_denoising_samples = combines
        pictures, _, statistics, data = _render(scene, True)
        bars = pictures["Lancer Denoised Error"]
        found.append(
            {
                "picture": hashlib.sha256(pictures["Combined"].tobytes()).hexdigest(),
                "errors": [statistics[f"denoised_error{end}"] for end in ("_low", "", "_high")],
                "error": statistics["error"],
                "lines": statistics["accuracy"],
                "stamped": f"{statistics['denoised_error']:.6g}".encode() in data,
                "bars": [list(bars.shape), float(bars.min()), float(bars.mean()), float(pictures["Lancer Error"].mean())],
            }
        )
    return found


def once():
    """Denoise one sample, which has no halves."""
    scene = _scene(samples=1)
    scene.lancer.use_pass_error = True
    pictures, _, statistics, _ = _render(scene, True)
    return {
        "denoised": not np.array_equal(pictures["Combined"], pictures["Noisy Image"]),
        "error": statistics["denoised_error"],
        "bars": float(np.abs(pictures["Lancer Denoised Error"]).max()),
        "lines": statistics["accuracy"],
    }


def target():
    """End at a target of the denoised picture, of the noisy one, and of one that denoising cannot reach."""
    scene = _noisy(4096)
    found = {}
    for name, error, of_denoised, samples in (
        ("denoised", 0.03, True, 4096),
        ("noisy", 0.03, False, 4096),
        ("missed", 0.0001, True, 32),
    ):
        scene.lancer.target_error, scene.lancer.use_denoised_target, scene.lancer.samples = error, of_denoised, samples
        _, messages, statistics, _ = _render(scene, True)
        names = ("ended_by", "samples_mean", "error", "denoised_error_high", "error_cannot_exclude", "denoising_seconds")
        found[name] = {key: statistics[key] for key in names} | {"lines": statistics["accuracy"], "messages": messages}
    return found


def stopped(how):
    """Cancel denoising at its first report of progress, by the polled function or by Ctrl-C, or even before."""
    scene = _scene(samples=1)
    raw, *_ = _render(scene, False)
    original, said, result = denoise.apply, [], {}

    def apply(session, combines, _, tell):
        def hear(text):
            said.append(text)
            tell(text)
            if how == "interrupt" and "%" in text:
                os.kill(os.getpid(), signal.SIGINT)

        return original(session, combines, lambda: how == "poll" and bool(said) or how == "at once", hear)

    denoise.apply = apply
    if how == "interrupt":
        # As in a terminal: a process that a shell starts in the background ignores Ctrl-C.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        pictures, _, statistics, data = _render(scene, True)
        result["raw"] = all(np.array_equal(pictures[name], raw["Combined"]) for name in ("Combined", "Noisy Image"))
        result["denoised"] = statistics["denoised"]
        result["stamped"] = denoise.DECLARATION.encode() in data
    except RuntimeError as error:
        result["error"] = str(error)
    finally:
        denoise.apply = original
    working = [thread.name for thread in threading.enumerate() if "denoising" in thread.name]
    return {**result, "said": said, "messages": list(engine.last_messages[scene.name]), "working": working}


def failing():
    """Let the denoiser raise an error."""
    original = denoise.denoiser.denoise

    def fail(*_, **__):
        raise denoise.LancerError("Open Image Denoise: out of memory")

    denoise.denoiser.denoise = fail
    try:
        return _compare(_scene())
    finally:
        denoise.denoiser.denoise = original


def as_cycles():
    """Return the passes of both engines for the same switches."""
    names = {"version": list(bpy.app.version)}
    for store in (False, True):
        scene = _scene(16, 16, 1)
        scene.view_layers[0].cycles.denoising_store_passes = store
        ours = _render(scene, True)[0]
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.use_denoising = 1, True
        path = os.path.join(tempfile.mkdtemp(), "cycles.exr")
        exr.write_settings(scene, path)
        bpy.ops.render.render(write_still=True)
        names[str(store)] = [{name: picture.shape[2] for name, picture in each.items()} for each in (ours, exr.read(path))]
    return names


def nearer():
    """Return the errors of a noisy and of a denoised picture of 16 samples against a converged one."""
    scene = _scene(96, 64, 16)
    pictures = _render(scene, True)[0]
    scene.lancer.samples, scene.lancer.seed = 1024, 1
    truth = _render(scene, False)[0]["Combined"][..., :3].astype(np.float64)

    def error(name):
        return float(np.mean((pictures[name][..., :3] - truth) ** 2 / (truth**2 + 0.01 * np.mean(truth) ** 2)))

    return {"raw": error("Noisy Image"), "denoised": error("Combined")}
