"""Random lamps, under any transform."""

from .record import Record

_RAYS = ("camera", "diffuse", "glossy", "transmission")


def lamp(dice, number):
    """The records of a lamp above the things, large enough to be met often."""
    name = f"Lamp {number}"
    kind = dice.pick(("POINT", "SPOT", "SUN", "AREA", "AREA"))
    settings = {"energy": dice.number(0.5, 3.0) if kind == "SUN" else dice.number(30.0, 200.0), "color": dice.color(0.3, 1.0)}
    if kind in ("POINT", "SPOT"):
        settings["shadow_soft_size"] = dice.pick((0.0, 0.3, 0.7))
        settings["use_soft_falloff"] = dice.chance(0.5)
    if kind == "SPOT":
        settings |= {"spot_size": dice.number(0.6, 2.0), "spot_blend": dice.number()}
    if kind == "SUN":
        settings["angle"] = dice.pick((0.0, 0.2, 0.8, 1.5))
    if kind == "AREA":
        shape = dice.pick(("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"))
        settings |= {"shape": shape, "size": dice.number(0.6, 2.5), "size_y": dice.number(0.6, 2.5)}
        if dice.chance(0.3):
            settings["spread"] = dice.number(0.5, 3.1)
    if dice.chance(0.2):
        settings["normalize"] = False
        settings["energy"] = dice.number(1.0, 10.0)
    if dice.chance(0.15):
        settings["exposure"] = dice.number(-1.0, 1.0)
    if dice.chance(0.15):
        settings |= {"use_temperature": True, "temperature": dice.number(2000.0, 9000.0)}
    if dice.chance(0.04):
        settings["energy"] = -0.3 * settings["energy"]
    fields = {"type": kind, "settings": settings}
    if dice.chance(0.1):
        fields["no_shadow"] = True
    if kind == "AREA" and dice.chance(0.05):
        fields["portal"] = True
    records = [Record("lamp", name, fields), Record("object", f"{name} object", _place(dice, name, kind))]
    if dice.chance(0.05):
        twin = {"data": f"@{name}", "location": [*dice.vector(-2.5, 2.5)[:2], 3.5], "rotation": dice.vector(-0.6, 0.6)}
        records.append(Record("object", f"{name} twin", twin))
    if dice.chance(0.15):
        records += _parents(dice, f"{name} object", kind)
    return records


def _place(dice, name, kind):
    place = {
        "data": f"@{name}",
        "location": [dice.number(-2.5, 2.5), dice.number(-2.5, 1.5), dice.number(2.8, 4.5)],
        "target": [dice.number(-0.7, 0.7), dice.number(-0.7, 0.7), dice.number(0.0, 1.0)],
    }
    scaled = dice.pick({"not": 12, "evenly": 2, "unevenly": 3, "mirrored": 2, "flat": 0.5})
    if scaled == "evenly":
        place["scale"] = [dice.number(0.5, 1.5)] * 3
    elif scaled != "not":
        scale = [dice.number(0.4, 1.6) for _ in range(3)]
        if scaled == "mirrored":
            scale = [-x if dice.chance(0.5) else x for x in scale]
        if scaled == "flat":
            # An area lamp flat along z shines by samples alone in Cycles, which Lancer reports.
            scale[dice.whole(0, 1 if kind == "AREA" and dice.chance(0.8) else 2)] = 0.0
        place["scale"] = scale
    settings = {f"visible_{ray}": False for ray in dice.some(_RAYS, 0.06)}
    if dice.chance(0.03):
        settings["hide_render"] = True
    if settings:
        place["settings"] = settings
    return place


def _parents(dice, child, kind):
    """An empty above the lamp; a sheared area lamp is another in Cycles, which Lancer reports, so there are few of them."""
    fields = {"location": dice.vector(-0.3, 0.3), "rotation": dice.vector(-0.4, 0.4)}
    if kind == "AREA" and dice.chance(0.7):
        fields["scale"] = [dice.number(0.7, 1.3)] * 3
    else:
        fields["scale"] = [dice.number(0.6, 1.4) for _ in range(3)]
    if dice.chance(0.2):
        fields["scale"][dice.whole(0, 2)] *= -1
    name = f"{child} parent"
    parent = {"parent": f"@{name}", "inverse": dice.chance(0.2)}
    return [Record("object", name, fields), Record("parent", child, parent)]
