"""Materials without one of their features, as an artist would simplify them.

Every function returns the same object if the material lacks the feature: identity of the result shows that it is unused.
"""

from __future__ import annotations

import dataclasses

from ..bindings.enums import Distribution, LobeKind, MaterialFlag, NodeKind
from ..bindings.parameters import is_zero, map_parameters, may_be_positive, parameters, sources, without_idle_nodes
from ..bindings.shading import Lobe, NodeRef

_BLACK = (0.0, 0.0, 0.0)
_GLASS = {LobeKind.DIELECTRIC, LobeKind.GLASS, LobeKind.REFRACTION}
_METAL = {LobeKind.MIRROR, LobeKind.GLOSSY, LobeKind.CONDUCTOR}
_GLOSS = {LobeKind.BECKMANN, LobeKind.PHONG, LobeKind.BLINN_PHONG}
_PICTURES = {NodeKind.IMAGE, NodeKind.ENVIRONMENT}
# Nodes whose results vary over a surface only if their inputs do.
_DULL = {
    NodeKind.ALPHA, NodeKind.MAPPING, NodeKind.TRANSFORM, NodeKind.MATH, NodeKind.VECTOR_MATH, NodeKind.MIX, NodeKind.SEPARATE,
    NodeKind.COMBINE, NodeKind.GREY, NodeKind.CLAMP, NodeKind.GAMMA, NodeKind.INVERT,
}  # fmt: skip


def _three(value):
    """Return a constant as three numbers; a single number becomes the first."""
    return value if isinstance(value, tuple) else (value, 0.0, 0.0)


def _with_lobes(material, change):
    """Return the material with change(lobe) for each lobe; change returns a lobe, or None to remove it."""
    lobes = [change(lobe) for lobe in material.lobes]
    if all(new is old for new, old in zip(lobes, material.lobes, strict=True)):
        return material
    return without_idle_nodes(material.replaced(lobes=tuple(lobe for lobe in lobes if lobe is not None)))


def _matt(lobe, color):
    # Keep the normal map or bump of the replaced lobe.
    return Lobe(LobeKind.LAMBERT, color=color, weight=lobe.weight, normal=lobe.normal, rules=lobe.rules)


def _principled(lobe, **values):
    """Return the lobe with these inputs of its Principled; the lobe itself if they are equal."""
    old = lobe.principled
    values = {name: value for name, value in values.items() if getattr(old, name) != value}
    return lobe.replaced(principled=old.replaced(**values)) if values else lobe


def opaque_glass(material):
    def change(lobe):
        if lobe.kind in _GLASS:
            return _matt(lobe, lobe.color)
        if lobe.principled is not None and may_be_positive(lobe.principled.transmission):
            return _principled(lobe, transmission=0.0)
        return lobe

    return _with_lobes(material, change)


def _color_of_metal(lobe):
    if lobe.kind != LobeKind.CONDUCTOR or lobe.option == 0:
        return lobe.color
    if isinstance(lobe.color, NodeRef) or isinstance(lobe.edge, NodeRef):
        return (0.8, 0.8, 0.8)
    # Reflectance at normal incidence for refractive index n and extinction k.
    return tuple(
        ((n - 1) ** 2 + k * k) / ((n + 1) ** 2 + k * k) for n, k in zip(_three(lobe.color), _three(lobe.edge), strict=True)
    )


def matt_metal(material):
    def change(lobe):
        if lobe.kind in _METAL:
            return _matt(lobe, _color_of_metal(lobe))
        if lobe.principled is not None and may_be_positive(lobe.principled.metallic):
            return _principled(lobe, metallic=0.0)
        return lobe

    return _with_lobes(material, change)


def _is_glossy(principled):
    return may_be_positive(principled.specular) and (isinstance(principled.ior, NodeRef) or principled.ior != 1.0)


def without_gloss(material):
    only = all(lobe.kind in _GLOSS for lobe in material.lobes)

    def change(lobe):
        if lobe.kind in _GLOSS:
            return _matt(lobe, lobe.color) if only else None
        if lobe.principled is not None and _is_glossy(lobe.principled):
            return _principled(lobe, specular=0.0)
        return lobe

    return _with_lobes(material, change)


def without_coat(material):
    return _with_lobes(material, lambda lobe: lobe if lobe.principled is None else _without_layer(lobe, "coat"))


def _without_layer(lobe, name):
    return _principled(lobe, **{name: 0.0}) if may_be_positive(getattr(lobe.principled, name)) else lobe


def without_sheen(material):
    only = all(lobe.kind == LobeKind.SHEEN for lobe in material.lobes)

    def change(lobe):
        if lobe.kind == LobeKind.SHEEN:
            return _matt(lobe, lobe.color) if only else None
        return lobe if lobe.principled is None else _without_layer(lobe, "sheen")

    return _with_lobes(material, change)


