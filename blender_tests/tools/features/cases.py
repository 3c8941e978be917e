"""One feature at a time in a minimal scene: used, and only compiled in.

The minimal scene is a diffuse ball on a diffuse floor under a point lamp, with a small diffuse square behind the camera that
rays rarely hit. The ball, the lamp, the sky or the camera uses a feature; it is only compiled in if the square alone has it, or
a second lamp below the floor, or a sky that is hidden from all rays: the scene then needs the code, but no path runs it.
"""

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import tiny_scenes as tiny
import trimesh

from addon.bindings.enums import (
    Coordinate,
    Distribution,
    Features,
    InstanceFlag,
    InstanceKind,
    LightKind,
    LobeKind,
    NodeKind,
    Pass,
    PixelFilter,
    Ray,
    Shading,
)
from addon.bindings.shading import Image, Lobe, Material, Node, NodeRef, Portal, Principled, World
from addon.bindings.snapshot import Camera, Instance, InstanceTable, Light, MeshData

from .grown import sixty

BALL, FLOOR, SQUARE = range(3)
SIZE = 96


@dataclass(frozen=True)
class Case:
    name: str
    used: Callable | None  # snapshot -> snapshot
    idle: Callable | None = None  # the same with the feature only compiled in
    idle_base: Callable | None = None  # the scene that idle is compared with, if not the minimal scene
    in_classic: str = ""  # why it is not idle in CLASSIC


def minimal(**settings):
    ball = trimesh.creation.uv_sphere(radius=1.0, count=(32, 32))
    uvs = np.stack([ball.vertices[:, 0], ball.vertices[:, 2]], axis=1)[ball.faces] * 0.5 + 0.5
    meshes = (
        MeshData("ball", ball.vertices, ball.faces, uvs=uvs),
        tiny.quad(12.0, "floor"),
        _with_uvs(tiny.quad(2.0, "square")),
    )
    matt = [dataclasses.replace(tiny.lambert(0.7), name=name) for name in ("ball", "floor", "square")]
    behind = tiny.move(0, -9, 3) @ tiny.rotate_x(math.pi / 2) @ tiny.scale(0.1)
    places = {"ball": tiny.move(z=1.0), "floor": np.eye(4), "square": behind}
    instances = [Instance(mesh=i, matrix=places[m.name], materials=(i,), name=m.name) for i, m in enumerate(matt)]
    camera = Camera(
        tiny.look_at((0, -6, 3), (0, 0, 0.9)), width=SIZE, height=SIZE, window=(-0.35, 0.35, -0.35, 0.35), focal_distance=6.0
    )
    lamp = Light("lamp", tiny.move(3, -3, 5), LightKind.POINT, emission=(60, 60, 60))
    return tiny.scene(instances, matt, [lamp], meshes, camera=camera, **{"max_bounces": 8, **settings})


def _with_uvs(mesh):
    return dataclasses.replace(mesh, uvs=mesh.positions[mesh.triangles][..., :2])


# ---- changes of the scene ----


def _on(number, material):
    def change(snapshot):
        materials = list(snapshot.materials)
        materials[number] = dataclasses.replace(material, name=materials[number].name)
        return dataclasses.replace(snapshot, materials=tuple(materials), images=(checks(),) if material.nodes else ())

    return change


def _surface(name, material):
    return Case(name, _on(BALL, material), _on(SQUARE, material))


def _with_levels(name, material):
    """Return the case of a material whose picture has levels, of which a ray reads one."""

    def on(number):
        def change(snapshot):
            texels = np.tile(checks().texels, (4, 4, 1))
            return dataclasses.replace(_on(number, material)(snapshot), images=(Image("checks", texels, mipmaps=1),))

        return change

    return Case(name, on(BALL), on(SQUARE))


def _objects(name, **columns):
    """Return the case of instances with other values in columns of their table."""

    def on(number):
        def change(snapshot):
            table = snapshot.instances
            changed = {}
            for column, value in columns.items():
                changed[column] = getattr(table, column).copy()
                changed[column][number] = value
            return dataclasses.replace(snapshot, instances=dataclasses.replace(table, **changed))

        return change

    return Case(name, on(BALL), on(SQUARE))


