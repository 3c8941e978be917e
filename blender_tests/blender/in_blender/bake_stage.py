"""A room with a block to bake, by either engine, and the difference of two bakes."""

import bpy
import numpy as np
import stage

from scenes import parts

SIZE = 32


def image(material, name="Baked", **options):
    """Return a new image that bakes of the material reach."""
    made = bpy.data.images.new(name, SIZE, SIZE, float_buffer=True, **options)
    made.colorspace_settings.name = "Non-Color"
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = made
    tree.nodes.active = node
    return made


def room():
    """Return the scene, and a textured block between a floor, a lamp and a sky, and its material."""
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
    choose(block)
    scene.lancer.quality, scene.lancer.target_error, scene.lancer.clamp_indirect = "CUSTOM", 0.0, 0.0
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    bounces(scene, 2)
    return scene, block, material


def bounces(scene, count):
    cycles = scene.cycles
    cycles.max_bounces = scene.lancer.max_bounces = count
    for kind in ("diffuse", "glossy", "transmission"):
        setattr(cycles, f"{kind}_bounces", count)


def choose(*things):
    """Select these objects; the last is the active one."""
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
    bpy.context.view_layer.objects.active = things[-1]


def pixels(picture):
    values = np.empty(len(picture.pixels), np.float32)
    picture.pixels.foreach_get(values)
    return values.reshape(picture.size[1], picture.size[0], 4)


def fill(picture, value=0.0):
    picture.pixels.foreach_set(np.full(len(picture.pixels), value, np.float32))


def run(scene, engine, kind, samples, **options):
    scene.render.engine = engine
    scene.lancer.samples = scene.cycles.samples = samples
    if kind == "NORMAL":
        options.setdefault("normal_space", "OBJECT")
    bpy.ops.object.bake(type=kind, **{"margin": 0, **options})


def bake(scene, picture, engine, kind, samples, **options):
    """Return the pixels of a bake into an image that was black."""
    fill(picture)
    run(scene, engine, kind, samples, **options)
    return pixels(picture)


def by_both(made):
    """Return what made(engine) returns for either engine, Lancer's first."""
    return tuple(made(engine) for engine in ("LANCER", "CYCLES"))


def in_blocks(picture, side=8):
    """Return the pixels of each block, (blocks, pixels, channels)."""
    height, width, channels = picture.shape
    tiled = picture.reshape(height // side, side, width // side, side, channels).swapaxes(1, 2)
    return tiled.reshape(-1, side * side, channels).astype(float)


def _levels(theirs):
    """Return the mean level of each block, or of the picture, if that is higher."""
    means = np.abs(theirs).mean(axis=(1, 2))
    return np.maximum(means, max(means.mean(), 1e-3))


def apart(ours, theirs):
    """Return the largest difference of block means, relative to the level."""
    ours, theirs = (in_blocks(picture[..., :3]) for picture in (ours, theirs))
    return float((np.abs((ours - theirs).mean(axis=1)).max(axis=-1) / _levels(theirs)).max())


def compared(ours, theirs):
    """Return how far two bakes are apart, relative to the level.

    bias: the largest difference of block means beyond five of its standard errors, which the spread of the differences of the
    block's pixels tells; noise: the mean standard error; other alpha: the number of pixels whose alpha differs; level: of all.
    """
    # Bytes are rounded to 1/255.
    other_alpha = int((np.abs(ours[..., 3] - theirs[..., 3]) > 0.004).sum())
    ours, theirs = (in_blocks(picture[..., :3]) for picture in (ours, theirs))
    between, levels = ours - theirs, _levels(theirs)[:, None]
    errors = between.std(axis=1, ddof=1) / np.sqrt(between.shape[1])
    return {
        "bias": float(((np.abs(between.mean(axis=1)) - 5.0 * errors) / levels).max()),
        "noise": float((errors / levels).mean()),
        "other alpha": other_alpha,
        "level": float(np.abs(theirs).mean()),
    }
