"""Point Density as it is exported: the voxels and their place, beside those of the definition; and nodes without points."""

import bpy
import numpy as np
import parts_cases
import stage
from export_cases import export_told

from addon.bindings.enums import NodeKind

_RADIUS, _SIDE = 0.7, 6
_POINTS = ((0.0, 0.0, 0.0), (1.0, 0.2, 0.0), (0.3, 1.0, 0.4), (1.2, 1.1, -0.5))


def _node(**fields):
    """Return a node whose colour a new cube emits; its material is the first of the scene."""
    material = stage.shader("ShaderNodeEmission", name="Shown")
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexPointDensity")
    node.name = "Dust"
    node.resolution, node.radius = _SIDE, _RADIUS
    for name, value in fields.items():
        setattr(node, name, value)
    emission = next(item for item in tree.nodes if item.type == "EMISSION")
    tree.links.new(node.outputs["Color"], emission.inputs["Color"])
    tree.links.new(node.outputs["Density"], emission.inputs["Strength"])
    stage.cube(material=material)
    return node


def _cloud(name="Cloud"):
    """Return a mesh of four points with a face, moved by a modifier along x."""
    thing = stage.mesh(name, _POINTS, [(0, 1, 3, 2)])
    modifier = thing.modifiers.new("Moved", "DISPLACE")
    modifier.direction, modifier.mid_level, modifier.strength = "X", 0.0, 0.5
    return thing


def _expected(points, normals):
    """Return the density and the mean normal around each voxel, (z, y, x) and (z, y, x, 3), and the corners of the cube."""
    low, high = points.min(0) - _RADIUS, points.max(0) + _RADIUS
    steps = [low[axis] + (high - low)[axis] * np.arange(_SIDE) / _SIDE for axis in range(3)]
    places = np.stack(np.meshgrid(*steps[::-1], indexing="ij")[::-1], -1)
    squares = ((places[..., None, :] - points) ** 2).sum(-1)
    near = squares < _RADIUS**2
    density = np.where(near, (1.0 - squares / _RADIUS**2) / 2.0, 0.0).sum(-1)
    count = np.maximum(near.sum(-1), 1)[..., None]
    return density, (near[..., None] * normals).sum(-2) / count, low, high


def voxels():
    """Return the largest differences from the definition, and whether the export has left the user's node as it was."""
    stage.empty()
    cloud = _cloud()
    cloud.location, cloud.rotation_euler, cloud.scale = (0.5, -1.0, 2.0), (0.3, 0.2, 1.0), (1.0, 2.0, 0.5)
    fields = {"point_source": "OBJECT", "object": cloud, "vertex_color_source": "VERTEX_NORMAL", "space": "WORLD"}
    node = _node(**fields, interpolation="Cubic")
    before = _settings(node)
    snapshot, messages = export_told()
    material = next(item for item in snapshot.materials if item.name == "Shown")
    look_up = next(item for item in material.nodes if item.kind == NodeKind.VOXELS)
    found = snapshot.images[look_up.image].texels.reshape(_SIDE, _SIDE, _SIDE, 4)
    points = np.array(_POINTS) + (0.5, 0.0, 0.0)
    normals = np.zeros((len(points), 3))
    cloud.data.vertices.foreach_get("normal", flat := np.zeros(normals.size))
    density, colors, low, high = _expected(points, flat.reshape(-1, 3))
    place = material.nodes[look_up.inputs[0].node]
    matrix = np.array(place.matrix).reshape(3, 4)
    corners = [np.array(cloud.matrix_world) @ (*corner, 1.0) for corner in (low, high)]
    return {
        "density": float(abs(found[..., 3] - density).max()),
        "color": float(abs(found[..., :3] - colors).max()),
        "seen": float(density.max()),
        "corners": [(matrix @ corner).tolist() for corner in corners],
        "option": int(look_up.option),
        "nodes": [item.kind for item in material.nodes].count(NodeKind.VOXELS),
        "kept": before == _settings(node),
        "messages": messages.lines(),
    }


def _settings(node):
    return [repr(getattr(node, field.identifier)) for field in node.bl_rna.properties]


def nowhere():
    """Return the messages of nodes without points, by what they lack, and the emission of each."""
    result = {}
    for name in ("object", "vertices", "mesh", "system", "shown system", "memory"):
        stage.empty()
        thing = _cloud()
        node = _node(point_source="OBJECT", object=thing)
        if name == "object":
            node.object = None
        elif name == "vertices":
            node.object = stage.link("Void", bpy.data.meshes.new("Void"))
        elif name == "mesh":
            node.object = stage.link("Bar", bpy.data.curves.new("Bar", "CURVE"))
        elif name == "system":
            node.point_source = "PARTICLE_SYSTEM"
        elif name == "shown system":
            modifier = thing.modifiers.new("Sparks", "PARTICLE_SYSTEM")
            node.point_source, node.particle_system = "PARTICLE_SYSTEM", thing.particle_systems[0]
            modifier.show_render = False
        else:
            node.resolution = 20000
        snapshot, messages = export_told()
        material = next(item for item in snapshot.materials if item.name == "Shown")
        lines = [line for line in messages.lines() if "Dust" in line]
        result[name] = [lines, material.emission]
    return result


def edits():
    """As parts_cases.edits, of objects whose vertices or particles a node reads."""
    scene = stage.empty()
    scene.frame_set(1)
    cloud, emitter = _cloud(), _cloud("Sparks")
    emitter.modifiers.new("Sparks", "PARTICLE_SYSTEM").particle_system.settings.frame_end = 4.0
    _node(point_source="OBJECT", object=cloud, space="WORLD")
    _node(point_source="PARTICLE_SYSTEM", object=emitter).particle_system = emitter.particle_systems[0]

    def pull():
        cloud.data.vertices[0].co.x -= 0.5
        cloud.data.update()

    def move():
        cloud.location.x += 0.25

    found = parts_cases.results({"points": pull, "place": move, "frame": lambda: scene.frame_set(2)})
    return {name: (result[0]["shaders"], *result[1:3]) for name, result in found.items()}


def roughness():
    """Return the messages of a Principled BSDF whose roughness is a density."""
    stage.empty()
    node = _node(point_source="OBJECT", object=_cloud())
    tree = node.id_data
    surface = tree.nodes.new("ShaderNodeBsdfPrincipled")
    tree.links.new(node.outputs["Density"], surface.inputs["Roughness"])
    tree.links.new(surface.outputs[0], next(item for item in tree.nodes if item.type == "OUTPUT_MATERIAL").inputs["Surface"])
    return export_told()[1].lines()
