"""Switches of objects, materials, view layers and cameras that become one number or flag of the snapshot."""

import bpy
import stage
from export_cases import export_told

from addon.bindings.enums import CameraKind, MaterialFlag, NodeKind


def _owner(thing, name):
    """Return the owner of a setting in this Blender: the data-block, or its settings of Cycles in older versions."""
    return thing if hasattr(thing, name) else thing.cycles


def terminators():
    stage.empty()
    for name, value in (("as it comes", None), ("none", 0.0), ("wide", 0.75)):
        item = stage.cube()
        item.name = name
        if value is not None:
            setting = "shadow_terminator_geometry_offset"
            setattr(_owner(item, setting), setting, value)
    table = export_told()[0].instances
    return {table.names[table.name_indices[i]]: float(table.terminators[i]) for i in range(len(table))}


def flags():
    stage.empty()
    bare, dull, solid = (stage.shader(name=name) for name in ("bare", "dull", "solid"))
    if hasattr(dull.cycles, "emission_sampling"):
        dull.cycles.emission_sampling = "NONE"
    else:
        dull.cycles.sample_as_light = False
    correction = hasattr(bare.cycles, "use_bump_map_correction")
    if correction:
        bare.cycles.use_bump_map_correction = False
    # The setting is Cycles' own in older versions.
    owner = solid.cycles if hasattr(solid.cycles, "use_transparent_shadow") else solid
    owner.use_transparent_shadow = False
    for material in (stage.shader(name="plain"), bare, dull, solid):
        stage.cube(material=material)
    materials = export_told()[0].materials
    told = {material.name: [flag.name for flag in MaterialFlag if material.flags & flag] for material in materials}
    return {**told, "has correction": correction}


def weak_lights():
    """Return which materials are sampled as lights, by their emission."""
    stage.empty()
    stage.cube(material=stage.shader("ShaderNodeEmission", name="dim", Color=(1.0, 0.2, 0.2, 1.0), Strength=0.5))
    stage.cube(material=stage.shader("ShaderNodeEmission", name="bright", Color=(1.0, 0.2, 0.2, 1.0), Strength=0.51))
    textured = stage.shader("ShaderNodeEmission", name="textured", Strength=0.5)
    strong = stage.shader("ShaderNodeEmission", name="strong texture", Strength=0.6)
    for material in (textured, strong):
        tree = material.node_tree
        picture = tree.nodes.new("ShaderNodeTexCoord")
        emission = next(node for node in tree.nodes if node.type == "EMISSION")
        tree.links.new(picture.outputs["Generated"], emission.inputs["Color"])
        stage.cube(material=material)
    asked = stage.shader("ShaderNodeEmission", name="asked for", Strength=0.1)
    if hasattr(asked.cycles, "emission_sampling"):
        asked.cycles.emission_sampling = "FRONT_BACK"
    stage.cube(material=asked)
    materials = export_told()[0].materials
    lights = {material.name: not material.flags & MaterialFlag.NOT_A_LIGHT for material in materials}
    return {**lights, "decides": hasattr(asked.cycles, "emission_sampling")}


def overrides():
    scene = stage.empty(samples=4)
    stage.cube(material=stage.shader(name="own"))
    stage.cube(material=None)
    scene.world = stage.sky((1.0, 0.0, 0.0))
    layer = bpy.context.view_layer
    layer.material_override, layer.samples = stage.shader(name="clay"), 9
    result = {"has world": hasattr(layer, "world_override")}
    if result["has world"]:
        other = stage.sky((0.0, 0.5, 0.0))
        other.mist_settings.start = 3.0
        layer.world_override, scene.world = other, bpy.data.worlds[0]
    snapshot = export_told()[0]
    slots = snapshot.instances.slots.tolist()
    result["materials"] = [snapshot.materials[number].name for number in slots]
    result["samples"] = snapshot.settings.samples
    result["radiance"], result["mist"] = list(snapshot.world.radiance), snapshot.settings.mist_start
    layer.material_override, layer.samples = None, 0
    snapshot = export_told()[0]
    result["without"] = sorted({material.name for material in snapshot.materials}), snapshot.settings.samples
    return result


PANORAMAS = {
    "EQUIRECTANGULAR": {"latitude_min": -0.5, "latitude_max": 0.25, "longitude_min": -2.0, "longitude_max": 1.5},
    "FISHEYE_EQUIDISTANT": {"fisheye_fov": 2.5},
    "FISHEYE_EQUISOLID": {"fisheye_fov": 2.0, "fisheye_lens": 8.0},
    "FISHEYE_LENS_POLYNOMIAL": {"fisheye_fov": 1.5, **{f"fisheye_polynomial_k{i}": 0.25 * (i + 1) for i in range(5)}},
    "MIRRORBALL": {},
    "CENTRAL_CYLINDRICAL": {
        "central_cylindrical_range_u_min": -1.0,
        "central_cylindrical_range_u_max": 2.0,
        "central_cylindrical_range_v_min": -0.5,
        "central_cylindrical_range_v_max": 0.75,
        "central_cylindrical_radius": 1.25,
    },
}


def cameras():
    """Return every panorama of this Blender on a sensor of 32 x 24 mm with an image of 2 x 1, and the lens of one."""
    result = {"version": list(bpy.app.version)}
    for kind, fields in PANORAMAS.items():
        stage.empty(width=40, height=20)
        camera = stage.camera(type="PANO", sensor_width=32.0, sensor_height=24.0, shift_x=0.125, shift_y=-0.25).data
        owner = _owner(camera, "panorama_type")
        if kind not in type(owner).bl_rna.properties["panorama_type"].enum_items:
            continue
        owner.panorama_type = kind
        for name, value in fields.items():
            setattr(owner, name, value)
        camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 2.0, 0.5
        camera.dof.aperture_blades, camera.dof.aperture_rotation, camera.dof.aperture_ratio = 5, 0.5, 2.0
        got = export_told()[0].camera
        result[kind] = {
            "kind": CameraKind(got.kind).name,
            "panorama": list(got.panorama),
            "window": list(got.window),
            "aperture": [got.aperture_blades, got.aperture_rotation, got.aperture_ratio],
            "lens": [got.lens_radius, got.focal_distance],
        }
    return result


def normal_maps():
    """The flags of a normal map's node, by the file's own nodes."""
    stage.empty()
    material = stage.shader(name="mapped")
    tree = material.node_tree
    surface = next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE")
    picture = tree.nodes.new("ShaderNodeTexCoord")
    node = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(picture.outputs["Generated"], node.inputs["Color"])
    tree.links.new(node.outputs["Normal"], surface.inputs["Normal"])
    stage.cube(material=material)
    (exported,) = (one for one in export_told()[0].materials if one.name == "mapped")
    flags = [int(one.flags) for one in exported.nodes if one.kind == NodeKind.NORMAL_MAP]
    return {"flags": flags, "version": list(bpy.app.version)}
