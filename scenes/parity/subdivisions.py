"""Adaptive subdivision: displaced, creased, mapped, with instances, by pixels and by lengths, without and with perspective."""

import bmesh
import bpy
import numpy as np

from .. import parts
from . import images
from .catalogue import case, variants
from .nodes import material
from .stages import add_uv, camera, displace, sky

# Since 5.0 the modifier has the settings; before, Cycles' settings of the object.
_OF_MODIFIER = (5, 0)


def divide(scene, thing, rate=1.0, kind="CATMULL_CLARK", **fields):
    """Adds a Subdivision modifier that Cycles replaces. rate: in pixels; fields: of the modifier."""
    modifier = thing.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = 1
    modifier.subdivision_type = kind
    for name, value in fields.items():
        setattr(modifier, name, value)
    dice(scene, thing, modifier, rate)
    return modifier


def dice(scene, thing, modifier, rate):
    """Lets Cycles replace the object's last Subdivision modifier. rate: in pixels."""
    if bpy.app.version >= _OF_MODIFIER:
        modifier.use_adaptive_subdivision = True
        modifier.adaptive_pixel_size = rate
    else:
        scene.cycles.feature_set = "EXPERIMENTAL"
        thing.cycles.use_adaptive_subdivision = True
        thing.cycles.dicing_rate = rate


def _glowing(output, scale=1.0):
    """Returns a material that shows a vector of Texture Coordinate or the texture that `output` makes of the nodes."""

    def build(nodes):
        value = nodes.add("ShaderNodeTexCoord").outputs[output] if isinstance(output, str) else output(nodes)
        return nodes.add("ShaderNodeEmission", Color=value, Strength=scale)

    return material(build)


def _checks(nodes):
    where = nodes.add("ShaderNodeTexCoord").outputs["UV"]
    return nodes.add("ShaderNodeTexChecker", Vector=where, Color1=(0.9, 0.5, 0.1), Color2=(0.1, 0.3, 0.8), Scale=6.0)


def _lit(scene):
    parts.add_light(scene, "Sun", "SUN", 2.5, (1.5, -1.0, 1.2), angle=0.02)
    sky(scene)


