"""Ten small scenes that together use every kind of geometry, lamp, lens and texture, at any size and place."""

import dataclasses

import numpy as np
import tiny_scenes
import trimesh
from tiny_scenes import beckmann, lambert, look_at, move, plane, quad, rotate_x, rotate_y, scale, showroom, sphere, veiled

from addon.bindings.abi import CameraKind, Falloff, InstanceKind, Integrator, Pass
from addon.bindings.enums import Coordinate, LightKind, LobeKind, NodeKind
from addon.bindings.snapshot import Camera, Image, Instance, Light, Lobe, Material, MeshData, Node, NodeRef, Principled, World

PIXELS = 24
SMOOTH = MeshData.from_trimesh(trimesh.creation.icosphere(2), "smooth", smooth=True)
# Coordinates in eighths are exact in single precision at all places to which the tests move the mesh.
ROCK = MeshData(
    "rock",
    np.round(8 * trimesh.creation.icosphere(1).vertices * (1 + 0.3 * np.sin(np.arange(42)))[:, None]) / 8,
    trimesh.creation.icosphere(1).faces,
)
GLASS = Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.5),))
MIRROR = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(0.9, 0.8, 0.7)),))
GLOW = Material("glow", lobes=(), emission=(4.0, 3.0, 2.0))


def mesh(number, material, matrix, **fields):
    return Instance(mesh=number, materials=(material,), matrix=matrix, **fields)


def camera(eye, target, window=0.45, **fields):
    return Camera(matrix=look_at(eye, target), width=PIXELS, height=PIXELS, window=(-window, window, -window, window), **fields)


def small(*things, **settings):
    return tiny_scenes.scene(*things, **{"samples": 8, "max_bounces": 5, **settings})


def sun(turn=0.7, angle=0.02, power=2.0):
    return Light("sun", rotate_x(turn), LightKind.SUN, emission=(power,) * 3, sun_angle=angle)


def everything():
    return showroom(PIXELS, samples=8, passes=(Pass.COMBINED,))


def smooth_meshes():
    """Smooth normals, an offset of the shadow terminator, and a sun at grazing angles."""
    things = [plane(0), mesh(0, 1, move(-1, 0, 1), terminator=0.1), mesh(0, 2, move(1.2, 0.5, 0.7) @ scale(0.7, 0.7, 0.5))]
    looks = [lambert(0.6), lambert((0.8, 0.3, 0.2)), beckmann(0.9, 0.25)]
    return small(things, looks, [sun(1.3, 0.0), sun(-0.4)], [SMOOTH], 0.1, camera((0, -6, 2), (0, 0, 0.7)))


def crowd():
    """Rotated, mirrored and flattened instances."""
    rng = np.random.default_rng(3)
    things = [plane(0)]
    for i in range(60):
        turn = rotate_x(rng.uniform(0, 6)) @ rotate_y(rng.uniform(0, 6)) @ scale(*rng.uniform(0.15, 0.5, 3) * (-1) ** i)
        place = rng.integers(-32, 32, 3) / 16
        things.append(mesh(i % 2, 1 + i % 3, move(*place[:2], 0.5 + abs(place[2]) / 2) @ turn))
    looks = [lambert(0.5), lambert((0.7, 0.4, 0.2)), MIRROR, beckmann(0.8, 0.3)]
    lamps = [Light("area", move(-2, -2, 5) @ rotate_y(-0.5), LightKind.AREA, emission=(8, 8, 8), size=(2, 1))]
    return small(things, looks, lamps, [ROCK, SMOOTH], 0.2, camera((1, -5, 4), (0, 0, 0.5)))


def glass():
    """A glass mesh around an exact glass ball, under a sky of nodes that is sampled as a light."""
    nodes = (Node(NodeKind.COORDINATE, Coordinate.GENERATED), Node(NodeKind.VECTOR_MATH, 17, inputs=(NodeRef(0),)))
    things = [plane(1), sphere(0, move(-1.1, 0, 1)), mesh(0, 0, move(1.1, 0, 1)), sphere(2, move(1.1, 0, 1) @ scale(0.5))]
    world = World(NodeRef(1), nodes, map_resolution=32)
    shot = small(things, [GLASS, lambert(0.7), MIRROR], [], [SMOOTH], camera=camera((0.5, -5, 1.5), (0, 0, 0.8)), max_bounces=8)
    return dataclasses.replace(shot, world=world)


def closed_room():
    """Light that reaches the eye only by several walls."""
    walls = MeshData.from_trimesh(trimesh.creation.box((4, 4, 4)), "walls")
    things = [
        mesh(0, 0, move(0, 0, 2)),
        mesh(1, 2, move(0, 0, 3.875) @ rotate_x(np.pi)),
        mesh(1, 1, move(0, 1.9, 2) @ rotate_x(np.pi / 2)),
        sphere(1, move(-0.9, 0.5, 0.75) @ scale(0.75)),
        Instance(kind=InstanceKind.CYLINDER, matrix=move(1, 0, 1) @ scale(0.5, 0.5, 1), materials=(3,)),
    ]
    looks = [lambert(0.7), MIRROR, GLOW, lambert((0.2, 0.6, 0.3))]
    return small(things, looks, [], [walls, quad(1.5)], camera=camera((0.25, -1.75, 2), (0, 1, 1.5), 0.7), max_bounces=10)


