"""describe(seed): a random small scene of what the add-on supports, as records. Knows nothing of Blender."""

from . import (
    closure_kinds,
    random_bakes,
    random_emitters,
    random_exact,
    random_frames,
    random_images,
    random_lights,
    random_limits,
    random_links,
    random_motion,
    random_outputs,
    random_photometry,
    random_properties,
    random_views,
)
from .dice import Dice
from .random_nodes import Trees
from .random_things import Things
from .record import Record

# Features that are rare in scenes unless they are asked for.
FEATURES = ("motion", "outputs", "links", "limits", "bakes", "views")


def describe(seed, asked=()):
    """asked: names of FEATURES that the scene has in any case."""
    dice = Dice(seed)
    images = [random_images.image(dice, number + 1) for number in range(dice.pick({0: 3, 1: 3, 2: 1}))]
    materials = [_material(dice, number + 1) for number in range(dice.pick({1: 4, 2: 3}))]
    lamps = [record for number in range(dice.pick({0: 3, 1: 5, 2: 2})) for record in random_lights.lamp(dice, number + 1)]
    things = Things(dice, [record.name for record in materials])
    things.fill()
    frame, views = random_frames.frame(dice)
    luminaires = [random_photometry.luminaire(dice, number + 1) for number in range(dice.whole(0, 1))]
    named = [[record.name for record in records] for records in (images, luminaires)]
    trees = Trees(dice, named[0], things.names, named[1])
    trees.is_opaque = frame.get("kind") == "DATA"
    for record in materials:
        trees.material(record.name)
    worlds = []
    world = random_emitters.world(dice, bool(lamps))
    if world is not None:
        sky = random_images.sky(dice) if dice.chance(0.3) else None
        worlds = [*([sky] if sky else []), world]
        random_emitters.world_tree(trees, "World", sky and sky.name)
    if any("world_override" in record.fields for record in views):
        worlds.append(Record("world", "Other world", {"apart": True}))
        random_emitters.world_tree(trees, "Other world")
    for record in lamps:
        if record.verb == "lamp" and dice.chance(0.3):
            record.fields["nodes"] = True
            random_emitters.lamp_tree(trees, record.name, record.fields["type"] == "SUN")
    kinds = {
        record.fields["kind"]
        for record in trees.records
        if record.verb == "node" and record.fields["kind"] in closure_kinds.SHADERS
    }
    frame.setdefault("kind", "EXACT" if kinds <= closure_kinds.EXACT else "LOBES")
    everything = [
        Record("frame", "Frame", frame),
        *images,
        *luminaires,
        *materials,
        *worlds,
        *lamps,
        *things.records,
        *views,
        *trees.records,
    ]
    everything += random_properties.properties(dice, everything)
    everything = random_exact.make_exact(dice, everything)
    if dice.chance(0.3):
        for record in images:
            record.fields["cached"] = True
    everything += random_motion.motion(dice, everything, "motion" in asked)
    everything += random_outputs.outputs(dice, everything, trees, "outputs" in asked)
    everything += random_links.links(dice, everything, "links" in asked)
    everything += random_limits.limits(dice, everything, "limits" in asked)
    everything += random_bakes.bakes(dice, everything, "bakes" in asked)
    everything += random_views.views(dice, everything, "views" in asked)
    return [record for record in everything if record.fields or record.verb not in ("film", "layer")]


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
