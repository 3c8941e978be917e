"""Images on surfaces: colours, any parameter of the BSDF, environments, bumps, normals and displacement."""

import dataclasses
import math

import numpy as np
import tiny_scenes
from tiny_scenes import lambert, plane, rgb, sphere

from addon.bindings.abi import Integrator, LobeKind
from addon.bindings.enums import Coordinate, Environment, Extension, Interpolation, NodeKind
from addon.bindings.session import Scene
from addon.bindings.snapshot import Image, Instance, Lobe, Material, MeshAttribute, MeshData, Node, NodeRef, World
from addon.export.course_models import MODELS, PARAMETERS, parameters_of
from addon.operators.course_groups import group_of
from scenes import parts, pictures

from . import studio
from .chapter import Figure, Picture, worst
from .lighting import Lit, light_of
from .studio import classic, lamp

_UV = Node(NodeKind.COORDINATE, Coordinate.UV)
_CLOSEST = int(Extension.REPEAT) | int(Interpolation.CLOSEST) << 4
_SQUARE = MeshData(
    "square",
    [(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)],
    [(0, 1, 2), (0, 2, 3)],
    uvs=np.float32([[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]]),
)


def _picture_node(**fields):
    return Node(NodeKind.IMAGE, image_count=1, flags=_CLOSEST, inputs=(NodeRef(0),), **fields)


def _square(material, texels, camera=None, **settings):
    """Returns the square -2 ... 2 under a lamp; node 1 of its material reads the image."""
    shot = classic([Instance()], [material], [lamp()], [_SQUARE], camera=camera, max_bounces=0, **settings)
    return dataclasses.replace(shot, images=(Image("texels", np.float32(texels)),))


def _texels_seen(shot, size):
    """Returns row and column of the texel in each pixel's middle, and the pixels on the square."""
    points, _ = studio.seen_on_plane(shot)
    on = np.all(np.abs(points[..., :2]) < 2.0, axis=-1)
    column, row = (np.clip(((points[..., k] + 2) / 4 * size).astype(int), 0, size - 1) for k in (0, 1))
    return row, column, on


def images(quick):
    size, rng = 8, np.random.default_rng(5)
    texels = rng.uniform(0.1, 1.0, (size, size, 3)).astype(np.float32)
    glow = Material("glow", lobes=(), emission=NodeRef(1), nodes=(_UV, _picture_node()))
    figures, shown = [], []
    views = {"without": studio.parallel((0, -3, 4), pixels=96), "with": studio.perspective((0, -4, 1.2), (0, 0, 0), 96)}
    for name, camera in views.items():
        shot = _square(glow, texels, camera)
        row, column, on = _texels_seen(shot, size)
        picture = studio.render(shot)[..., :3]
        wrong = np.sum(np.any(picture[on] != texels[row[on], column[on]], axis=-1))
        what = f"a slanted square {name} perspective: pixels of {int(on.sum())} that do not show the texel of their point"
        figures.append(Figure.near(what, int(wrong), 0, 0, "u and v are computed at the hit, so the perspective is correct"))
        shown.append(Picture(name, f"An 8 x 8 picture, {name} perspective", picture))
    return tuple(figures), tuple(shown)


# Two values for each parameter of the lobes, side by side in an image.
_HALVES = {
    "color": ((0.75, 0.5, 0.25), (0.125, 0.25, 0.5)),
    "roughness": (0.25, 0.5),
    "ior": (1.25, 2.0),
    "shininess": (2.0, 40.0),
}
_PARAMETERS = {
    LobeKind.LAMBERT: ("color",),
    LobeKind.BECKMANN: ("color", "roughness", "ior"),
    LobeKind.PHONG: ("color", "shininess"),
    LobeKind.BLINN_PHONG: ("color", "shininess"),
    LobeKind.MINNAERT: ("color", "shininess"),
}


def parameters(quick):
    figures = [_modulated(kind, name) for kind, names in _PARAMETERS.items() for name in names]
    for model in MODELS:
        differ = 0
        for integrator in (Integrator.PATH, Integrator.CLASSIC):
            differ += int(np.sum(_shown(model, False, integrator) != _shown(model, True, integrator)))
        what = f"node group {model}: values of pictures that differ from the material's own settings, both integrators"
        figures.append(Figure.near(what, differ, 0, 0, "both use the same code from there on"))
    caption = "Phong's node group: pictures as Kd, as Ks and as the exponent"
    return figures, [Picture("group", caption, _painted())]