_WHITE = (1.0, 1.0, 1.0)
_ASKED = "every lamp is asked at every hit"


def _glowing(name, material):
    """Return the case of an emissive material: below the floor it lights nothing, and is compared with a lamp there."""

    def below(snapshot):
        matrices = snapshot.instances.matrices.copy()
        matrices[SQUARE, :, 3] = 0, 0, -5
        return dataclasses.replace(snapshot, instances=dataclasses.replace(snapshot.instances, matrices=matrices))

    def with_lamp(snapshot):
        lamp = Light("second", tiny.move(0, 0, -5), LightKind.POINT, emission=(1, 1, 1))
        return dataclasses.replace(below(snapshot), lights=(*snapshot.lights, lamp))

    return Case(name, _on(BALL, material), lambda s: _on(SQUARE, material)(below(s)), with_lamp, _ASKED)


def _lamp(name, **fields):
    light = {"matrix": tiny.move(3, -3, 5) @ tiny.rotate_y(0.5) @ tiny.rotate_x(-0.5), "emission": (60, 60, 60), **fields}

    def used(snapshot):
        return dataclasses.replace(snapshot, lights=(Light("lamp", **light),))

    def second(lamp):
        # Below the floor, emitting away from it; a sun, which has no place, from below.
        turn = tiny.rotate_x(math.pi if lamp.kind == LightKind.SUN else 0.0)
        below = dataclasses.replace(lamp, name="second", matrix=tiny.move(0, 0, -5) @ turn)
        return lambda snapshot: dataclasses.replace(snapshot, lights=(*snapshot.lights, below))

    plain = second(Light(kind=LightKind.POINT, emission=light["emission"]))
    return Case(name, used, second(Light(**light)), plain, _ASKED)


def _sky(name, world, hidden=True):
    everyone = int(Ray.CAMERA | Ray.DIFFUSE | Ray.GLOSSY | Ray.TRANSMISSION)

    def change(**fields):
        return lambda s: dataclasses.replace(s, world=dataclasses.replace(world, **fields), images=(checks(),))

    return Case(name, change(), change(hidden_from=everyone) if hidden else None)


def _opened(snapshot):
    window = Light("window", tiny.move(z=5), LightKind.AREA, size=(4, 4), emission=(0, 0, 0), opening=True)
    return dataclasses.replace(snapshot, world=World(radiance=(0.5, 0.6, 0.7)), lights=(*snapshot.lights, window))


def _filtered(snapshot):
    return tiny.with_settings(_on(BALL, _lobe(LobeKind.GLOSSY, roughness=0.1))(snapshot), filter_glossy=1.0)


def _camera(name, **fields):
    return Case(name, lambda s: dataclasses.replace(s, camera=dataclasses.replace(s.camera, **fields)))


def _settings(name, **fields):
    return Case(name, lambda s: tiny.with_settings(s, **fields))


def _copies(snapshot, meshes):
    """Add a second square behind the first."""
    table = snapshot.instances
    order = [BALL, FLOOR, SQUARE, SQUARE]
    matrices = table.matrices[order].copy()
    matrices[-1, 1, 3] -= 0.1
    columns = ("kinds", "first_slots", "slot_counts", "object_indices", "shadings", "name_indices", "hidden_from", "flags")
    values = {name: getattr(table, name)[order] for name in (*columns, "terminators")}
    changed = InstanceTable(matrices=matrices, meshes=meshes, names=table.names, slots=table.slots, **values)
    return dataclasses.replace(snapshot, instances=changed, meshes=(*snapshot.meshes, snapshot.meshes[SQUARE]))


