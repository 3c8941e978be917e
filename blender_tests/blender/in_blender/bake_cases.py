"""Object > Bake: the texels of both engines, targets, and what cannot be baked."""

import bpy
import numpy as np
import stage
from bake_stage import apart, bake, choose, image, room

from addon.engine import last_messages
from scenes import parts
from scenes.parity import subdivisions

_PLAIN = ("POSITION", "NORMAL", "ROUGHNESS", "EMIT", "ENVIRONMENT")
_LIT = ("COMBINED", "AO", "DIFFUSE", "GLOSSY", "TRANSMISSION")


def alike():
    """Return for each type the largest difference of block means, the number of texels of other alpha, and the level."""
    scene, _, material = room()
    picture = image(material)
    found = {}
    # The shadows of Cycles 3 are black.
    for kind in (*_PLAIN, *_LIT, *(("SHADOW",) if bpy.app.version >= (4, 0) else ())):
        # The pass of positions is summed over Cycles' samples.
        samples = 1 if kind == "POSITION" else 256
        ours, theirs = (bake(scene, picture, engine, kind, samples) for engine in ("LANCER", "CYCLES"))
        other_alpha = int((ours[..., 3] != theirs[..., 3]).sum())
        found[kind] = [apart(ours, theirs), other_alpha, float(np.abs(theirs[..., :3]).mean())]
    return {"types": found}


def filtered():
    """Return the largest difference of the engines' block means for contributions and parts of the light."""
    scene, _, material = room()
    picture, found = image(material), {}
    for name, kind, filters in (
        ("direct", "DIFFUSE", {"DIRECT", "COLOR"}),
        ("indirect", "DIFFUSE", {"INDIRECT", "COLOR"}),
        ("color", "DIFFUSE", {"COLOR"}),
        ("light", "DIFFUSE", {"DIRECT", "INDIRECT"}),
        ("no gloss", "COMBINED", {"DIRECT", "INDIRECT", "DIFFUSE", "EMIT"}),
    ):
        found[name] = apart(*(bake(scene, picture, engine, kind, 256, pass_filter=filters) for engine in ("LANCER", "CYCLES")))
    return {"parts": found}


def targets():
    """Return what reaches a colour attribute, a second object by rays, and an image of a scene without a camera."""
    scene, block, material = room()
    picture = image(material)
    flat = float(bake(scene, picture, "LANCER", "COMBINED", 16)[..., :3].mean())
    camera = scene.camera
    # A bake is none of a render's jobs, also after one.
    bpy.ops.render.render()
    scene.camera = None
    bare = float(bake(scene, picture, "LANCER", "COMBINED", 16)[..., :3].mean())
    scene.camera = camera
    copy = parts.place(scene, "Copy", block.data.copy(), None, block.location, rotation=block.rotation_euler)
    copy.scale = (1.02, 1.02, 1.02)
    copy.hide_render = False
    choose(block, copy)
    onto = bake(scene, picture, "LANCER", "EMIT", 4, use_selected_to_active=True, cage_extrusion=0.2)
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0, 1, 0, 1)
    colors = bake(
        scene, picture, "LANCER", "DIFFUSE", 4, use_selected_to_active=True, cage_extrusion=0.2, pass_filter={"COLOR"}
    )
    bpy.data.objects.remove(copy)
    choose(block)
    attribute = block.data.color_attributes.new("Color", "FLOAT_COLOR", "CORNER")
    block.data.color_attributes.active_color = attribute
    bpy.ops.object.bake(type="DIFFUSE", target="VERTEX_COLORS", pass_filter={"COLOR"})
    corners = np.array([tuple(item.color) for item in attribute.data])
    return {
        "with": flat,
        "bare": bare,
        "emission": float(onto[..., :3].max()),
        "green": colors[colors[..., 1] > 0.1][:, :3].mean(axis=0).tolist() if (colors[..., 1] > 0.1).any() else [],
        "attribute": corners[:, :3].mean(axis=0).tolist(),
    }


def refused():
    """Return the errors of what cannot be baked."""
    scene, block, material = room()
    picture = image(material)
    errors = {}

    def attempt(name, kind):
        try:
            bake(scene, picture, "LANCER", kind, 4)
        except RuntimeError as error:
            errors[name] = str(error)

    block.lancer.shape = "SPHERE"
    attempt("exact", "COMBINED")
    block.lancer.shape = "MESH"
    scene.lancer.integrator = "CLASSIC"
    attempt("classic", "COMBINED")
    return errors


def divided():
    """Return the largest difference of both engines' places of a block that is divided adaptively in pictures."""
    scene, block, material = room()
    picture = image(material)
    modifier = block.modifiers.new("Divide", "SUBSURF")
    modifier.levels = modifier.render_levels = 1
    subdivisions.dice(scene, block, modifier, 1.0)
    ours, theirs = (bake(scene, picture, engine, "POSITION", 1) for engine in ("LANCER", "CYCLES"))
    return {"apart": float(np.abs(ours - theirs).max()), "level": float(np.abs(theirs[..., :3]).max())}


def beside_the_frame():
    """Return the messages of bakes with a shutter that opens around the frame, and at the frame."""
    scene, _, material = room()
    picture, told = image(material), {}
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
    for position in ("CENTER", "START"):
        owner.motion_blur_position = position
        bake(scene, picture, "LANCER", "EMIT", 1)
        told[position] = list(last_messages.get(scene.name, ()))
    return told


def unannounced():
    """Return the level of a picture that is rendered without Lancer's handlers, which a script has removed."""
    scene, _, _ = room()
    scene.lancer.samples = 4
    bpy.app.handlers.render_init.clear()
    return {"level": float(stage.picture(scene)[..., :3].mean())}


def same():
    """Return whether a bake has the same bits for one thread and for two, and ends by its target error."""
    scene, _, material = room()
    picture = image(material)
    pictures = []
    for threads in (1, 2):
        scene.render.threads_mode, scene.render.threads = "FIXED", threads
        pictures.append(bake(scene, picture, "LANCER", "COMBINED", 16).tobytes())
    scene.lancer.target_error = 0.2
    bake(scene, picture, "LANCER", "COMBINED", 4096)
    return {"same": pictures[0] == pictures[1]}
