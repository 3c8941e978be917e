"""Random properties of objects, their data, the scene, its layer and its world, which Attribute nodes read by name."""

from .record import Record

# Share of each name; a number may also be an attribute of meshes.
NAMES = {"Heat": 3, "Tint": 3, "Number": 1, "color": 2, "pass_index": 1, '["Heat"]': 1, "Missing": 0.5}
TYPES = {"GEOMETRY": 6, "OBJECT": 1, "INSTANCER": 1, "VIEW_LAYER": 0.7}
_GIVEN = ("Heat", "Tint", "Number", "color")


def properties(dice, records):
    """Records of properties, if a node reads any."""
    if not any("attribute_type" in record.fields.get("props", {}) for record in records):
        return []
    owners = [f"@{record.name}" for record in records if record.verb in ("object", "mesh")]
    return [
        Record("property", name, {"owner": owner, "value": _value(dice)})
        for owner in (*owners, "scene", "layer", "world")
        for name in dice.some(_GIVEN, 0.3)
    ]


def _value(dice):
    kind = dice.pick({"number": 3, "whole": 1, "switch": 1, "numbers": 4, "wholes": 1, "word": 0.5})
    if kind == "number":
        return dice.number()
    if kind == "whole":
        return dice.whole(0, 2)
    if kind == "switch":
        return dice.chance(0.5)
    if kind == "numbers":
        return [dice.number() for _ in range(dice.whole(1, 5))]
    return [dice.whole(0, 2) for _ in range(dice.whole(1, 4))] if kind == "wholes" else "word"
