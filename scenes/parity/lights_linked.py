"""Light linking and shadow linking: collections of objects that a lamp or a glowing mesh lights, and that block its light."""

import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import shader
from .stages import ball, camera, floor, sky

_SINCE = (4, 0)
_EMITTERS = {kind: kind for kind in ("lamp", "ball", "sun", "mesh")}
_QUICK = _EMITTERS | {kind: (kind, {"quick": True}) for kind in ("lamp", "mesh")}


def _link(emitter, member, state, *things):
    collection = bpy.data.collections.new(f"{emitter.name} {member}")
    for thing in things:
        collection.objects.link(thing)
    for link in collection.collection_objects:
        link.light_linking.link_state = state
    setattr(emitter.light_linking, member, collection)
    return collection


def _emitter(scene, kind):
    """A lamp that rays run into, or a glowing mesh, that the camera does not see."""
    place = (1.1, -0.6, 2.2)
    if kind == "mesh":
        glow = shader("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=12.0)
        thing = parts.place(scene, "Glow", parts.plane_mesh("Glow", 1.2), glow, place, rotation=(3.0, 0.4, 0))
        thing.visible_camera = False
        return thing
    if kind == "lamp":
        thing = parts.add_light(scene, "Lamp", "AREA", 100.0, place, (0, 0, 0.4), size=1.2)
    elif kind == "ball":
        thing = parts.add_light(scene, "Lamp", "POINT", 120.0, place, shadow_soft_size=0.4)
    else:
        thing = parts.add_light(scene, "Lamp", "SUN", 3.0, place, (0, 0, 0), angle=0.3)
    thing.visible_camera = False
    return thing


def _stage(scene, ground=None):
    """A block and a ball on a floor under a dim sky and a weak lamp that lights all."""
    bottom = floor(scene)
    if ground is not None:
        bottom.data.materials[0] = ground
    block = shader("ShaderNodeBsdfDiffuse", Color=(0.3, 0.5, 0.75))
    left = parts.place(scene, "Block", parts.cube_mesh("Block", 1.0), block, (-0.9, 0.2, 0.5), rotation=(0, 0, 0.4))
    right = ball(
        scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.4, 0.3)), segments=48, radius=0.5, location=(0.6, 0.1, 0.5)
    )
    parts.add_light(scene, "Other", "AREA", 30.0, (-2.5, -2.0, 3.0), (0, 0, 0.4), size=1.5)
    sky(scene, strength=0.2)
    camera(scene)
    return bottom, left, right


@variants(values=_EMITTERS, since=_SINCE)
def light_linking_include(scene, kind):
    """The emitter lights the ball alone."""
    _, _, right = _stage(scene)
    _link(_emitter(scene, kind), "receiver_collection", "INCLUDE", right)


@variants(values=_EMITTERS, since=_SINCE)
def light_linking_exclude(scene, kind):
    """The emitter lights all but the floor."""
    bottom, _, _ = _stage(scene)
    _link(_emitter(scene, kind), "receiver_collection", "EXCLUDE", bottom)


@variants(values=_QUICK, since=_SINCE)
def shadow_linking_exclude(scene, kind):
    """The ball casts no shadow of the emitter."""
    _, _, right = _stage(scene)
    _link(_emitter(scene, kind), "blocker_collection", "EXCLUDE", right)


@variants(values=_QUICK, since=_SINCE)
def shadow_linking_include(scene, kind):
    """The block alone casts a shadow of the emitter."""
    _, left, _ = _stage(scene)
    _link(_emitter(scene, kind), "blocker_collection", "INCLUDE", left)


@variants("LOBES", values={"lamp": "lamp", "mesh": "mesh"}, since=_SINCE)
def linking_on_gloss(scene, kind):
    """A glossy floor, whose rays run into the emitter, and on which one ball casts no shadow of it."""
    glossy = shader("ShaderNodeBsdfGlossy", Color=(0.8, 0.8, 0.8), Roughness=0.25)
    _, left, right = _stage(scene, glossy)
    emitter = _emitter(scene, kind)
    _link(emitter, "receiver_collection", "EXCLUDE", left)
    _link(emitter, "blocker_collection", "EXCLUDE", right)


@case(since=_SINCE)
def linking_of_children(scene):
    """A collection with a child that it excludes, and an object of both, which it includes; another lamp shares a set."""
    bottom, left, right = _stage(scene)
    emitter = _emitter(scene, "lamp")
    collection = _link(emitter, "receiver_collection", "INCLUDE", left, bottom)
    child = bpy.data.collections.new("Child")
    child.objects.link(left)
    child.objects.link(right)
    collection.children.link(child)
    collection.collection_children[0].light_linking.link_state = "EXCLUDE"
    second = parts.add_light(scene, "Second", "POINT", 80.0, (-1.0, -2.5, 2.0), shadow_soft_size=0.3)
    _link(second, "receiver_collection", "EXCLUDE", left, right)
    third = parts.add_light(scene, "Third", "POINT", 40.0, (2.0, 1.5, 2.0), shadow_soft_size=0.3)
    _link(third, "blocker_collection", "INCLUDE", left)
