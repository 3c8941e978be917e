"""Point Density on surfaces, which is 0 there since Blender 4.0: its spaces, its interpolations, its sources and colours."""

import bpy

from .. import parts
from .boards import set_board, size_of, tile_mesh
from .catalogue import case, variants

_POINTS = ((-0.3, -0.2, 0.05), (0.25, -0.35, -0.1), (0.1, 0.3, 0.1), (-0.25, 0.35, 0.0), (0.4, 0.15, 0.2))
_INTERPOLATIONS = ("Closest", "Linear", "Cubic")
_OUTPUTS = ("Density", "Color")
_OLD = {"until": (5, 0)}


def _cloud(scene, name, location=(0.0, 0.0, 0.0)):
    """A mesh that no camera sees, with a colour and a weight for each point, and faces for normals."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(_POINTS, [], [(0, 1, 2), (0, 2, 3), (1, 4, 2)])
    mesh.update()
    colors = mesh.color_attributes.new("Col", "BYTE_COLOR", "CORNER")
    for number, item in enumerate(colors.data):
        item.color = (number % 3 / 2, number % 2, number % 5 / 4, 1.0)
    thing = parts.place(scene, name, mesh, None, location, (0.9, 1.1, 0.8), rotation=(0.1, 0.2, 0.3))
    group = thing.vertex_groups.new(name="Weight")
    for number in range(len(_POINTS)):
        group.add([number], number / len(_POINTS), "REPLACE")
    thing.hide_render = True
    return thing


def _sparks(scene, name, location):
    """An emitter whose particles have flown for some frames."""
    thing = _cloud(scene, name, location)
    settings = thing.modifiers.new("Sparks", "PARTICLE_SYSTEM").particle_system.settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 12, -20.0, 1.0, 50.0
    settings.normal_factor, settings.factor_random = 0.3, 0.3
    settings.effector_weights.gravity = 0.0
    scene.frame_set(-20)
    for frame in range(-19, 6):
        scene.frame_set(frame)
    return thing


def _place(nodes):
    """The tile's square at one height in the unit cube of its own space."""
    position = nodes.add("ShaderNodeNewGeometry").outputs["Position"]
    return nodes.add("ShaderNodeVectorMath", position, (0.5, 0.5, 0.45)).outputs[0]


def _density(nodes, source, fields, place):
    """Adds a node with the points of an object, and with these settings instead of its own."""
    node = nodes.add("ShaderNodeTexPointDensity")
    node.object, node.resolution, node.radius, node.point_source = source, 7, 0.35, "OBJECT"
    for name, setting in fields.items():
        setattr(node, name, setting)
    if source.particle_systems:
        node.particle_system = source.particle_systems[0]
    if place is not None:
        nodes.link(place(nodes), node.inputs["Vector"])
    return node


def _set(scene, make, settings):
    """Shows a tile for each of (output, place, fields), whose source is made where the tile stands."""
    tiles = []
    for number, (output, place, fields) in enumerate(settings):
        source = make(scene, f"Cloud {number}", (number % 8 + 0.5, number // 8 + 0.5, 0.0))
        tiles.append((tile_mesh(), _shown(source, output, place, fields)))
    return set_board(scene, tiles)


def _shown(source, output, place, fields):
    return lambda nodes: _density(nodes, source, fields, place).outputs[output]


@variants(values={name.lower(): name for name in _INTERPOLATIONS}, quick=True, size=size_of(4), **_OLD)
def point_density(scene, interpolation):
    """In the bounds of the points, and in the space of the tile."""
    shared = {"interpolation": interpolation, "vertex_color_source": "VERTEX_NORMAL"}
    in_world, in_object = ({"space": space, **shared} for space in ("WORLD", "OBJECT"))
    _set(scene, _cloud, [(name, None, in_world) for name in _OUTPUTS] + [(name, _place, in_object) for name in _OUTPUTS])


@case(quick=True, size=size_of(6), **_OLD)
def point_density_of_vertices(scene):
    """The colours of vertices: of corners, of the weight in a group, of normals."""
    sources = ("VERTEX_COLOR", "VERTEX_WEIGHT", "VERTEX_NORMAL")
    names = {"VERTEX_COLOR": "Col", "VERTEX_WEIGHT": "Weight"}
    fields = [
        {"space": "WORLD", "vertex_color_source": source, "vertex_attribute_name": names.get(source, "")} for source in sources
    ]
    _set(scene, _cloud, [(output, None, item) for item in fields for output in _OUTPUTS])


@case(quick=True, size=size_of(6), **_OLD)
def point_density_of_particles(scene):
    """The colours of particles: age, speed, velocity."""
    sources = ("PARTICLE_AGE", "PARTICLE_SPEED", "PARTICLE_VELOCITY")
    shared = {"space": "WORLD", "point_source": "PARTICLE_SYSTEM"}
    fields = [{**shared, "particle_color_source": source} for source in sources]
    _set(scene, _sparks, [(output, None, item) for item in fields for output in _OUTPUTS])


@case(quick=True, size=size_of(4), **_OLD)
def point_density_at_the_limits(scene):
    """One voxel; no object; no particle system; small points in a fine cube."""
    limits = ({"resolution": 1}, {"object": None}, {"point_source": "PARTICLE_SYSTEM"}, {"radius": 0.2, "resolution": 24})
    _set(scene, _cloud, [("Density", None, {"space": "WORLD", **fields}) for fields in limits])


@case(quick=True, size=size_of(1), **_OLD)
def point_density_as_bump(scene):
    source = _cloud(scene, "Cloud", (0.5, 0.5, 0.0))

    def normal(nodes):
        node = _density(nodes, source, {"space": "WORLD", "interpolation": "Cubic"}, None)
        return nodes.add("ShaderNodeBump", Strength=0.8, Distance=0.2, Height=node.outputs["Density"]).outputs[0]

    set_board(scene, [(tile_mesh(), normal)])


@case(size=size_of(2), announced="volumes are not supported", **_OLD)
def point_density_beside_a_volume(scene):
    """In the texture space of the mesh, which an object with a volume has."""
    for thing in _set(scene, _cloud, [(output, None, {}) for output in _OUTPUTS]):
        tree = thing.active_material.node_tree
        volume = tree.nodes.new("ShaderNodeVolumeAbsorption")
        volume.inputs["Density"].default_value = 0.0
        end = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
        tree.links.new(volume.outputs[0], end.inputs["Volume"])
