"""Settings that Lancer adds to scenes, objects, materials, lights and worlds.

Items of enums carry numbers that files store: never renumber, never reuse.
"""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty

from .registering import add_all

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


def _color(name, description, default):
    return FloatVectorProperty(
        name=name, description=description, subtype="COLOR", size=3, min=0.0, soft_max=1.0, default=(default,) * 3
    )


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


class LancerObjectSettings(bpy.types.PropertyGroup):
    shape: EnumProperty(
        name="Shape",
        description="Trace the mesh itself, or the exact surface that fits its bounding box",
        items=(
            ("MESH", "Mesh", "The mesh as it is", 0),
            ("SPHERE", "Sphere", "An exact sphere or ellipsoid in the mesh's bounding box", 1),
            ("PLANE", "Plane", "A plane without end through the middle of the mesh's bounding box, facing its Z", 2),
            ("CYLINDER", "Cylinder", "An exact closed cylinder along Z in the mesh's bounding box", 3),
            ("CONE", "Cone", "An exact closed cone with its tip at +Z in the mesh's bounding box", 4),
        ),
        default="MESH",
    )
    shading: EnumProperty(
        name="Shading",
        description="How light varies over a face",
        items=(
            ("AS_MESH", "As Mesh", "Smooth and flat faces as the mesh has them", 0),
            (
                "FLAT",
                "Flat",
                "One direction for each face. In Classic one colour for each face, computed at its centre; in Path Tracing "
                "light still varies over it",
                1,
            ),
            (
                "GOURAUD",
                "Gouraud",
                "Light is computed at the vertices and blended between them (Classic; elsewhere as Phong)",
                2,
            ),
            ("PHONG", "Phong", "Directions are blended between the vertices", 3),
        ),
        default="AS_MESH",
    )


class LancerMaterialSettings(bpy.types.PropertyGroup):
    model: EnumProperty(
        name="Model",
        description="Where the material's look comes from",
        items=(
            ("NODES", "Nodes", "The material's shader nodes", 0),
            ("KD_KS", "Diffuse and Coat", "A matt body under a rough, clear layer", 1),
            ("PHONG", "Phong", "A matt body with Phong's highlight", 2),
            ("BLINN_PHONG", "Blinn-Phong", "A matt body with Blinn's highlight", 3),
            ("MINNAERT", "Minnaert", "A matt body whose rim is darker, or brighter as the moon's", 4),
        ),
        default="NODES",
    )
    ka: _color("Ambient", "Share of ambient light that the surface shows: the world's, and that of lamps (Classic only)", 0.0)
    kd: _color("Diffuse", "Colour of the matt body", 0.8)
    ks: _color("Specular", "Colour of the highlight or of the clear layer", 0.2)
    roughness: FloatProperty(
        name="Roughness",
        description="Roughness of the clear layer, as the alpha of Beckmann's formula (Blender's roughness is its square root)",
        min=0.0,
        max=1.0,
        precision=4,
        default=0.2,
    )
    ior: FloatProperty(
        name="IOR", description="Index of refraction of the clear layer", min=1e-3, soft_min=1.0, soft_max=3.0, default=1.5
    )
    shininess: FloatProperty(
        name="Shininess",
        description="Exponent of the highlight: larger is smaller and sharper",
        min=0.0,
        soft_max=1000.0,
        default=50.0,
    )
    darkness: FloatProperty(
        name="Darkness",
        description="Exponent k of Minnaert's law: 1 is even; more darkens the rim; less brightens it, as far as no more light "
        "comes back than arrives",
        min=0.0,
        soft_max=4.0,
        default=1.5,
    )


class LancerLightSettings(bpy.types.PropertyGroup):
    falloff: EnumProperty(
        name="Falloff",
        description="How the light weakens with distance (Classic only; Path Tracing is always physical)",
        items=(
            ("PHYSICAL", "Physical", "With the square of the distance, as in nature", 0),
            ("CONSTANT", "Constant", "Not at all", 1),
            ("LINEAR", "Linear", "Evenly, to nothing at the radius", 2),
            ("QUADRATIC", "Quadratic", "Slowly at first, to nothing at the radius", 3),
            ("SMOOTH", "Smooth", "With soft ends, to nothing at the radius", 4),
            ("GAUSSIAN", "Gaussian", "As a bell curve whose width is the radius", 5),
        ),
        default="PHYSICAL",
    )
    radius: FloatProperty(
        name="Radius",
        description="Distance over which the light weakens",
        subtype="DISTANCE",
        min=1e-6,
        soft_max=1000.0,
        default=10.0,
    )
    use_ambient: BoolProperty(
        name="Ambient Light",
        description="The light reaches surfaces with an ambient colour from everywhere too, whatever their direction and what "
        "stands between (Classic only)",
        default=True,
    )
    use_separate_colors: BoolProperty(
        name="Separate Colors",
        description="Give ambient, diffuse and specular light factors of their own (Classic only)",
        default=False,
    )
    ambient_color: _color("Ambient", "Factor of the light's colour for ambient light", 1.0)
    diffuse_color: _color("Diffuse", "Factor of the light's colour for diffuse light", 1.0)
    specular_color: _color("Specular", "Factor of the light's colour for highlights", 1.0)


def _side(direction):
    return PointerProperty(
        name=direction, description=f"Picture that is seen when looking along {direction} of the world", type=bpy.types.Image
    )


class LancerWorldSettings(bpy.types.PropertyGroup):
    use_ambient_color: BoolProperty(
        name="Ambient Color",
        description="Give light from everywhere, which a material's Ambient shows, a colour of its own in place of the world's "
        "mean. It is added once, whatever the lamps (Classic only)",
        default=False,
    )
    ambient_color: _color("Ambient Color", "Light from everywhere, the same at every place (Classic only)", 0.1)
    use_cube: BoolProperty(
        name="Cube Environment",
        description="Surround the scene with six pictures, one for each side of a cube, in place of the world's nodes",
        default=False,
    )
    cube_strength: FloatProperty(
        name="Strength", description="Factor of the pictures' brightness", min=0.0, soft_max=10.0, default=1.0
    )
    cube_positive_x: _side("+X")
    cube_negative_x: _side("-X")
    cube_positive_y: _side("+Y")
    cube_negative_y: _side("-Y")
    cube_positive_z: _side("+Z")
    cube_negative_z: _side("-Z")


def _add_watched(scene):
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


_WATCHED = ("integrator", "use_denoising", "use_pass_error", "use_pass_albedo", "quality", "target_error", "samples")
_GROUPS = (
    (LancerSceneSettings, bpy.types.Scene),
    (LancerObjectSettings, bpy.types.Object),
    (LancerMaterialSettings, bpy.types.Material),
    (LancerLightSettings, bpy.types.Light),
    (LancerWorldSettings, bpy.types.World),
)


def register():
    add_all(_GROUPS, _add, _remove)


def unregister():
    for item in reversed(_GROUPS):
        _remove(item)


def _add(item):
    group, owner = item
    bpy.utils.register_class(group)
    if group is LancerSceneSettings:
        _add_watched(group)
    owner.lancer = PointerProperty(type=group, name="Lancer")


def _remove(item):
    group, owner = item
    del owner.lancer
    if group is LancerSceneSettings:
        for name in _WATCHED:
            delattr(group, name)
    bpy.utils.unregister_class(group)
