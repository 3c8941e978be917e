"""Settings that Lancer adds to scenes.

Files store the numbers of enum items: never renumber or reuse them.
"""

import bpy
from bpy.app.handlers import persistent
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..bindings.structs import SETTINGS
from ..denoise.view_layer import missing
from ..host.main_thread import ENGINE
from ..host.registering import add_handlers, remove_handlers

_GIVEN = {name: given for name, (_, given) in SETTINGS.items()}

# Target error and the limit of samples of each preset.
QUALITIES = {"DRAFT": (0.1, 1024), "GOOD": (0.03, 8192), "FINAL": (0.01, 65536)}
_presets = []  # presets that are being applied


def _is(settings, quality):
    error, samples = QUALITIES[quality]
    return abs(settings.target_error - error) < 1e-6 and settings.samples == samples


def _quality_changed(self, _context):
    if self.quality in QUALITIES and not _is(self, self.quality):
        # After the first of the two changes the numbers fit no preset: _numbers_changed must not treat that as custom.
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
    defaults: IntProperty(
        name="Defaults",
        description="Which defaults the file was saved with; 0 = those of the first releases",
        options={"HIDDEN"},
    )
    time_limit: FloatProperty(
        name="Time Limit",
        description="End the render this many seconds after its start, once every pixel has a sample. Samples go to the "
        "pixels with the largest error. 0 = no limit",
        subtype="TIME_ABSOLUTE",
        min=0.0,
        soft_max=3600.0,
        default=0.0,
    )
    preview_samples: IntProperty(
        name="Viewport Samples",
        description="Samples per pixel after which a 3D view in Rendered shading stops; 0 = no limit",
        min=0,
        soft_max=4096,
        max=1 << 24,
        default=1024,
    )
    preview_start_resolution: IntProperty(
        name="Start Resolution",
        description="While a 3D view moves, and right after a change, it uses coarser pixels to show a picture at once, but "
        "at least this many along the shorter side",
        subtype="PIXEL",
        min=8,
        soft_max=1024,
        max=16384,
        default=64,
    )
    use_preview_denoising: BoolProperty(
        name="Viewport Denoising",
        description="Remove noise from 3D views in Rendered shading with Blender's Open Image Denoise",
        default=False,
    )
    use_denoising_samples: BoolProperty(
        name="Keep Samples",
        description="Combine the denoised picture with its samples where that lowers the estimated error, so that it converges "
        "to the truth as samples rise. Off: the denoised picture alone",
        default=True,
    )
    use_denoised_target: BoolProperty(
        name="Target of Denoised Picture",
        description="The target error is that of the denoised picture, which is checked each time the samples have doubled. "
        "Off: that of the picture before denoising",
        default=True,
    )
    use_resume: BoolProperty(
        name="Resume",
        description="Keep the samples of F12 in a file beside the output, written now and then and at the end. The next render "
        "of the same scene continues from it, after Esc, a crash, or with more samples, to the picture of one long render",
        default=False,
    )
    use_many_machines: BoolProperty(
        name="Many Machines",
        description="F12 renders on the workers of a scheduler instead of this machine, to the same picture",
        default=False,
    )
    scheduler: StringProperty(
        name="Scheduler",
        description="Address of a Dask scheduler, as tcp://192.168.1.10:8786 or tls://farm:8786; local: two workers on this "
        "machine",
        default="",
    )
    seed: IntProperty(name="Seed", description="Number that selects the pattern of noise", min=0, default=0)
    use_animated_seed: BoolProperty(
        name="Animate Seed", description="Use a different pattern of noise in each frame of an animation", default=False
    )
    max_bounces: IntProperty(
        name="Max Bounces",
        description="Largest number of bounces of light between surfaces; in Classic, the depth of reflections and refractions",
        min=0,
        soft_max=64,
        max=1024,
        default=_GIVEN["max_bounces"],
    )
    diffuse_bounces: IntProperty(
        name="Diffuse Bounces",
        description="Largest number of diffuse reflections of a path, below the total. Makes the picture too dark",
        min=0,
        soft_max=64,
        max=1024,
        default=_GIVEN["diffuse_bounces"],
    )
    glossy_bounces: IntProperty(
        name="Glossy Bounces",
        description="Largest number of glossy reflections of a path, below the total. Makes the picture too dark",
        min=0,
        soft_max=64,
        max=1024,
        default=_GIVEN["glossy_bounces"],
    )
    transmission_bounces: IntProperty(
        name="Transmission Bounces",
        description="Largest number of refractions of a path, below the total. Makes the picture too dark",
        min=0,
        soft_max=64,
        max=1024,
        default=_GIVEN["transmission_bounces"],
    )
    filter_glossy: FloatProperty(
        name="Filter Glossy",
        description="Blur glossy surfaces behind blurred reflections, to reduce the noise of caustics. Blurs light; 0 = off",
        min=0.0,
        soft_max=10.0,
        default=_GIVEN["filter_glossy"],
    )
    contribution_threshold: FloatProperty(
        name="Contribution Threshold",
        description="Classic: do not trace rays that contribute less than this share to their pixel; 0 = trace all",
        min=0.0,
        soft_max=0.1,
        precision=4,
        default=_GIVEN["contribution_threshold"],
    )
    transparent_bounces: IntProperty(
        name="Transparent Bounces",
        description="Largest number of transparent surfaces that a ray passes in a row; the next one shows only its emission",
        min=0,
        soft_max=64,
        max=1023,
        default=_GIVEN["transparent_bounces"],
    )
    environment_reflections: BoolProperty(
        name="Environment Reflections",
        description="Classic: mirrors and glass show only the environment, without tracing rays. Fast, but without the scene",
        default=False,
    )
    clamp_indirect: FloatProperty(
        name="Clamp Indirect",
        description="Limit of a sample's indirect light, to avoid fireflies. Makes the picture too dark; 0 = off",
        min=0.0,
        soft_max=100.0,
        default=_GIVEN["clamp_indirect"],
    )
    pixel_filter: EnumProperty(
        name="Pixel Filter",
        description="How samples are weighted within a pixel",
        items=(
            ("BOX", "Box", "Each pixel is the mean over its own area", 0),
            ("BLACKMAN_HARRIS", "Blackman-Harris", "Smooth edges, as in Cycles", 1),
        ),
        default="BLACKMAN_HARRIS",
    )
    filter_width: FloatProperty(
        name="Filter Width",
        description="Width of the Blackman-Harris filter, as in Cycles: its extent to each side; wider is softer",
        subtype="PIXEL",
        min=0.01,
        soft_max=3.0,
        max=10.0,
        default=1.5,
    )
    film_transparent_glass: BoolProperty(
        name="Transparent Glass",
        description="With a transparent film, glass is transparent too, for compositing over another picture",
        default=False,
    )
    film_transparent_roughness: FloatProperty(
        name="Roughness Threshold",
        description="Glass with a higher roughness stays opaque",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
        default=0.1,
    )
    use_check: BoolProperty(
        name="Check at Render",
        description="Run quick checks for faults before each render and list them with the messages",
        default=True,
    )
    accelerator: EnumProperty(
        name="Accelerator",
        description="Data structure for finding the surfaces that rays hit. Changes the time, never the picture",
        items=(
            ("BVH", "BVH", "Nested boxes: the fastest for nearly all scenes", 0),
            ("KDTREE", "kd-Tree", "Space divided by planes", 1),
            ("BRUTE_FORCE", "Brute Force", "Every surface for every ray: only to verify the others", 2),
        ),
        default="BVH",
    )
    features: EnumProperty(
        name="Features",
        description="Version of the renderer's inner loop. Changes the time, never the picture",
        items=(
            ("SCENE", "Scene", "The version with only the features that this scene uses", 0),
            ("ALL", "All", "The version with all features: only to verify the other", 1),
        ),
        default="SCENE",
    )


