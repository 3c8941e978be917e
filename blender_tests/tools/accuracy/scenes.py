"""Small scenes of all kinds, on which error estimates are tested."""

import dataclasses
import math

import numpy as np
import tiny_scenes
from tiny_scenes import beckmann, lambert, look_at, move, plane, quad, rotate_x, rotate_y, scale, sphere

from addon.bindings.enums import AlphaMode, Coordinate, Integrator, LightKind, LobeKind, NodeKind, Pass, PixelFilter
from addon.bindings.shading import Image, Lobe, Material, Node, NodeRef, World
from addon.bindings.snapshot import Camera, Instance, InstanceMotion, Light, Motion, SceneSnapshot
from tools.bench import jobs
from tools.harness.places import BUILD
from tools.harness.terminal import wanted

WIDTH, HEIGHT = 96, 64
MIRROR = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(0.9, 0.85, 0.8)),))
GLASS = Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.5),))


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    build: object  # a function that returns a snapshot
    reference: int  # samples of the reference
    in_blender: bool = False  # the scene is in scenes/, so Cycles can render it, too


def _scene(instances, materials, lights=(), eye=(0, -6, 2.5), target=(0, 0, 0.7), meshes=(), world=0.0, lens=0.0, **settings):
    window = 0.45, 0.45 * HEIGHT / WIDTH
    camera = Camera(
        matrix=look_at(eye, target),
        width=WIDTH,
        height=HEIGHT,
        window=(-window[0], window[0], -window[1], window[1]),
        lens_radius=lens,
        focal_distance=math.dist(eye, target),
    )
    defaults = {"max_bounces": 8, "passes": (Pass.COMBINED,)}
    return tiny_scenes.scene(instances, materials, lights, meshes, world, camera, **{**defaults, **settings})


def _balls(*materials):
    """Return a ball of each material, side by side on a floor."""
    count = len(materials)
    balls = [sphere(i + 1, move(2.2 * (i - (count - 1) / 2), 0, 0.9) @ scale(0.9)) for i in range(count)]
    return [plane(0), *balls], [lambert((0.6, 0.6, 0.55)), *materials]


def _area(power, place=(-2.5, -2.0, 4.0), size=(1.5, 1.5), tilt=-0.5):
    return Light("area", move(*place) @ rotate_y(tilt), LightKind.AREA, emission=(power,) * 3, size=size)


def soft_shadow():
    filtered = {"pixel_filter": PixelFilter.BLACKMAN_HARRIS, "filter_width": 1.5}
    return _scene(*_balls(lambert(0.7), beckmann(0.8, 0.4)), [_area(6.0)], **filtered)


def mirror():
    return _scene(*_balls(MIRROR, lambert((0.7, 0.2, 0.1)), MIRROR), [_area(4.0)], world=(0.2, 0.3, 0.5))


def depth_of_field():
    return _scene(*_balls(beckmann(0.9, 0.15), lambert(0.4), MIRROR), [_area(5.0)], eye=(2.5, -5, 1.5), world=0.1, lens=0.25)


def environment():
    """An image as sky, with a sun of two texels that is a thousand times as bright."""
    texels = np.full((32, 64, 3), 0.3, np.float32)
    texels[16:] = np.linspace((0.5, 0.6, 0.9), (0.15, 0.3, 0.8), 16)[:, None]
    texels[24, 20:22] = 300.0
    shown = Node(kind=NodeKind.ENVIRONMENT, image_count=1, inputs=(NodeRef(0),))
    world = World(radiance=NodeRef(1), nodes=(Node(kind=NodeKind.COORDINATE, option=Coordinate.GENERATED), shown))
    image = Image("sky", texels=texels, alpha=AlphaMode.NONE)
    lit = _scene(*_balls(beckmann(0.9, 0.1), lambert(0.6), GLASS))
    return dataclasses.replace(lit, world=world, images=(image,))


def tiny_lamp():
    """A bright emissive ball that covers a thousandth of the picture, and a point lamp behind a screen."""
    instances, materials = _balls(lambert(0.7), beckmann(0.7, 0.3))
    instances += [
        sphere(3, move(0.5, -1.0, 3.0) @ scale(0.05)),
        Instance(mesh=0, matrix=move(-2.5, 0, 1.5) @ rotate_y(1.2), materials=(4,)),
    ]
    materials += [Material("glow", lobes=(), emission=(900.0, 800.0, 700.0)), lambert(0.5)]
    return _scene(instances, materials, [Light("point", move(-3.5, 0.5, 2.0), emission=(60,) * 3)], meshes=[quad(1.6)])


def half_black():
    """An empty half of the picture, and a lit ball before black in the other."""
    instances = [sphere(0, move(1.6, 0, 0.7) @ scale(1.0))]
    return _scene(instances, [lambert(0.7)], [_area(5.0, (3, -3, 4), (2, 2), 0.4)])


def classic():
    instances, materials = _balls(beckmann(0.8, 0.2), lambert(0.7), GLASS)
    return _scene(instances, materials, [_area(5.0)], integrator=Integrator.CLASSIC, max_bounces=4)


def very_dark():
    """Light of a millionth of the usual power, and its caustics from a mirror ball."""
    dark = 1e-6
    return _scene(*_balls(MIRROR, beckmann(0.6, 0.5)), [_area(3.0 * dark)], world=(0.01 * dark,) * 3)


