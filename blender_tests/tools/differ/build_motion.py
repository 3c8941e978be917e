"""Keyframes around the frame that is rendered, and the shutter that opens there."""

from scenes import moving

_FRAME = 1


def build_motion(scene, owner, fields):
    if "modifier" in fields:
        owner = owner.modifiers.get(fields["modifier"])
    if owner is None or not hasattr(owner, fields["path"]):
        return
    value = getattr(owner, fields["path"])
    by = fields["by"]
    if isinstance(by, list):
        first, last = ([x + sign * y for x, y in zip(value, by, strict=True)] for sign in (-1, 1))
    else:
        first, last = value - by, value + by
    moving.animate(owner, fields["path"], first, last)
    for setting, chosen in fields.get("cycles", {}).items():
        setattr(owner.cycles, setting, chosen)
    scene.frame_set(_FRAME)


def build_shutter(scene, fields):
    moving.open_shutter(scene, fields["frames"], fields.get("position"))
    if "rolling" in fields:
        scene.cycles.rolling_shutter_type, scene.cycles.rolling_shutter_duration = "TOP", fields["rolling"]
