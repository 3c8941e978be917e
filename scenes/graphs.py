"""Materials of many nodes: one of 60 nodes, most of which fold, and a floor of planks computed by textures."""

import math

import bpy

from . import parts


class Graph:
    """The nodes of a Principled material, under construction."""

    def __init__(self, name, **inputs):
        self.material = parts.principled(name, **inputs)
        self.tree = self.material.node_tree
        self.principled = next(node for node in self.tree.nodes if node.type == "BSDF_PRINCIPLED")

    def add(self, kind, inputs=None, **properties):
        """Add a node. inputs: constants or output sockets, by identifier or number."""
        node = self.tree.nodes.new("ShaderNode" + kind)
        for key, value in properties.items():
            setattr(node, key, value)
        for key, value in (inputs or {}).items():
            socket = node.inputs[key] if isinstance(key, int) else next(s for s in node.inputs if s.identifier == key)
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = value
        return node

    def math(self, operation, a, b=0.0, c=0.0):
        inputs = {0: a, 1: b} if operation != "MULTIPLY_ADD" else {0: a, 1: b, 2: c}
        return self.add("Math", inputs, operation=operation).outputs[0]

    def mix(self, factor, a, b, blend_type="MIX"):
        """Add a mix of two colours, with four numbers each or a socket."""
        node = self.add("Mix", data_type="RGBA", blend_type=blend_type)
        for key, value in (("Factor_Float", factor), ("A_Color", a), ("B_Color", b)):
            socket = next(s for s in node.inputs if s.identifier == key)
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = value
        return next(s for s in node.outputs if s.identifier == "Result_Color")

    def ramp(self, factor, *colors):
        """Add a ramp of evenly spaced colours."""
        node = self.add("ValToRGB", {0: factor})
        elements = node.color_ramp.elements
        for _ in colors[2:]:
            elements.new(0.5)
        for number, color in enumerate(colors):
            elements[number].position = number / (len(colors) - 1)
            elements[number].color = (*color, 1.0)
        return node.outputs[0]

    def noise(self, vector, scale, detail):
        return self.add("TexNoise", {"Vector": vector, "Scale": scale, "Detail": detail}).outputs[0]

    def show(self, name, value):
        self.tree.links.new(value, self.principled.inputs[name])


def sixty_nodes(name="Sixty nodes"):
    """Return a material as it grows over the years: 60 nodes, of which 13 do not fold.

    The others are constant, repeat one of these, change nothing, or are hidden by a factor of 0.
    """
    graph = Graph(name)
    place = graph.add("TexCoord").outputs["Object"]  # 1
    # Twice the same: coordinates through a mapping that changes nothing, noise, a ramp and its contrast.
    sides = []
    for _ in range(2):
        vector = graph.add("Mapping", {"Vector": place}).outputs[0]
        grain = graph.noise(vector, 4.0, 4.0)
        wide = graph.math("MULTIPLY_ADD", grain, 1.8, -0.4)
        color = graph.ramp(wide, (0.20, 0.11, 0.06), (0.55, 0.36, 0.20), (0.80, 0.62, 0.42))
        flakes = graph.add("TexVoronoi", {"Vector": vector, "Scale": 9.0}).outputs["Distance"]
        dents = graph.math("SMOOTH_MIN", flakes, 0.5, 0.1)
        wear = graph.math("SUBTRACT", 1.0, dents)
        stain = graph.mix(wear, color, (0.06, 0.05, 0.04, 1.0), "MULTIPLY")
        sides.append((stain, wear, grain))  # 8 nodes each: 17
    (stain, wear, grain), (same, _, _) = sides
    # A sum, a product, a difference and a quotient that change nothing, six times: 41.
    rough = grain
    for _ in range(6):
        rough = graph.math("ADD", graph.math("MULTIPLY", rough, 1.0), 0.0)
        rough = graph.math("SUBTRACT", graph.math("DIVIDE", rough, 1.0), 0.0)
    # A constant tint out of five nodes, and its use: 47.
    tint = graph.add("RGB").outputs[0]
    tint.default_value = (0.9, 0.8, 0.7, 1.0)
    shade = graph.add("Value").outputs[0]
    shade.default_value = 0.8
    level = graph.math("POWER", graph.math("ADD", shade, 0.2), 2.0)
    scaled = graph.mix(level, (0.0, 0.0, 0.0, 1.0), tint)
    tinted = graph.mix(0.6, stain, scaled, "MULTIPLY")
    # Moss, which a factor of 0 hides: 51.
    moss = graph.ramp(graph.noise(place, 30.0, 12.0), (0.02, 0.10, 0.02), (0.20, 0.40, 0.10))
    hidden = graph.add("HueSaturation", {"Color": moss}).outputs[0]
    shown = graph.mix(0.0, tinted, hidden)
    # The other side by a factor of 1, taken apart and put together: 54.
    both = graph.mix(1.0, same, shown)
    parts_of = graph.add("SeparateXYZ", {0: both})
    whole = graph.add("CombineXYZ", {axis: parts_of.outputs[axis] for axis in range(3)}).outputs[0]
    graph.show("Base Color", whole)
    # Roughness within limits that are constants themselves: 58.
    low = graph.math("MULTIPLY", 0.5, 0.5)
    high = graph.math("ADD", low, 0.5)
    within = graph.math("MINIMUM", graph.math("MAXIMUM", rough, low), high)
    graph.show("Roughness", within)
    # A bump of the wear: 60.
    height = graph.math("MULTIPLY", wear, 0.4)
    graph.show("Normal", graph.add("Bump", {"Height": height, "Strength": 0.3}).outputs[0])
    return graph.material


