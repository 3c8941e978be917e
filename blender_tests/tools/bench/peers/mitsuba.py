"""Mitsuba 3, scalar or vectorised through LLVM; the option is its variant."""

import glob
import os
import time

import numpy as np

from addon.bindings.enums import AreaShape, InstanceKind, LightKind

from . import Cannot
from .geometry import is_baked, placements
from .plain import Texture, is_black, read_surface, read_world, texels
from .view import read_view

# Most lanes of one launch: its memory grows with them.
_MOST_LANES = 1 << 24
_BLACK = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}
# Mitsuba's environment maps have +y at the top and +z in the middle column; Blender's have +z and +x.
_ENVIRONMENT = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def _load(variant):
    if variant.startswith("llvm") and "DRJIT_LIBLLVM_PATH" not in os.environ:
        # Other releases than 19 compile, but fail on processors that they do not know.
        found = glob.glob("/usr/lib/*/libLLVM.so.19.1") or glob.glob("/usr/lib/*/libLLVM-19.so")
        if not found:
            raise RuntimeError("LLVM 19 is missing (Debian's package libllvm19)")
        os.environ["DRJIT_LIBLLVM_PATH"] = found[0]
    import mitsuba

    mitsuba.set_variant(variant)
    return mitsuba


def version(variant="scalar_rgb"):
    """Return the package's version; render one pixel, so that a back end that does not work fails here."""
    mitsuba = _load(variant)
    scene = {"type": "scene", "light": {"type": "constant"}, "sensor": {"type": "perspective"}}
    scene["sensor"]["film"] = {"type": "hdrfilm", "width": 1, "height": 1}
    scene["integrator"] = {"type": "path"}
    np.array(mitsuba.render(mitsuba.load_dict(scene), spp=1))
    return mitsuba.__version__


def check(snapshot):
    read_view(snapshot.camera)
    read_world(snapshot.world)
    for material in snapshot.materials:
        surface = read_surface(material)
        if surface.model == "course":
            raise Cannot("the course's materials have no equal")
    for placed in placements(snapshot):
        if placed.kind not in (InstanceKind.MESH, InstanceKind.SPHERE):
            raise Cannot(f"exact shapes of kind {InstanceKind(placed.kind).name} have no equal")
    for light in snapshot.lights:
        if light.kind == LightKind.SPOT:
            raise Cannot(f"{light.name} is a spot with Blender's edge")
        if light.no_shadow:
            raise Cannot(f"{light.name} casts no shadow")


