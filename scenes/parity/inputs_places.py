"""What nodes know of the ray, the camera, the edges, the parts and the particles of what it meets."""

import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import material
from .stages import ball, camera, floor, lamp, sky

_SPACES = ("WORLD", "OBJECT", "CAMERA")


def _half(nodes, output, scale=0.5):
    """Brings a number or a vector to visible colours."""
    if output.type == "VECTOR":
        return nodes.add("ShaderNodeVectorMath", output, (scale,) * 3, (0.5,) * 3, props={"operation": "MULTIPLY_ADD"}).outputs[
            0
        ]
    return nodes.add("ShaderNodeMath", output, scale, 0.5, props={"operation": "MULTIPLY_ADD"}).outputs[0]


def _shining(build):
    return material(lambda nodes: nodes.add("ShaderNodeEmission", Color=build(nodes)))


def _blocks(scene, shown):
    """Two turned blocks of different sizes and a ball before a plain sky."""
    block = parts.cube_mesh("Block", 1.0)
    parts.place(scene, "Block", block, shown, (-0.9, 0.2, 0.5), (1.0, 0.8, 1.0), rotation=(0.2, 0.1, 0.4))
    parts.place(scene, "Beam", block, shown, (1.0, 0.6, 0.6), (0.4, 0.4, 1.2), rotation=(0.3, -0.3, 0.8))
    ball(scene, shown, 24, radius=0.45, location=(0.2, -0.6, 0.45))
    sky(scene, (0.2, 0.2, 0.2), 1.0)
    camera(scene, (0.3, -4.0, 1.8), (0, 0, 0.5))


@variants(values={"vector": "View Vector", "depth": "View Z Depth", "distance": "View Distance"}, quick=True)
def camera_data(scene, output):
    _blocks(scene, _shining(lambda nodes: _half(nodes, nodes.add("ShaderNodeCameraData").outputs[output], 0.1)))


