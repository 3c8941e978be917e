"""Modified normals and surfaces: normal maps, bump, and true displacement."""

import math

import bmesh
import bpy
import numpy as np

from .. import parts
from . import images
from .catalogue import case, variants
from .nodes import material, shader
from .stages import add_uv, ball, camera, card, displace, floor, lamp, sky, studio


def _waves(space):
    """Returns an image of gently varying normals, encoded as colours."""
    x, y = np.meshgrid(np.linspace(0, 1, 32), np.linspace(0, 1, 32))
    direction = np.stack([0.5 * np.sin(9 * x), 0.4 * np.cos(7 * y), np.ones_like(x)], axis=-1)
    if space == "BLENDER":
        direction[..., 1:] *= -1.0
    direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
    pixels = np.ones((32, 32, 4))
    pixels[..., :3] = 0.5 + 0.5 * direction
    return images.image("Waves", pixels, "Non-Color")


def _leaning(space, strength=1.0):
    def build(nodes):
        waves = _waves("BLENDER" if space.startswith("BLENDER") else space)
        picture = nodes.add("ShaderNodeTexImage", props={"image": waves})
        lean = nodes.add("ShaderNodeNormalMap", props={"space": space}, Strength=strength, Color=picture.outputs["Color"])
        return nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.7, 0.6), Normal=lean)

    return material(build)


def _tilted_card(scene, surface):
    thing = card(scene, surface)
    thing.rotation_euler = (0.15, 0.1, 0.3)
    parts.add_light(scene, "Sun", "SUN", 2.0, (1, -0.5, 1.2), angle=0.1)
    return thing


@variants(
    values={
        "tangent": ("TANGENT", 1.0),
        "tangent_strong": ("TANGENT", 2.0),
        "tangent_weak": ("TANGENT", 0.4),
        "object": ("OBJECT", 1.0),
        "world": ("WORLD", 1.0),
        "blender_object": ("BLENDER_OBJECT", 1.0),
        "blender_world": ("BLENDER_WORLD", 1.0),
    }
)
def normal_map(scene, value):
    _tilted_card(scene, _leaning(*value))


@case()
def normal_map_on_barrel(scene):
    """Smooth sides between two faces of twelve corners."""
    thing = studio(scene, _leaning("TANGENT"))
    mesh = parts.cone_mesh("Barrel", 0.7, 0.7, 1.4, segments=12)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    layer = mesh.uv_layers.new(name="UVMap")
    for face in mesh.polygons:
        # Sides are unrolled, each from its own edge; the ends are projected from above.
        start = np.floor(np.arctan2(face.center.y, face.center.x) / (np.pi / 6))
        for corner in face.loop_indices:
            x, y, z = mesh.vertices[mesh.loops[corner].vertex_index].co
            ahead = np.rint(np.arctan2(y, x) / (np.pi / 6) - start) % 12
            layer.data[corner].uv = (x, y) if abs(face.normal.z) > 0.5 else ((start + ahead) / 4, z)
    mesh.materials.append(thing.data.materials[0])
    thing.data, thing.rotation_euler = mesh, (0.5, 0.2, 0.0)


@case()
def normal_map_on_ball(scene):
    """Tangents of a UV map that rotates and shrinks over a round mesh."""
    thing = studio(scene, _leaning("TANGENT"))
    add_uv(thing.data)


@case()
def normal_map_in_gloss(scene):
    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": _waves("TANGENT")})
        lean = nodes.add("ShaderNodeNormalMap", Color=picture.outputs["Color"])
        return nodes.add(
            "ShaderNodeBsdfGlossy", props={"distribution": "GGX"}, Color=(0.8, 0.8, 0.8), Roughness=0.3, Normal=lean
        )

    _tilted_card(scene, material(build))


def _heights(ripples=0.0):
    x, y = np.meshgrid(np.linspace(0, 1, 64), np.linspace(0, 1, 64))
    pixels = np.ones((64, 64, 4))
    height = 0.5 + 0.25 * np.sin(9 * x) + 0.25 * np.cos(8 * y) + ripples * np.sin(60 * x)
    pixels[..., :3] = height[..., None]
    return images.image("Heights", pixels, "Non-Color")


def _bump(strength=1.0, distance=0.3, invert=False, kind="ShaderNodeBsdfDiffuse", color="Color", coordinate="UV"):
    def build(nodes):
        where = nodes.add("ShaderNodeTexCoord").outputs[coordinate]
        picture = nodes.add("ShaderNodeTexImage", props={"image": _heights(), "interpolation": "Cubic"}, Vector=where)
        bump = nodes.add(
            "ShaderNodeBump", props={"invert": invert}, Strength=strength, Distance=distance, Height=picture.outputs["Color"]
        )
        return nodes.add(kind, Normal=bump, **{color: (0.8, 0.7, 0.6)})

    return material(build)


