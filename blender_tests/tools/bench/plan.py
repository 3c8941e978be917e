"""What is measured: renderers, scenes, sizes, samples, rounds."""

from dataclasses import dataclass, replace

from tools.harness.terminal import wanted


@dataclass(frozen=True)
class Renderer:
    key: str
    title: str
    tolerance: float  # of the median of block differences, as a share of the picture's level
    engine: str = ""  # of Blender, or
    module: str = ""  # an adapter of bench.peers
    option: str | None = None
    same_picture_as: str = ""  # another key, whose converged picture is this one's too


# Cycles computes the same light by the same models, so that only noise should differ: a twentieth is what blocks of 64
# pixels at 32 samples show of it in the noisiest scene. Principled, between diffuse and metal, is another model elsewhere.
# Mitsuba's gives back 1 to 5 % more light of a lamp or a sky (measured on one grey triangle), and as much again where light
# meets several surfaces. LuxCore's Disney material gives back 9 to 17 % less, a third where light meets several surfaces: the
# same work at another brightness.
RENDERERS = (
    Renderer("lancer", "Lancer", 0.0, engine="LANCER"),
    Renderer("cycles", "Cycles", 0.05, engine="CYCLES"),
    Renderer("mitsuba_llvm", "Mitsuba llvm_ad_rgb", 0.15, module="mitsuba", option="llvm_ad_rgb"),
    Renderer(
        "mitsuba_scalar", "Mitsuba scalar_rgb", 0.15, module="mitsuba", option="scalar_rgb", same_picture_as="mitsuba_llvm"
    ),
    Renderer("luxcore", "LuxCore PATHCPU", 0.35, module="luxcore"),
)
BY_KEY = {renderer.key: renderer for renderer in RENDERERS}


@dataclass(frozen=True)
class Scene:
    """rounds: of one seed each; reference: samples a pixel of the converged picture, 0 = no errors are measured."""

    name: str
    title: str
    width: int = 256
    height: int = 192
    samples: int = 64
    rounds: int = 5
    reference: int = 1024
    renderers: tuple = tuple(renderer.key for renderer in RENDERERS)
    exact: bool = False  # Cycles would trace the meshes that stand in for exact shapes
    lifelike: bool = False  # as files of artists are; judged by itself


def _lifelike(name, title):
    size = {"width": 512, "height": 384, "samples": 32, "reference": 512}
    return Scene(name, title, **size, renderers=("lancer", "cycles"), lifelike=True)


SCENES = (
    Scene("balls", "60 balls, 238 082 triangles"),
    Scene("balls_exact", "the same as exact spheres", exact=True),
    Scene("room", "closed room, indirect light"),
    Scene("glass_metal", "glass and metal under the sun"),
    Scene("lights200", "200 lamps of unequal power"),
    Scene("instances", "20 000 instances of 15 744 triangles", samples=32),
    Scene("models", "bunny and spot, textured, under a pictured sky"),
    Scene("textured", "the same with roughness and normals by images", renderers=("lancer", "cycles")),
    Scene("coated", "60 balls: brushed, with sheen, with tinted coat", renderers=("lancer", "cycles")),
    Scene("leaves", "a tree of cut-out leaves"),
    Scene("triangle", "one triangle", samples=256, reference=2048),
    # As files of artists are: images in every slot, passes ticked, large lamps, much geometry.
    _lifelike("daylight", "a million triangles lit through windows, with passes"),
    _lifelike("product", "a product between softboxes, with passes"),
    _lifelike("foliage", "a wood of cut-out leaves, with passes"),
    # What lamps cost, measured against each other: no part of the comparison, whose mean the many would carry alone.
    Scene("lights2", "two lamps", rounds=3, reference=0, renderers=("lancer",)),
    Scene("lights10k", "10 000 lamps", samples=4, rounds=3, reference=0, renderers=("lancer",)),
)

# Where a short run measures errors, and beside whom.
_QUICK_ERRORS = ("balls", "room")
_QUICK_RENDERERS = ("lancer", "cycles", "mitsuba_llvm")


def _quick(scene):
    small = replace(scene, width=128, height=96, samples=max(min(16, scene.samples), scene.samples // 2))
    if scene.name in _QUICK_ERRORS:
        return replace(small, reference=256, renderers=_QUICK_RENDERERS)
    renderers = _QUICK_RENDERERS if scene.name == "instances" else scene.renderers
    return replace(small, rounds=1, reference=0, renderers=renderers)


def scenes(only="", quick=False):
    """The scenes whose names match one of the comma-separated patterns; all without any."""
    return [_quick(scene) if quick else scene for scene in SCENES if wanted(only, scene.name)]
