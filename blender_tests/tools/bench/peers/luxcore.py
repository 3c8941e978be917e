"""LuxCore with its unidirectional path tracer on the CPU, PATHCPU."""

import tempfile
import time
from pathlib import Path

import numpy as np

from addon.bindings.enums import AreaShape, InstanceKind, LightKind

from . import Cannot
from .geometry import Part, is_baked, placements
from .plain import Texture, is_black, read_surface, read_world, texels
from .view import read_view

_POLL = 0.01
_SUN_CORNERS, _SUN_DISTANCE = 64, 1e4
# LuxCore's environment maps begin at +x and continue to +y; Blender's begin at -x and turn the other way.
_ENVIRONMENT = np.diag([-1.0, 1.0, 1.0])
_VERTEX = ("x", "y", "z", "nx", "ny", "nz", "s", "t")


def _load():
    import pyluxcore

    pyluxcore.Init(lambda message: None)
    return pyluxcore


def version():
    return _load().Version()


def check(snapshot):
    read_view(snapshot.camera)
    read_world(snapshot.world)
    for material in snapshot.materials:
        surface = read_surface(material)
        if surface.model == "course":
            raise Cannot("the course's materials have no equal")
        if surface.cut_out is not None:
            raise Cannot(f"material '{material.name}' is cut out by alpha, which counts as a bounce there")
        if surface.transmission > 0.0 and surface.model == "principled":
            raise Cannot(f"material '{material.name}' is rough glass, which its Disney material has not")
    for placed in placements(snapshot):
        if placed.kind != InstanceKind.MESH:
            raise Cannot("exact shapes have no equal")
    for light in snapshot.lights:
        if light.kind == LightKind.SPOT:
            raise Cannot(f"{light.name} is a spot with Blender's edge")
        if light.kind == LightKind.AREA and (light.shape == AreaShape.ELLIPSE or light.spread < np.pi):
            raise Cannot(f"{light.name} is an ellipse or has a spread")
        if light.no_shadow:
            raise Cannot(f"{light.name} casts no shadow")