# The defaults of files saved before a scene recorded which defaults it has.
_FIRST_DEFAULTS = {"quality": "CUSTOM", "target_error": 0.0, "samples": 256, "use_denoising": False, "max_bounces": 10}


def keep_first_defaults(scene):
    """Give a scene of an old file the values that it was saved with. Files store no default, so a new one would change them."""
    own = scene.lancer
    if own.defaults or scene.render.engine != ENGINE or scene.library is not None:
        return
    kept = {name: getattr(own, name) if own.is_property_set(name) else value for name, value in _FIRST_DEFAULTS.items()}
    # Custom first: it changes no number, and no number changes it.
    for name in _FIRST_DEFAULTS:
        setattr(own, name, kept[name] if name != "quality" else "CUSTOM")
    own.quality = kept["quality"]
    own.defaults = 1


@persistent
def _loaded(*_):
    # A new file, from the startup file, has no path and starts with the defaults.
    if not bpy.data.filepath:
        return
    for scene in bpy.data.scenes:
        keep_first_defaults(scene)


@persistent
def _saving(*_):
    for scene in bpy.data.scenes:
        if scene.library is None:
            scene.lancer.defaults = 1


_HANDLERS = (("load_post", _loaded), ("save_pre", _saving))


def register_handlers():
    add_handlers(_HANDLERS)