def checks():
    """Return a picture of squares with rows that are cut out."""
    texels = np.zeros((64, 64, 4), np.uint8)
    texels[...] = np.where((np.indices((64, 64)).sum(axis=0) // 8 % 2)[..., None], (200, 180, 40, 255), (60, 90, 200, 255))
    texels[::3, :, 3] = 0
    return Image("checks", texels)


# ---- materials ----

_UV = Node(NodeKind.COORDINATE, option=Coordinate.UV)
_PICTURE = Node(NodeKind.IMAGE, inputs=(NodeRef(0),), image_count=1)
_NORMAL = Node(NodeKind.COORDINATE, option=Coordinate.SHADING_NORMAL)


def _lobe(kind, **fields):
    return Material(lobes=(Lobe(kind, **fields),))


def _principled(**fields):
    return Material(lobes=(Lobe(LobeKind.PRINCIPLED, color=(1, 1, 1), principled=Principled(**fields)),))


def _nodes(nodes, **lobe):
    return Material(lobes=(Lobe(LobeKind.LAMBERT, **lobe),), nodes=nodes)


_CUT = Material(
    lobes=(Lobe(LobeKind.LAMBERT, color=NodeRef(1), weight=NodeRef(2)),),
    transmittance=NodeRef(3),
    nodes=(
        _UV,
        _PICTURE,
        Node(NodeKind.ALPHA, inputs=(NodeRef(1),)),
        Node(NodeKind.MATH, inputs=(1.0, NodeRef(2)), option=1),
    ),
)
_BUMP = _nodes(
    (_UV, _PICTURE, _NORMAL, Node(NodeKind.BUMP, inputs=(1.0, 0.05, NodeRef(1), NodeRef(2), 1.0), first=0)), normal=NodeRef(3)
)


def _looking(kind, inputs, parameter, option):
    """Return a matt material of which a node that sends rays gives a parameter."""
    place = Node(NodeKind.COORDINATE, option=Coordinate.POSITION)
    return _nodes((place, Node(kind, option=option, inputs=inputs)), **{parameter: NodeRef(1)})


def grown(folded=False):
    nodes = sixty(folded)
    return _nodes(nodes, color=NodeRef(len(nodes) - 1))


_SKY_NODES = (Node(NodeKind.COORDINATE), Node(NodeKind.ENVIRONMENT, inputs=(NodeRef(0),), image_count=1))

CASES = (
    Case(
        "every feature compiled in",
        None,
        lambda s: tiny.with_settings(s, features=Features.ALL),
        in_classic="the plain code, which its lanes are compared with",
    ),
    _surface("rough matt (Oren-Nayar)", _lobe(LobeKind.DIFFUSE, roughness=0.6, option=1)),
    _surface("mirror", _lobe(LobeKind.MIRROR)),
    _surface("rough metal", _lobe(LobeKind.GLOSSY, roughness=0.4)),
    _surface("rough metal, light between facets", _lobe(LobeKind.GLOSSY, roughness=0.4, distribution=Distribution.MULTI_GGX)),
    _surface("metal by F82", _lobe(LobeKind.CONDUCTOR, roughness=0.4)),
    _surface("stretched highlight", _lobe(LobeKind.GLOSSY, roughness=0.4, anisotropy=0.7)),
    _surface("Beckmann facets", _lobe(LobeKind.BECKMANN, roughness=0.2)),
    _surface("Phong", _lobe(LobeKind.PHONG)),
    _surface("Blinn-Phong", _lobe(LobeKind.BLINN_PHONG)),
    _surface("Minnaert", _lobe(LobeKind.MINNAERT, shininess=1.5)),
    _surface("smooth glass", _lobe(LobeKind.DIELECTRIC)),
    _surface("rough glass", _lobe(LobeKind.GLASS, roughness=0.4)),
    _surface("refraction alone", _lobe(LobeKind.REFRACTION, roughness=0.2)),
    _surface("cloth (sheen)", _lobe(LobeKind.SHEEN)),
    _surface("translucency", _lobe(LobeKind.TRANSLUCENT)),
    _surface("toon", _lobe(LobeKind.TOON, roughness=0.4, roughness_across=0.3)),
    _surface("rough glass with a thin film", _lobe(LobeKind.GLASS, roughness=0.4, film_thickness=400.0)),
    _surface("portal", Material(lobes=(), transmittance=_WHITE, portals=(Portal(weight=_WHITE, direction=(0, 1, 1)),))),
    _surface("Principled plastic", _principled()),
    _surface("Principled with clear coat", _principled(coat=1.0)),
    _surface("Principled glass", _principled(transmission=1.0, roughness=0.1)),
    _surface("Principled, all layers", _principled(coat=1.0, sheen=0.5, metallic=0.5, transmission=0.5, anisotropic=0.5)),
    _surface("half transparent", tiny.veiled(tiny.lambert(0.7), 0.5)),
    _surface("cut out by a picture", _CUT),
    _surface("picture as colour", _nodes((_UV, _PICTURE), color=NodeRef(1))),
    _with_levels("picture with levels", _nodes((_UV, _PICTURE), color=NodeRef(1))),
    _surface("bump of a picture", _BUMP),
    _surface(
        "colour by nodes (layer weight)",
        _nodes((_NORMAL, Node(NodeKind.LAYER_WEIGHT, inputs=(0.5, NodeRef(0)), option=1)), color=NodeRef(1)),
    ),
    _surface("colour by ambient occlusion", _looking(NodeKind.OCCLUSION, (1.0,), "color", 16)),
    _surface("normal by a bevel", _looking(NodeKind.BEVEL, (0.05,), "normal", 4)),
    _surface("colour by a raycast", _looking(NodeKind.RAYCAST, (NodeRef(0), (0.0, 0.0, 1.0), 5.0), "color", 0)),
    _surface("60 nodes that the core evaluates", grown()),
    _surface("60 nodes, of which the export leaves 7", grown(folded=True)),
    _glowing("glowing mesh", Material(lobes=(), emission=(5, 5, 5))),
    _surface("hole in the picture by material", Material(lobes=(), holdout=1.0)),
    _surface("displacement", Material(displacement=(0.0, 0.0, 0.1), lobes=tiny.lambert(0.7).lobes)),
    _objects("smooth normals", shadings=int(Shading.PHONG)),
    _objects("exact sphere", kinds=int(InstanceKind.SPHERE)),
    _objects("exact cylinder", kinds=int(InstanceKind.CYLINDER)),
    _objects("exact cone", kinds=int(InstanceKind.CONE)),
    _objects("hidden from bounced light", hidden_from=int(Ray.DIFFUSE)),
    _objects("hole in the picture", flags=int(InstanceFlag.HOLDOUT)),
    Case("copies of a mesh", None, lambda s: _copies(s, [0, 1, 2, 2]), lambda s: _copies(s, [0, 1, 2, 3])),
    _lamp("point lamp with extent", kind=LightKind.POINT, radius=0.5),
    _lamp("spot lamp", kind=LightKind.SPOT, spot_angle=1.2),
    _lamp("sun with extent", kind=LightKind.SUN, emission=(2, 2, 2), sun_angle=0.05),
    _lamp("area lamp", kind=LightKind.AREA),
    _sky("even sky", World(radiance=(0.5, 0.6, 0.7))),
    Case("portal under an even sky", _opened),
    _sky("pictured sky", World(radiance=NodeRef(1), nodes=_SKY_NODES)),
    _camera("depth of field", lens_radius=0.1),
    _settings("filter over several pixels", pixel_filter=PixelFilter.BLACKMAN_HARRIS, filter_width=3.0),
    _settings("clamped indirect light", clamp_indirect=10.0),
    Case("gloss that is filtered behind matt surfaces", _filtered),
    _settings("Fast GI", fast_bounces=1, fast_distance=1.0),
    _settings("pass: depth", passes=(Pass.COMBINED, Pass.DEPTH)),
    _settings("passes: light by component", passes=(Pass.COMBINED, Pass.DIFFUSE_DIRECT, Pass.DIFFUSE_INDIRECT)),
    _settings("passes: all", passes=tuple(Pass)),
)
