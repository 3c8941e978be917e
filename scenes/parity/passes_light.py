"""The passes of light, split as in Cycles, and their sum."""

from .. import parts
from .catalogue import case
from .nodes import material, shader
from .stages import ball, camera, floor, lamp, sky

_LIGHT = tuple(f"{kind} {part}" for kind in ("Diffuse", "Glossy", "Transmission") for part in ("Direct", "Indirect", "Color"))


def _still_life(scene):
    """One object for every pass, with mutual reflections."""
    floor(scene)
    ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.3, 0.2)), radius=0.6, location=(-1.3, 0.3, 0.6))
    steel = shader("ShaderNodeBsdfGlossy", {"distribution": "GGX"}, Color=(0.8, 0.8, 0.6), Roughness=0.4)
    ball(scene, steel, radius=0.6, location=(0, 0.3, 0.6))
    leaf = shader("ShaderNodeBsdfTranslucent", Color=(0.4, 0.8, 0.3))
    parts.place(scene, "Leaf", parts.plane_mesh("Leaf", 0.8), leaf, (0.6, -0.8, 0.3), rotation=(1.2, 0, 0.2))
    glow = shader("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=2.0)
    parts.place(scene, "Glow", parts.cube_mesh("Glow", 0.3), glow, (-0.6, -0.8, 0.3), rotation=(0.3, 0.4, 0))
    clear = shader("ShaderNodeBsdfRefraction", {"distribution": "GGX"}, Color=(0.8, 0.9, 1.0), Roughness=0.3, IOR=1.3)
    ball(scene, clear, radius=0.6, location=(1.3, 0.3, 0.6))
    lamp(scene)
    sky(scene, strength=0.8)
    camera(scene, (0, -4.5, 1.5), (0, 0, 0.6))


def _room(scene, surface):
    """Bright walls and a ball of one closure fill the view, so that indirect light is strong in every block."""
    for name, place, turn in (
        ("Floor", (0, 0, 0), (0, 0, 0)),
        ("Back", (0, 2, 0), (1.5708, 0, 0)),
        ("Left", (-2, 0, 0), (0, 1.5708, 0)),
        ("Right", (2, 0, 0), (0, -1.5708, 0)),
    ):
        parts.place(scene, name, parts.plane_mesh("Wall", 8.0), surface, place, rotation=turn)
    ball(scene, surface, radius=0.7, location=(0.2, 0.6, 0.7))
    parts.add_light(scene, "Lamp", "AREA", 150.0, (0, -1.5, 3.5), (0, 0.5, 0.5), size=2.0)
    camera(scene, (0, -3.5, 1.5), (0, 0, 0.9))


@case(passes=_LIGHT[:3])
def pass_diffuse(scene):
    _room(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.7, 0.6)))


@case(passes=_LIGHT[3:6])
def pass_glossy(scene):
    _room(scene, shader("ShaderNodeBsdfGlossy", {"distribution": "GGX"}, Color=(0.8, 0.7, 0.6), Roughness=0.6))


def _behind_pane(scene, y):
    """The room through a wide rough pane at the given y, which a lamp also lights from behind."""
    _room(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.7, 0.6)))
    clear = shader("ShaderNodeBsdfRefraction", {"distribution": "GGX"}, Color=(0.8, 0.9, 1.0), Roughness=0.2, IOR=1.3)
    parts.place(scene, "Pane", parts.plane_mesh("Pane", 4.0), clear, (0, y, 1.2), rotation=(1.5708, 0, 0))
    parts.add_light(scene, "Facing", "AREA", 100.0, (-0.4, 1.9, 1.5), (-0.2, -3.5, 1.5), size=3.6)


@case(passes=_LIGHT[6:])
def pass_transmission(scene):
    """The pane is between the camera and the whole lamp of the room."""
    _behind_pane(scene, -2.6)


@case(passes=_LIGHT[6:], bounces=1)
def pass_transmission_cut_lamp(scene):
    """The room's lamp extends through the pane's plane and lights it obliquely from the far side."""
    _behind_pane(scene, -1.9)


@case(passes=_LIGHT, dark=_LIGHT[3:])
def pass_translucent(scene):
    """The passes that contain the light through a leaf: the lamp's direct light, and the floor's."""
    floor(scene)
    leaf = shader("ShaderNodeBsdfTranslucent", Color=(0.4, 0.8, 0.3))
    parts.place(scene, "Leaf", parts.plane_mesh("Leaf", 3.0), leaf, (0, -1.0, 1.2), rotation=(1.4, 0, 0))
    parts.add_light(scene, "Behind", "AREA", 150.0, (0.5, 2.0, 3.0), (0, 0, 0.5), size=2.0)
    camera(scene, (0, -3.5, 1.5), (0, 0, 0.9))


@case(passes=("Emission",))
def pass_emission(scene):
    _still_life(scene)