def many_lamps():
    """Enough lamps for a light tree."""
    rng = np.random.default_rng(5)
    lamps = []
    for i in range(40):
        kind = (LightKind.POINT, LightKind.SPOT, LightKind.AREA)[i % 3]
        place = move(*rng.uniform(-4, 4, 2), rng.uniform(0.5, 3)) @ rotate_x(rng.uniform(-1, 1))
        power = rng.uniform(0.05, 1.0) * (1, 1, 3)[i % 3]
        shape = {"radius": 0.1 * (i % 2), "soft_falloff": i % 4 < 2, "spot_angle": 1.5, "size": (0.5, 0.25)}
        lamps.append(Light(f"lamp {i}", place, kind, (power,) * 3, **shape))
    things = [plane(0), mesh(0, 1, move(0, 0, 0.75)), sphere(2, move(-2, 1, 0.5) @ scale(0.5)), mesh(1, 3, move(2, 0, 1))]
    looks = [lambert(0.6), beckmann(0.8, 0.2), lambert(0.8), GLOW]
    return small(things, looks, lamps, [ROCK, quad(0.5)], camera=camera((0, -7, 4), (0, 0, 0.3)))


def principled():
    """Coats, metal and rough glass; an image as colour and as bump, whose height is a length."""
    coordinate = Node(NodeKind.COORDINATE, Coordinate.GENERATED)
    picture = Node(NodeKind.IMAGE, image=0, image_count=1, inputs=(NodeRef(0),))
    bump = Node(NodeKind.BUMP, first=0, inputs=(0.8, 0.125, NodeRef(1), (0, 0, 0), 0.1))
    checks = Image("checks", np.random.default_rng(7).integers(40, 255, (8, 8, 3)).astype(np.uint8))

    def shiny(nodes=(), normal=(0, 0, 0), **fields):
        lobe = Lobe(LobeKind.PRINCIPLED, normal=normal, principled=Principled(**fields))
        return Material("principled", (lobe,), nodes=nodes)

    looks = [
        shiny((coordinate, picture, bump), NodeRef(2), base_color=NodeRef(1), roughness=0.6),
        shiny(base_color=(0.8, 0.2, 0.1), coat=1.0, sheen=0.3),
        shiny(metallic=1.0, roughness=0.2, anisotropic=0.5),
        shiny(transmission=1.0, roughness=0.1),
    ]
    things = [
        mesh(1, 0, move(0, 0, 0)),
        mesh(0, 1, move(-1.5, 0, 0.75)),
        mesh(0, 2, move(0, 0.5, 1)),
        mesh(0, 3, move(1.5, -0.5, 1)),
    ]
    lamp = Light("lamp", move(2, -3, 4), emission=(30,) * 3, radius=0.25)
    shot = small(things, looks, [lamp], [SMOOTH, quad(8.0)], 0.3, camera((0, -6, 3), (0, 0, 0.5)))
    return dataclasses.replace(shot, images=(checks,))


def veils():
    """Shadow rays of a spot through transparent layers onto a floor."""
    things = [plane(0), *(mesh(0, 1 + i, move(0.25 * i - 0.5, 0, 0.5 + 0.5 * i) @ rotate_x(0.2 * i)) for i in range(3))]
    looks = [lambert(0.8), *(veiled(lambert(c), 0.4) for c in ((0.8, 0.2, 0.2), (0.2, 0.8, 0.2), (0.2, 0.2, 0.8)))]
    spot = Light("spot", move(0.5, 0, 5), LightKind.SPOT, (40,) * 3, radius=0.1, spot_angle=0.9, spot_blend=0.4)
    return small(things, looks, [spot], [quad(2.0)], 0.05, camera((1, -4, 3), (0, 0, 0.7)))


def course():
    """CLASSIC with falloffs, whose radii are lengths."""
    kinds = (Falloff.PHYSICAL, Falloff.LINEAR, Falloff.SMOOTH, Falloff.GAUSSIAN)
    lamps = [
        Light(f"lamp {i}", move(2 * i - 3, -2, 3), emission=(2,) * 3, falloff=f, falloff_radius=6.0)
        for i, f in enumerate(kinds)
    ]
    things = [
        plane(0),
        sphere(1, move(-1, 0, 1)),
        mesh(0, 2, move(1.5, 0, 1)),
        Instance(kind=InstanceKind.CONE, matrix=move(0, 2, 1), materials=(3,)),
    ]
    phong = Material("phong", (Lobe(color=(0.3, 0.3, 0.6)), Lobe(LobeKind.PHONG, color=(0.4,) * 3, shininess=30.0)))
    looks, eye = [lambert(0.6), MIRROR, GLASS, phong], camera((0, -6, 2), (0, 0, 0.8))
    return small(things, looks, lamps, [SMOOTH], 0.1, eye, integrator=Integrator.CLASSIC)