@case()
def camera_data_mirrored(scene):
    """By a mirror, where the camera's view is not the ray's."""
    scale = _shining(lambda nodes: _half(nodes, nodes.add("ShaderNodeCameraData").outputs["View Distance"], 0.05))
    _blocks(scene, scale)
    mirror = material(lambda nodes: nodes.add("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0))
    parts.place(scene, "Mirror", parts.plane_mesh("Mirror", 8.0), mirror)


@variants(
    values={
        f"{kind.lower()}_{start.lower()}_{end.lower()}": (kind, start, end)
        for kind in ("POINT", "VECTOR", "NORMAL")
        for start in _SPACES
        for end in _SPACES
        if start != end
    },
    size=(64, 48),
)
def vector_transform(scene, setting):
    kind, start, end = setting

    def build(nodes):
        source = nodes.add("ShaderNodeNewGeometry").outputs["Position" if kind == "POINT" else "Normal"]
        props = {"vector_type": kind, "convert_from": start, "convert_to": end}
        return _half(nodes, nodes.add("ShaderNodeVectorTransform", source, props=props).outputs[0], 0.15)

    _blocks(scene, _shining(build))


_PLACES = ("Generated", "UV", "UV Map")


@variants(values={"world": (0.06, False), "pixels": (2.5, True)}, quick=True)
def wireframe(scene, setting):
    size, in_pixels = setting

    def build(nodes):
        return nodes.add("ShaderNodeWireframe", size, props={"use_pixel_size": in_pixels}).outputs[0]

    _blocks(scene, _shining(build))


@variants(values={"pointiness": "Pointiness", "island": "Random Per Island"}, quick=True)
def geometry_part(scene, output):
    """A block, a grid of bumps and a mesh of many parts."""

    def build(nodes):
        found = nodes.add("ShaderNodeNewGeometry").outputs[output]
        # Pointiness differs little from 1/2.
        scale = 3.0 if output == "Pointiness" else 1.0
        return nodes.add("ShaderNodeMath", found, scale, 0.5 - 0.5 * scale, props={"operation": "MULTIPLY_ADD"}).outputs[0]

    shown = _shining(build)
    _blocks(scene, shown)
    vertices, faces = [], []
    for number in range(24):
        x, y = number % 6 * 0.4 - 1.0, number // 6 * 0.4 - 1.4
        first = len(vertices)
        vertices += [(x, y, 0.0), (x + 0.3, y, 0.1), (x + 0.3, y + 0.3, 0.0), (x, y + 0.3, 0.2)]
        faces.append(tuple(first + k for k in range(4)))
        # Vertices at one place count as one for Pointiness, and join no parts.
        if number % 3 == 0:
            vertices += [(x + 0.3, y, 0.1), (x + 0.38, y + 0.15, 0.2), (x + 0.3, y + 0.3, 0.0)]
            faces.append((first + 4, first + 5, first + 6))
    mesh = bpy.data.meshes.new("Parts")
    mesh.from_pydata(vertices, [(0, 9)], faces)
    mesh.update()
    parts.place(scene, "Parts", mesh, shown)


@variants(
    values={name.lower().replace(" ", "_"): name for name in ("Index", "Random", "Age", "Lifetime", "Location", "Size")},
    bounces=0,
)
def particle_info(scene, output):
    """Particles on a plane, shown by a block, and the block itself, which stands for none."""
    scale = {"Index": 0.02, "Age": 0.005, "Lifetime": 0.005, "Random": 0.5, "Size": 0.5}.get(output, 0.2)
    shown = _shining(lambda nodes: _half(nodes, nodes.add("ShaderNodeParticleInfo").outputs[output], scale))
    block = parts.place(scene, "Shown", parts.cube_mesh("Shown", 0.8), shown, (0, -2.0, 0.4))
    ground = parts.place(
        scene, "Ground", parts.plane_mesh("Ground", 4.0), material(lambda nodes: nodes.add("ShaderNodeEmission"))
    )
    settings = ground.modifiers.new("Particles", "PARTICLE_SYSTEM").particle_system.settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 12, -8, 4, 30
    settings.lifetime_random, settings.size_random, settings.particle_size = 0.5, 0.6, 0.5
    settings.render_type, settings.instance_object = "OBJECT", block
    settings.physics_type = "NO"
    sky(scene, (0.2, 0.2, 0.2), 1.0)
    camera(scene, (0.3, -5.0, 4.0), (0, -0.2, 0.0))


def _from_instancer(nodes, output):
    if output == "UV Map":
        return nodes.add("ShaderNodeUVMap", props={"from_instancer": True}).outputs["UV"]
    return nodes.add("ShaderNodeTexCoord", props={"from_instancer": True}).outputs[output]


@variants(
    values={f"{where}_{name.lower().replace(' ', '_')}": (where, name) for where in ("faces", "hairs") for name in _PLACES},
    bounces=0,
    quick=True,
)
def from_instancer(scene, value):
    """Coordinates of the faces and the particles of a grid that show a block, and of the block itself."""
    where, output = value
    shown = _shining(lambda nodes: _half(nodes, _from_instancer(nodes, output), 0.5))
    block = parts.place(scene, "Shown", parts.cube_mesh("Shown", 0.3), shown, (0, -2.0, 0.4))
    mesh = parts.plane_mesh("Ground", 3.0)
    ground = parts.place(scene, "Ground", mesh, material(lambda nodes: nodes.add("ShaderNodeEmission")))
    if where == "faces":
        mesh.clear_geometry()
        corners = [(x, y, 0.0) for y in (-1.5, -0.2, 1.5) for x in (-1.5, -0.5, 0.5, 1.5)]
        mesh.from_pydata(corners, [], [(i, i + 1, i + 5, i + 4) for i in (0, 1, 2, 4, 5, 6)])
        layer = mesh.uv_layers.new(name="Map")
        for number, corner in enumerate(layer.data):
            corner.uv = 0.07 * (number % 11), 0.05 * (number % 17)
        ground.instance_type = "FACES"
        block.parent = ground
    else:
        settings = ground.modifiers.new("Particles", "PARTICLE_SYSTEM").particle_system.settings
        settings.type, settings.count, settings.hair_length = "HAIR", 12, 1.0
        settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", block, 0.5
    sky(scene, (0.2, 0.2, 0.2), 1.0)
    camera(scene, (0.3, -5.0, 4.0), (0, -0.2, 0.0))


@variants(values={"quadratic": "Quadratic", "linear": "Linear", "constant": "Constant"})
def light_falloff_of_surface(scene, output):
    """A shining ball whose strength falls with the length of rays, by which the camera and a floor see it."""

    def build(nodes):
        strength = nodes.add("ShaderNodeLightFalloff", 0.1, 0.4).outputs[output]
        return nodes.add("ShaderNodeEmission", Color=(0.9, 0.6, 0.3), Strength=strength)

    floor(scene)
    surface = material(build)
    if hasattr(surface.cycles, "emission_sampling"):
        surface.cycles.emission_sampling = "NONE"
    else:
        surface.cycles.sample_as_light = False
    ball(scene, surface, 32, radius=0.5, location=(0, 0.3, 0.7))
    lamp(scene)
    sky(scene)
    camera(scene)


@case(quick=True)
def facts_of_strands(scene):
    """Facts about strands, points and volumes, on a mesh."""

    def build(nodes):
        total = None
        for kind in ("ShaderNodeHairInfo", "ShaderNodePointInfo", "ShaderNodeVolumeInfo"):
            for output in nodes.add(kind).outputs:
                value = output if total is None else nodes.add("ShaderNodeVectorMath", total, output).outputs[0]
                total = value
        return _half(nodes, nodes.add("ShaderNodeVectorMath", total, (0.2,) * 3).outputs[0])

    _blocks(scene, _shining(build))
