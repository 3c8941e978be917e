"""Settings that Lancer adds to scenes.

Items of enums carry numbers that files store: never renumber, never reuse.
"""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

# Target error, and the most samples that may be spent on it.
QUALITIES = {"DRAFT": (0.1, 1024), "GOOD": (0.03, 8192), "FINAL": (0.01, 65536)}
_presets = []  # those that are being set


def _is(settings, quality):
    error, samples = QUALITIES[quality]
    return abs(settings.target_error - error) < 1e-6 and settings.samples == samples


def _quality_changed(self, _context):
    if self.quality in QUALITIES and not _is(self, self.quality):
        # The first of two changes fits no preset, and would be taken for a wish of the artist's.
        _presets.append(self.quality)
        self.target_error, self.samples = QUALITIES[self.quality]
        _presets.pop()


def _numbers_changed(self, _context):
    if not _presets and self.quality != "CUSTOM" and not _is(self, self.quality):
        self.quality = "CUSTOM"


def _passes_changed(self, _context):
    # The compositor's nodes have a socket for each pass.
    for layer in self.id_data.view_layers:
        layer.update_render_passes()


class LancerSceneSettings(bpy.types.PropertyGroup):
    time_limit: FloatProperty(
        name="Time Limit",
        description="End the render this many seconds after its start, once every pixel has a sample. The last go where "
        "the error is. 0 = no limit",
        subtype="TIME_ABSOLUTE",
        min=0.0,
        soft_max=3600.0,
        default=0.0,
    )
    preview_samples: IntProperty(
        name="Viewport Samples",
        description="Rays through each pixel of a 3D view in Rendered shading, after which it rests; 0 = it never does",
        min=0,
        soft_max=4096,
        max=1 << 24,
        default=1024,
    )
    preview_start_resolution: IntProperty(
        name="Start Resolution",
        description="While a 3D view moves, and right after a change, its pixels become as coarse as it takes to show a "
        "picture at once, but the shorter side keeps this many",
        subtype="PIXEL",
        min=8,
        soft_max=1024,
        max=16384,
        default=64,
    )
    use_preview_denoising: BoolProperty(
        name="Viewport Denoising",
        description="Have Blender's Open Image Denoise guess what lies under the noise of 3D views in Rendered shading",
        default=False,
    )
    seed: IntProperty(name="Seed", description="Another number gives another pattern of noise", min=0, default=0)
    use_animated_seed: BoolProperty(
        name="Animate Seed", description="Another pattern of noise in each frame of an animation", default=False
    )
    max_bounces: IntProperty(
        name="Max Bounces",
        description="How often light may bounce between surfaces; in Classic, how deep mirrors show mirrors",
        min=0,
        soft_max=64,
        max=1024,
        default=10,
    )
    contribution_threshold: FloatProperty(
        name="Contribution Threshold",
        description="Classic: a ray that brings its pixel no more than this share of what it meets is left out; 0 = trace all",
        min=0.0,
        soft_max=0.1,
        precision=4,
        default=0.0,
    )
    transparent_bounces: IntProperty(
        name="Transparent Bounces",
        description="Through how many transparent surfaces, one behind the other, light and camera see; beyond is black",
        min=0,
        soft_max=64,
        max=1023,
        default=8,
    )
    environment_reflections: BoolProperty(
        name="Environment Reflections",
        description="Classic: mirrors and glass show the environment alone, without tracing a ray. Fast, blind to the scene",
        default=False,
    )
    clamp_indirect: FloatProperty(
        name="Clamp Indirect",
        description="Limit of a sample's indirect light, against bright specks. Makes the picture too dark; 0 = off",
        min=0.0,
        soft_max=100.0,
        default=0.0,
    )
    pixel_filter: EnumProperty(
        name="Pixel Filter",
        description="How neighbouring samples are weighed within a pixel",
        items=(
            ("BOX", "Box", "Each pixel is the plain mean of its own area", 0),
            ("BLACKMAN_HARRIS", "Blackman-Harris", "Smooth edges, as in Cycles", 1),
        ),
        default="BLACKMAN_HARRIS",
    )
    filter_width: FloatProperty(
        name="Filter Width",
        description="Width of the Blackman-Harris filter as Cycles counts it: how far it reaches to each side; wider is softer",
        subtype="PIXEL",
        min=0.01,
        soft_max=3.0,
        max=10.0,
        default=1.5,
    )
    film_transparent_glass: BoolProperty(
        name="Transparent Glass",
        description="With a transparent film, glass lets it show through, for compositing over another picture",
        default=False,
    )
    film_transparent_roughness: FloatProperty(
        name="Roughness Threshold",
        description="Rougher glass than this stays opaque",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
        default=0.1,
    )
    use_check: BoolProperty(
        name="Check at Render",
        description="Before each render look for what will hurt, as far as that takes no time, and tell it with the messages",
        default=True,
    )
    accelerator: EnumProperty(
        name="Accelerator",
        description="How the surfaces are sorted so that rays find them. Changes the time, never the picture",
        items=(
            ("BVH", "BVH", "Nested boxes: the fastest for nearly all scenes", 0),
            ("KDTREE", "kd-Tree", "Space cut by planes", 1),
            ("BRUTE_FORCE", "Brute Force", "Every surface for every ray: only to check the others", 2),
        ),
        default="BVH",
    )
    features: EnumProperty(
        name="Features",
        description="Which version of the renderer's inner loop runs. Changes the time, never the picture",
        items=(
            ("SCENE", "Scene", "The one made for what this scene uses", 0),
            ("ALL", "All", "The general one: only to check the other", 1),
        ),
        default="SCENE",
    )