def parallel():
    """An orthographic lens, whose window is a length, with every pass that depends on lengths."""
    shot = showroom(PIXELS, samples=8, passes=tuple(Pass), occlusion_distance=1.0, mist_start=2.0, mist_depth=8.0)
    lens = {"lens_radius": 0.05, "focal_distance": 6.5, "clip_end": 50.0}
    return dataclasses.replace(shot, camera=camera((2, -6, 3), (0, 0, 0.8), 3.0, kind=CameraKind.ORTHOGRAPHIC, **lens))


TEN = (everything, smooth_meshes, crowd, glass, closed_room, many_lamps, principled, veils, course, parallel)


# ---- other sizes and places ----


_OF_CAMERA = ("matrix", "matrix_before", "matrix_after")


def _placed(table, placed):
    """Return an InstanceTable whose matrices, and those of the frames around, are changed by placed(matrices)."""
    vectors = table.vectors and dataclasses.replace(table.vectors, matrices=placed(table.vectors.matrices))
    return dataclasses.replace(table, matrices=placed(table.matrices), vectors=vectors)


def resized(shot, factor):
    """Return the scene with all lengths times factor, and lamps scaled for equal irradiance. The factor is a float."""

    def larger(matrix):
        return np.array(matrix, float) * np.array([[1, 1, 1, factor]])

    def lamp(light):
        spreads = light.kind in (LightKind.POINT, LightKind.SPOT) and light.falloff == Falloff.PHYSICAL
        squared = factor * factor if spreads else 1.0
        return dataclasses.replace(
            light,
            matrix=larger(light.matrix),
            emission=tuple(squared * e for e in light.emission),
            radius=factor * light.radius,
            size=light.size if light.kind == LightKind.SPOT else tuple(factor * s for s in light.size),
            falloff_radius=factor * light.falloff_radius,
        )

    def look(material):
        # Among the nodes in these scenes only BUMP has an input that is a length.
        def node(n):
            taller = (n.inputs[0], factor * n.inputs[1], *n.inputs[2:]) if n.kind == NodeKind.BUMP else n.inputs
            return dataclasses.replace(n, inputs=taller)

        return dataclasses.replace(material, nodes=tuple(node(n) for n in material.nodes))

    eye, settings = shot.camera, shot.settings
    window = factor if eye.kind == CameraKind.ORTHOGRAPHIC else 1.0
    return dataclasses.replace(
        shot,
        instances=_placed(shot.instances, lambda matrices: matrices * factor),
        lights=tuple(lamp(light) for light in shot.lights),
        materials=tuple(look(material) for material in shot.materials),
        camera=dataclasses.replace(
            eye,
            matrix=larger(eye.matrix),
            matrix_before=larger(eye.matrix_before),
            matrix_after=larger(eye.matrix_after),
            window=tuple(window * w for w in eye.window),
            window_before=tuple(window * w for w in eye.window_before),
            window_after=tuple(window * w for w in eye.window_after),
            clip_start=factor * eye.clip_start,
            clip_end=factor * eye.clip_end,
            lens_radius=factor * eye.lens_radius,
            focal_distance=factor * eye.focal_distance,
        ),
        settings=dataclasses.replace(
            settings,
            occlusion_distance=factor * settings.occlusion_distance,
            mist_start=factor * settings.mist_start,
            mist_depth=factor * settings.mist_depth,
        ),
    )


def resized_meshes(shot, factor):
    """Return the resized scene with the factor in the vertices of meshes instead of the transforms."""
    larger = resized(shot, factor)
    is_mesh = (shot.instances.kinds == InstanceKind.MESH)[:, None, None]
    linear = np.where(is_mesh, shot.instances.matrices[..., :3], larger.instances.matrices[..., :3])
    matrices = np.concatenate([linear, larger.instances.matrices[..., 3:]], axis=2)

    def mesh(m):
        frames = None if m.vector_positions is None else np.float32(factor) * m.vector_positions
        return dataclasses.replace(m, positions=np.float32(factor) * m.positions, vector_positions=frames)

    meshes = tuple(map(mesh, shot.meshes))
    return dataclasses.replace(larger, meshes=meshes, instances=dataclasses.replace(larger.instances, matrices=matrices))


def moved(shot, offset):
    """Return the scene moved by offset."""

    def there(matrix):
        return np.array(matrix, float) + np.concatenate([np.zeros((3, 3)), np.reshape(offset, (3, 1))], axis=1)

    return dataclasses.replace(
        shot,
        instances=_placed(shot.instances, there),
        lights=tuple(dataclasses.replace(light, matrix=there(light.matrix)) for light in shot.lights),
        camera=dataclasses.replace(
            shot.camera,
            # A camera that stands still has zeros for the frames around.
            **{name: there(matrix) for name in _OF_CAMERA if (matrix := getattr(shot.camera, name)).any()},
        ),
    )
