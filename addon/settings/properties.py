"""Settings that Lancer adds to objects, materials, lights and worlds; registration of all settings.

Files store the numbers of enum items: never renumber or reuse them.
"""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, PointerProperty

from ..host.registering import add_all
from .scene_settings import LancerSceneSettings, add_watched, register_handlers, remove_watched, unregister_handlers


def _color(name, description, default):
    return FloatVectorProperty(
        name=name, description=description, subtype="COLOR", size=3, min=0.0, soft_max=1.0, default=(default,) * 3
    )


class LancerObjectSettings(bpy.types.PropertyGroup):
    shape: EnumProperty(
        name="Shape",
        description="Trace the mesh itself, or the exact surface that fits its bounding box",
        items=(
            ("MESH", "Mesh", "The mesh itself", 0),
            ("SPHERE", "Sphere", "An exact sphere or ellipsoid in the mesh's bounding box", 1),
            ("PLANE", "Plane", "An infinite plane through the centre of the mesh's bounding box, facing its Z", 2),
            ("CYLINDER", "Cylinder", "An exact closed cylinder along Z in the mesh's bounding box", 3),
            ("CONE", "Cone", "An exact closed cone with its tip at +Z in the mesh's bounding box", 4),
        ),
        default="MESH",
    )
    shading: EnumProperty(
        name="Shading",
        description="How light varies over a face",
        items=(
            ("AS_MESH", "As Mesh", "The mesh's own smooth and flat faces", 0),
            (
                "FLAT",
                "Flat",
                "One normal for each face. In Classic one colour for each face, computed at its centre; in Path Tracing "
                "light still varies over the face",
                1,
            ),
            (
                "GOURAUD",
                "Gouraud",
                "Light is computed at the vertices and interpolated (Classic only; otherwise as Phong)",
                2,
            ),
            ("PHONG", "Phong", "Normals are interpolated between the vertices", 3),
        ),
        default="AS_MESH",
    )


class LancerMaterialSettings(bpy.types.PropertyGroup):
    model: EnumProperty(
        name="Model",
        description="The material's nodes, or a model of the course with settings of its own",
        items=(
            ("NODES", "Nodes", "The material's shader nodes", 0),
            ("KD_KS", "Diffuse and Coat", "A diffuse base under a rough, clear layer", 1),
            ("PHONG", "Phong", "A diffuse base with Phong's highlight", 2),
            ("BLINN_PHONG", "Blinn-Phong", "A diffuse base with Blinn's highlight", 3),
            ("MINNAERT", "Minnaert", "A diffuse surface with a darker rim, or a brighter one like the moon's", 4),
        ),
        default="NODES",
    )
    ka: _color("Ambient", "Share of the ambient light of world and lamps that the surface reflects (Classic only)", 0.0)
    kd: _color("Diffuse", "Colour of the diffuse base", 0.8)
    ks: _color("Specular", "Colour of the highlight or of the clear layer", 0.2)
    roughness: FloatProperty(
        name="Roughness",
        description="Roughness of the clear layer: alpha of the Beckmann distribution (Blender's roughness is its square root)",
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
        description="Exponent of the highlight: larger exponents make it smaller and sharper",
        min=0.0,
        soft_max=1000.0,
        default=50.0,
    )
    darkness: FloatProperty(
        name="Darkness",
        description="Exponent k of Minnaert's law: 1 is Lambert's law, larger values darken the rim, smaller ones brighten it "
        "as far as the surface reflects no more light than it receives",
        min=0.0,
        soft_max=4.0,
        default=1.5,
    )


class LancerLightSettings(bpy.types.PropertyGroup):
    falloff: EnumProperty(
        name="Falloff",
        description="How the light decreases with distance (Classic only; Path Tracing is always physical)",
        items=(
            ("PHYSICAL", "Physical", "With the square of the distance, as in nature", 0),
            ("CONSTANT", "Constant", "No decrease", 1),
            ("LINEAR", "Linear", "Linearly, to zero at the radius", 2),
            ("QUADRATIC", "Quadratic", "Slowly at first, to zero at the radius", 3),
            ("SMOOTH", "Smooth", "With smooth ends, to zero at the radius", 4),
            ("GAUSSIAN", "Gaussian", "As a bell curve with the radius as its width", 5),
        ),
        default="PHYSICAL",
    )
    radius: FloatProperty(
        name="Radius",
        description="Distance over which the light decreases",
        subtype="DISTANCE",
        min=1e-6,
        soft_max=1000.0,
        default=10.0,
    )
    use_ambient: BoolProperty(
        name="Ambient Light",
        description="The light also adds ambient light, which surfaces with an ambient colour reflect whatever their direction "
        "and without shadows (Classic only)",
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
        name=direction, description=f"Image for the side of the cube in the world's direction {direction}", type=bpy.types.Image
    )


class LancerWorldSettings(bpy.types.PropertyGroup):
    use_ambient_color: BoolProperty(
        name="Ambient Color",
        description="Use a colour of its own for the ambient light that a material's Ambient reflects, instead of the world's "
        "mean colour. It is added once, whatever the number of lamps (Classic only)",
        default=False,
    )
    ambient_color: _color("Ambient Color", "Ambient light, equal everywhere and from all directions (Classic only)", 0.1)
    use_cube: BoolProperty(
        name="Cube Environment",
        description="Surround the scene with six images, one for each side of a cube, instead of the world's nodes",
        default=False,
    )
    cube_strength: FloatProperty(
        name="Strength", description="Factor of the images' brightness", min=0.0, soft_max=10.0, default=1.0
    )
    cube_positive_x: _side("+X")
    cube_negative_x: _side("-X")
    cube_positive_y: _side("+Y")
    cube_negative_y: _side("-Y")
    cube_positive_z: _side("+Z")
    cube_negative_z: _side("-Z")


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
        add_watched(group)
        register_handlers()
    owner.lancer = PointerProperty(type=group, name="Lancer")


def _remove(item):
    group, owner = item
    del owner.lancer
    if group is LancerSceneSettings:
        unregister_handlers()
        remove_watched(group)
    bpy.utils.unregister_class(group)
