"""Random bakes, in place of a picture: a type with its switches, from one thing or from others onto a copy around them."""

from .record import Record

_SHARE = 0.06
# Without UV, which Cycles bakes as black where no node of the material reads a map.
_TYPES = {
    "COMBINED": 4, "DIFFUSE": 3, "GLOSSY": 2, "TRANSMISSION": 1, "AO": 1, "SHADOW": 1, "EMIT": 2, "ENVIRONMENT": 1,
    "NORMAL": 2, "POSITION": 1, "ROUGHNESS": 2,
}  # fmt: skip
_PARTS = ("DIRECT", "INDIRECT", "COLOR")
_COMPONENTS = ("DIFFUSE", "GLOSSY", "TRANSMISSION", "EMIT")
_AXES = ("POS_X", "POS_Y", "POS_Z", "NEG_X", "NEG_Y", "NEG_Z")


def bakes(dice, records, is_asked=False):
    """The record of a bake of a mesh; none in most scenes. The frame becomes one of light."""
    frame = next(record.fields for record in records if record.verb == "frame")
    things = [record for record in records if _can_be_baked(record, records)]
    if not things or not is_asked and not dice.chance(_SHARE):
        return []
    frame["passes"], frame["bounces"] = ["Combined"], min(2, frame["bounces"])
    frame.pop("mattes", None)
    if frame["kind"] == "DATA":
        frame["kind"] = "LOBES"
    kind = dice.pick(_TYPES)
    fields = {"object": f"@{dice.pick(things).name}", "type": kind, "size": [dice.pick((16, 24, 32)), dice.pick((16, 24, 32))]}
    if kind in ("DIFFUSE", "GLOSSY", "TRANSMISSION"):
        fields["filters"] = dice.some(_PARTS, 0.6) or ["COLOR"]
    elif kind == "COMBINED":
        fields["filters"] = [dice.pick(_PARTS[:2]), *dice.some((*_PARTS[:2], *_COMPONENTS), 0.6)]
    if kind == "NORMAL":
        fields["space"] = dice.pick(("OBJECT", "TANGENT"))
        if dice.chance(0.4):
            fields["axes"] = [dice.pick(_AXES) for _ in range(3)]
    if dice.chance(0.2):
        fields["view_from"] = "ACTIVE_CAMERA"
    shape = next(record.fields["shape"] for record in records if record.name == _mesh_of(fields["object"], records))
    # A flat copy lies in its source, where rounding decides what its rays meet.
    if shape != "plane" and dice.chance(0.3):
        fields["onto"] = {"scale": dice.number(1.02, 1.2), "extrusion": dice.number(0.1, 0.5)}
        if dice.chance(0.4):
            fields["onto"]["distance"] = dice.number(0.2, 1.0)
        if dice.chance(0.3):
            fields["onto"]["cage"] = dice.number(1.25, 1.6)
    # The places of a few corners may have a mean near 0, of which rounding is a large share.
    if kind != "POSITION" and dice.chance(0.2):
        fields["attribute"] = dice.pick(("POINT", "CORNER"))
    return [Record("bake", "Bake", fields)]


def _mesh_of(reference, records):
    return next(record.fields["data"][1:] for record in records if record.verb == "object" and f"@{record.name}" == reference)


def _can_be_baked(record, records):
    """Whether a record is a mesh that renders and that no collection leaves out."""
    if record.verb != "object" or "exact" in record.fields or record.fields.get("settings", {}).get("hide_render"):
        return False
    meshes = {other.name for other in records if other.verb == "mesh"}
    moved = {name for other in records if other.verb == "collection" for name in other.fields["objects"]}
    is_seat = record.name in ("Seats", "Seed")
    return record.fields.get("data", "@")[1:] in meshes and f"@{record.name}" not in moved and not is_seat
