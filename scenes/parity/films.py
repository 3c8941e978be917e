"""The film: its alpha with and without glass, and the filter between pixels."""

from .. import parts
from .catalogue import case, variants
from .nodes import shader
from .stages import ball, camera, sky


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
    """Glass above the threshold of roughness stays opaque."""
    _things(scene, glass_roughness=0.5)
    scene.render.film_transparent = True
    scene.cycles.film_transparent_glass = True
    scene.cycles.film_transparent_roughness = 0.1


@case(exposure=2.0)
def film_exposure(scene):
    """The exposure of the film scales the picture."""
    _things(scene)


@variants(
    "EDGES",
    values={
        "narrow": (0.6, {"filter_width": 0.6}),
        "usual": (1.5, {"filter_width": 1.5}),
        "wide": (4.0, {"filter_width": 4.0}),
    },
    bounces=0,
)
def film_filter(scene, width):
    """Slanted bars before a wall, all emissive: the values of their edge pixels depend on the filter alone."""
    wall = shader("ShaderNodeEmission", Color=(0.8, 0.9, 1.0), Strength=1.5)
    parts.place(scene, "Wall", parts.plane_mesh("Wall", 20.0), wall, (0, 0, -1))
    for index in range(9):
        color = (1.0, 0.2 + 0.08 * index, 0.9 - 0.1 * index)
        glow = shader("ShaderNodeEmission", Color=color, Strength=3.0)
        mesh = parts.plane_mesh("Bar", 1.0)
        parts.place(scene, f"Bar {index}", mesh, glow, (0.5 * index - 2.0, 0, 0), (0.2, 4.0, 1.0), rotation=(0, 0, 0.25))
    eye = camera(scene, (0, 0, 5), (0, 0, 0))
    eye.rotation_euler = (0, 0, 0)
