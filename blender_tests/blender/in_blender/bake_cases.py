"""Object > Bake: the texels of both engines, targets, and what cannot be baked."""

import bpy
import numpy as np
import stage

from addon.engine import last_messages
from scenes import parts
from scenes.parity import subdivisions

SIZE = 32
_PLAIN = ("POSITION", "NORMAL", "ROUGHNESS", "EMIT", "ENVIRONMENT")
_LIT = ("COMBINED", "AO", "DIFFUSE", "GLOSSY", "TRANSMISSION")


def _image(material, name="Baked", **options):
    image = bpy.data.images.new(name, SIZE, SIZE, float_buffer=True, **options)
    image.colorspace_settings.name = "Non-Color"
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    tree.nodes.active = node
    return image


def _room():
    """Return the scene, and a textured block between a floor, a lamp and a sky."""
    scene = stage.empty(SIZE, SIZE, 16)
    parts.add_camera(scene, (0, -5, 2), (0, 0, 0.7))
    parts.set_world(scene, (0.3, 0.4, 0.6), 0.5)
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 8.0), parts.principled("Grey", base_color=(0.6, 0.5, 0.4)))
    parts.add_light(scene, "Lamp", "AREA", 120.0, (2.0, -2.0, 3.0), size=1.0)
    material = parts.principled("Paint", base_color=(0.7, 0.4, 0.2), roughness=0.4, ior=1.5)
    block = parts.place(scene, "Block", parts.cube_mesh("Block", 1.0), None, (0, 0, 0.8), rotation=(0.3, 0.2, 0.5))
    block.data.materials.append(material)
    block.data.uv_layers.new(name="UVMap")
    # The six faces lie beside one another.
    for number, polygon in enumerate(block.data.polygons):
        for corner, loop in enumerate(polygon.loop_indices):
            u, v = ((0, 0), (1, 0), (1, 1), (0, 1))[corner]
            block.data.uv_layers[0].data[loop].uv = ((number % 3 + 0.9 * u + 0.05) / 3, (number // 3 + 0.9 * v + 0.05) / 2)
    _choose(block)
    scene.lancer.quality, scene.lancer.target_error, scene.lancer.clamp_indirect = "CUSTOM", 0.0, 0.0
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.max_bounces = scene.lancer.max_bounces = 2
    for kind in ("diffuse", "glossy", "transmission"):
        setattr(cycles, f"{kind}_bounces", 2)
    return scene, block, material


def _choose(*things):
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
    bpy.context.view_layer.objects.active = things[-1]


def _pixels(image):
    pixels = np.empty(4 * len(image.pixels) // 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], image.size[0], 4)


def _bake(scene, image, engine, kind, samples, **options):
    scene.render.engine = engine
    scene.lancer.samples = scene.cycles.samples = samples
    image.pixels.foreach_set(np.zeros(len(image.pixels), np.float32))
    if kind == "NORMAL":
        options["normal_space"] = "OBJECT"
    bpy.ops.object.bake(type=kind, margin=0, **options)
    return _pixels(image)


def _blocks(picture, side=8):
    height, width, channels = picture.shape
    return picture.reshape(height // side, side, width // side, side, channels).mean(axis=(1, 3))


def _apart(ours, theirs):
    """Return the largest difference of block means, relative to the block's level or the picture's, if that is higher."""
    ours, theirs = _blocks(ours[..., :3]), _blocks(theirs[..., :3])
    level = max(float(np.abs(theirs).mean()), 1e-3)
    return float((np.abs(ours - theirs).max(axis=-1) / np.maximum(np.abs(theirs).mean(axis=-1), level)).max())


def alike():
    """Return for each type the largest difference of block means, the number of texels of other alpha, and the level."""
    scene, _, material = _room()
    image = _image(material)
    found = {}
    # The shadows of Cycles 3 are black.
    for kind in (*_PLAIN, *_LIT, *(("SHADOW",) if bpy.app.version >= (4, 0) else ())):
        # The pass of positions is summed over Cycles' samples.
        samples = 1 if kind == "POSITION" else 256
        ours, theirs = (_bake(scene, image, engine, kind, samples) for engine in ("LANCER", "CYCLES"))
        other_alpha = int((ours[..., 3] != theirs[..., 3]).sum())
        found[kind] = [_apart(ours, theirs), other_alpha, float(np.abs(theirs[..., :3]).mean())]
    return {"types": found}


def filtered():
    """Return the largest difference of the engines' block means for contributions and parts of the light."""
    scene, _, material = _room()
    image, found = _image(material), {}
    for name, kind, filters in (
        ("direct", "DIFFUSE", {"DIRECT", "COLOR"}),
        ("indirect", "DIFFUSE", {"INDIRECT", "COLOR"}),
        ("color", "DIFFUSE", {"COLOR"}),
        ("light", "DIFFUSE", {"DIRECT", "INDIRECT"}),
        ("no gloss", "COMBINED", {"DIRECT", "INDIRECT", "DIFFUSE", "EMIT"}),
    ):
        found[name] = _apart(*(_bake(scene, image, engine, kind, 256, pass_filter=filters) for engine in ("LANCER", "CYCLES")))
    return {"parts": found}


def targets():
    """Return what reaches a colour attribute, a second object by rays, and an image of a scene without a camera."""
    scene, block, material = _room()
    image = _image(material)
    flat = float(_bake(scene, image, "LANCER", "COMBINED", 16)[..., :3].mean())
    camera = scene.camera
    # A bake is none of a render's jobs, also after one.
    bpy.ops.render.render()
    scene.camera = None
    bare = float(_bake(scene, image, "LANCER", "COMBINED", 16)[..., :3].mean())
    scene.camera = camera
    copy = parts.place(scene, "Copy", block.data.copy(), None, block.location, rotation=block.rotation_euler)
    copy.scale = (1.02, 1.02, 1.02)
    copy.hide_render = False
    _choose(block, copy)
    onto = _bake(scene, image, "LANCER", "EMIT", 4, use_selected_to_active=True, cage_extrusion=0.2)
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0, 1, 0, 1)
    colors = _bake(scene, image, "LANCER", "DIFFUSE", 4, use_selected_to_active=True, cage_extrusion=0.2, pass_filter={"COLOR"})
    bpy.data.objects.remove(copy)
    _choose(block)
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
    scene, block, material = _room()
    image = _image(material)
    errors = {}

    def attempt(name, kind):
        try:
            _bake(scene, image, "LANCER", kind, 4)
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
    scene, block, material = _room()
    image = _image(material)
    modifier = block.modifiers.new("Divide", "SUBSURF")
    modifier.levels = modifier.render_levels = 1
    subdivisions.dice(scene, block, modifier, 1.0)
    ours, theirs = (_bake(scene, image, engine, "POSITION", 1) for engine in ("LANCER", "CYCLES"))
    return {"apart": float(np.abs(ours - theirs).max()), "level": float(np.abs(theirs[..., :3]).max())}


def beside_the_frame():
    """Return the messages of bakes with a shutter that opens around the frame, and at the frame."""
    scene, _, material = _room()
    image, told = _image(material), {}
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
    for position in ("CENTER", "START"):
        owner.motion_blur_position = position
        _bake(scene, image, "LANCER", "EMIT", 1)
        told[position] = list(last_messages.get(scene.name, ()))
    return told


def unannounced():
    """Return the level of a picture that is rendered without Lancer's handlers, which a script has removed."""
    scene, _, _ = _room()
    scene.lancer.samples = 4
    bpy.app.handlers.render_init.clear()
    return {"level": float(stage.picture(scene)[..., :3].mean())}


def same():
    """Return whether a bake has the same bits for one thread and for two, and ends by its target error."""
    scene, _, material = _room()
    image = _image(material)
    pictures = []
    for threads in (1, 2):
        scene.render.threads_mode, scene.render.threads = "FIXED", threads
        pictures.append(_bake(scene, image, "LANCER", "COMBINED", 16).tobytes())
    scene.lancer.target_error = 0.2
    _bake(scene, image, "LANCER", "COMBINED", 4096)
    return {"same": pictures[0] == pictures[1]}