def unregister_handlers():
    remove_handlers(_HANDLERS)


_WATCHED = ("integrator", "use_denoising", "use_pass_error", "use_pass_albedo", "quality", "target_error", "samples")


def add_watched(scene):
    """Add the properties with an update function. As annotations they make bpy 4.2 crash at exit."""
    scene.integrator = EnumProperty(
        name="Integrator",
        description="Method by which light is computed",
        items=(
            (
                "PATH",
                "Path Tracing",
                "Global illumination: indirect light, soft shadows, caustics. More samples reduce the noise",
                0,
            ),
            ("CLASSIC", "Classic", "Recursive ray tracing: direct light, mirrors and glass. Fast and without noise", 1),
            ("NORMALS", "Normals", "Surface normals as colours, to check geometry", 2),
        ),
        default="PATH",
        update=_passes_changed,
    )
    scene.use_denoising = BoolProperty(
        name="Denoising",
        description="Remove noise from the finished picture with Blender's Open Image Denoise, which can also remove details. "
        "The pass Noisy Image keeps the picture before denoising; the error of both is reported",
        # As Blender's for Cycles.
        default=not missing(),
        update=_passes_changed,
    )
    scene.use_pass_error = BoolProperty(
        name="Lancer Error",
        description="Standard error of each pixel's luminance: 95 % of the pixels are correct within 1.96 times this value. "
        "With Denoising, the pass Lancer Denoised Error is that of the denoised picture",
        default=False,
        update=_passes_changed,
    )
    scene.use_pass_albedo = BoolProperty(
        name="Denoising Albedo",
        description="Surface colours without light, for denoisers",
        default=False,
        update=_passes_changed,
    )
    scene.quality = EnumProperty(
        name="Quality",
        description="Accuracy of the picture: a preset, or your own numbers",
        items=(
            ("DRAFT", "Draft", "An error of 10 %: a quick look", 0),
            ("GOOD", "Good", "An error of 3 %: for most scenes", 1),
            ("FINAL", "Final", "An error of 1 %: hardly any visible noise", 2),
            ("CUSTOM", "Custom", "Your own target error and number of samples", 3),
        ),
        default="GOOD",
        update=_quality_changed,
    )
    scene.target_error = FloatProperty(
        name="Target Error",
        description="End the render when the error is below this with 95 % confidence: the root mean square over the pixels of "
        "the standard error, relative to the luminance plus 1 % of its mean. Samples go to the pixels with the largest "
        "error. 0 = off",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
        precision=4,
        default=QUALITIES["GOOD"][0],
        update=_numbers_changed,
    )
    scene.samples = IntProperty(
        name="Samples",
        description="Samples per pixel; with a target error, the limit of any pixel. Four times the samples halve the noise",
        min=1,
        soft_max=4096,
        max=1 << 24,
        default=QUALITIES["GOOD"][1],
        update=_numbers_changed,
    )


def remove_watched(scene):
    for name in _WATCHED:
        delattr(scene, name)