@case(passes=("Environment",))
def pass_environment(scene):
    _still_life(scene)


@case(passes=("Combined", "Environment"), bounces=1, quick=True)
def pass_environment_transparent(scene):
    """The sky that a transparent film leaves out of the picture, around a ball and through a pane."""
    scene.render.film_transparent = True
    ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.4, 0.3)), segments=24)
    pane = shader("ShaderNodeBsdfTransparent", Color=(0.9, 0.6, 0.3))
    parts.place(scene, "Pane", parts.plane_mesh("Pane", 1.2), pane, (0.8, -1.0, 1.2), rotation=(1.4, 0, 0))
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85))


@case(passes=("Ambient Occlusion",), bounces=1, quick=True)
def pass_ambient_occlusion_coarse(scene):
    """Smooth normals far from those of the faces: rays start on the curved surface. Without a world they end at 10."""
    floor(scene)
    parts.place(scene, "Cube", _smooth_cube(), shader("ShaderNodeBsdfDiffuse"), (0, 0, 0.8), rotation=(0, 0, 0.4))
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85))


@case("LOBES", passes=("Ambient Occlusion",), bounces=1, quick=True)
def pass_ambient_occlusion_of_panes(scene):
    """Half transparent, under a sky that is worth several paths of a sample."""
    half = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.8, 0.8, 0.8), Alpha=0.45)
    parts.place(scene, "Pane", parts.plane_mesh("Pane", 2.0), half, (0, 0, 0.8), rotation=(0.6, 0.3, 0))
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 12.0), half)
    sky(scene, (1, 1, 1), 1.0)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85))


def _smooth_cube():
    mesh = parts.cube_mesh("Cube", 1.3)
    for face in mesh.polygons:
        face.use_smooth = True
    return mesh


@case(passes=("Ambient Occlusion",))
def pass_ambient_occlusion(scene):
    _still_life(scene)
    scene.world.light_settings.distance = 1.0


@case("LOBES", passes=_LIGHT[:6], bounces=2)
def pass_light_principled(scene):
    """One node that contributes to several passes."""
    _room(scene, shader("ShaderNodeBsdfPrincipled", Base_Color=(0.8, 0.4, 0.3), Roughness=0.6, Metallic=0.4))


def _varnished(scene, **more):
    floor(scene)
    look = {"Base_Color": (0.8, 0.4, 0.3), "Roughness": 0.4, "Metallic": 0.2, "Coat_Weight": 0.5, **more}
    ball(scene, shader("ShaderNodeBsdfPrincipled", **look))
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85))


# Before 4.0 Cycles loses light below a clear coat under a sky, in the darkest blocks nearly all.
@case("LOBES", passes=_LIGHT[:6], since=(4, 0))
def pass_light_varnish(scene):
    _varnished(scene)
    lamp(scene)
    sky(scene)


@case("LOBES", passes=(_LIGHT[0], *_LIGHT[2:4], _LIGHT[5]), bounces=0)
def pass_light_coat(scene):
    """Under a sun, where each layer's share depends on its value alone."""
    _varnished(scene, Coat_Roughness=0.3)
    parts.set_world(scene, (0, 0, 0))
    parts.add_light(scene, "Sun", "SUN", 3.0, (0, 0, 30), angle=0.0).rotation_euler = (0.7, 0.4, 0)


@case(passes=("Combined", *_LIGHT, "Emission", "Environment"), sum_of_passes=True, quick=True)
def pass_sum(scene):
    """Lancer alone: the sum of the passes equals the picture."""
    _still_life(scene)


@case(passes=("Denoising Albedo", "Denoising Normal"))
def pass_denoising(scene):
    _still_life(scene)


@case(passes=("Denoising Depth",), transparent_bounces=1, bounces=1, size=(48, 32), quick=True, since=(4, 0))
def pass_denoising_last_surface(scene):
    """Three panes that fill the view; a path that may pass one of them ends at the second, which guides no denoiser."""

    def build(nodes):
        mix = nodes.add("ShaderNodeMixShader", 0.08)
        nodes.link(nodes.add("ShaderNodeBsdfTransparent"), mix.inputs[1])
        nodes.link(nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8)), mix.inputs[2])
        return mix

    clear = material(build)
    for index in range(3):
        parts.place(scene, f"Pane {index}", parts.plane_mesh("Pane", 40.0), clear, (0, 2.0 * index, 0), rotation=(1.5708, 0, 0))
    sky(scene)
    camera(scene)


@case(passes=("Denoising Depth",))
def pass_denoising_depth(scene):
    """Along the ray, from the camera's near clipping distance."""
    _still_life(scene)
    white = shader("ShaderNodeBsdfDiffuse", Color=(0.7, 0.7, 0.7))
    parts.place(scene, "Back", parts.plane_mesh("Back", 40.0), white, (0, 6, 0), rotation=(1.5708, 0, 0))
    scene.camera.data.clip_start = 0.5
