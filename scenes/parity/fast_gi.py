"""Cycles' Fast GI Approximation, and what Simplify leaves out: objects by camera and distance, texels."""

from .. import parts
from .catalogue import case, variants
from .images import gradient_pixels, image
from .light_paths import glass, glossy, room
from .nodes import material, shader
from .stages import ball, camera, card, floor, sky


def _fast(scene, method, distance, factor=1.0, bounces=1):
    cycles, light = scene.cycles, scene.world.light_settings
    cycles.use_fast_gi, cycles.fast_gi_method = True, method
    cycles.ao_bounces = cycles.ao_bounces_render = bounces
    light.ao_factor, light.distance = factor, distance


@variants("LOBES", values={"1": 1, "2": 2}, bounces=4, limited={"use_fast_gi": True})
def fast_gi_replace(scene, bounces):
    room(scene, glossy(), glass())
    _fast(scene, "REPLACE", 1.5, 0.7, bounces)


@case("LOBES", bounces=4, limited={"use_fast_gi": True})
def fast_gi_replace_near_object(scene):
    """An object has a distance of its own, and a lamp is beyond the distance."""
    room(scene, glossy(), glass())
    _fast(scene, "REPLACE", 0.8)
    scene.objects["Ball 0"].cycles.ao_distance = 5.0
    scene.objects["Floor"].cycles.ao_distance = 0.3


@variants("LOBES", values={"near": (0.5, {"quick": True}), "far": 20.0}, bounces=2, limited={"use_fast_gi": True})
def fast_gi_add(scene, distance):
    room(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.3, 0.5, 0.75)), glossy())
    _fast(scene, "ADD", distance, 0.5)


def _row_of_balls(scene):
    floor(scene)
    scene.objects["Floor"].cycles.use_camera_cull = False
    matt = shader("ShaderNodeBsdfDiffuse", Color=(0.7, 0.4, 0.3))
    for index in range(8):
        thing = ball(scene, matt, segments=24, radius=0.5, location=(1.4 * index - 4.9, 0.2 * index, 0.5))
        thing.cycles.use_camera_cull = thing.cycles.use_distance_cull = True
    parts.add_light(scene, "Lamp", "AREA", 900.0, (-9.0, -1.5, 1.8), (0, 0, 0.5), size=0.8)
    sky(scene)
    camera(scene, (0, -4.5, 2.0), (0, 0, 0.5))


@variants(values={"0": (0.0, {"quick": True}), "margin": 0.3}, bounces=1, simplify=True)
def camera_culling(scene, margin):
    """Balls beside the picture throw no shadows into it."""
    _row_of_balls(scene)
    scene.cycles.use_camera_cull, scene.cycles.camera_cull_margin = True, margin


@case(bounces=1, simplify=True)
def distance_culling(scene):
    _row_of_balls(scene)
    scene.cycles.use_distance_cull, scene.cycles.distance_cull_margin = True, 5.5


@case(bounces=1, simplify=True)
def camera_and_distance_culling(scene):
    """Both switches: a ball is left out only if it is beside the picture and beyond the distance."""
    _row_of_balls(scene)
    scene.cycles.use_camera_cull, scene.cycles.camera_cull_margin = True, 0.0
    scene.cycles.use_distance_cull, scene.cycles.distance_cull_margin = True, 6.0


@case(until=(5, 2), simplify=True)
def texture_limit(scene):
    """An image of 512 texels along its longer side, shown with 128."""
    picture = image("limited", gradient_pixels(512, 384))

    def build(nodes):
        shown = nodes.add("ShaderNodeTexImage", props={"image": picture, "interpolation": "Closest"})
        return nodes.add("ShaderNodeBsdfDiffuse", Color=shown)

    card(scene, material(build))
    scene.cycles.texture_limit_render = "128"
