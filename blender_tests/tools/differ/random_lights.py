"""Random lamps."""

from .record import Record

_RAYS = ("camera", "diffuse", "glossy", "transmission")


def lamp(dice, number):
    """The records of a lamp above the things, large enough to be met often."""
    name = f"Lamp {number}"
    kind = dice.pick(("POINT", "SPOT", "SUN", "AREA", "AREA"))
    settings = {"energy": dice.number(0.5, 3.0) if kind == "SUN" else dice.number(30.0, 200.0), "color": dice.color(0.3, 1.0)}
    if kind in ("POINT", "SPOT"):
        settings["shadow_soft_size"] = dice.pick((0.0, 0.2, 0.5))
        settings["use_soft_falloff"] = dice.chance(0.5)
    if kind == "SPOT":
        settings |= {"spot_size": dice.number(0.6, 2.0), "spot_blend": dice.number()}
    if kind == "SUN":
        settings["angle"] = dice.pick((0.0, 0.1, 0.6, 1.5))
    if kind == "AREA":
        shape = dice.pick(("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"))
        settings |= {"shape": shape, "size": dice.number(0.3, 2.0), "size_y": dice.number(0.3, 2.0)}
        if dice.chance(0.3):
            settings["spread"] = dice.number(0.5, 3.1)
    if dice.chance(0.2):
        settings["normalize"] = False
        settings["energy"] = dice.number(1.0, 10.0)
    if dice.chance(0.15):
        settings["exposure"] = dice.number(-1.0, 1.0)
    if dice.chance(0.15):
        settings |= {"use_temperature": True, "temperature": dice.number(2000.0, 9000.0)}
    fields = {"type": kind, "settings": settings}
    if dice.chance(0.1):
        fields["no_shadow"] = True
    place = {
        "data": f"@{name}",
        "location": [dice.number(-2.5, 2.5), dice.number(-2.5, 1.5), dice.number(2.8, 4.5)],
        "target": [dice.number(-0.7, 0.7), dice.number(-0.7, 0.7), dice.number(0.0, 1.0)],
    }
    if dice.chance(0.25):
        size = dice.number(0.5, 1.5)
        place["scale"] = [size] * 3 if kind != "AREA" or dice.chance(0.4) else [dice.number(0.4, 1.6) for _ in range(3)]
    switches = {f"visible_{ray}": False for ray in dice.some(_RAYS, 0.06)}
    if switches:
        place["settings"] = switches
    return [Record("lamp", name, fields), Record("object", f"{name} object", place)]
