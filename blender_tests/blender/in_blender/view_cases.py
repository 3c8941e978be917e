"""Stereoscopy: each view of a picture by both engines, of surfaces that show where they are."""

import os

import bpy
import exr
import numpy as np
import stage

_SIZE = 48, 32


def _shows_its_place():
    """Return a material that glows in the colour of its place, shifted to be positive."""
    material = stage.shader("ShaderNodeEmission", name="Place")
    tree = material.node_tree
    glow = next(node for node in tree.nodes if node.type == "EMISSION")
    place, moved = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeVectorMath")
    moved.operation, moved.inputs[1].default_value = "ADD", (10.0, 10.0, 10.0)
    tree.links.new(place.outputs["Position"], moved.inputs[0])
    tree.links.new(moved.outputs[0], glow.inputs["Color"])
    return material


def _scene():
    scene = stage.empty(*_SIZE, samples=64)
    scene.cycles.samples, scene.cycles.device = 64, "CPU"
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type, scene.lancer.pixel_filter = "BOX", "BOX"
    material = _shows_its_place()
    stage.ball(radius=8.0, material=material, segments=48)
    stage.cube(material=material, location=(0.4, 1.0, 0.5))
    camera = stage.camera(location=(0.5, -3.0, 1.0), target=(0.0, 0.0, 0.6))
    scene.render.use_multiview = True
    return scene, camera


def _rendered(scene, folder, which="Combined"):
    """Return {engine: {view: picture of a pass}}."""
    found = {}
    for engine in ("LANCER", "CYCLES"):
        scene.render.engine = engine
        path = os.path.join(folder, f"{engine}.exr")
        exr.write_settings(scene, path)
        scene.render.image_settings.views_format = "MULTIVIEW"
        bpy.ops.render.render(write_still=True)
        passes = exr.read(path)
        found[engine] = {name.split(".")[1]: passes[name] for name in passes if name.startswith(f"{which}.")}
    return found


def _differences(found):
    """Return the mean distance between both engines' places in each view, and that between the first two views."""
    ours, theirs = found["LANCER"], found["CYCLES"]
    apart = {view: float(np.abs(ours[view] - theirs[view])[..., :3].mean()) for view in theirs}
    first, second, *_ = ours.values()
    return {"engines": apart, "views": float(np.abs(first - second)[..., :3].mean()), "same": sorted(ours) == sorted(theirs)}


def stereo(folder):
    """Return the differences of each way to converge, of flat and spherical cameras."""
    scene, camera = _scene()
    stereo, result = camera.data.stereo, {}
    stereo.interocular_distance, stereo.convergence_distance = 0.4, 3.0
    for mode in ("PARALLEL", "OFFAXIS", "TOE"):
        stereo.convergence_mode = mode
        for pivot in ("CENTER", "LEFT"):
            stereo.pivot = pivot
            result[f"{mode} {pivot}"] = _differences(_rendered(scene, folder))
    stereo.pivot = "CENTER"
    camera.data.shift_x, camera.data.sensor_fit = 0.1, "VERTICAL"
    result["shifted"] = _differences(_rendered(scene, folder))
    camera.data.type, camera.data.sensor_fit = "PANO", "AUTO"
    for owner in (camera.data, getattr(camera.data, "cycles", None)):
        if owner is not None and "panorama_type" in owner.bl_rna.properties:
            owner.panorama_type = "EQUIRECTANGULAR"
    stereo.use_spherical_stereo = True
    for mode in ("PARALLEL", "OFFAXIS"):
        stereo.convergence_mode = mode
        for merges in (False, True):
            stereo.use_pole_merge = merges
            result[f"sphere {mode} {merges}"] = _differences(_rendered(scene, folder))
    camera.data.type = "PERSP"
    result["flat sphere"] = _differences(_rendered(scene, folder))
    return result


def cameras(folder):
    """Each view has a camera of its own, by the ends of their names."""
    scene, camera = _scene()
    _two_cameras(scene, camera)
    return _differences(_rendered(scene, folder))


def _two_cameras(scene, camera):
    """Let the scene's views be those of its camera and of another one, which is returned."""
    camera.name = "Camera_A"
    other = stage.camera(location=(2.0, -2.5, 1.5), target=(0.0, 0.0, 0.6))
    other.name = "Camera_B"
    scene.camera = camera
    scene.render.views_format = "MULTIVIEW"
    for view in scene.render.views:
        view.use = False
    for end in "AB":
        view = scene.render.views.new(end)
        view.camera_suffix, view.use = f"_{end}", True
    return other


def _flight(kind):
    """Return a scene seen by two eyes of a camera that moves, or by two cameras of which the second is faster."""
    scene, camera = _scene()
    seen = [camera]
    if kind == "cameras":
        seen.append(_two_cameras(scene, camera))
    camera.data.stereo.interocular_distance, camera.data.stereo.convergence_distance = 0.4, 3.0
    for number, eye in enumerate(seen):
        place = eye.location.copy()
        for frame in (1, 3):
            eye.location.x = place.x + 0.2 * (1 + number) * (frame - 2)
            eye.keyframe_insert("location", frame=frame)
    scene.frame_set(2)
    return scene


def blurred(folder):
    """Return the differences of eyes and of cameras that move, and how far motion blur changes each view."""
    result = {}
    for kind in ("eyes", "cameras"):
        scene = _flight(kind)
        sharp = _rendered(scene, folder)["LANCER"]
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 2.0
        found = _rendered(scene, folder)
        blur = {view: float(np.abs(found["LANCER"][view] - sharp[view])[..., :3].mean()) for view in sharp}
        result[kind] = {**_differences(found), "blur": blur}
    return result


def vectors(folder):
    """Return {view: largest difference and largest value of both engines' vectors} of eyes and of cameras that move."""
    result = {}
    for kind in ("eyes", "cameras"):
        scene = _flight(kind)
        scene.view_layers[0].use_pass_vector = True
        # Samples at the middle of pixels show the same edges in both engines.
        for owner in (scene.cycles, scene.lancer):
            owner.filter_width = 0.01
        scene.cycles.pixel_filter_type = scene.lancer.pixel_filter = "BLACKMAN_HARRIS"
        ours, theirs = _rendered(scene, folder, "Vector").values()
        for view in theirs:
            apart = np.sort(np.abs(ours[view] - theirs[view]).max(axis=-1).ravel())
            result[f"{kind} {view}"] = float(apart[int(0.98 * apart.size)]), float(np.abs(theirs[view]).max())
    return result


def told():
    """Return the accuracy lines of a render with two eyes, and the names of its layers in the statistics."""
    from addon.engine import last_statistics

    scene, _ = _scene()
    scene.render.engine = "LANCER"
    bpy.ops.render.render()
    numbers = last_statistics[scene.name]
    return {"layers": sorted(numbers["layers"]), "lines": [layer["accuracy"][0] for layer in numbers["layers"].values()]}
