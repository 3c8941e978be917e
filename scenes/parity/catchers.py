"""Shadow catchers: their picture, their pass, the lights and the objects that they know."""

import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import shader
from .stages import ball, camera, floor, lamp, sky


def _shadow(scene, surface=None):
    """A ball and a glowing cube over a floor that catches their shadows, under a lamp and a sky."""
    ground = floor(scene)
    ground.is_shadow_catcher = True
    if surface is not None:
        ground.data.materials.clear()
        ground.data.materials.append(surface)
    ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.4, 0.3)), segments=32, radius=0.7, location=(0, 0, 0.7))
    glow = shader("ShaderNodeEmission", Color=(1.0, 0.8, 0.5), Strength=4.0)
    parts.place(scene, "Glow", parts.cube_mesh("Glow", 0.4), glow, (1.2, -0.6, 0.3), rotation=(0.3, 0.4, 0))
    lamp(scene)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.4))
    return ground


@variants(values={"opaque": (False, {"quick": True}), "transparent": True})
def catcher_film(scene, transparent):
    """Before the sky, or in the alpha of a transparent film."""
    _shadow(scene)
    scene.render.film_transparent = transparent


@variants(values={"opaque": False, "transparent": True}, passes=("Combined", "Shadow Catcher"))
def catcher_pass(scene, transparent):
    """With the pass, the picture leaves the floor out."""
    _shadow(scene)
    scene.render.film_transparent = transparent


@case(passes=("Combined", "Shadow Catcher"))
def catcher_pass_without_catchers(scene):
    _shadow(scene).is_shadow_catcher = False


@case(passes=("Combined", "Environment", "Diffuse Direct", "Diffuse Indirect", "Emission", "Mist", "Normal"))
def catcher_other_passes(scene):
    """The sky lies behind the floor in its pass; passes of light leave the floor out, those of data do not."""
    _shadow(scene)


@case(passes=("Combined", "Shadow Catcher"))
def catcher_glossy(scene):
    """Mirrored objects brighten a catcher."""
    _shadow(scene, shader("ShaderNodeBsdfGlossy", Color=(0.7, 0.7, 0.7), Roughness=0.2))


@case(passes=("Combined", "Shadow Catcher"))
def catcher_glowing(scene):
    """A catcher that glows lights other catchers too."""
    ground = _shadow(scene)
    glow = shader("ShaderNodeEmission", Color=(0.3, 0.6, 1.0), Strength=2.0)
    tube = parts.place(scene, "Tube", parts.cube_mesh("Tube", 0.5), glow, (-1.4, 0.2, 0.5), rotation=(0.2, 0.4, 0))
    ground.is_shadow_catcher = tube.is_shadow_catcher = True


@case()
def catcher_lamp_left_out(scene):
    """A lamp that is no catcher is light of the objects, as a glowing mesh is."""
    _shadow(scene)
    other = parts.add_light(scene, "Other", "POINT", 60.0, (-1.5, -1.0, 2.0), (0, 0, 0.5), shadow_soft_size=0.4)
    other.is_shadow_catcher = False


@case()
def catcher_behind_pane(scene):
    """A catcher through a coloured pane, which is an object of the picture."""
    _shadow(scene)
    pane = shader("ShaderNodeBsdfTransparent", Color=(0.9, 0.6, 0.3))
    parts.place(scene, "Pane", parts.plane_mesh("Pane", 1.2), pane, (-0.8, -1.2, 0.8), rotation=(1.4, 0, 0))


@case(passes=("Combined", "Shadow Catcher"))
def catcher_before_catcher(scene):
    """A clear catcher before the floor: the path goes on among catchers from the first."""
    _shadow(scene)
    half = shader("ShaderNodeBsdfTransparent", Color=(0.7, 0.7, 0.7))
    pane = parts.place(scene, "Pane", parts.plane_mesh("Pane", 1.2), half, (-0.8, -1.2, 0.8), rotation=(1.4, 0, 0))
    pane.is_shadow_catcher = True


@case()
def catcher_hole(scene):
    """A catcher that is a hole stays a hole."""
    _shadow(scene).is_holdout = True


@case()
def catcher_mirrored(scene):
    """In a mirror a catcher is any object."""
    _shadow(scene)
    mirror = shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0)
    parts.place(scene, "Mirror", parts.plane_mesh("Mirror", 2.0), mirror, (-1.2, 1.0, 0.8), rotation=(1.57, 0, 0.6))


@case()
def catcher_lights_only_catchers(scene):
    """A lamp within a ball: its light reaches the floor of the reference alone."""
    _shadow(scene)
    parts.add_light(scene, "Inner", "POINT", 30.0, (0, 0, 0.7), (0, 0, 0), shadow_soft_size=0.1)


@case()
def catcher_collection(scene):
    """Instances catch shadows where their instancer does."""
    ground = _shadow(scene)
    ground.is_shadow_catcher = False
    kept = bpy.data.collections.new("Kept")
    scene.collection.objects.unlink(ground)
    kept.objects.link(ground)
    maker = bpy.data.objects.new("Maker", None)
    scene.collection.objects.link(maker)
    maker.instance_type, maker.instance_collection, maker.is_shadow_catcher = "COLLECTION", kept, True


@case(passes=("Combined", "Shadow Catcher"), limited={"sample_clamp_direct": 0.3})
def catcher_clamped(scene):
    """Light is clamped before it is divided. The result depends on the choice among lights: there is one."""
    _shadow(scene)
    bpy.data.objects.remove(scene.objects["Glow"])
    sky(scene, strength=0.0)
