"""Effects of an object's own switches: visibility by kind of ray, holdout, transparent shadows, override, instances."""

import bpy
from mathutils import Matrix

from .. import parts
from .catalogue import case, variants
from .nodes import material, shader
from .stages import ball, camera, floor, lamp, sky


def _gallery(scene):
    """A red ball seen directly, in a mirror and through glass, on a floor with its shadow and its reflected colour."""
    floor(scene)
    red = shader("ShaderNodeBsdfDiffuse", Color=(0.9, 0.15, 0.1))
    thing = ball(scene, red, radius=0.6, location=(0, 0.2, 0.6))
    mirror = shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0)
    glass = shader("ShaderNodeBsdfRefraction", Color=(1, 1, 1), Roughness=0.0, IOR=1.1)
    pane = parts.plane_mesh("Pane", 1.0)
    in_the_way = (
        parts.place(scene, "Mirror", pane, mirror, (-1.3, 0.8, 0.8), (1.5, 1.5, 1.5), (1.5, 0, 0.9)),
        parts.place(scene, "Pane", pane, glass, (0.5, -1.0, 0.7), rotation=(1.4, 0, 0)),
    )
    # Their caustics on the floor are noise and excluded.
    for piece in in_the_way:
        piece.visible_diffuse = False
    lamp(scene)
    sky(scene)
    camera(scene, (0, -4.5, 1.8), (0, 0, 0.7))
    return thing


@variants(values={name: name for name in ("camera", "diffuse", "glossy", "transmission", "shadow")})
def object_invisible_to(scene, ray):
    setattr(_gallery(scene), f"visible_{ray}", False)


@case()
def object_hidden(scene):
    _gallery(scene).hide_render = True


@case()
def object_hidden_from_all_rays(scene):
    thing = _gallery(scene)
    for ray in ("camera", "diffuse", "glossy", "transmission", "shadow"):
        setattr(thing, f"visible_{ray}", False)


@case()
def object_holdout(scene):
    scene.render.film_transparent = True
    _gallery(scene).is_holdout = True


@case(quick=True, bounces=1)
def object_holdout_alone(scene):
    """The hole in the picture of the floor, and the remaining shadow on it."""
    scene.render.film_transparent = True
    floor(scene, size=6.0)
    ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.9, 0.15, 0.1)), radius=0.6, location=(0, 0.2, 0.6)).is_holdout = True
    parts.add_light(scene, "Light", "POINT", 300.0, (1.5, -1, 2.5), shadow_soft_size=0.2)
    camera(scene, (0, -4.5, 1.8), (0, 0, 0.7))


@case()
def collection_holdout(scene):
    scene.render.film_transparent = True
    _into_collection(scene, _gallery(scene)).holdout = True


@case()
def collection_indirect_only(scene):
    _into_collection(scene, _gallery(scene)).indirect_only = True


def _into_collection(scene, thing):
    """Moves the object into a new collection and returns that collection's switches in the view layer."""
    own = bpy.data.collections.new("Own")
    scene.collection.children.link(own)
    own.objects.link(thing)
    scene.collection.objects.unlink(thing)
    return bpy.context.view_layer.layer_collection.children["Own"]


def _pane(scene, surface, height, size=2.0):
    return parts.place(scene, "Pane", parts.plane_mesh("Pane", size), surface, (0, 0, height))


@case(quick=True, bounces=1)
def transparent_shadow(scene):
    floor(scene)
    _pane(scene, shader("ShaderNodeBsdfTransparent", Color=(0.9, 0.4, 0.2)), 0.8, 1.5)
    parts.add_light(scene, "Light", "POINT", 300.0, (0.8, -0.5, 3), shadow_soft_size=0.1)
    camera(scene)


@case(bounces=1)
def glass_shadow(scene):
    """Glass itself occludes the direct light of lamps."""
    floor(scene)
    _pane(scene, shader("ShaderNodeBsdfGlass", Color=(1, 1, 1), Roughness=0.0, IOR=1.3), 0.8, 1.5)
    parts.add_light(scene, "Light", "POINT", 300.0, (0.8, -0.5, 3), shadow_soft_size=0.0)
    camera(scene)


