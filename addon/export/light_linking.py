"""Light linking and shadow linking: collections of objects as the sets of lancer.h.

As in Blender, objects that the same collections include and exclude are one set, up to 63 of them beside the default set 0,
which all other objects belong to. An emitter whose collection includes objects reaches these alone, otherwise all but those
that the collection excludes. An object of the collection itself overrules one of its child collections, which hold for all
objects below them.
"""

from typing import NamedTuple

import bpy

from ..messages.severity import Severity

_HAS_LINKING = "light_linking" in bpy.types.Object.bl_rna.properties
_MOST = 64  # sets, and collections
_ALL = 2**_MOST - 1


class Links(NamedTuple):
    """The members of lancer_instance of these names."""

    receiver_set: int = 0
    blocker_set: int = 0
    unlit_sets: int = 0
    clear_sets: int = 0


_UNLINKED = Links()


class _Sets(NamedTuple):
    """The sets of receivers or of blockers. Keys are addresses of original objects."""

    set_of: dict  # of objects in other sets than 0
    lacking: dict  # of emitters: bits of the sets that are not theirs


_NOTHING = _Sets({}, {})


class LightLinking(NamedTuple):
    """All links of a depsgraph; compared by value."""

    light: _Sets = _NOTHING
    shadow: _Sets = _NOTHING

    def links(self, key, parent_key=None):
        """Return the Links of an object by its original's address. parent_key: that of its instancer, whose sets go first."""
        if self is UNLINKED:
            return _UNLINKED
        light, shadow = (sets.set_of.get(parent_key) or sets.set_of.get(key, 0) for sets in (self.light, self.shadow))
        return Links(light, shadow, self.light.lacking.get(key, 0), self.shadow.lacking.get(key, 0))

    def has(self, thing):
        """Whether an object belongs to another set than 0."""
        if self is UNLINKED:
            return False
        key = thing.original.as_pointer()
        return key in self.light.set_of or key in self.shadow.set_of


UNLINKED = LightLinking()


def read_linking(depsgraph, messages):
    """Return the LightLinking of a depsgraph; UNLINKED if no object of it has links."""
    if not _HAS_LINKING:
        return UNLINKED
    emitters = {"receiver_collection": {}, "blocker_collection": {}}
    for block in depsgraph.ids:
        if not isinstance(block, bpy.types.Object):
            continue
        linking = block.original.light_linking
        for name, found in emitters.items():
            collection = getattr(linking, name)
            if collection is not None:
                found[block.original.as_pointer()] = collection.original
    if not any(emitters.values()):
        return UNLINKED
    who = f"scene '{depsgraph.scene.name}'"
    light = _sets_of(emitters["receiver_collection"], f"{who}: light linking", messages)
    return LightLinking(light, _sets_of(emitters["blocker_collection"], f"{who}: shadow linking", messages))


def _sets_of(emitters, who, messages):
    """Return the _Sets of emitters, a collection for each key."""
    numbers = {}
    for collection in emitters.values():
        numbers.setdefault(collection, len(numbers))
    if len(numbers) > _MOST:
        messages.add(f"{who} has {len(numbers)} collections, as in Cycles only {_MOST} of them count", severity=Severity.HINT)
    # The bits of the collections that include an object, and of those that exclude it.
    masks = {}
    for collection, number in numbers.items():
        for thing, includes in _objects(collection) if number < _MOST else ():
            key, bit = thing.as_pointer(), 1 << number
            included, excluded = masks.get(key, (0, 0))
            masks[key] = (included | bit, excluded & ~bit) if includes else (included & ~bit, excluded | bit)
    sets = {pair: number for number, pair in enumerate(dict.fromkeys(masks.values()), 1)}
    if len(sets) >= _MOST:
        messages.add(
            f"{who} needs {len(sets)} sets of objects, as in Cycles only {_MOST - 1} of them count, which may be others there"
        )
    set_of = {key: sets[pair] for key, pair in masks.items() if sets[pair] < _MOST}
    lacking = {}
    for key, collection in emitters.items():
        bit = 1 << numbers[collection]
        of_pairs = [(1 << number, pair) for pair, number in sets.items() if number < _MOST]
        includes = sum(each for each, pair in of_pairs if pair[0] & bit)
        excludes = sum(each for each, pair in of_pairs if pair[1] & bit)
        lacking[key] = _ALL & ~((includes or _ALL) & ~excludes)
    return _Sets(set_of, lacking)


def _objects(collection):
    """Yield (object, whether it is included): the last entry of an object holds."""
    for child, link in zip(collection.children, collection.collection_children, strict=True):
        for thing in _all_objects(child):
            yield thing, _includes(link)
    for thing, link in zip(collection.objects, collection.collection_objects, strict=True):
        yield thing, _includes(link)


def _all_objects(collection):
    for child in collection.children:
        yield from _all_objects(child)
    yield from collection.objects


def _includes(link):
    return link.light_linking.link_state == "INCLUDE"