def without_translucency(material):
    return _with_lobes(material, lambda lobe: _matt(lobe, lobe.color) if lobe.kind == LobeKind.TRANSLUCENT else lobe)


def round_highlights(material):
    def change(lobe):
        if lobe.principled is not None:
            return lobe if is_zero(lobe.principled.anisotropic) else _principled(lobe, anisotropic=0.0)
        if lobe.kind in (LobeKind.GLOSSY, LobeKind.CONDUCTOR) and not is_zero(lobe.anisotropy):
            return dataclasses.replace(lobe, anisotropy=0.0, rotation=0.0, tangent=_BLACK)
        return lobe

    return _with_lobes(material, change)


def smooth_matt(material):
    def change(lobe):
        if lobe.kind == LobeKind.DIFFUSE and may_be_positive(lobe.roughness):
            return _matt(lobe, lobe.color)
        if lobe.kind == LobeKind.MINNAERT and lobe.shininess != 1.0:
            return _matt(lobe, lobe.color)
        return lobe if lobe.principled is None else _without_layer(lobe, "diffuse_roughness")

    return _with_lobes(material, change)


def single_scattering(material):
    """Return the material without multiple scattering between facets."""

    def change(lobe):
        if lobe.principled is not None and lobe.principled.distribution == Distribution.MULTI_GGX:
            return _principled(lobe, distribution=Distribution.GGX)
        if lobe.distribution == Distribution.MULTI_GGX and lobe.kind in _GLASS | _METAL:
            return dataclasses.replace(lobe, distribution=Distribution.GGX)
        return lobe

    return _with_lobes(material, change)


def opaque(material):
    if is_zero(material.transmittance):
        return material
    behind = sources(material.nodes, material.transmittance)
    shares = [lobe for lobe in material.lobes if sources(material.nodes, lobe.weight) & behind]
    rest = 1.0 if behind else 1.0 - sum(_three(material.transmittance)) / 3.0

    def change(owner, name, value):
        if owner == "lobe" and name == "weight" and sources(material.nodes, value) & behind:
            # Lobes that cover the surface partly now cover all of it.
            return (1.0 / len(shares),) * 3
        if owner == "lobe" and name == "weight" and not isinstance(value, NodeRef) and rest > 0.0:
            return tuple(min(1.0, x / rest) for x in _three(value))
        return _BLACK if (owner, name) == ("material", "transmittance") else value

    return without_idle_nodes(map_parameters(material.replaced(portals=()), change))


def dark(material):
    def change(owner, name, value):
        return value if name != "emission" or is_zero(value) else _BLACK

    return without_idle_nodes(map_parameters(material, change))


def undisplaced(material):
    if is_zero(material.displacement):
        return material
    flags = int(material.flags) & ~int(MaterialFlag.KEEP_NORMALS)
    return without_idle_nodes(dataclasses.replace(material, displacement=_BLACK, flags=flags))


def even_normals(material):
    if not material.nodes:
        return material

    def change(owner, name, value):
        return _BLACK if name in ("normal", "coat_normal") and isinstance(value, NodeRef) else value

    return without_idle_nodes(map_parameters(material, change))


def _is_of_the_surface(owner, name):
    return name not in ("normal", "coat_normal", "tangent", "displacement")


def _varied(material, pictured):
    """Return the numbers of the nodes whose results are parameters other than normals and vary over the surface. pictured: only
    results that depend on images; otherwise only results that do not. If a node controls the transmittance, the material's own
    parameters and the lobes' weights are left out, because they depend on each other.
    """
    nodes, found = material.nodes, set()
    if not nodes:
        return found
    cut = isinstance(material.transmittance, NodeRef)
    for owner, name, value in parameters(material):
        if not isinstance(value, NodeRef) or not _is_of_the_surface(owner, name):
            continue
        if cut and (name == "weight" or owner == "material"):
            continue
        kinds = {nodes[number].kind for number in sources(nodes, value)}
        if bool(kinds & _PICTURES) == pictured and kinds - _DULL:
            found.add(value.node)
    return found


def pictured_nodes(material):
    return _varied(material, True)


def computed_nodes(material):
    return _varied(material, False)


def with_constants(material, values):
    """Replace parameters that refer to nodes by values, {node: three numbers}, except the parameters that _varied omits."""
    cut = isinstance(material.transmittance, NodeRef)

    def change(owner, name, value):
        if not isinstance(value, NodeRef) or value.node not in values or not _is_of_the_surface(owner, name):
            return value
        return value if cut and (name == "weight" or owner == "material") else tuple(values[value.node])

    return without_idle_nodes(map_parameters(material, change))
