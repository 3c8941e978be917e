"""The plan of the benchmark: renderers, scenes, sizes, samples, rounds."""

from dataclasses import dataclass, replace

from tools.harness.terminal import wanted


@dataclass(frozen=True)
class Renderer:
    key: str
    title: str
    tolerance: float  # of the median of block differences, as a share of the picture's level
    engine: str = ""  # an engine of Blender, or
    module: str = ""  # an adapter of bench.peers
    option: str | None = None
    same_picture_as: str = ""  # key of a renderer that converges to the same picture


# Cycles has the same materials and lights, so that pictures should differ by noise alone: up to a twentieth in blocks of 64
# pixels at 32 samples of the noisiest scene. Other renderers have another Principled model between diffuse and metal.
# Mitsuba's reflects 1 to 5 % more light of a lamp or a sky (measured on one grey triangle), and as much again over several
# bounces. LuxCore's Disney material reflects 9 to 17 % less, a third less over several bounces: the same work at another
# brightness.
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
    """rounds: one seed each; reference: samples per pixel of the converged picture, 0 = no errors are measured."""

    name: str
    title: str
    width: int = 256
    height: int = 192
    samples: int = 64
    rounds: int = 5
    reference: int = 1024
    renderers: tuple = tuple(renderer.key for renderer in RENDERERS)
    exact: bool = False  # it has exact shapes, in place of which Cycles would trace meshes
    # Scenes with goals of their own: "lifelike" resemble artists' files, "moving" ones are blurred by motion.
    group: str = ""


def _lifelike(name, title):
    size = {"width": 512, "height": 384, "samples": 32, "reference": 512}
    return Scene(name, title, **size, renderers=("lancer", "cycles"), group="lifelike")


def _moving(name, title):
    return replace(_lifelike(name, title), group="moving")


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
    Scene("sixty_nodes", "60 nodes, of which 13 do not fold", renderers=("lancer", "cycles")),
    Scene("procedural_floor", "planks by textures without an image", renderers=("lancer", "cycles")),
    Scene("leaves", "a tree of cut-out leaves"),
    Scene("triangle", "one triangle", samples=256, reference=2048),
    # Like artists' files: images in every slot, passes, large lamps, much geometry.
    _lifelike("daylight", "a million triangles lit through windows, with passes"),
    _lifelike("product", "a product between softboxes, with passes"),
    _lifelike("foliage", "a wood of cut-out leaves, with passes"),
    _moving("runner", "a running character, motion blur"),
    _moving("flight", "the camera flies through the wood, motion blur"),
    # One feature each, which the other scenes lack.
    Scene("wax", "a head of wax, light below its surface", renderers=("lancer", "cycles")),
    Scene("sun", "columns under sky and sun", renderers=("lancer", "cycles")),
    # The cost of lamps, compared with each other and left out of the means, which 10 000 lamps would dominate.
    Scene("lights2", "two lamps", rounds=3, reference=0, renderers=("lancer",)),
    Scene("lights10k", "10 000 lamps", samples=4, rounds=3, reference=0, renderers=("lancer",)),
)

# The scenes and renderers of which a short run measures errors.
_QUICK_ERRORS = ("balls", "room")
_QUICK_RENDERERS = ("lancer", "cycles", "mitsuba_llvm")


def _quick(scene):
    small = replace(scene, width=128, height=96, samples=max(min(16, scene.samples), scene.samples // 2))
    if scene.name in _QUICK_ERRORS:
        return replace(small, reference=256, renderers=_QUICK_RENDERERS)
    renderers = _QUICK_RENDERERS if scene.name == "instances" else scene.renderers
    return replace(small, rounds=1, reference=0, renderers=renderers)


def scenes(only="", quick=False):
    """Return the scenes whose names match one of the comma-separated patterns, or all if there are no patterns."""
    return [_quick(scene) if quick else scene for scene in SCENES if wanted(only, scene.name)]
