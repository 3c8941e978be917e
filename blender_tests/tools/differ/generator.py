"""describe(seed): a random small scene of what the add-on supports, as records. Knows nothing of Blender."""

from . import closure_kinds, random_frames, random_lights
from .dice import Dice
from .random_nodes import Trees
from .random_things import Things
from .record import Record

_FORMATS = {"BYTE": 3, "FLOAT": 1, "PNG8": 1, "PNG16": 1, "TIFF": 1, "OPEN_EXR": 1, "HDR": 1}
_SPACES = ("sRGB", "sRGB", "Non-Color", "Linear", "Filmic sRGB")


def describe(seed):
    dice = Dice(seed)
    images = [_image(dice, number + 1) for number in range(dice.pick({0: 3, 1: 3, 2: 1}))]
    materials = [_material(dice, number + 1) for number in range(dice.pick({1: 4, 2: 3}))]
    things = Things(dice, [record.name for record in materials])
    things.fill()
    lamps = [record for number in range(dice.pick({0: 3, 1: 5, 2: 2})) for record in random_lights.lamp(dice, number + 1)]
    frame, views = random_frames.frame(dice)
    trees = Trees(dice, [record.name for record in images], things.names)
    trees.is_opaque = frame.get("kind") == "DATA"
    for record in materials:
        trees.material(record.name)
    world, sky = _world(dice, bool(lamps)), None
    if dice.chance(0.3):
        sky = Record(
            "image",
            "Sky",
            {
                "format": "FLOAT",
                "size": [16, 8],
                "space": "Linear",
                "seed": dice.whole(0, 99),
                "peak": dice.pick((1.0, 1.0, 20.0)),
            },
        )
    if world is not None:
        trees.world("World", sky and sky.name)
    for record in lamps:
        if record.verb == "lamp" and dice.chance(0.15):
            record.fields["nodes"] = True
            trees.light(record.name)
    kinds = {
        record.fields["kind"]
        for record in trees.records
        if record.verb == "node" and record.fields["kind"] in closure_kinds.SHADERS
    }
    frame.setdefault("kind", "EXACT" if kinds <= closure_kinds.EXACT else "LOBES")
    head = [*images, *([sky] if sky and world else []), *materials, *([world] if world else [])]
    everything = [Record("frame", "Frame", frame), *head, *things.records, *lamps, *views, *trees.records]
    return [record for record in everything if record.fields or record.verb not in ("film", "layer")]


def _image(dice, number):
    fields = {"format": dice.pick(_FORMATS), "size": [dice.whole(1, 8), dice.whole(1, 8)], "space": dice.pick(_SPACES)}
    fields["alpha"] = dice.pick(("none", "none", "smooth", "cut"))
    fields["alpha_mode"] = dice.pick(("STRAIGHT", "STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"))
    return Record("image", f"Image {number}", {**fields, "seed": dice.whole(0, 99)})


def _material(dice, number):
    fields = {}
    if dice.chance(0.3):
        fields["pass_index"] = dice.whole(0, 9)
    if dice.chance(0.4):
        fields["displacement"] = dice.pick(("BUMP", "DISPLACEMENT", "BOTH"))
    if dice.chance(0.05):
        fields["opaque_shadows"] = True
    if dice.chance(0.1):
        fields["emission_sampling"] = dice.pick(("NONE", "AUTO", "FRONT", "BACK", "FRONT_BACK"))
    if dice.chance(0.1):
        fields["no_bump_correction"] = True
    return Record("material", f"Material {number}", fields)


def _world(dice, is_lit):
    if is_lit and dice.chance(0.3):
        return None
    fields = {}
    hidden = dice.some(("camera", "diffuse", "glossy", "transmission"), 0.05)
    if hidden:
        fields["hidden_from"] = hidden
    if dice.chance(0.2):
        fields["mist"] = {
            "start": dice.number(1.0, 4.0),
            "depth": dice.number(2.0, 6.0),
            "falloff": dice.pick(("LINEAR", "QUADRATIC", "INVERSE_QUADRATIC")),
        }
    if dice.chance(0.1):
        fields["occlusion_distance"] = dice.number(0.3, 3.0)
    return Record("world", "World", fields)
