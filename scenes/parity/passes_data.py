"""The passes of data, at the centres of pixels."""

import bmesh
import bpy

from .. import parts
from . import images
from .catalogue import case, variants
from .nodes import material, shader
from .stages import add_uv, ball, camera, sky

_ONE_SAMPLE = {
    "limit": (0.005, 1e-3),
    "reason": "Cycles keeps the data of one sample, up to 0.005 pixels off the middle: on a ball of 30 pixels this turns the "
    "normal by 3e-4, and three times as much in its outer tenth, the worst hundredth of the picture; on surfaces at such "
    "grazing angles, depth, UV and mist change as much",
}
_NORMALS = {
    "limit": (0.005, 2e-3),
    "reason": "Cycles keeps the normal of one sample, up to 0.005 pixels off the middle: in the outer tenth of a ball of 30 "
    "pixels this varies the normal by 6e-4, and noise may be a third of a limit",
}


def _corner(scene):
    """Three walls fill the view, with a ball and a block before them."""
    for index, (place, turn) in enumerate((((0, 0, 0), (0, 0, 0)), ((0, 4, 0), (1.5708, 0, 0)), ((-4, 0, 0), (0, 1.5708, 0)))):
        wall = parts.place(scene, f"Wall {index}", parts.plane_mesh("Wall", 30.0), _plain((0.6, 0.5, 0.2 * index)), place)
        wall.rotation_euler = turn
        wall.pass_index = index + 3
        add_uv(wall.data)
    thing = ball(scene, _plain((0.8, 0.3, 0.2), 7))
    thing.pass_index = 5
    add_uv(thing.data)
    block = parts.place(scene, "Block", parts.cube_mesh("Block", 1.0), _plain((0.2, 0.3, 0.8), 11), (1.6, 0, 0.5))
    block.rotation_euler, block.pass_index = (0, 0, 0.5), 9
    add_uv(block.data)
    sky(scene)
    camera(scene, (2, -5, 3), (0, 0, 0.8))


def _plain(color, index=2):
    result = shader("ShaderNodeBsdfDiffuse", Color=color)
    result.pass_index = index
    return result


@variants(
    "PIXELS",
    values={
        "depth": ("Depth", {"passes": ("Depth",), **_ONE_SAMPLE}),
        "normal": ("Normal", {"passes": ("Normal",), **_NORMALS}),
        "position": ("Position", {"passes": ("Position",), "quick": True, "size": (288, 192)}),
        "uv": ("UV", {"passes": ("UV",), **_ONE_SAMPLE}),
        "object_index": ("Object Index", {"passes": ("Object Index",)}),
        "material_index": ("Material Index", {"passes": ("Material Index",)}),
    },
    filter_width=0.01,
    bounces=0,
    samples=16,
)
def pass_data(scene, name):
    _corner(scene)


@variants(
    "PIXELS",
    values={name.lower(): (name, {}) for name in ("LINEAR", "QUADRATIC", "INVERSE_QUADRATIC")},
    passes=("Mist",),
    **_ONE_SAMPLE,
    filter_width=0.01,
    bounces=0,
    samples=16,
)
def pass_mist(scene, falloff):
    _corner(scene)
    mist = scene.world.mist_settings
    mist.start, mist.depth, mist.falloff = 3.0, 9.0, falloff


@case("PIXELS", passes=("Normal",), filter_width=0.01, bounces=0, samples=16, size=(192, 128), **_NORMALS)
def pass_normal_mapped(scene):
    """The normal includes the normal map's tilt, as in the shader."""

    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": images.gradient(colorspace="Non-Color")})
        lean = nodes.add("ShaderNodeNormalMap", props={"space": "WORLD"}, Color=picture.outputs["Color"])
        return nodes.add("ShaderNodeBsdfDiffuse", Normal=lean)

    _corner(scene)
    bpy.data.objects["Ball"].material_slots[0].material = material(build)


@case("PIXELS", passes=("UV",), filter_width=0.01, bounces=0, samples=16, quick=True, **_ONE_SAMPLE)
def pass_uv_without_map(scene):
    """A block without a map before walls with one."""
    _corner(scene)
    mesh = bpy.data.objects["Block"].data
    mesh.uv_layers.remove(mesh.uv_layers[0])


def _coarse_ball(bm):
    bmesh.ops.create_icosphere(bm, subdivisions=1, radius=1.0)


@case(passes=("Normal",), filter_width=0.01, bounces=0, samples=16, quick=True)
def pass_normal_uneven(scene):
    """Coarse smooth meshes under uneven scales: Cycles moves that into the world which no other object shares, and the others
    not. By blocks, in which the outlines count little.
    """
    meshes = {name: parts.mesh_from_bmesh(name, _coarse_ball, smooth=True) for name in ("Alone", "Shared")}
    for mesh in meshes.values():
        mesh.materials.append(_plain((0.8, 0.3, 0.2)))
    for name, mesh, x in (("Alone", "Alone", -2), ("One", "Shared", -0.7), ("Two", "Shared", 0.7), ("Own", "Shared", 2)):
        thing = parts.place(scene, name, meshes[mesh], None, (x, 0, 0), (-0.4, 0.8, 1.2), (0.4, 0.3, 0.2))
        # To Cycles an object with a material of its own shares nothing.
        thing.material_slots[0].link = "OBJECT" if name == "Own" else "DATA"
    sky(scene)
    camera(scene, (0, -6, 1), (0, 0, 0))


@case("PIXELS", passes=("Depth", "Position", "Normal"), filter_width=0.01, bounces=2, samples=16, **_ONE_SAMPLE)
def pass_data_through_panes(scene):
    """Two panes before the scene, one of alpha 0 and one of alpha 1: the surface that data passes record.

    For values in between, Cycles keeps a randomly chosen path."""
    _corner(scene)
    for name, alpha, x in (("Clear", 0.0, -0.1), ("Solid", 1.0, 1.7)):
        surface = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.7, 0.3), Alpha=alpha)
        parts.place(scene, name, parts.plane_mesh("Pane", 1.2), surface, (x, -2.5, 1.6), rotation=(1.3, 0, 0.3))


@case("PIXELS", passes=("Denoising Depth",), filter_width=0.01, samples=16, size=(192, 128), **_ONE_SAMPLE)
def pass_denoising_depth_of_the_sky(scene):
    """The largest float since 5.2, 0 before."""
    ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.3, 0.2)))
    sky(scene)
    camera(scene, (0, -4.5, 1.5), (0, 0, 0.9))