def _modulated(kind, name):
    """Returns the error of an image of two values in one parameter of a lobe, against the formula for each half."""
    others = {} if name == "color" or "shininess" not in _PARAMETERS[kind] else {"color": (0.8, 0.8, 0.8)}
    lobe = Lobe(kind, **{**others, name: NodeRef(1)})
    material = Material("textured", (lobe,), nodes=(_UV, _picture_node()))
    shot = _square(material, [[rgb(value) for value in _HALVES[name]]])
    _, column, on = _texels_seen(shot, 2)
    lit = Lit(shot)
    halves = [light_of(kind, lit, **{**others, name: value}) for value in _HALVES[name]]
    want = np.where(column[..., None] == 0, *halves) * on[..., None]
    what = f"{LobeKind(kind).name.capitalize().replace('_', '-')}, {name}: largest relative deviation of 256 pixels"
    why = "as with constants: up to 40 times the rounding of a cosine"
    return Figure.at_most(what, worst(studio.render(shot)[..., :3], want), 2e-5, why)


def _shown(model, grouped, integrator):
    """Returns a ball with a model in Blender, by the material's settings or by the node group, with the same numbers."""
    values = {"kd": (0.5, 0.25, 0.125), "ks": (0.75, 0.5, 0.25), "ka": (0.25, 0.125, 0.0)}
    values |= {"roughness": 0.3, "ior": 1.75, "shininess": 30.0, "darkness": 1.75}

    def prepare(scene):
        material = scene.objects["Red"].material_slots[0].material
        own = material.lancer
        own.model = "NODES" if grouped else model
        own.ka = (0.0, 0.0, 0.0) if grouped else values["ka"]
        if not grouped:
            for name in parameters_of(model):
                setattr(own, name, values[name])
            return
        node = _group_node(material, model)
        for name in parameters_of(model):
            value = values[name]
            node.inputs[PARAMETERS[name].socket].default_value = (*value, 1.0) if isinstance(value, tuple) else value

    shot = studio.from_blender("lab", 64, 48, prepare)
    return studio.render(shot, integrator=integrator, samples=4)


def _group_node(material, model):
    tree = parts.enable_nodes(material)
    node, output = tree.nodes.new("ShaderNodeGroup"), tree.nodes.new("ShaderNodeOutputMaterial")
    node.node_tree = group_of(model)
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])
    return node


def _painted():
    def prepare(scene):
        for name in ("Red", "Gold"):
            material = scene.objects[name].material_slots[0].material
            material.lancer.model = "NODES"
            node = _group_node(material, "PHONG")
            tree = material.node_tree
            place = tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"]
            for socket, image in (
                ("Diffuse", pictures.cloth()),
                ("Specular", _stripes(0.0, 1.0)),
                ("Shininess", _stripes(5.0, 200.0)),
            ):
                texture = tree.nodes.new("ShaderNodeTexImage")
                texture.image, texture.projection = image, "SPHERE"
                tree.links.new(place, texture.inputs["Vector"])
                tree.links.new(texture.outputs["Color"], node.inputs[socket])

    return studio.render(studio.from_blender("lab", 320, 240, prepare), samples=16)


def _stripes(low, high):
    pixels = np.ones((1, 16, 4))
    pixels[..., :3] = np.where(np.arange(16) % 2, low, high)[:, None]
    return pictures.make_image(f"Stripes {low:g} {high:g}", pixels, linear=True)


def environment(quick):
    count = 10_000 if quick else 100_000
    rng = np.random.default_rng(6)
    directions = rng.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    with Scene.upload(_cube_world(classic([plane()], [lambert()]))) as scene:
        radiance, _ = scene.world(directions)
    axis = np.argmax(np.abs(directions), axis=1)
    side = 2 * axis + (directions[np.arange(count), axis] < 0.0)
    wrong = int(np.sum(radiance[:, 0] != side + 1))
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=rgb(1.0)),))
    camera = studio.perspective((0, -5, 1), (0, 0, 0), 200, 0.25)
    seen = studio.render(_cube_world(classic([sphere()], [mirror], camera=camera, samples=16), colors=True))
    return (
        Figure.near(f"directions of {count} that show another side than their longest component's", wrong, 0, 0, "six sides"),
    ), (Picture("ball", "A mirror within six colours", seen),)


def _cube_world(shot, colors=False):
    palette = np.float32([(0.9, 0.2, 0.2), (0.2, 0.8, 0.8), (0.2, 0.8, 0.2), (0.8, 0.2, 0.8), (0.3, 0.4, 1.0), (0.9, 0.9, 0.2)])
    texels = [palette[i] if colors else rgb(i + 1.0) for i in range(6)]
    sides = tuple(Image(f"side {i}", np.float32(texel).reshape(1, 1, 3)) for i, texel in enumerate(texels))
    direction = Node(NodeKind.COORDINATE, Coordinate.GENERATED)
    cube = Node(NodeKind.ENVIRONMENT, Environment.CUBE, image_count=6, inputs=(NodeRef(0),))
    return dataclasses.replace(shot, images=sides, world=World(NodeRef(1), nodes=(direction, cube)))