def high_contrast():
    """A corner in full light beside a corner lit through a slit."""
    walls = [
        plane(0),
        Instance(mesh=0, matrix=move(0, 1.5, 1.5) @ rotate_x(math.pi / 2), materials=(0,)),
        Instance(mesh=0, matrix=move(0.0, 0, 1.5) @ rotate_y(math.pi / 2), materials=(0,)),
        Instance(mesh=0, matrix=move(-1.6, 0, 3.0) @ rotate_x(math.pi), materials=(0,)),
    ]
    lights = [
        Light("strong", move(1.8, -1, 3.0), emission=(900,) * 3, radius=0.3),
        Light("weak", move(-1.5, -1, 1.5), emission=(0.3,) * 3, radius=0.1),
    ]
    return _scene(walls, [lambert(0.75)], lights, meshes=[quad(3.0)], max_bounces=12)


def showroom():
    room = tiny_scenes.showroom(64, passes=(Pass.COMBINED,), max_bounces=8)
    return at_size(room)


def glossy():
    """Highlights of three small lamps on metals from nearly smooth to rough."""
    instances, materials = _balls(*(beckmann((0.9, 0.7, 0.4), alpha, 1.8) for alpha in (0.02, 0.1, 0.4)))
    lights = [Light(f"lamp {x}", move(x, -3, 3), emission=(30,) * 3, radius=0.1) for x in (-2, 0, 2)]
    return _scene(instances, materials, lights, world=0.05)


def veils():
    """Ten transparent cards, one behind another, under a lamp and the sky."""
    instances = [plane(0)]
    for i in range(10):
        instances.append(Instance(mesh=0, matrix=move(0.35 * (i - 5), 0.3 * i, 1.0) @ rotate_x(1.5), materials=(1,)))
    veil = tiny_scenes.veiled(lambert((0.3, 0.6, 0.2)), 0.4)
    settings = {"world": (0.2, 0.25, 0.3), "transparent_bounces": 16}
    return _scene(instances, [lambert(0.6), veil], [_area(5.0)], meshes=[quad(1.8)], **settings)


def glow():
    """A room lit by emissive balls alone."""
    instances, materials = _balls(lambert(0.7), beckmann(0.8, 0.3))
    for x, y, z, radius in ((0, -1, 2.5, 0.3), (-2.6, 0.5, 0.3, 0.3), (2.6, 1, 2.2, 0.6)):
        instances.append(sphere(3, move(x, y, z) @ scale(radius)))
    materials += [Material("glow", lobes=(), emission=(5.0, 4.0, 3.0))]
    return _scene(instances, materials)


def swing():
    """A ball that slides past a card that turns, under a glowing ball that rises, while the shutter is open."""
    instances, materials = _balls(lambert(0.7), beckmann(0.8, 0.3))
    glowing, card = len(instances), len(instances) + 1
    instances += [
        sphere(len(materials), move(0, -1.5, 2.5) @ scale(0.3)),
        Instance(mesh=0, matrix=move(-2.4, 0, 1.2) @ rotate_x(1.5), materials=(1,)),
    ]
    materials.append(Material("glow", lobes=(), emission=(40.0, 36.0, 30.0)))
    snapshot = _scene(instances, materials, meshes=[quad(1.6)], world=0.05)
    keys = {
        1: [move(x, 0, 0.9) @ scale(0.9) for x in (-1.6, -1.1, -0.6)],
        glowing: [move(0, -1.5, z) @ scale(0.3) for z in (2.0, 2.5, 3.0)],
        card: [move(-2.4, 0, 1.2) @ rotate_x(angle) for angle in (0.7, 1.5, 2.3)],
    }
    matrices = np.array([[np.asarray(key, float)[:3] for key in moved] for moved in keys.values()])
    table = dataclasses.replace(snapshot.instances, motions=(InstanceMotion(instances=list(keys), matrices=matrices),))
    return snapshot.replaced(instances=table, motion=Motion(shutter=np.ones(2, np.float32)))


def at_size(snapshot, width=WIDTH, height=HEIGHT):
    """Return the snapshot with another size of picture, and the same view from left to right."""
    camera = snapshot.camera
    left, right, bottom, top = camera.window
    wide, middle = right - left, 0.5 * (bottom + top)
    half = 0.5 * wide * height / width
    size = {"width": width, "height": height, "region_width": width, "region_height": height}
    camera = dataclasses.replace(camera, window=(left, right, middle - half, middle + half), **size)
    return dataclasses.replace(snapshot, camera=camera)


def from_blender(name):
    """Return a function that exports the scene of that name in scenes/."""

    def build():
        path = BUILD / "accuracy" / "scenes" / f"{name}.npz"
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            size = {"width": WIDTH, "height": HEIGHT, "samples": 64}
            jobs.in_blender("snapshot", path=str(path), name=name, threads=1, **size)
        return SceneSnapshot.load(str(path))

    return Scene(name, build, 8192, in_blender=True)


_OWN = (soft_shadow, mirror, depth_of_field, environment, tiny_lamp, half_black, glossy)
_SLOWER = (classic, very_dark, high_contrast, showroom, veils, glow, swing)
SCENES = (
    *(Scene(build.__name__, build, 16384) for build in _OWN),
    *(Scene(build.__name__, build, 8192) for build in _SLOWER),
    *(from_blender(name) for name in ("balls", "room", "glass_metal", "leaves", "lights200", "models", "triangle")),
)

# The scenes of a short run.
_QUICK = "half_black,glossy,room"


def chosen(only="", quick=False):
    """Return the scenes whose names match one of the comma-separated patterns."""
    return [scene for scene in SCENES if wanted(only or (_QUICK if quick else ""), scene.name)]
