"""Shader nodes with constant inputs as weighted lobes."""

import math

import bpy

from ..bindings import snapshot
from ..bindings.enums import LobeKind
from . import fresnel
from .sockets import PRINCIPLED, Reader, source

_MAX_LOBES = 8
_MIRROR_BELOW = 2e-5  # alpha below which the core treats a rough lobe as a mirror
_BLACK = (0.0, 0.0, 0.0)


def _scaled(color, factor):
    return tuple(c * factor for c in color)


def _plus(a, b):
    return tuple(x + y for x, y in zip(a, b, strict=True))


class ShaderReader:
    """Walks from the surface socket upstream; weights multiply through Mix and Add."""

    def __init__(self, owner, messages):
        self.reader = Reader(owner, messages)
        self.lobes = {}
        self.emission = _BLACK
        self.transparency = 0.0

    def read(self, output, weight):
        """Adds the shader at an output socket with a weight."""
        if output is None or weight <= 0.0:
            return
        node = output.node
        method = _SHADERS.get(node.type)
        if method is None:
            self._unknown(node, weight)
        else:
            method(self, node, weight)

    def result(self):
        """(lobes, emission, opacity). The core scales lobes and emission by opacity, so that is divided out here."""
        opacity = min(max(1.0 - self.transparency, 0.0), 1.0)
        scale = 1.0 / opacity if opacity > 0.0 else 0.0
        ranked = sorted(self.lobes.items(), key=lambda item: -sum(item[1]))
        if len(ranked) > _MAX_LOBES:
            self.reader.messages.add(f"{self.reader.owner}: has {len(ranked)} lobes, the {_MAX_LOBES} strongest are used")
        lobes = tuple(
            snapshot.Lobe(kind, _scaled(color, scale), roughness=roughness, ior=ior)
            for (kind, roughness, ior), color in ranked[:_MAX_LOBES]
        )
        return lobes, _scaled(self.emission, scale), opacity

    def _add(self, kind, color, roughness=0.0, ior=1.0):
        """Equal lobes become one, and black ones none: the scene pays for what it shows."""
        if any(color):
            key = (kind, roughness, ior)
            self.lobes[key] = _plus(self.lobes.get(key, _BLACK), color)

    def _mix(self, node, weight):
        factor = self.reader.number(node, ("Fac", "Factor"), 0.5, 0.0, 1.0)
        first, second = [socket for socket in node.inputs if socket.type == "SHADER"]
        self.read(source(first), weight * (1.0 - factor))
        self.read(source(second), weight * factor)

    def _sum(self, node, weight):
        for socket in node.inputs:
            if socket.type == "SHADER":
                self.read(source(socket), weight)

    def _diffuse(self, node, weight):
        self.reader.unsupported(node, ("Roughness",))
        self.reader.unsupported(node, ("Normal",))
        self._add(LobeKind.LAMBERT, _scaled(self.reader.color(node, ("Color",)), weight))

    def _glossy(self, node, weight):
        roughness = 0.0
        if node.distribution != "SHARP":
            roughness = self.reader.number(node, ("Roughness",), 0.5, 0.0, 1.0)
        self.reader.unsupported(node, ("Anisotropy",))
        self.reader.unsupported(node, ("Normal",))
        # Without roughness all distributions are the same mirror.
        if roughness**2 >= _MIRROR_BELOW and node.distribution != "BECKMANN":
            self.reader.tell(node, f"distribution {node.distribution} is not supported, Beckmann is used")
        self._metal(_scaled(self.reader.color(node, ("Color",)), weight), roughness**2)

    def _metallic(self, node, weight):
        self.reader.tell(node, "the edge tint is not supported")
        self._metal(
            _scaled(self.reader.color(node, ("Base Color",)), weight),
            self.reader.number(node, ("Roughness",), 0.5, 0.0, 1.0) ** 2,
        )

    def _metal(self, color, alpha):
        if alpha < _MIRROR_BELOW:
            self._add(LobeKind.MIRROR, color)
        else:
            self._add(LobeKind.BECKMANN, color, alpha, math.inf)

    def _glass(self, node, weight):
        if node.type == "BSDF_REFRACTION":
            self.reader.tell(node, "refraction alone is not supported, glass that reflects too is used")
        rough = getattr(node, "distribution", "") != "SHARP" and self.reader.number(node, ("Roughness",), 0.0, 0.0, 1.0) > 0.0
        if rough:
            self.reader.tell(node, "rough glass is not supported, smooth glass is used")
        self.reader.unsupported(node, ("Normal",))
        self.reader.unsupported(node, ("Thin Film Thickness",))
        color = _scaled(self.reader.color(node, ("Color",)), weight)
        self._add(LobeKind.DIELECTRIC, color, ior=self.reader.number(node, ("IOR",), 1.5, 1e-5))

    def _emit(self, node, weight):
        strength = self.reader.number(node, ("Strength",), 1.0)
        color = self.reader.color(node, ("Color",))
        self.emission = _plus(self.emission, _scaled(color, strength * weight))

    def _transparent(self, node, weight):
        color = self.reader.color(node, ("Color",))
        if max(color) - min(color) > 1e-6:
            self.reader.tell(node, "coloured transparency is not supported, its mean is used")
        self.transparency += weight * sum(color) / 3.0

    def _holdout(self, node, weight):
        self.reader.tell(node, "holdout is not supported, black is used")

    def _principled(self, node, weight):
        def number(name, default, low=0.0, high=math.inf):
            return self.reader.number(node, PRINCIPLED[name], default, low, high)

        def color(name, default):
            return self.reader.color(node, PRINCIPLED[name], default)

        for name in ("anisotropic", "coat", "sheen", "subsurface", "diffuse_roughness", "transmission_roughness"):
            self.reader.unsupported(node, PRINCIPLED[name])
        for name in ("thin_film", "thin_wall", "normal", "coat_normal"):
            self.reader.unsupported(node, PRINCIPLED[name])
        layered = bpy.app.version >= (4, 0)
        tint = color("specular_tint", (1.0, 1.0, 1.0))
        if any(abs(c - (1.0 if layered else 0.0)) > 1e-6 for c in tint):
            self.reader.tell(node, "input 'Specular Tint' is not supported")

        # Take what alpha leaves; the rest of the light passes straight on.
        alpha = number("alpha", 1.0, 0.0, 1.0)
        self.transparency += weight * (1.0 - alpha)
        weight *= alpha
        strength = number("emission_strength", 1.0)
        if strength > 0.0:
            self.emission = _plus(self.emission, _scaled(color("emission_color", _BLACK), strength * weight))

        # Split the rest between metal, glass and the layered dielectric.
        base = color("base_color", (0.8, 0.8, 0.8))
        metallic = number("metallic", 0.0, 0.0, 1.0)
        transmission = number("transmission", 0.0, 0.0, 1.0)
        roughness_alpha = number("roughness", 0.5, 0.0, 1.0) ** 2
        opaque = weight * (1.0 - metallic) * (1.0 - transmission)
        glass = weight * (1.0 - metallic) * transmission
        self._metal(_scaled(base, weight * metallic), roughness_alpha)
        if glass > 0.0:
            if roughness_alpha > 0.0:
                self.reader.tell(node, "rough glass is not supported, smooth glass is used")
            self._tinted_glass(base, glass, number("ior", 1.5, 1e-5), layered)
        if opaque > 0.0:
            ior, scale = self._specular(node, number, layered)
            self._add(LobeKind.LAMBERT, _scaled(base, opaque * scale))
            if ior > 1.0:
                self._add(LobeKind.BECKMANN, (opaque,) * 3, roughness_alpha, ior)

    def _tinted_glass(self, base, weight, ior, layered):
        """Only what is refracted takes the colour: from 4.0 its root at each of the two surfaces that light passes."""
        tint = tuple(math.sqrt(min(c, 1.0)) for c in base) if layered else base
        self._add(LobeKind.DIELECTRIC, _scaled(tint, weight), ior=ior)
        # The dielectric lobe tints its reflection too; a smooth coat gives back what that takes.
        rest = tuple(max(0.0, 1.0 - c) for c in tint)
        if max(rest) > 1e-6:
            self._add(LobeKind.BECKMANN, _scaled(rest, weight), 0.0, ior)

    @staticmethod
    def _specular(node, number, layered):
        """Index of the specular layer, and what it leaves to the diffuse one below."""
        level = number("specular", 0.5)
        # Before 4.0 the level alone gives the reflectance, IOR has no part in it, and the layer is added on top.
        if not layered:
            return fresnel.ior_of_reflectance(min(0.08 * level, 1.0)), 1.0
        f0 = min(2.0 * level * fresnel.reflectance_at_normal(number("ior", 1.5, 1e-5)), 1.0)
        ior = fresnel.ior_of_reflectance(f0)
        return ior, 1.0 - fresnel.mean_reflectance(ior)

    def _unknown(self, node, weight):
        self.reader.tell(node, f"{node.bl_label} is not supported, a diffuse surface is used")
        color = next((socket for socket in node.inputs if socket.type == "RGBA" and socket.enabled), None)
        base = (0.5, 0.5, 0.5) if color is None else self.reader.color(node, (color.identifier,))
        self._add(LobeKind.LAMBERT, _scaled(base, weight))


_SHADERS = {
    "ADD_SHADER": ShaderReader._sum,
    "BSDF_DIFFUSE": ShaderReader._diffuse,
    "BSDF_GLASS": ShaderReader._glass,
    "BSDF_GLOSSY": ShaderReader._glossy,
    "BSDF_METALLIC": ShaderReader._metallic,
    "BSDF_PRINCIPLED": ShaderReader._principled,
    "BSDF_REFRACTION": ShaderReader._glass,
    "BSDF_TRANSPARENT": ShaderReader._transparent,
    "EMISSION": ShaderReader._emit,
    "HOLDOUT": ShaderReader._holdout,
    "MIX_SHADER": ShaderReader._mix,
}
