"""POV-Ray 3.7, the classic ray tracer: scenes of exact spheres and planes under point lights, for CLASSIC."""

import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from addon.bindings.enums import InstanceKind, LightKind

from . import Cannot
from .geometry import placements
from .plain import Texture, read_surface, read_world
from .view import read_view

# POV-Ray clips pictures at 1: all light is scaled by this factor.
_DARKER = 0.125
_SHAPES = {InstanceKind.SPHERE: "sphere { <0, 0, 0>, 1", InstanceKind.PLANE: "plane { <0, 0, 1>, 0"}


def version():
    if shutil.which("povray") is None:
        raise RuntimeError("the program povray is not installed")
    said = subprocess.run(["povray", "--version"], capture_output=True, text=True)
    return re.search(r"POV-Ray (\d[\w.]*)", said.stdout + said.stderr)[1]


def check(snapshot):
    read_view(snapshot.camera)
    _, image = read_world(snapshot.world)
    if image is not None:
        raise Cannot("pictured skies have no equal")
    for material in snapshot.materials:
        if read_surface(material).model != "course":
            raise Cannot(f"material '{material.name}' is not of the course's model")
    for placed in placements(snapshot):
        if placed.kind not in _SHAPES:
            raise Cannot(f"shapes of kind {InstanceKind(placed.kind).name} are left out")
    for light in snapshot.lights:
        if light.kind != LightKind.POINT or light.radius > 0.0:
            raise Cannot(f"{light.name} is no point light")


class Renderer:
    """option is unused. render() also stores the numbers of rays and shadow tests in .rays."""

    def __init__(self, snapshot, threads, option=None):
        self.camera, self.threads = snapshot.camera, threads
        self.text = "\n".join(_describe(snapshot))

    def render(self, samples, seed):
        """Render. samples: a square number; seed is unused, as POV-Ray samples nothing at random here."""
        side = round(samples**0.5)
        if side * side != samples:
            raise ValueError(f"{samples} samples are no square")
        with tempfile.TemporaryDirectory() as folder:
            scene, picture = Path(folder) / "scene.pov", Path(folder) / "picture.ppm"
            scene.write_text(self.text)
            size = [f"+W{self.camera.width}", f"+H{self.camera.height}", f"+WT{self.threads}"]
            # Every pixel is divided into side x side, whatever its content.
            smooth = ["+AM1", "+A0.0", f"+R{side}", "+AG1.0", "-J"] if side > 1 else ["-A"]
            command = ["povray", f"+I{scene}", f"+O{picture}", *size, *smooth, "+FP16", "File_Gamma=1.0", "-D", "+Q9"]
            said = subprocess.run(command, capture_output=True, text=True, cwd=folder)
            if said.returncode:
                raise RuntimeError(said.stderr.strip().splitlines()[-1])
            values = _read_ppm(picture)
        seconds = float(re.search(r"Trace Time:.*?\((\d+\.\d+) seconds\)", said.stderr)[1])
        self.rays = {
            "rays": int(re.search(r"Rays:\s+(\d+)", said.stderr)[1]),
            "shadow": int(re.search(r"Shadow Ray Tests:\s+(\d+)", said.stderr)[1]),
        }
        return values / _DARKER, seconds, "its own trace time"


def _read_ppm(path):
    """Return (height, width, 3), row 0 at the bottom, from 16 bits per channel."""
    data = path.read_bytes()
    head = re.match(rb"P6\s(?:#[^\n]*\n)*(\d+)\s+(\d+)\s+65535\s", data)
    width, height = int(head[1]), int(head[2])
    values = np.frombuffer(data, ">u2", 3 * width * height, head.end())
    return values.reshape(height, width, 3)[::-1].astype(np.float32) / 65535.0


def _vector(values):
    return "<" + ", ".join(f"{float(value):.9g}" for value in values) + ">"


def _describe(snapshot):
    view = read_view(snapshot.camera)
    left, right, bottom, top = view.window
    yield "#version 3.7;"
    # One level is the camera ray. Without a bailout POV-Ray follows all reflections to the last level, as Lancer does.
    levels = snapshot.settings.max_bounces + 1
    yield f"global_settings {{ assumed_gamma 1.0 max_trace_level {levels} adc_bailout 0 }}"
    yield f"camera {{ perspective location {_vector(view.origin)} right {_vector(view.right * (right - left))}"
    yield f"  up {_vector(view.up * (top - bottom))} direction {_vector(view.forward)} }}"
    radiance, _ = read_world(snapshot.world)
    yield f"background {{ rgb {_vector(np.multiply(radiance, _DARKER))} }}"
    for light in snapshot.lights:
        # Faded light is 2 / (1 + (d / fade_distance)^2) times its colour: twice the inverse square if d is much larger than 1.
        # POV-Ray's diffuse surfaces reflect the colour itself at normal incidence, ours the colour over pi.
        color = np.multiply(light.emission, _DARKER / (2.0 * np.pi))
        yield f"light_source {{ {_vector(light.matrix[:, 3])} color rgb {_vector(color)} fade_distance 1 fade_power 2 }}"
    surfaces = [read_surface(material) for material in snapshot.materials]
    for placed in placements(snapshot):
        for matrix in placed.matrices:
            # POV-Ray multiplies row vectors by matrices.
            numbers = ", ".join(f"{value:.9g}" for value in matrix.T.ravel())
            yield f"{_SHAPES[placed.kind]} {_material(surfaces[placed.material])} matrix <{numbers}> }}"


def _material(surface):
    """Return Kd as pigment, Ks as a highlight and as a mirror times Fresnel's formula."""
    if isinstance(surface.color, Texture):
        raise Cannot("textures are left out")
    alpha2 = surface.roughness**4
    facing = ((surface.ior - 1.0) / (surface.ior + 1.0)) ** 2
    # Beckmann's lobe as a power of cos(n, h), of the same height and width at its middle.
    highlight = f"specular {max(surface.specular) * facing / (4.0 * alpha2):.6g} roughness {0.5 * alpha2:.6g}"
    mirror = f"reflection {{ rgb 0, rgb {_vector(surface.specular)} fresnel on }}"
    finish = f"finish {{ ambient 0 diffuse 1 {highlight} {mirror} }}"
    return f"pigment {{ rgb {_vector(surface.color)} }} {finish} interior {{ ior {surface.ior:.6g} }}"