class Renderer:
    """option is unused."""

    def __init__(self, snapshot, threads, option=None):
        self.lux = _load()
        self.snapshot, self.threads = snapshot, threads
        self.scene = self.lux.Scene()
        self.properties = self.lux.Properties()
        with tempfile.TemporaryDirectory() as folder:
            self.folder = Path(folder)
            self._describe()
            self.scene.Parse(self.properties)

    def render(self, samples, seed):
        camera = self.snapshot.camera
        settings = {
            "renderengine.type": "PATHCPU",
            "sampler.type": "SOBOL",
            "native.threads.count": self.threads,
            "renderengine.seed": seed + 1,
            "film.width": camera.width,
            "film.height": camera.height,
            "film.filter.type": "BOX",
            "film.filter.width": 0.5,
            "film.outputs.0.type": "RGB",
            "film.outputs.0.filename": "picture.exr",
            "batch.haltspp": samples,
            # LuxCore's depth counts the light at the last vertex, too.
            "path.pathdepth.total": self.snapshot.settings.max_bounces + 1,
            "path.pathdepth.diffuse": self.snapshot.settings.max_bounces + 1,
            "path.pathdepth.glossy": self.snapshot.settings.max_bounces + 1,
            "path.pathdepth.specular": self.snapshot.settings.max_bounces + 1,
            "path.clamping.variance.maxvalue": 0.0,
        }
        properties = self.lux.Properties()
        for name, value in settings.items():
            properties.Set(self.lux.Property(name, value))
        session = self.lux.RenderSession(self.lux.RenderConfig(properties, self.scene))
        session.Start()
        started = time.perf_counter()
        # LuxCore has no call that waits.
        while not session.HasDone():
            time.sleep(_POLL)
            session.UpdateStats()
        seconds = time.perf_counter() - started
        film = session.GetFilm()
        picture = np.zeros((camera.height, camera.width, 3), np.float32)
        film.GetOutputFloat(self.lux.FilmOutputType.RGB, picture, 0)
        session.Stop()
        return picture, seconds, "wall clock from the end of its start to the last sample"

    # ---- the scene as properties

    def _set(self, name, value):
        self.properties.Set(self.lux.Property(f"scene.{name}", value))

    def _describe(self):
        snapshot = self.snapshot
        view = read_view(snapshot.camera)
        self._set("camera.type", "perspective")
        self._set("camera.lookat.orig", view.origin.tolist())
        self._set("camera.lookat.target", (view.origin + view.forward).tolist())
        self._set("camera.up", view.up.tolist())
        # At 90 degrees the window is the one at distance 1. LuxCore's rows are one lower than those of other renderers.
        left, right, bottom, top = view.window
        row = (top - bottom) / view.height
        self._set("camera.fieldofview", 90.0)
        self._set("camera.screenwindow", [left, right, bottom - row, top - row])
        self._set("camera.autofocus.enable", False)
        self._set("camera.cliphither", snapshot.camera.clip_start)
        surfaces = [read_surface(material) for material in snapshot.materials]
        for number, surface in enumerate(surfaces):
            self._material(f"material_{number}", surface)
        for number, placed in enumerate(placements(snapshot)):
            self._objects(number, placed)
        for number, light in enumerate(snapshot.lights):
            self._light(f"light_{number}", light)
        radiance, image = read_world(snapshot.world)
        if image is not None:
            self._image("world_map", texels(snapshot.images[image])[:, :, :3])
            self._set("lights.world.type", "infinite")
            self._set("lights.world.file", "world_map")
            self._set("lights.world.gamma", 1.0)
            self._set("lights.world.transformation", _columns(_ENVIRONMENT))
        elif any(radiance):
            self._set("lights.world.type", "constantinfinite")
            self._set("lights.world.color", list(radiance))

    def _image(self, name, values):
        rows = np.ascontiguousarray(values[::-1], np.float32)
        height, width, channels = rows.shape
        self.scene.DefineImageMap(name, rows, 1.0, channels, width, height)

    def _color(self, owner, color):
        """Return three numbers, or the name of a texture that is created for owner."""
        if not isinstance(color, Texture):
            return [float(channel) for channel in color]
        self._image(f"{owner}_map", texels(self.snapshot.images[color.image])[..., :3])
        self._set(f"textures.{owner}_texture.type", "imagemap")
        self._set(f"textures.{owner}_texture.file", f"{owner}_map")
        self._set(f"textures.{owner}_texture.gamma", 1.0)
        self._set(f"textures.{owner}_texture.mapping.type", "uvmapping2d")
        self._set(f"textures.{owner}_texture.mapping.uvscale", [1.0, -1.0])
        return f"{owner}_texture"

    def _material(self, name, surface):
        color = self._color(name, surface.color)
        kinds = {
            "black": {"type": "matte", "kd": [0.0, 0.0, 0.0]},
            "diffuse": {"type": "matte", "kd": color},
            "glass": {"type": "glass", "kr": [1.0, 1.0, 1.0], "kt": color, "interiorior": surface.ior},
            "mirror": {"type": "mirror", "kr": color},
            "principled": {
                "type": "disney",
                "basecolor": color,
                "metallic": surface.metallic,
                "roughness": surface.roughness,
                # LuxCore's specular of 1 reflects 8 %.
                "specular": ((surface.ior - 1.0) / (surface.ior + 1.0)) ** 2 / 0.08,
            },
        }
        for key, value in kinds[surface.model].items():
            self._set(f"materials.{name}.{key}", value)
        if not is_black(surface.emission):
            self._emit(name, surface.emission)

    def _emit(self, material, radiance):
        self._set(f"materials.{material}.emission", [float(channel) for channel in radiance])

    def _objects(self, number, placed):
        if is_baked(placed):
            for index, matrix in enumerate(placed.matrices):
                self._mesh(f"object_{number}_{index}", placed.part.placed(matrix), f"material_{placed.material}")
            return
        first = f"object_{number}_0"
        self._mesh(first, placed.part, f"material_{placed.material}", placed.matrices[0])
        path = self.folder / f"{first}.ply"
        for index, matrix in enumerate(placed.matrices[1:], 1):
            name = f"objects.object_{number}_{index}"
            self._set(f"{name}.ply", str(path))
            self._set(f"{name}.material", f"material_{placed.material}")
            self._set(f"{name}.transformation", _columns(matrix))

    def _mesh(self, name, part, material, matrix=None):
        path = self.folder / f"{name}.ply"
        _write_ply(path, part)
        self._set(f"objects.{name}.ply", str(path))
        self._set(f"objects.{name}.material", material)
        if matrix is not None:
            self._set(f"objects.{name}.transformation", _columns(matrix))

    def _light(self, name, light):
        emission = np.array(light.emission, float)
        if light.kind == LightKind.POINT:
            self._set(f"lights.{name}.type", "sphere" if light.radius > 0.0 else "point")
            self._set(f"lights.{name}.position", light.matrix[:, 3].tolist())
            # LuxCore divides the colour by all directions of the sphere.
            self._set(f"lights.{name}.color", (4.0 * np.pi * emission).tolist())
            if light.radius > 0.0:
                self._set(f"lights.{name}.radius", light.radius)
            return
        axes = light.matrix[:, :3] / np.linalg.norm(light.matrix[:, :3], axis=0)
        if light.kind == LightKind.SUN and light.sun_angle == 0.0:
            self._set(f"lights.{name}.type", "sharpdistant")
            self._set(f"lights.{name}.direction", (-axes[:, 2]).tolist())
            self._set(f"lights.{name}.color", emission.tolist())
            return
        if light.kind == LightKind.SUN:
            # Reflected rays do not hit LuxCore's suns: a distant disk of many corners replaces them.
            half = 0.5 * light.sun_angle
            turn = np.linspace(0.0, 2.0 * np.pi, _SUN_CORNERS, endpoint=False)[:, None]
            radius = _SUN_DISTANCE * np.tan(half)
            rim = _SUN_DISTANCE * axes[:, 2] - radius * (np.cos(turn) * axes[:, 0] - np.sin(turn) * axes[:, 1])
            fan = np.arange(1, _SUN_CORNERS - 1)
            faces = np.stack([np.zeros_like(fan), fan, fan + 1], axis=1)
            self._lamp(name, emission / (np.pi * np.sin(half) ** 2), rim, faces)
            return
        # A lamp's rectangle, which emits along -z.
        x, y = 0.5 * light.size[0] * axes[:, 0], 0.5 * light.size[1] * axes[:, 1]
        corners = light.matrix[:, 3] + np.array([-x - y, -x + y, x + y, x - y])
        self._lamp(name, emission, corners, np.array([[0, 1, 2], [0, 2, 3]]))

    def _lamp(self, name, radiance, corners, faces):
        """Add a black emissive mesh that is hidden from the camera."""
        self._set(f"materials.{name}.type", "matte")
        self._set(f"materials.{name}.kd", [0.0, 0.0, 0.0])
        self._emit(name, radiance)
        self._mesh(name, Part(corners, faces, None, None), name)
        self._set(f"objects.{name}.camerainvisible", True)


def _columns(matrix):
    """Return sixteen numbers, column by column."""
    full = np.eye(4)
    full[: matrix.shape[0], : matrix.shape[1]] = matrix
    return [float(value) for value in full.T.ravel()]


def _write_ply(path, part):
    columns = [part.positions, part.normals, part.uvs]
    names = [n for n, column in zip(("xyz", "n", "st"), columns, strict=True) if column is not None]
    names = [name for group in names for name in {"xyz": _VERTEX[:3], "n": _VERTEX[3:6], "st": _VERTEX[6:]}[group]]
    rows = np.concatenate([column for column in columns if column is not None], axis=1).astype("<f4")
    faces = np.empty(len(part.triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, part.triangles
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}"]
    head += [f"property float {name}" for name in names]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    path.write_bytes("\n".join(head).encode() + rows.tobytes() + faces.tobytes())