def _hills(bumps):
    """Returns a material of grey hills, whose height waves are a fifth of the UV map's square wide."""
    x, y = np.meshgrid(*2 * [np.linspace(0.0, 1.0, 128)])
    pixels = np.ones((128, 128, 4))
    pixels[..., :3] = (0.5 + 0.25 * np.sin(30.0 * x) + 0.25 * np.cos(30.0 * y))[..., None]
    picture = images.image("Hills", pixels, "Non-Color")

    def build(nodes):
        height = nodes.add("ShaderNodeTexImage", props={"image": picture, "interpolation": "Cubic"}).outputs["Color"]
        return (
            nodes.add("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5)),
            nodes.add("ShaderNodeDisplacement", Height=height, Midlevel=0.5, Scale=bumps),
        )

    surface = material(build)
    displace(surface, "DISPLACEMENT")
    return surface


def _crease(mesh, values):
    if bpy.app.version >= (4, 0):
        mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", values)
    else:
        mesh.edges.foreach_set("crease", values)


@case(quick=True, bounces=1)
def subdivided_plane_at_a_grazing_angle(scene):
    """Hills of one square face that reaches from behind the camera to far away, mostly outside the picture."""
    mesh = parts.plane_mesh("Ground", 40.0)
    mesh.polygons.foreach_set("use_smooth", [True])
    add_uv(mesh)
    divide(scene, parts.place(scene, "Ground", mesh, _hills(1.5), (0, 12, 0)), 1.0, "SIMPLE")
    _lit(scene)
    camera(scene, (0, -5, 2.2), (0, 3, 0.8))


@variants(values={"soft": 0.15, "half": 0.5, "full": 1.0}, quick=True)
def subdivided_creases(scene, crease):
    """The normals of a cube, of which half of the edges are creased."""
    mesh = parts.cube_mesh("Cube", 2.0)
    _crease(mesh, [crease * (index % 2) for index in range(len(mesh.edges))])
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    thing = parts.place(scene, "Cube", mesh, _glowing("Normal"), (0, 0, 0.9), rotation=(0.2, 0.1, 0.5))
    divide(scene, thing)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


@variants(values={"soft": 0.15, "full": 1.0})
def subdivided_sharp_vertices(scene, crease):
    """The normals of a body, of which some vertices inside the surface are creased."""
    thing = _gem(scene, _glowing("Normal"), True)
    thing.rotation_euler = (0.5, -0.2, 0.3)
    count = len(thing.data.vertices)
    values = [crease * (index % 2) for index in range(count)]
    if bpy.app.version >= (4, 0):
        thing.data.attributes.new("crease_vert", "FLOAT", "POINT").data.foreach_set("value", values)
    else:
        with bpy.context.temp_override(object=thing, active_object=thing, mesh=thing.data):
            bpy.ops.mesh.customdata_crease_vertex_add()
        thing.data.vertex_creases[0].data.foreach_set("value", values)
    divide(scene, thing)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


def _mapped(scene, name, points, faces, surface):
    """Places smooth faces that fill most of the picture."""
    mesh = parts.mesh_from_points(name, points, faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    thing = parts.place(scene, name, mesh, surface, (0, 0, 0.9), rotation=(0.3, 0.1, 0.5))
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)
    return thing


@variants(values={"half": 0.15, "full": 1.0})
def subdivided_border_creases(scene, crease):
    """A bent sheet with creases on its border and across it, whose corners they keep in their places."""
    points = [(x, y, 0.4 * x * y) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    faces = [(3 * y + x, 3 * y + x + 1, 3 * y + x + 4, 3 * y + x + 3) for y in (0, 1) for x in (0, 1)]
    thing = _mapped(scene, "Sheet", points, faces, _glowing("Normal"))
    _crease(thing.data, [crease] * len(thing.data.edges))
    divide(scene, thing)


def _fin():
    """A sheet with a fin of two squares in its middle: three faces meet at two edges."""
    points = [(0.5 * x - 1, 0.5 * y - 1, 0.3 * (x == 2)) for y in range(5) for x in range(5)]
    faces = [(5 * y + x, 5 * y + x + 1, 5 * y + x + 6, 5 * y + x + 5) for y in range(4) for x in range(4)]
    points += [(-0.3, y, 1.0) for y in (-0.5, 0.0, 0.5)]
    return points, [*faces, (7, 12, 26, 25), (12, 17, 27, 26)]


def _turned():
    """Two squares whose sides run the same way at the edge that they share."""
    points = [(0, -1, 0), (0, 1, 0), (1, -1, 0.5), (1, 1, 0.5), (-1, -1, 0.6), (-1, 1, 0.6)]
    return points, [(0, 2, 3, 1), (0, 4, 5, 1)]


def _apex():
    """Two pyramids that share their apex."""
    square = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    points = [(0, 0, 0), *((x, y, -1) for x, y in square), *((0.8 * x, 0.8 * y, 1) for x, y in square)]
    sides = [(0, first + row, first + (row + 1) % 4) for first in (1, 5) for row in range(4)]
    return points, [*sides, (4, 3, 2, 1), (5, 6, 7, 8)]


@variants(values={"fin": _fin, "turned": _turned, "apex": _apex})
def subdivided_odd_faces(scene, build):
    """Faces that form no single sheet, where OpenSubdiv keeps edges and vertices sharp."""
    divide(scene, _mapped(scene, "Odd", *build(), _glowing("Generated")))


def _gem(scene, surface, smooth):
    """A closed body of triangles, quads and a polygon of five corners, with a UV map of five islands."""

    def make(bm):
        bmesh.ops.create_cone(bm, cap_ends=True, segments=5, radius1=1.1, radius2=0.6, depth=1.8)
        top = max(bm.faces, key=lambda face: face.calc_center_median().z)
        bmesh.ops.poke(bm, faces=[top], offset=0.3)
        layer = bm.loops.layers.uv.new("UVMap")
        for face in bm.faces:
            for loop in face.loops:
                x, y, z = loop.vert.co
                loop[layer].uv = (0.3 * x + 0.5, 0.3 * y + 0.5) if len(face.verts) > 4 else (0.4 * x + 0.2 * y, 0.4 * z)

    return parts.place(scene, "Gem", parts.mesh_from_bmesh("Gem", make, smooth), surface, (0, 0, 0.9))


@variants(values={"smooth": True, "flat": False}, quick=True)
def subdivided_maps(scene, smooth):
    """Checks of a UV map on smooth faces, and the normals of flat ones."""
    thing = _gem(scene, _glowing(_checks if smooth else "Normal"), smooth)
    thing.rotation_euler = (0.3, -0.2, 0.3)
    divide(scene, thing)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


_CORNERS = ("PRESERVE_CORNERS", "PRESERVE_CORNERS_AND_JUNCTIONS", "PRESERVE_CORNERS_JUNCTIONS_AND_CONCAVE")


@variants(values={name.lower(): name for name in ("NONE", *_CORNERS, "PRESERVE_BOUNDARIES", "SMOOTH_ALL")})
def subdivided_map_smoothed(scene, rule):
    divide(scene, _gem(scene, _glowing(_checks), True), uv_smooth=rule)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


@case(quick=True, bounces=1)
def subdivided_instances(scene):
    """A displaced body and two instances of it, larger and turned, that are divided as the original is."""
    thing = _gem(scene, _hills(0.15), True)
    divide(scene, thing)
    source = bpy.data.collections.new("Source")
    scene.collection.children.link(source)
    scene.collection.objects.unlink(thing)
    source.objects.link(thing)
    for place, scale in (((-2.2, 0.8, -0.6), 1.2), ((1.9, -0.3, 0.0), 0.8)):
        copy = bpy.data.objects.new("Copy", None)
        copy.instance_type, copy.instance_collection = "COLLECTION", source
        copy.location, copy.scale, copy.rotation_euler = place, 3 * [scale], (0.2, 0.1, 0.7)
        scene.collection.objects.link(copy)
    _lit(scene)
    camera(scene, (0, -8, 3.5), (-0.2, 0, 0.7))


@case(since=(5, 0))
def subdivided_by_lengths(scene):
    """Edges of a tenth of the object's units, whatever its scale: the facets are seen."""
    thing = _gem(scene, _glowing("Generated"), True)
    thing.scale = (1.2, 1.0, 0.7)
    divide(scene, thing, adaptive_space="OBJECT", adaptive_object_edge_length=0.1)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


@case(bounces=1)
def subdivided_without_perspective(scene):
    thing = _gem(scene, _hills(0.15), True)
    divide(scene, thing)
    _lit(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), type="ORTHO", ortho_scale=4.0)


@case(bounces=1, since=(4, 5))
def subdivided_by_another_camera(scene):
    """The camera that divides the ground looks at another part of it, so that the picture shows a coarse one."""
    mesh = parts.plane_mesh("Ground", 12.0)
    add_uv(mesh)
    divide(scene, parts.place(scene, "Ground", mesh, _hills(0.8)), 2.0, "SIMPLE")
    _lit(scene)
    scene.cycles.dicing_camera = camera(scene, (0, 20, 2.5), (0, 40, 0.8))
    camera(scene, (0, -5, 2.5), (0, 0, 0.0))