def planks(name="Planks"):
    """Return wooden planks: bricks, grain by distorted waves and noise, gaps and dents by a bump. Nothing can be left out."""
    graph = Graph(name)
    place = graph.add("TexCoord").outputs["Object"]
    sizes = {"Vector": place, "Scale": 1.0, "Mortar Size": 0.004, "Brick Width": 1.6, "Row Height": 0.16}
    boards = graph.add("TexBrick", sizes)
    for key, value in (("Color1", (0.2, 0.2, 0.2, 1.0)), ("Color2", (0.9, 0.9, 0.9, 1.0)), ("Mortar", (0.0, 0.0, 0.0, 1.0))):
        boards.inputs[key].default_value = value
    along = graph.add("Mapping", {"Vector": place, "Scale": (0.6, 9.0, 1.0)}).outputs[0]
    shifted = graph.add("VectorMath", {0: along, 1: boards.outputs[0]}, operation="MULTIPLY_ADD")
    shifted.inputs[1].default_value = (1.0, 1.0, 1.0)
    graph.tree.links.new(boards.outputs[0], shifted.inputs[2])
    waves = {"Vector": shifted.outputs[0], "Scale": 1.2, "Distortion": 7.0, "Detail": 3.0}
    rings = graph.add("TexWave", waves, bands_direction="Y").outputs["Fac"]
    fibres = graph.noise(shifted.outputs[0], 24.0, 5.0)
    grain = graph.math("MULTIPLY_ADD", fibres, 0.35, graph.math("MULTIPLY", rings, 0.65))
    wood = graph.ramp(grain, (0.16, 0.07, 0.03), (0.42, 0.22, 0.10), (0.66, 0.42, 0.22))
    toned = graph.mix(0.35, wood, boards.outputs[0], "OVERLAY")
    knots = graph.add("TexVoronoi", {"Vector": place, "Scale": 2.2, "Randomness": 1.0}).outputs["Distance"]
    dark = graph.ramp(knots, (0.3, 0.25, 0.2), (1.0, 1.0, 1.0))
    graph.show("Base Color", graph.mix(0.5, toned, dark, "MULTIPLY"))
    graph.show("Roughness", graph.math("MULTIPLY_ADD", fibres, 0.3, 0.25))
    gaps = graph.math("MULTIPLY_ADD", boards.outputs["Fac"], -1.0, graph.math("MULTIPLY", fibres, 0.15))
    graph.show("Normal", graph.add("Bump", {"Height": gaps, "Distance": 0.02}).outputs[0])
    return graph.material


def _show(scene, material):
    parts.set_size(scene, 640, 480, 64)
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 12.0), material)
    ball = parts.principled("Ball", base_color=(0.8, 0.8, 0.8), roughness=0.4, ior=1.5)
    parts.place(scene, "Ball", parts.sphere_mesh("Ball", radius=0.6), ball, (0.9, 0.4, 0.6))
    parts.place(scene, "Torus", parts.torus_mesh("Torus"), material, (-0.9, 0.2, 0.32), 0.8)
    parts.add_light(scene, "Sun", "SUN", 2.5, (4, -3, 6), angle=math.radians(3.0))
    parts.set_world(scene, (0.5, 0.6, 0.75), 0.7)
    parts.add_camera(scene, (0.0, -4.2, 2.0), (0, 0.2, 0.3), lens=40.0)


def build_sixty_nodes(scene):
    """A floor and a ring of the material of 60 nodes, of which 13 do not fold."""
    _show(scene, sixty_nodes())


def build_procedural_floor(scene):
    """A floor and a ring of planks without an image: bricks, waves, noise and Voronoi cells, with a bump."""
    _show(scene, planks())
