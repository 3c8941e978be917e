"""Random limits of light, and what Simplify leaves out: what Cycles' settings of a scene, a lamp, a world or an object ask."""

from .record import Record

_SHARE = 0.15
_KINDS = ("diffuse", "glossy", "transmission")


def limits(dice, records, is_asked=False):
    """Change the frame, lamps and worlds, and return records of Fast GI, culling and texels; nothing in most scenes."""
    frame = next(record.fields for record in records if record.verb == "frame")
    if frame.get("kind") == "DATA" or not is_asked and not dice.chance(_SHARE):
        return []
    limited = {f"{kind}_bounces": dice.whole(0, 2) for kind in dice.some(_KINDS, 0.3)}
    for kind in ("reflective", "refractive"):
        if dice.chance(0.2):
            limited[f"caustics_{kind}"] = False
    if dice.chance(0.2):
        limited["blur_glossy"] = dice.pick((0.3, 1.0, 5.0))
    if dice.chance(0.2):
        limited["film_exposure"] = dice.number(0.2, 3.0)
    if dice.chance(0.15):
        limited["sample_clamp_direct"] = dice.number(0.5, 4.0)
    if dice.chance(0.15):
        limited["sample_clamp_indirect"] = dice.number(0.5, 4.0)
    if limited:
        frame["limited"] = limited
    frame["bounces"] = dice.pick((frame["bounces"], 2, 3))
    for record in records:
        if record.verb in ("lamp", "world") and dice.chance(0.25):
            record.fields["max_bounces"] = dice.whole(0, 2)
    found = []
    if dice.chance(0.2) and any(record.verb == "world" for record in records):
        found.append(_fast_gi(dice, records))
    if dice.chance(0.2):
        found.append(_culling(dice, records))
    images = [record for record in records if record.verb == "image" and record.name != "Sky"]
    if images and dice.chance(0.4):
        for record in images:
            # More texels than the smallest limit, at edges that the smaller texels do not have.
            record.fields["enlarged"] = 37
        found.append(Record("texels", "Texels", {"limit": "128", "share": dice.pick((50.0, 25.0))}))
    return found


def _things(records):
    return [
        record.name for record in records if record.verb == "object" and record.name.startswith(("Thing", "Ground", "Copy"))
    ]


def _fast_gi(dice, records):
    fields = {
        "method": dice.pick(("REPLACE", "ADD")),
        "bounces": dice.whole(1, 2),
        "factor": dice.number(0.2, 1.2),
        "distance": dice.number(0.3, 8.0),
        "distances": {f"@{name}": dice.number(0.3, 5.0) for name in _things(records) if dice.chance(0.2)},
    }
    return Record("fast_gi", "Fast GI", {key: value for key, value in fields.items() if value != {}})


def _culling(dice, records):
    """Margins near the edges of things, so that some of them are left out."""
    fields = {}
    if dice.chance(0.7):
        fields |= {"margin": dice.number(0.0, 0.2), "beside": [f"@{name}" for name in _things(records)]}
    if dice.chance(0.5) or not fields:
        fields |= {"distance": dice.number(3.0, 6.0), "beyond": [f"@{name}" for name in dice.some(_things(records), 0.6)]}
    return Record("culling", "Culling", fields)
