"""Renders that continue from the file beside the output."""

import os
import signal
from pathlib import Path

import bpy
import numpy as np
import recording
import stage

from addon.bindings.session import Session
from addon.engine import last_messages, last_statistics, resume, resume_file, stepped_session
from addon.engine.render_engine import LancerRenderEngine
from addon.ui.resume import LANCER_RENDER_PT_resume


def room(samples, keeps=True, **settings):
    """Return a small scene that renders in many steps."""
    scene = stage.room(width=24, height=24, samples=samples)
    scene.render.filepath = os.path.abspath("out_")
    scene.lancer.use_resume = keeps
    for name, value in settings.items():
        setattr(scene.lancer, name, value)
    # Two tiles a step, and each range in two pieces, on any machine.
    stepped_session._STEP_SECONDS, stepped_session._TILES_EACH, stepped_session._PIECES = 0.0, 1, 2
    return scene


def files():
    return sorted(path.name for path in Path().glob("*" + resume_file.ENDING))


def clear():
    for name in files():
        os.remove(name)


def rendered(scene, name="picture"):
    """Render; return the colours of the render result."""
    bpy.ops.render.render()
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "IMAGE"
    image.file_format, image.color_depth = "OPEN_EXR", "32"
    path = os.path.abspath(f"{name}.exr")
    bpy.data.images["Render Result"].save_render(path, scene=scene)
    return stage.pixels(path)


def facts(scene):
    """Return samples per pixel, reason of the end, and messages about files of the last render."""
    numbers, texts = last_statistics[scene], [message.text for message in last_messages[scene].told()]
    return [numbers["samples_mean"], numbers["ended_by"], [text for text in texts if text.startswith("resume file")]]


def interrupted(scene, steps):
    """Render with a cancel in this step; return what facts() does."""
    begun, begin, is_over = [], stepped_session.SteppedSession._begin, LancerRenderEngine._is_over

    def count(session):
        begun.append(session)
        begin(session)

    stepped_session.SteppedSession._begin = count
    LancerRenderEngine._is_over = lambda self: len(begun) >= steps
    try:
        bpy.ops.render.render()
    finally:
        stepped_session.SteppedSession._begin, LancerRenderEngine._is_over = begin, is_over
    return facts(scene)


def more_samples():
    """Pictures of more and more samples, beside those of one render each."""
    result = []
    for few, many in ((4, 24), (24, 40)):
        whole = rendered(room(many, keeps=False))
        clear()
        scene = room(few)
        bpy.ops.render.render()
        scene.lancer.samples = many
        result.append({"same": bool(np.array_equal(rendered(scene), whole)), "facts": facts(scene), "files": files()})
    # Render once more, where nothing is left to do.
    result.append({"same": bool(np.array_equal(rendered(scene), whole)), "facts": facts(scene), "files": files()})
    panel = [panel_of(scene)]
    clear()
    return result, [*panel, panel_of(scene)]


def panel_of(scene):
    """Return the words of the panel."""
    return recording.draw(LANCER_RENDER_PT_resume, recording.Context(engine="LANCER", scene=scene)).words


def cancelled(target):
    """Renders that are cancelled twice, among the first samples and where some pixels get more, and then end.

    checks: the confidences at which each compares its error with the target, from the second check on.
    """
    checks, error = [], Session.error

    def note(session, confidence=0.95):
        if confidence > 0.95:
            checks[-1].append(confidence)
        return error(session, confidence)

    Session.error = note
    try:
        checks.append([])
        scene = room(256, keeps=False, target_error=float(target))
        whole, last = rendered(scene), facts(scene)
        checks.append([])
        scene = room(256, target_error=float(target))
        told = [interrupted(scene, 9), interrupted(scene, 30)]
        same = bool(np.array_equal(rendered(scene), whole))
    finally:
        Session.error = error
    return {"same": same, "cancelled": told, "whole": last, "facts": facts(scene), "checks": checks}


def until_killed():
    """Kill the process while it writes the file for the sixth time; samples.txt has the mean samples of each writing."""
    replace = os.replace

    def note(new, path):
        found, _ = resume_file.look(new)
        with open("samples.txt", "a", encoding="utf-8") as file:
            file.write(f"{found['mean']!r} {found['samples'] + found['next']}\n")
        if len(Path("samples.txt").read_text().splitlines()) == 6:
            os.kill(os.getpid(), signal.SIGKILL)
        replace(new, path)

    os.replace = note
    resume._EVERY, resume._SHARE = 0.0, 1.0
    room(64)
    bpy.ops.render.render()


def after_a_kill():
    """Continue the killed render, beside one that was not killed."""
    whole = rendered(room(64, keeps=False))
    found, _ = resume_file.look(files()[0])
    return {"mean": found["mean"], "same": bool(np.array_equal(rendered(room(64)), whole)), "facts": facts(bpy.context.scene)}


def unusable():
    """Files that are damaged in their head, facts and samples, cut off, and of another camera, setting, and scene."""
    scene = room(4)
    result = {}

    def render(what, data):
        """Return whether the picture is that without a file, and facts about the render."""
        clear()
        whole = rendered(scene)
        path.write_bytes(data)
        result[what] = [bool(np.array_equal(rendered(scene), whole)), *facts(scene)]

    bpy.ops.render.render()
    path = Path(files()[0])
    data = path.read_bytes()
    for what, at in {"magic": 0, "format": 8, "facts": 40, "samples": len(data) // 2}.items():
        render(what, data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :])
    render("cut off", data[: len(data) // 2])
    render("empty", b"")
    scene.camera.data.lens += 1.0
    render("camera", data)
    scene.camera.data.lens -= 1.0
    scene.lancer.max_bounces = 3
    render("bounces", data)
    scene.lancer.max_bounces = 12
    bpy.data.objects["Cube"].location.x += 0.125
    render("scene", data)
    bpy.data.objects["Cube"].location.x -= 0.125
    clear()
    path.write_bytes(data)
    result["the same"] = [True, *interrupted(scene, 1)]
    return result


def layers_and_frames():
    """Two view layers of two frames, rendered twice: whether each continues, and the files before and after their deletion."""
    scene = room(4)
    scene.view_layers.new("A/B %")
    item = bpy.data.objects["Cube"]
    for frame in (1, 2):
        item.location.x = float(frame)
        item.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 2
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.color_depth = "OPEN_EXR_MULTILAYER", "32"
    result = {}

    def animation(name):
        scene.render.filepath = os.path.abspath(os.path.join(name, "out_"))
        loaded, load = [], resume.Resume.load

        def note(self, session):
            messages = load(self, session)
            loaded.append(self.is_continued)
            return messages

        resume.Resume.load = note
        try:
            bpy.ops.render.render(animation=True)
        finally:
            resume.Resume.load = load
        return loaded

    result["first"] = animation("a")
    result["again"] = animation("a")
    result["files"] = sorted(path.name for path in Path("a").glob("*" + resume_file.ENDING))
    result["deleted"] = [list(bpy.ops.lancer.delete_resume_files()), sorted(path.name for path in Path("a").iterdir())]
    return result


def without_files():
    """Return the files of a render without the setting, and facts about one into a folder that cannot be made."""
    scene = room(4, keeps=False)
    bpy.ops.render.render()
    none = files()
    Path("file").write_text("no folder")
    scene.lancer.use_resume, scene.render.filepath = True, os.path.abspath(os.path.join("file", "out_"))
    bpy.ops.render.render()
    return none, facts(scene)
