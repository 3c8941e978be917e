"""Records of limits of light, of Fast GI and of Simplify as Cycles' settings."""


def build_fast_gi(scene, fields, find):
    """Whether Fast GI is on at all is a setting of each render."""
    cycles = scene.cycles
    cycles.fast_gi_method = fields.get("method", "REPLACE")
    cycles.ao_bounces = cycles.ao_bounces_render = fields.get("bounces", 1)
    if scene.world is not None:
        light = scene.world.light_settings
        light.ao_factor, light.distance = fields.get("factor", 1.0), fields.get("distance", 10.0)
    for thing, distance in _found(fields.get("distances", {}), find):
        thing.cycles.ao_distance = distance


def build_culling(scene, fields, find):
    cycles = scene.cycles
    if "margin" in fields:
        cycles.use_camera_cull, cycles.camera_cull_margin = True, fields["margin"]
    if "distance" in fields:
        cycles.use_distance_cull, cycles.distance_cull_margin = True, fields["distance"]
    for key, switch in (("beside", "use_camera_cull"), ("beyond", "use_distance_cull")):
        for thing, _ in _found(dict.fromkeys(fields.get(key, ())), find):
            setattr(thing.cycles, switch, True)


def build_texels(scene, fields):
    cycles = scene.cycles
    if hasattr(cycles, "texture_resolution_render"):
        cycles.texture_resolution_render = fields.get("share", 100.0)
    else:
        cycles.texture_limit_render = fields.get("limit", "OFF")


def _found(values, find):
    return [(thing, value) for thing, value in ((find(key), value) for key, value in values.items()) if thing is not None]