_WATCHED = ("integrator", "use_denoising", "use_pass_error", "use_pass_albedo", "quality", "target_error", "samples")


def add_watched(scene):
    """Properties with an update function: as annotations they make bpy 4.2 crash at exit; added and deleted they do not."""
    scene.integrator = EnumProperty(
        name="Integrator",
        description="How light is followed through the scene",
        items=(
            (
                "PATH",
                "Path Tracing",
                "Global illumination: light that bounces, soft shadows, caustics. Noise falls with samples",
                0,
            ),
            ("CLASSIC", "Classic", "Recursive ray tracing: direct light, mirrors and glass. Fast and free of noise", 1),
            ("NORMALS", "Normals", "Surface directions as colours, to check geometry", 2),
        ),
        default="PATH",
        update=_passes_changed,
    )
    scene.use_denoising = BoolProperty(
        name="Denoising",
        description="Have Blender's Open Image Denoise guess what lies under the noise of the finished picture. "
        "As it was rendered it stays as the pass Noisy Image, and the error that is told is that pass's own",
        default=False,
        update=_passes_changed,
    )
    scene.use_pass_error = BoolProperty(
        name="Lancer Error",
        description="Also give the standard error of each pixel's luminance: 95 % of the pixels are within 1.96 of it",
        default=False,
        update=_passes_changed,
    )
    scene.use_pass_albedo = BoolProperty(
        name="Denoising Albedo",
        description="Also render the surface colours without light, which denoisers use",
        default=False,
        update=_passes_changed,
    )
    scene.quality = EnumProperty(
        name="Quality",
        description="How accurate the picture shall be: a preset, or your own numbers",
        items=(
            ("DRAFT", "Draft", "An error of 10 %: a quick look", 0),
            ("GOOD", "Good", "An error of 3 %: for most scenes", 1),
            ("FINAL", "Final", "An error of 1 %: hardly any noise is left", 2),
            ("CUSTOM", "Custom", "Your own target error and number of samples", 3),
        ),
        default="CUSTOM",
        update=_quality_changed,
    )
    scene.target_error = FloatProperty(
        name="Target Error",
        description="End the render when, with 95 % confidence, the picture is no farther than this from the finished one: the "
        "root mean square over pixels of the standard error, relative to luminance plus 1 % of its mean. Samples go where the "
        "error is. 0 = off",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
        precision=4,
        default=0.0,
        update=_numbers_changed,
    )
    scene.samples = IntProperty(
        name="Samples",
        description="Rays through each pixel; with a target error, the most that any gets. Four times as many halve the noise",
        min=1,
        soft_max=4096,
        max=1 << 24,
        default=256,
        update=_numbers_changed,
    )


def remove_watched(scene):
    for name in _WATCHED:
        delattr(scene, name)