def _stack(scene, count):
    floor(scene)
    clear = shader("ShaderNodeBsdfTransparent", Color=(0.95, 0.9, 0.85))
    mesh = parts.plane_mesh("Pane", 1.6)
    for index in range(count):
        parts.place(scene, f"Pane {index}", mesh, clear, (0, 0, 0.3 + 0.12 * index))
    parts.add_light(scene, "Light", "SUN", 3.0, (0.3, -0.3, 3), angle=0.05)
    sky(scene, strength=0.3)
    camera(scene, (0, -3, 4), (0, 0, 0.5))


@variants(
    values={
        "enough": (12, {"transparent_bounces": 32}),
        "few": (12, {"transparent_bounces": 8}),
        "none": (3, {"transparent_bounces": 0}),
    },
    bounces=1,
)
def transparent_bounces(scene, count):
    _stack(scene, count)


@case()
def transparent_counts_no_bounce(scene):
    """Transparent panes do not use up the bounces of light."""
    floor(scene)
    half = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.7, 0.3), Alpha=0.3, Specular_IOR_Level=0.0)
    mesh = parts.plane_mesh("Pane", 1.6)
    for index in range(5):
        parts.place(scene, f"Pane {index}", mesh, half, (0, 0.3 * index, 0.8), rotation=(1.4, 0, 0))
    lamp(scene)
    sky(scene)
    camera(scene)


@case(quick=True)
def no_material(scene):
    """The default surface of an object without a material."""
    floor(scene)
    ball(scene, None, radius=0.8, location=(0, 0, 0.8))
    lamp(scene)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85))


@case()
def material_override(scene):
    _gallery(scene)
    bpy.context.view_layer.material_override = shader("ShaderNodeBsdfDiffuse", name="Clay", Color=(0.6, 0.5, 0.4))


@case(quick=True)
def collection_instances(scene):
    """Copies of a collection, one of them mirrored."""
    source = bpy.data.collections.new("Source")
    for name, color, place in (("One", (0.8, 0.2, 0.2), (0, 0, 0.4)), ("Two", (0.2, 0.4, 0.9), (0.5, 0.2, 0.3))):
        surface = shader("ShaderNodeBsdfDiffuse", Color=color)
        thing = parts.place(scene, name, parts.cube_mesh(name, 0.6), surface, place, rotation=(0, 0, 0.3))
        source.objects.link(thing)
        scene.collection.objects.unlink(thing)
    for index, scale in enumerate(((1, 1, 1), (-1, 1, 1.5), (0.7, 0.7, 0.7))):
        copy = bpy.data.objects.new(f"Copy {index}", None)
        copy.instance_type, copy.instance_collection = "COLLECTION", source
        copy.location, copy.scale = (1.4 * (index - 1), 0.3 * index, 0), scale
        scene.collection.objects.link(copy)
    floor(scene)
    lamp(scene)
    sky(scene)
    camera(scene)


@case(quick=True, bounces=0, size=(48, 32))
def instances_and_holdouts(scene):
    """The instancer alone decides whether its instances are holes; an original that is one leaves them as they are."""
    source = bpy.data.collections.new("Source")
    grey = shader("ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6))
    thing = parts.place(scene, "Original", parts.cube_mesh("Original", 0.8), grey, (0, 40, 0))
    thing.is_holdout = True
    source.objects.link(thing)
    for index in range(2):
        copy = bpy.data.objects.new(f"Copy {index}", None)
        copy.instance_type, copy.instance_collection = "COLLECTION", source
        copy.location, copy.is_holdout = (1.4 * index - 0.7, -40, 0.6), index == 1
        scene.collection.objects.link(copy)
    sky(scene)
    camera(scene)


@case()
def sheared_mesh(scene):
    """A matrix that is no product of location, rotation and scale."""
    floor(scene)
    thing = ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.5, 0.3)), radius=0.8)
    thing.matrix_world = Matrix.Translation((0, 0, 1)) @ Matrix.Shear("XY", 4, (0.5, 0.2)) @ Matrix.Scale(0.8, 4)
    lamp(scene)
    sky(scene)
    camera(scene)


