"""Smallest scenes as snapshots, each for one fact, and renders of single pixels."""

import dataclasses

import numpy as np

from addon.bindings.abi import CameraKind, InstanceKind, LightKind, LobeKind, Pass, PassKind
from addon.bindings.numbered_pass import MATTES, NumberedPass, extras
from addon.bindings.session import Session
from addon.bindings.snapshot import (
    Camera,
    Instance,
    InstanceTable,
    InstanceVectors,
    Light,
    Lobe,
    Material,
    MeshData,
    Output,
    SceneSnapshot,
    Settings,
)


def move(x=0.0, y=0.0, z=0.0):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def scale(x, y=None, z=None):
    return np.diag([x, x if y is None else y, x if z is None else z, 1.0])


def rotate_x(angle):
    matrix = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    matrix[1:3, 1:3] = [[c, -s], [s, c]]
    return matrix


def rotate_y(angle):
    matrix = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    matrix[0, 0], matrix[0, 2], matrix[2, 0], matrix[2, 2] = c, s, -s, c
    return matrix


def look_at(eye, target, up=(0.0, 0.0, 1.0)):
    """Return the matrix from camera to world, 4 x 4: at eye, looking at target along local -z."""
    eye, target, up = (np.asarray(v, float) for v in (eye, target, up))
    z = eye - target
    z /= np.linalg.norm(z)
    x = np.cross(up, z)
    if np.linalg.norm(x) < 1e-6:
        x = np.cross((0.0, 1.0, 0.0), z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    matrix[:3, 3] = eye
    return matrix


def lambert(albedo=1.0, **fields):
    return Material("lambert", lobes=(Lobe(LobeKind.LAMBERT, color=rgb(albedo)),), **fields)


def beckmann(color=1.0, alpha=0.3, ior=1.5, **fields):
    return Material("beckmann", lobes=(Lobe(LobeKind.BECKMANN, color=rgb(color), roughness=alpha, ior=ior),), **fields)


def veiled(material, opacity):
    """Return the material with that opacity; the rest of the light is transmitted."""
    lobes = tuple(dataclasses.replace(lobe, weight=rgb(opacity)) for lobe in material.lobes)
    emission = tuple(opacity * c for c in material.emission)
    return dataclasses.replace(material, lobes=lobes, emission=emission, transmittance=rgb(1.0 - opacity))


def rgb(value):
    return tuple(value) if np.ndim(value) else (float(value),) * 3


def quad(size=2.0, name="quad"):
    """Return a square in z = 0 around the origin that faces +z."""
    r = size / 2
    return MeshData(name, [(-r, -r, 0), (r, -r, 0), (r, r, 0), (-r, r, 0)], [(0, 1, 2), (0, 2, 3)])


def plane(material=0, matrix=None, **fields):
    return Instance(kind=InstanceKind.PLANE, materials=(material,), matrix=np.eye(4) if matrix is None else matrix, **fields)


def sphere(material=0, matrix=None, **fields):
    return Instance(kind=InstanceKind.SPHERE, materials=(material,), matrix=np.eye(4) if matrix is None else matrix, **fields)


def pencil(eye=(0.0, 0.0, 1.0), target=(0.0, 0.0, 0.0), width=1e-6, pixels=1, **fields):
    """Return an orthographic camera so narrow that all its pixels see one point."""
    r = width / 2
    return Camera(
        matrix=look_at(eye, target),
        kind=CameraKind.ORTHOGRAPHIC,
        width=pixels,
        height=pixels,
        window=(-r, r, -r, r),
        clip_start=0.0,
        clip_end=1e30,
        **fields,
    )


def one_pixel(**settings):
    """Return settings for pictures of one or few pixels."""
    return Settings(**{"samples": 1, "threads": 1, "max_bounces": 0, "passes": (Pass.COMBINED,), **settings})


def scene(instances=(), materials=(), lights=(), meshes=(), world=0.0, camera=None, **settings):
    return SceneSnapshot(
        meshes=tuple(meshes),
        instances=InstanceTable.build(list(instances)),
        materials=tuple(materials),
        lights=tuple(lights),
        world=rgb(world),
        camera=camera or pencil(),
        settings=one_pixel(**settings),
    )


def furnace(albedo, emission, **settings):
    """Return the inside of an emitting Lambert sphere, seen from its centre."""
    return scene([sphere()], [lambert(albedo, emission=rgb(emission))], camera=pencil((0, 0, 0), (0, 0, -1)), **settings)


def two_planes(distance=2.0, albedo=0.8, emission=1.0, **settings):
    """Return an infinite emitting floor under an infinite Lambert ceiling."""
    ceiling = move(z=distance) @ rotate_x(np.pi)
    materials = [Material("glow", lobes=(), emission=rgb(emission)), lambert(albedo)]
    camera = pencil((0, 0, distance / 2), (0, 0, distance), 1e-6)
    return scene([plane(0), plane(1, ceiling)], materials, camera=camera, **settings)


# The passes of a showroom beside those of Pass whose values follow from the samples alone.
EXTRAS = (
    *(NumberedPass(kind, level) for kind in MATTES for level in range(2)),
    *(NumberedPass(PassKind.LIGHT_GROUP, group) for group in range(4)),
    *(NumberedPass(kind) for kind in (PassKind.AOV_COLOR, PassKind.AOV_VALUE, PassKind.SAMPLES)),
)


def showroom(pixels=32, **settings):
    """Return a scene with many kinds of objects, which move from frame to frame, for comparing configurations."""
    materials = [
        lambert((0.8, 0.7, 0.6)),
        beckmann(0.9, 0.2, 1.5),
        Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.5),)),
        Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(0.9, 0.8, 0.7)),)),
        Material("glow", lobes=(), emission=(4.0, 3.0, 2.0)),
        Material("mixed", lobes=(Lobe(color=(0.3, 0.1, 0.1)), Lobe(LobeKind.BECKMANN, color=(1, 1, 1), roughness=0.1))),
        veiled(lambert(0.5), 0.5),
    ]
    instances = [
        plane(0, name="floor", object_index=1),
        sphere(1, move(-1.2, 0, 1), name="rough", object_index=2),
        sphere(2, move(1.0, -0.8, 0.6) @ scale(0.6), name="glass", object_index=3),
        sphere(3, move(0.4, 1.5, 0.8) @ scale(0.8), name="mirror", object_index=4),
        Instance(mesh=0, matrix=move(0, 0, 3.5) @ rotate_x(np.pi), materials=(4,), name="lamp", object_index=5),
        Instance(mesh=0, matrix=move(-0.5, -1.5, 0.6) @ rotate_x(1.2), materials=(6,), name="veil", object_index=6),
        Instance(
            kind=InstanceKind.CYLINDER, matrix=move(2.0, 1.0, 0.5) @ scale(0.4, 0.4, 0.5), materials=(5,), name="cylinder"
        ),
        Instance(kind=InstanceKind.CONE, matrix=move(-2.2, 1.0, 0.7) @ scale(0.6, 0.6, 0.7), materials=(0,), name="cone"),
    ]
    # Mattes, light groups and outputs of all of them.
    values = Output(value=(0.25, -2.0, 1e3)), Output(is_color=False, value=(0.7, 0.0, 0.0))
    materials = [dataclasses.replace(item, matte=7 + n, outputs=values) for n, item in enumerate(materials)]
    instances = [
        dataclasses.replace(item, object_matte=n + 1, asset_matte=n % 3 + 1, light_group=1) for n, item in enumerate(instances)
    ]
    lights = [
        Light("point", move(2, -3, 4), LightKind.POINT, emission=(20, 20, 25), radius=0.2, light_group=2),
        Light("area", move(-3, -2, 4) @ rotate_y(-0.6), LightKind.AREA, emission=(3, 3, 3), size=(1, 0.5), light_group=3),
        Light("sun", rotate_x(0.7), LightKind.SUN, emission=(0.5, 0.5, 0.4), sun_angle=0.05, light_group=2),
        Light("spot", move(0, 0, 5), LightKind.SPOT, emission=(10, 5, 5), spot_angle=0.8, spot_blend=0.3, light_group=3),
    ]
    camera = Camera(
        matrix=look_at((1.5, -6.0, 2.5), (0, 0, 0.8)),
        width=pixels,
        height=pixels,
        window=(-0.45, 0.45, -0.45, 0.45),
        lens_radius=0.02,
        focal_distance=6.0,
        matrix_before=look_at((1.4, -6.0, 2.5), (0, 0, 0.8)),
        matrix_after=look_at((1.5, -6.1, 2.5), (0, 0.1, 0.8)),
        window_before=(-0.45, 0.45, -0.45, 0.45),
        window_after=(-0.44, 0.44, -0.44, 0.44),
    )
    square = quad(1.5)
    square = dataclasses.replace(square, vector_positions=np.stack([0.9 * square.positions, 1.2 * square.positions]))
    defaults = {"samples": 4, "max_bounces": 6, "passes": tuple(Pass), **extras(EXTRAS)}
    shown = scene(instances, materials, lights, [square], (0.1, 0.15, 0.2), camera, **{**defaults, **settings})
    frames = np.array([(move(-1.2, 0.1, 1)[:3], move(-1.3, 0, 1.2)[:3]), (scale(0.7)[:3], (move(y=2) @ scale(0.9))[:3])])
    table = dataclasses.replace(shown.instances, vectors=InstanceVectors([1, 3], frames))
    shown = dataclasses.replace(shown, instances=table)
    return dataclasses.replace(shown, world=dataclasses.replace(shown.world, light_group=4))


def overflowing(side=16, **settings):
    """Return a floor right under a lamp: at its centre 1e30 W/sr over (1e-6 m)^2 exceeds float's 3.4e38, elsewhere not."""
    lamp = Light("lamp", move(z=1e-6), LightKind.POINT, emission=(1e30,) * 3)
    camera = Camera(look_at((0.0, 0.0, 2.0), (0.0, 0.0, 0.0)), width=side, height=side, window=(-1e-4, 1e-4, -1e-4, 1e-4))
    return scene([plane(0)], [lambert(0.5)], [lamp], camera=camera, **{"samples": 4, "threads": 2, **settings})


def with_settings(snapshot, **fields):
    return dataclasses.replace(snapshot, settings=dataclasses.replace(snapshot.settings, **fields))


def render(snapshot, which=Pass.COMBINED, samples=None):
    """Render and return one pass, (h, w, channels) in double."""
    with Session.upload(snapshot) as session:
        assert session.render_all(samples)
        return session.read(which).astype(np.float64)


def radiance(snapshot):
    """Render and return the mean RGB over the pixels."""
    return render(snapshot)[..., :3].mean(axis=(0, 1))