class Renderer:
    def __init__(self, snapshot, threads, variant):
        self.mitsuba = mitsuba = _load(variant)
        import drjit

        self.drjit = drjit
        self.vectorised = variant != "scalar_rgb"
        drjit.set_thread_count(threads)
        self.snapshot = snapshot
        self.pixels = snapshot.camera.width * snapshot.camera.height
        self.scene = mitsuba.load_dict(self._describe())

    def render(self, samples, seed):
        left, total, seconds = samples, 0.0, 0.0
        most = max(1, _MOST_LANES // self.pixels) if self.vectorised else samples
        while left:
            count = min(left, most)
            started = time.perf_counter()
            # The launches of one picture have consecutive seeds; those of two pictures are much farther apart.
            picture = self.mitsuba.render(self.scene, spp=count, seed=1000 * seed + (samples - left) // most)
            if self.vectorised:
                self.drjit.eval(picture)
                self.drjit.sync_thread()
            seconds += time.perf_counter() - started
            total = total + count * np.array(picture, np.float64)[::-1]
            left -= count
        return (total / samples).astype(np.float32), seconds, "wall clock around the render call"

    # ---- the scene as a dictionary

    def _describe(self):
        snapshot = self.snapshot
        self.surfaces = [read_surface(material) for material in snapshot.materials]
        scene = {"type": "scene", "integrator": self._integrator(), "sensor": self._sensor()}
        self.bsdfs = [self.mitsuba.load_dict(self._bsdf(surface)) for surface in self.surfaces]
        for number, placed in enumerate(placements(snapshot)):
            scene.update(self._shapes(number, placed))
        for number, light in enumerate(snapshot.lights):
            scene[f"light_{number}"] = self._light(light)
        radiance, image = read_world(snapshot.world)
        if image is not None:
            scene["world"] = self._environment(snapshot.images[image])
        elif any(radiance):
            scene["world"] = {"type": "constant", "radiance": self._rgb(radiance)}
        return scene

    def _integrator(self):
        # This is the only integrator of Mitsuba whose shadow rays pass through cut-out surfaces.
        kind = "volpath" if any(surface.cut_out for surface in self.surfaces) else "path"
        # Hiding lamps hides the world, too.
        hide = read_world(self.snapshot.world) == ((0.0, 0.0, 0.0), None)
        # Mitsuba's depth counts the camera ray, and the light at the last vertex.
        return {"type": kind, "max_depth": self.snapshot.settings.max_bounces + 2, "hide_emitters": hide}

    def _sensor(self):
        view = read_view(self.snapshot.camera)
        # Mitsuba's cameras look along +z and have +x on the left.
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = -view.right, view.up, view.forward, view.origin
        return {
            "type": "perspective",
            "to_world": self._matrix(matrix),
            "fov": view.horizontal_angle,
            "fov_axis": "x",
            "near_clip": self.snapshot.camera.clip_start,
            "far_clip": self.snapshot.camera.clip_end,
            "film": {
                "type": "hdrfilm",
                "width": view.width,
                "height": view.height,
                "rfilter": {"type": "box"},
                "pixel_format": "rgb",
                "component_format": "float32",
            },
            "sampler": {"type": "independent"},
        }

    def _matrix(self, matrix):
        full = np.eye(4)
        full[: matrix.shape[0], : matrix.shape[1]] = matrix
        return self.mitsuba.ScalarTransform4f(full.tolist())

    def _rgb(self, color):
        return {"type": "rgb", "value": [float(channel) for channel in color]}

    def _texture(self, color):
        if not isinstance(color, Texture):
            return self._rgb(color)
        return self._bitmap(texels(self.snapshot.images[color.image])[..., :3])

    def _bitmap(self, values):
        # Mitsuba's v = 0 is the first stored row.
        bitmap = self.mitsuba.Bitmap(np.ascontiguousarray(values, np.float32))
        return {"type": "bitmap", "bitmap": bitmap, "raw": True, "wrap_mode": "repeat"}

    def _bsdf(self, surface):
        result = self._opaque(surface)
        if surface.cut_out is None:
            return result
        alpha = texels(self.snapshot.images[surface.cut_out.image])[..., 3:]
        return {"type": "mask", "nested": result, "opacity": self._bitmap(alpha)}

    def _opaque(self, surface):
        color = self._texture(surface.color)
        if surface.model in ("diffuse", "black"):
            return {"type": "twosided", "nested": {"type": "diffuse", "reflectance": color}}
        if surface.model == "glass":
            return {"type": "dielectric", "int_ior": surface.ior, "ext_ior": 1.0, "specular_transmittance": color}
        if surface.model == "mirror":
            mirror = {"type": "conductor", "material": "none", "specular_reflectance": color}
            return {"type": "twosided", "nested": mirror}
        principled = {
            "type": "principled",
            "base_color": color,
            "roughness": surface.roughness,
            "metallic": surface.metallic,
            "eta": surface.ior,
            "spec_trans": surface.transmission,
        }
        return principled if surface.transmission > 0.0 else {"type": "twosided", "nested": principled}

    def _shapes(self, number, placed):
        bsdf, emission = self.bsdfs[placed.material], self.surfaces[placed.material].emission
        glow = None if is_black(emission) else {"type": "area", "radiance": self._rgb(emission)}
        if placed.kind == InstanceKind.SPHERE:
            for index, matrix in enumerate(placed.matrices):
                sphere = {"type": "sphere", "to_world": self._matrix(matrix), "material": bsdf}
                yield f"shape_{number}_{index}", sphere if glow is None else {**sphere, "emitter": glow}
            return
        if is_baked(placed):
            for index, matrix in enumerate(placed.matrices):
                yield f"shape_{number}_{index}", self._mesh(placed.part.placed(matrix), bsdf, glow)
            return
        if glow is not None:
            raise Cannot("instances that glow have no equal")
        yield f"group_{number}", {"type": "shapegroup", "mesh": self._mesh(placed.part, bsdf, None)}
        for index, matrix in enumerate(placed.matrices):
            group = {"type": "ref", "id": f"group_{number}"}
            yield f"instance_{number}_{index}", {"type": "instance", "to_world": self._matrix(matrix), "group": group}

    def _mesh(self, part, bsdf, glow):
        properties = self.mitsuba.Properties()
        properties["bsdf"] = bsdf
        if glow is not None:
            properties["emitter"] = self.mitsuba.load_dict(glow)
        has_normals, has_uvs = part.normals is not None, part.uvs is not None
        counts = len(part.positions), len(part.triangles)
        mesh = self.mitsuba.Mesh("mesh", *counts, properties, has_normals, has_uvs)
        parameters = self.mitsuba.traverse(mesh)
        parameters["vertex_positions"] = np.ascontiguousarray(part.positions, np.float32).ravel()
        parameters["faces"] = np.ascontiguousarray(part.triangles, np.uint32).ravel()
        if has_normals:
            parameters["vertex_normals"] = np.ascontiguousarray(part.normals, np.float32).ravel()
        if has_uvs:
            parameters["vertex_texcoords"] = np.ascontiguousarray(part.uvs, np.float32).ravel()
        parameters.update()
        return mesh

    def _light(self, light):
        name, emission = light.name, light.emission
        frame = np.eye(4)
        frame[:3] = light.matrix
        axes = frame[:3, :3] / np.linalg.norm(frame[:3, :3], axis=0)
        frame[:3, :3] = axes
        if light.kind == LightKind.POINT:
            if light.radius == 0.0:
                return {"type": "point", "position": frame[:3, 3].tolist(), "intensity": self._rgb(emission)}
            # A ball's intensity is its radiance times its cross-section.
            radiance = np.divide(emission, np.pi * light.radius**2)
            glow = {"type": "area", "radiance": self._rgb(radiance)}
            return {"type": "sphere", "center": frame[:3, 3].tolist(), "radius": light.radius, "emitter": glow, "bsdf": _BLACK}
        if light.kind == LightKind.SUN:
            if light.sun_angle == 0.0:
                return {"type": "directional", "direction": (-axes[:, 2]).tolist(), "irradiance": self._rgb(emission)}
            return self._sun(light, axes)
        if light.kind == LightKind.AREA:
            if light.spread < np.pi:
                raise Cannot(f"{name} has a spread")
            # Lamps emit along -z, Mitsuba's rectangles and disks along +z.
            matrix = frame @ np.diag([0.5 * light.size[0], -0.5 * light.size[1], -1.0, 1.0])
            shape = "disk" if light.shape == AreaShape.ELLIPSE else "rectangle"
            glow = {"type": "area", "radiance": self._rgb(emission)}
            return {"type": shape, "to_world": self._matrix(matrix), "emitter": glow, "bsdf": _BLACK}
        raise Cannot(f"{name} has no equal")

    def _sun(self, light, axes):
        """Return a distant disk of the sun's angle; its irradiance is its radiance times pi sin^2 of half the angle."""
        distance, half = 1e5, 0.5 * light.sun_angle
        matrix = np.eye(4)
        matrix[:3, :3] = axes @ np.diag([1.0, -1.0, -1.0]) * (distance * np.tan(half))
        matrix[:3, 3] = axes[:, 2] * distance
        radiance = np.divide(light.emission, np.pi * np.sin(half) ** 2)
        glow = {"type": "area", "radiance": self._rgb(radiance)}
        return {"type": "disk", "to_world": self._matrix(matrix), "emitter": glow, "bsdf": _BLACK}

    def _environment(self, image):
        bitmap = self.mitsuba.Bitmap(np.ascontiguousarray(texels(image)[::-1, :, :3], np.float32))
        return {"type": "envmap", "bitmap": bitmap, "to_world": self._matrix(_ENVIRONMENT)}
