"""The film: its alpha with and without glass, and the filter between pixels."""

from .. import parts
from .catalogue import case
from .nodes import shader
from .stages import ball, camera, floor, lamp, sky


def _things(scene, glass_roughness=0.0):
    parts.place(scene, "Table", parts.plane_mesh("Table", 2.4), shader("ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4)))
    clear = shader("ShaderNodeBsdfGlass", {"distribution": "GGX"}, Color=(1, 1, 1), Roughness=glass_roughness, IOR=1.2)
    ball(scene, clear, radius=0.7, location=(0.3, -0.2, 1.0))
    half = shader("ShaderNodeBsdfTransparent", Color=(0.9, 0.5, 0.3))
    parts.place(scene, "Pane", parts.plane_mesh("Pane", 1.0), half, (-0.9, 0, 0.9), rotation=(1.3, 0, 0.4))
    sky(scene, (0.7, 0.8, 1.0), 1.0)
    camera(scene, (0, -4.5, 2.0), (0, 0, 0.6))


@case(quick=True)
def film_transparent(scene):
    _things(scene)
    scene.render.film_transparent = True


@case()
def film_transparent_glass(scene):
    _things(scene)
    scene.render.film_transparent = True
    scene.cycles.film_transparent_glass = True
    scene.cycles.film_transparent_roughness = 0.1


@case()
def film_transparent_glass_rough(scene):
    """Rougher glass than the threshold stays opaque."""
    _things(scene, glass_roughness=0.5)
    scene.render.film_transparent = True
    scene.cycles.film_transparent_glass = True
    scene.cycles.film_transparent_roughness = 0.1


@case(may_differ=True)
def film_exposure(scene):
    """Cycles' exposure of the film scales the picture; Lancer may say that it does not."""
    _things(scene)
    scene.cycles.film_exposure = 2.0


@case(filter_width=1.5)
def film_filter(scene):
    floor(scene)
    ball(scene, shader("ShaderNodeEmission", Color=(1, 0.8, 0.6), Strength=2.0), segments=12, radius=0.8)
    parts.place(
        scene, "Bars", parts.cube_mesh("Bars", 0.3), shader("ShaderNodeEmission", Color=(0.2, 1, 0.4)), (1.2, -0.6, 0.5)
    )
    lamp(scene)
    camera(scene)


@case(filter_width=4.0)
def film_filter_wide(scene):
    film_filter(scene)