def relief(quick):
    figures = [_normal_map(), _bump(), *_displaced()]
    shown = [
        Picture(name, caption, _hills(name)) for name, caption in (("flat", "A plane"), ("bump", "The same with a bump map"))
    ]
    return tuple(figures), tuple(shown)


def _lit_by(normal):
    """Returns Lambert's law about another normal, for albedo 1 on the square."""
    return lambda s: np.maximum(np.sum(s.l * normal, axis=-1, keepdims=True), 0.0) * s.lc / math.pi


def _turned(nodes, node, normal, texels=(((0.5, 0.5, 0.5),),)):
    material = Material("turned", (Lobe(color=(1, 1, 1), normal=NodeRef(node)),), nodes=nodes)
    shot = _square(material, texels, studio.parallel(width=2.0))
    want = _lit_by(normal)(Lit(shot))
    return worst(studio.render(shot)[..., :3], np.broadcast_to(want, (16, 16, 3)))


def _normal_map():
    normal = np.array((0.28, 0.0, 0.96))
    color = tuple(0.5 * normal + 0.5)
    nodes = (_UV, _picture_node(), Node(NodeKind.NORMAL_MAP, 2, inputs=(1.0, NodeRef(1))))
    error = _turned(nodes, 2, normal, [[color]])
    what = "normal map of one turned normal: largest relative deviation from Kd/π (l·n') lc"
    return Figure.at_most(what, error, 1e-5, "a normalised normal in single precision")


def _bump():
    """A height that grows by 1/4 per unit along x: n' = (-1/4, 0, 1) / |...|."""
    normal = np.array((-0.25, 0.0, 1.0)) / math.hypot(0.25, 1.0)
    position = Node(NodeKind.COORDINATE, Coordinate.POSITION)
    height = Node(NodeKind.SEPARATE, 0, inputs=(NodeRef(0),))
    bump = Node(NodeKind.BUMP, inputs=(1.0, 0.25, NodeRef(1), (0.0, 0.0, 0.0), 0.1))
    error = _turned((position, height, bump), 2, normal)
    what = "bump of a slope of 1/4: largest relative deviation from Kd/π (l·n') lc"
    return Figure.at_most(
        what, error, 1e-4, "a height's rounding of 6e-8 over a tenth of a pixel, 1/80 of a unit, is 2e-5 of the slope"
    )


def _displaced():
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], np.float32)
    height = MeshAttribute("height", np.array([[0.0], [1.0], [1.0], [0.0]], np.float32), 0)
    mesh = MeshData("square", corners, [(0, 1, 2), (0, 2, 3)], normals=[(0, 0, 1)] * 4, attributes=(height,))
    nodes = (
        Node(NodeKind.ATTRIBUTE, name="height"),
        Node(NodeKind.DISPLACEMENT, inputs=(NodeRef(0), 0.5, 2.0, (0.0, 0.0, 0.0))),
    )
    material = Material("lifted", (Lobe(),), nodes=nodes, displacement=NodeRef(1))
    x = np.linspace(0.05, 0.95, 19)
    with Scene.upload(tiny_scenes.scene([Instance()], [material], meshes=[mesh])) as scene:
        hits = scene.intersect(np.stack([x, 0.5 + 0 * x, 50 + 0 * x], axis=1), (0, 0, -1))
    error = np.abs(hits.position[:, 2] - 2 * (x - 0.5)).max()
    yield Figure.at_most("displacement: largest deviation of hits from (h - 1/2) 2", error, 1e-6, "single precision")
    slope = np.array([-2.0, 0.0, 1.0]) / math.sqrt(5)
    error = np.abs(hits.normal - slope).max()
    yield Figure.at_most(
        "displacement: largest deviation of normals from those of the new slope", error, 1e-6, "single precision"
    )


def _hills(name):
    y, x = np.mgrid[0:64, 0:64] / 64
    heights = 0.5 + 0.5 * np.sin(2 * math.pi * 3 * x) * np.sin(2 * math.pi * 3 * y)
    picture = Node(NodeKind.IMAGE, image_count=1, flags=int(Interpolation.LINEAR) << 4, inputs=(NodeRef(0),))
    bump = Node(NodeKind.BUMP, inputs=(1.0, 0.3, NodeRef(1), (0.0, 0.0, 0.0), 0.1))
    lobe = Lobe(color=(0.8, 0.6, 0.4), normal=NodeRef(2) if name == "bump" else (0.0, 0.0, 0.0))
    material = Material("hills", (lobe,), nodes=(_UV, picture, bump))
    texels = np.repeat(heights[..., None], 3, axis=2)
    return studio.render(_square(material, texels, studio.perspective((0, -4, 2.5), (0, 0, 0), 200)))


CHAPTERS = (images, parameters, environment, relief)