def _sheet(axis, smooth=False):
    """A bulged sheet that looks along an axis."""
    count = 5
    places = [(-0.7 + 0.35 * i, -0.7 + 0.35 * j) for j in range(count) for i in range(count)]
    points = [(x, y, 0.4 - x * x - 0.5 * y * y + 0.2 * x) for x, y in places]
    points = [tuple(point[(k - axis - 1) % 3] for k in range(3)) for point in points]
    squares = [count * j + i for j in range(count - 1) for i in range(count - 1)]
    mesh = parts.mesh_from_points("Sheet", points, [(a, a + 1, a + count + 1, a + count) for a in squares])
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(mesh.polygons))
    return mesh


# Each looks upwards, leaning a little.
_LEANING = {"x": (0, (0.2, -1.37, 0.3)), "y": (1, (1.37, 0.1, 0.3)), "z": (2, (0.2, 0.2, 0.3))}
_TAN = (0.8, 0.5, 0.3)


@variants(values={**{name: (name, False) for name in _LEANING}, "smooth": (("z", True), {"quick": True})})
def flattened(scene, value):
    """Scaled to 0 along an axis, as artists flatten."""
    name, smooth = value
    axis, rotation = _LEANING[name]
    floor(scene)
    scale = tuple(0.0 if k == axis else 1.2 for k in range(3))
    parts.place(scene, "Sheet", _sheet(axis, smooth), shader("ShaderNodeBsdfDiffuse", Color=_TAN), (0, 0, 0.8), scale, rotation)
    lamp(scene)
    sky(scene)
    camera(scene)


@case(quick=True)
def flattened_by_a_parent(scene):
    """Sheared at once."""
    floor(scene)
    parent = bpy.data.objects.new("Parent", None)
    parent.location, parent.scale = (0, 0, 0.8), (1, 1.3, 0)
    scene.collection.objects.link(parent)
    thing = parts.place(
        scene, "Sheet", _sheet(2), shader("ShaderNodeBsdfDiffuse", Color=_TAN), (0.2, 0, 0), rotation=(0.5, 0.3, 0.4)
    )
    thing.parent = parent
    lamp(scene)
    sky(scene)
    camera(scene)


@case(bounces=1)
def flattened_light(scene):
    """Emission scales with the area that is left."""
    floor(scene)
    glow = shader("ShaderNodeEmission", Color=(1.0, 0.8, 0.5), Strength=4.0)
    sheet = parts.place(scene, "Sheet", _sheet(2), glow, (0, 0, 1.2), (1.2, 1.2, 0), (2.8, 0.3, 0.3))
    sheet.visible_camera = False
    camera(scene)


@case()
def modifier_evaluated(scene):
    floor(scene)
    thing = parts.place(
        scene, "Cube", parts.cube_mesh("Cube", 1.4), shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.5, 0.3)), (0, 0, 0.8)
    )
    modifier = thing.modifiers.new("Bevel", "BEVEL")
    modifier.width, modifier.segments = 0.3, 4
    lamp(scene)
    sky(scene)
    camera(scene)


@case()
def curve_and_text(scene):
    """Objects that become meshes only at the render."""
    floor(scene)
    surface = material(lambda nodes: nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.5, 0.3)))
    curve = bpy.data.curves.new("Ring", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.12
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(2)
    for point, co in zip(spline.bezier_points, ((-1, 0, 0.3), (0, 0.5, 1.4), (1, 0, 0.3)), strict=True):
        point.co, point.handle_left_type, point.handle_right_type = co, "AUTO", "AUTO"
    curve.materials.append(surface)
    scene.collection.objects.link(bpy.data.objects.new("Ring", curve))
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude, text.align_x = "Abc", 0.1, "CENTER"
    text.materials.append(surface)
    sign = bpy.data.objects.new("Text", text)
    sign.location, sign.rotation_euler = (0, -0.6, 0.1), (1.2, 0, 0)
    scene.collection.objects.link(sign)
    lamp(scene)
    sky(scene)
    camera(scene)
