"""Random motion within an open shutter, or for the pass Vector: of objects, what they hang on, the camera, its lens and
modifiers that deform.
"""

from .record import Record

_SHARE, _SHARE_OF_VECTORS = 0.2, 0.9
# Settings of modifiers that deform without another number of vertices, and how far they go.
_DEFORMING = {"SIMPLE_DEFORM": ("factor", 0.4), "DISPLACE": ("strength", 0.15), "ARRAY": ("constant_offset_displace", 0.2)}


def motion(dice, records, is_asked=False):
    """Records of motion; none in most scenes, and where data of single samples are compared but vectors."""
    frame = next(record.fields for record in records if record.verb == "frame")
    of_vectors = "Vector" in frame["passes"]
    share = 1.0 if is_asked else _SHARE_OF_VECTORS if of_vectors else _SHARE
    if frame.get("kind") == "DATA" and not of_vectors or not dice.chance(share):
        return []
    moving = []
    for record in records:
        if record.verb == "object" and dice.chance(0.08 if record.name == "Ground" else 0.4):
            moving += _object(dice, record)
        elif record.verb == "camera" and dice.chance(0.1):
            moving.append(_change(record.name, "lens", dice.number(2.0, 12.0)))
        elif record.verb == "modifier" and record.fields["type"] in _DEFORMING and dice.chance(0.5):
            path, most = _DEFORMING[record.fields["type"]]
            by = dice.vector(-most, most) if path.endswith("displace") else dice.number(0.05, most)
            moving.append(_change(record.fields["object"][1:], path, by, modifier=record.name))
    if not moving or of_vectors:
        return moving
    return [*moving, Record("shutter", "Shutter", _shutter(dice))]


def _object(dice, record):
    """Ways of one object; a camera's are short, since all that it shows becomes noise."""
    is_camera = record.name == "Camera object"
    moving = []
    if dice.chance(0.7):
        moving.append(_change(record.name, "location", dice.vector(-0.2, 0.2) if is_camera else dice.vector(-0.7, 0.7)))
    if dice.chance(0.4):
        moving.append(_change(record.name, "rotation_euler", dice.vector(-0.06, 0.06) if is_camera else dice.vector(-1.2, 1.2)))
    if not is_camera and dice.chance(0.2):
        # Each side grows or shrinks, and none through zero.
        sides = record.fields.get("scale", [1.0, 1.0, 1.0])
        moving.append(_change(record.name, "scale", [round(side * dice.number(-0.4, 0.4), 3) for side in sides]))
    if moving and dice.chance(0.3):
        steps = {"motion_steps": dice.whole(2, 3)} if dice.chance(0.7) else {"use_motion_blur": False}
        moving[-1].fields["cycles"] = steps
    return moving


def _change(owner, path, by, **more):
    """A property goes from its value less `by` to its value and `by`, over the frames around the one rendered."""
    name = " ".join((owner, *more.values(), path, "moves"))
    return Record("motion", name, {"owner": f"@{owner}", "path": path, "by": by, **more})


def _shutter(dice):
    fields = {"frames": dice.number(0.1, 1.5)}
    if dice.chance(0.3):
        fields["position"] = dice.pick(("START", "END"))
    if dice.chance(0.1):
        fields["rolling"] = dice.number(0.0, 0.8)
    return fields