@variants(values={"plain": {}, "weak": {"strength": 0.3}, "inverted": {"invert": True}})
def bump(scene, settings):
    _tilted_card(scene, _bump(**settings))


@case("LOBES", quick=True)
def bump_principled(scene):
    """The shadow terminator of a bump, which differs between versions of Blender."""
    card(scene, _bump(distance=0.6, kind="ShaderNodeBsdfPrincipled", color="Base Color"))
    parts.add_light(scene, "Sun", "SUN", 4.0, (1, -0.5, 0.25), angle=0.1)


@variants(values={"leaf": "ShaderNodeBsdfTranslucent", "cloth": "ShaderNodeBsdfSheen"})
def normal_map_turned_away(scene, kind):
    """A normal that does not follow the visible side, on lobes that do not reflect about it."""

    def build(nodes):
        fixed = nodes.add("ShaderNodeNormalMap", props={"space": "WORLD"}, Color=(0.7, 0.6, 0.9), Strength=0.5)
        return nodes.add(kind, Color=(0.6, 0.8, 0.3), Normal=fixed)

    studio(scene, material(build))


@variants(values={"uv": "UV", "generated": "Generated", "object": "Object"})
def bump_from_behind(scene, coordinate):
    """Seen from behind, bumps in texture coordinates of the mesh are inverted; bumps in object space are not."""
    thing = _tilted_card(scene, _bump(coordinate=coordinate))
    thing.rotation_euler.rotate_axis("X", math.pi)


@case()
def bump_scaled_object(scene):
    thing = _tilted_card(scene, _bump())
    thing.scale = (1.0, 1.0, 0.4)


@variants(values={"true": "DISPLACEMENT", "both": "BOTH", "bump": "BUMP"})
def displacement(scene, method):
    """Hills that the mesh can follow, with ripples finer than its faces, which need bump."""

    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": _heights(0.06)})
        height = nodes.add("ShaderNodeDisplacement", Height=picture.outputs["Color"], Midlevel=0.5, Scale=0.4)
        return nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.7, 0.6)), height

    surface = material(build)
    displace(surface, method)
    mesh = _grid(24, 3.0)
    parts.place(scene, "Grid", mesh, surface, rotation=(0.15, 0.1, 0.3))
    lamp(scene)
    sky(scene)
    camera(scene, (0.2, -2.4, 2.6), (0, 0.05, 0))


@variants(
    values={
        f"{space.lower()}_{name}": (space, method)
        for space in ("TANGENT", "OBJECT", "WORLD")
        for name, method in (("true", "DISPLACEMENT"), ("both", "BOTH"), ("bump", "BUMP"))
    }
)
def vector_displacement(scene, given):
    """Hills that lean, of a grid that is turned and scaled."""
    space, method = given

    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": _heights(0.06)})
        height = nodes.add("ShaderNodeSeparateXYZ", picture.outputs["Color"]).outputs[0]
        lean = nodes.add("ShaderNodeMath", height, 0.4, props={"operation": "MULTIPLY"}).outputs[0]
        parts_of_it = (lean, height, 0.1) if space == "TANGENT" else (lean, 0.1, height)
        vector = nodes.add("ShaderNodeCombineXYZ", *parts_of_it)
        props = {"space": space}
        offset = nodes.add("ShaderNodeVectorDisplacement", Vector=vector, Midlevel=0.1, Scale=0.4, props=props)
        return nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.7, 0.6)), offset

    surface = material(build)
    displace(surface, method)
    parts.place(scene, "Grid", _grid(24, 3.0), surface, rotation=(0.15, 0.1, 0.3), scale=(1.0, 0.8, 1.2))
    lamp(scene)
    sky(scene)
    camera(scene, (0.2, -2.4, 2.6), (0, 0.05, 0))


def _grid(count, size):
    def make(bm):
        bmesh.ops.create_grid(bm, x_segments=count, y_segments=count, size=size / 2)

    mesh = parts.mesh_from_bmesh("Grid", make, smooth=True)
    add_uv(mesh)
    return mesh


@case()
def smooth_and_sharp(scene):
    """Smooth and flat faces in one mesh: the normals of the corners decide."""
    mesh = parts.cone_mesh("Cylinder", 0.9, 0.5, 1.8, 12)
    for face in mesh.polygons:
        face.use_smooth = len(face.vertices) == 4
    parts.place(
        scene, "Cylinder", mesh, material(lambda nodes: nodes.add("ShaderNodeBsdfDiffuse", Color=(0.7, 0.7, 0.7))), (0, 0, 0.9)
    )
    lamp(scene)
    sky(scene)
    camera(scene)


