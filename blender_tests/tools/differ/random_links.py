"""Random light and shadow linking: collections of what emitters light, and of what blocks their light."""

from .record import Record

_SHARE = 0.12
_MEMBERS = ("receiver_collection", "blocker_collection")
_STATES = ("INCLUDE", "EXCLUDE")


def links(dice, records, is_asked=False):
    """Records of links of lamps, things and copies of things; none in most scenes."""
    if not is_asked and not dice.chance(_SHARE):
        return []
    objects = [record for record in records if record.verb == "object" and record.fields.keys() & {"data", "collection"}]
    names = [record.name for record in objects if record.fields.get("data") != "@Camera"]
    # Lamps stand first, and give most of the light.
    emitters = [name for name in names if dice.chance(0.7 if name.startswith("Lamp") else 0.3)] or names[:1]
    found = []
    for emitter in emitters:
        for member in dice.some(_MEMBERS, 0.6):
            found.append(_collection(dice, emitter, member, names))
    if found and len(emitters) > 1 and dice.chance(0.3):
        # Another emitter shares a collection.
        shared = found[0].fields["emitters"]
        found[0].fields["emitters"] = [*shared, *(f"@{name}" for name in emitters[1:2])]
        found[1:] = [record for record in found[1:] if not _overrules(record, found[0])]
    return found


def _collection(dice, emitter, member, names):
    """Objects of a collection, each included or excluded, and now and then a child of it with objects of its own."""
    common = dice.pick((*_STATES, None))
    chosen = dice.some(names, 0.4) or [dice.pick(names)]
    fields = {
        "emitters": [f"@{emitter}"],
        "member": member,
        "objects": {f"@{name}": common or dice.pick(_STATES) for name in chosen},
    }
    if dice.chance(0.15):
        below = dice.some(names, 0.4) or [dice.pick(names)]
        fields["child"] = {"objects": [f"@{name}" for name in below], "state": dice.pick(_STATES)}
    return Record("linking", f"{emitter} {member}", fields)


def _overrules(record, other):
    same = record.fields["member"] == other.fields["member"]
    return same and any(name in other.fields["emitters"] for name in record.fields["emitters"])
