"""Random outputs for compositing: light groups, AOVs of materials and worlds, cryptomattes and shadow catchers."""

from .record import Record

_SHARE = 0.15
MATTES = ("CryptoObject", "CryptoMaterial", "CryptoAsset")
_AOVS = {"Tint": "COLOR", "Number": "VALUE", "Other tint": "COLOR", "Other number": "VALUE"}
# Passes of one sample or of a denoiser's guides are compared elsewhere.
_PLAIN = ("Combined", "Environment", "Emission", "Diffuse Direct", "Glossy Direct")


def outputs(dice, records, trees, is_asked=False):
    """Records of outputs; none in most scenes, and where data of single samples are compared."""
    frame = next(record.fields for record in records if record.verb == "frame")
    film = next(record.fields for record in records if record.verb == "film")
    has_odd_pixels = any(name.startswith("pixel_aspect") for name in film)
    if not is_asked and (not dice.chance(_SHARE) or frame.get("kind") == "DATA" or has_odd_pixels):
        return []
    if frame["kind"] == "DATA":
        frame["kind"] = "LOBES"
    for name in ("pixel_aspect_x", "pixel_aspect_y"):
        film.pop(name, None)
    frame["passes"] = [name for name in frame["passes"] if name in _PLAIN] or ["Combined"]
    frame["bounces"] = min(2, frame["bounces"])
    found = []
    if dice.chance(0.4):
        found += _groups(dice, records)
    if dice.chance(0.4):
        found += _aovs(dice, records, trees)
    if dice.chance(0.4):
        frame["mattes"] = dice.some(MATTES, 0.6) or [MATTES[0]]
        frame["matte_levels"] = dice.pick({2: 1, 4: 1, 6: 4, 16: 1})
    # Cycles counts AOVs twice at catchers, which Lancer reports.
    has_aovs = any(record.verb == "aov" for record in found)
    if dice.chance(0.02 if has_aovs else 0.5):
        _catch(dice, records)
        if dice.chance(0.6):
            frame["passes"].append("Shadow Catcher")
    return found


def _groups(dice, records):
    """One to three light groups, and what belongs to them: lamps, objects of any kind, worlds."""
    names = [f"Light group {number + 1}" for number in range(dice.whole(1, 3))]
    members = [record.name for record in records if record.verb in ("object", "world")]
    share = dice.pick((0.6, 1.0))
    belongs = [
        Record("member", f"{name} in group", {"owner": f"@{name}", "group": f"@{dice.pick(names)}"})
        for name in members
        if dice.chance(share)
    ]
    return [*(Record("light_group", name, {}) for name in names), *belongs]


def _aovs(dice, records, trees):
    """One to three AOVs, given by materials, worlds and what groups they use, by nodes and as constants."""
    wanted = dice.some(_AOVS, 0.5) or ["Tint"]
    trees.records, trees.is_opaque = [], False
    for record in records:
        if record.verb not in ("material", "world", "group"):
            continue
        if record.verb == "group" and dice.chance(0.8):
            continue
        for name in dice.some(wanted, 0.7):
            _give(dice, trees, record.name, name)
    return [*(Record("aov", name, {"type": _AOVS[name]}) for name in wanted), *trees.records]


def _give(dice, trees, tree, name):
    is_color = _AOVS[name] == "COLOR"
    trees.budget = dice.whole(1, 4)
    value = dice.color(-0.5, 2.0) if is_color else dice.number(-2.0, 2.0)
    if dice.chance(0.7):
        value = trees.value(tree, "c" if is_color else "f", 2)
    trees.write(tree, "ShaderNodeOutputAOV", {}, {"Color" if is_color else "Value": value}, aov=name)


def _catch(dice, records):
    """Let the floor, or another thing, catch shadows; a lamp or two light the objects of the picture alone."""
    things = [record for record in records if record.verb == "object" and record.name.startswith(("Ground", "Thing"))]
    caught = [record for record in things if record.name == "Ground"] if dice.chance(0.7) else []
    for record in caught or [dice.pick(things)]:
        record.fields.setdefault("settings", {})["is_shadow_catcher"] = True
    for record in records:
        if record.verb == "object" and record.name.startswith("Lamp") and "data" in record.fields and dice.chance(0.15):
            record.fields.setdefault("settings", {})["is_shadow_catcher"] = False