def _hills(fins):
    """Returns a hilly grid with non-planar faces; with fins, some of its edges have three faces."""
    side = 6
    places = [
        (x, y, 0.9 * math.sin(1.7 * x) * math.cos(2.3 * y)) for y in np.linspace(-1, 1, side) for x in np.linspace(-1, 1, side)
    ]
    corners = [y * side + x for y in range(side - 1) for x in range(side - 1)]
    faces = [(a, a + 1, a + side + 1, a + side) for a in corners]
    for a in corners[side:-side:3] if fins else ():
        x, y, z = places[a]
        places += [(x, y + 0.3, z + 0.5), (x + 0.4, y + 0.3, z + 0.5)]
        faces.append((a, a + 1, len(places) - 1, len(places) - 2))
    mesh = bpy.data.meshes.new("Hills")
    mesh.from_pydata(places, [], faces)
    return mesh


def _under_lamp(scene, mesh, surface=None):
    surface = surface or shader("ShaderNodeBsdfDiffuse", Color=(0.7, 0.7, 0.7))
    thing = parts.place(scene, "Hills", mesh, surface, rotation=(0.2, 0, 0.3))
    lamp(scene)
    sky(scene)
    camera(scene, (0.2, -2.4, 2.6), (0, 0.05, 0))
    return thing


@case(quick=True)
def smooth_and_flat_divided(scene):
    """Flat faces beside smooth ones, none of them planar."""
    mesh = _hills(False)
    mesh.polygons.foreach_set("use_smooth", [index % 3 > 0 for index in range(len(mesh.polygons))])
    modifier = _under_lamp(scene, mesh).modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = 1


def _set_normals(mesh, normals):
    """Sets one normal for each corner, in the order of the faces."""
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
    mesh.normals_split_custom_set(normals)


@case()
def normals_at_edges_of_three_faces(scene):
    """Custom normals: those of the fins are tilted the other way."""
    mesh = _hills(True)
    normals = [(0.4, 0.0, 0.9165) if face.index < 25 else (-0.4, -0.5, 0.7681) for face in mesh.polygons for _ in face.vertices]
    _set_normals(mesh, normals)
    _under_lamp(scene, mesh)


def _normals_away(scene, surface):
    """Leaves with transferred normals: those of every other face point away from the viewer, the others are tilted."""
    mesh = _hills(False)
    normals = [(0.5, 0.3, -0.8124) if face.index % 2 else (0.4, 0.0, 0.9165) for face in mesh.polygons for _ in face.vertices]
    _set_normals(mesh, normals)
    _under_lamp(scene, mesh, surface)
    floor(scene)


@case(quick=True)
def normals_away(scene):
    _normals_away(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.7, 0.6)))


@variants(
    "LOBES",
    values={
        "glossy": ("ShaderNodeBsdfAnisotropic", {"distribution": "GGX"}, {"Anisotropy": 0.0, "Roughness": 0.5}),
        "translucent": ("ShaderNodeBsdfTranslucent", {}, {"Color": (0.8, 0.7, 0.6)}),
        "principled": ("ShaderNodeBsdfPrincipled", {}, {"Roughness": 0.4}),
    },
)
def normals_away_lobe(scene, value):
    kind, props, inputs = value
    _normals_away(scene, shader(kind, props=props, **inputs))


@case("LOBES", since=(4, 0))
def normals_away_glass(scene):
    """In Blender 3 one face is 6 % brighter than in Cycles under the sky alone, although both lobes agree separately."""
    _normals_away(scene, shader("ShaderNodeBsdfGlass", Roughness=0.3))


@variants(
    "LOBES",
    values={
        "refraction": (("ShaderNodeBsdfRefraction", 0.3), {"quick": True}),
        "clear_refraction": ("ShaderNodeBsdfRefraction", 0.0),
        "glass": ("ShaderNodeBsdfGlass", 0.3),
    },
)
def normals_leaning(scene, value):
    """A pane seen from behind: with normals tilted towards the viewer, Blender 3 refracts light back to the viewer's side."""
    kind, roughness = value
    pane = parts.plane_mesh("Pane", 3.0)
    _set_normals(pane, [(0.0, -0.7071, 0.7071)] * 4)
    parts.place(scene, "Pane", pane, shader(kind, Roughness=roughness), (0, 0, 1), rotation=(math.pi, 0, 0))
    floor(scene)
    sky(scene, strength=1.0)
    camera(scene, (0, -4, 1.8), (0, 0, 1))


@variants(
    "LOBES",
    values={
        "glossy": ("ShaderNodeBsdfAnisotropic", {"distribution": "GGX"}, {"Anisotropy": 0.0, "Roughness": 0.5}),
        "principled": ("ShaderNodeBsdfPrincipled", {}, {"Roughness": 0.4}),
        "clay": ("ShaderNodeBsdfDiffuse", {}, {"Roughness": 1.0}),
    },
)
def coarse(scene, value):
    """Few smooth faces, whose interpolated normals point away from the viewer at the rim."""
    kind, props, inputs = value
    ball(scene, shader(kind, props, **inputs), segments=12)
    lamp(scene)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)
