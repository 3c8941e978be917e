"""Procedural textures and curves: compare Cycles' values with those of the core's nodes at the same places.

A case renders squares side by side with Cycles, one for each setting of a node, and then the texture coordinates of the same
hits, at which the core evaluates its nodes.
"""

import itertools
import random

import bpy
import numpy as np
import stage
from export_cases import export

from addon.bindings.session import Scene

# Light is not negative: this offset is added to every value; single precision keeps 2^-20 of the sum.
LIFT = 16.0
_WIDE = (4, 0)  # the first Blender with octaves of Voronoi cells and with unnormalised noise
_SHARPEST = 0.0 if bpy.app.version >= _WIDE else 0.05  # smoothness; before, 0 divides by 0 between two equally far points


class Board:
    """Squares of pixels in rows, each showing one output."""

    COLUMNS = 16

    def __init__(self, side):
        self.side = side
        self.scene = stage.empty(engine="CYCLES")
        self.names = []
        self.tree = None

    def square(self, name, build):
        """Add a square. build(tree, vector) returns the output socket to show; vector is a socket with 3D coordinates."""
        self.tree = self._material(name)
        output = build(self.tree, self._vector())
        self._show(self._lifted(output))
        x, y = (len(self.names) % self.COLUMNS), len(self.names) // self.COLUMNS
        corners = [(x, y, 0), (x + 1, y, 0), (x + 1, y + 1, 0), (x, y + 1, 0)]
        shown = stage.mesh(name, corners, [(0, 1, 2, 3)], bpy.data.materials[name])
        layer = shown.data.uv_layers.new(name="UVMap")
        for corner, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
            corner.uv = uv
        self.names.append(name)

    def _material(self, name):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        material.node_tree.nodes.clear()
        return material.node_tree

    def _vector(self):
        """Return a socket with coordinates, made by single operations, which both engines round alike."""
        place, parts, whole = (self.tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "SeparateXYZ", "CombineXYZ"))
        self.tree.links.new(place.outputs["UV"], parts.inputs[0])
        for axis, (a, b) in enumerate(((0, 0.6), (1, 0.3), (1, 0))):
            apart = self.tree.nodes.new("ShaderNodeMath")
            apart.operation = "SUBTRACT"
            self.tree.links.new(parts.outputs[a], apart.inputs[0])
            if isinstance(b, int):
                self.tree.links.new(parts.outputs[b], apart.inputs[1])
            else:
                apart.inputs[1].default_value = b
            self.tree.links.new(apart.outputs[0], whole.inputs[axis])
        return whole.outputs[0]

    def _lifted(self, output):
        lifted = self.tree.nodes.new("ShaderNodeVectorMath")
        lifted.operation, lifted.inputs[1].default_value = "ADD", (LIFT,) * 3
        self.tree.links.new(output, lifted.inputs[0])
        return lifted.outputs[0]

    def _show(self, output):
        emission, end = self.tree.nodes.new("ShaderNodeEmission"), self.tree.nodes.new("ShaderNodeOutputMaterial")
        self.tree.links.new(output, emission.inputs["Color"])
        self.tree.links.new(emission.outputs[0], end.inputs["Surface"])

    def rendered(self):
        """Return the rendered values, (squares, side^2, 3)."""
        picture = stage.picture(self.scene)[:, :, :3]
        rows = picture.shape[0] // self.side
        squares = picture.reshape(rows, self.side, self.COLUMNS, self.side, 3).transpose(0, 2, 1, 3, 4)
        return squares.reshape(rows * self.COLUMNS, -1, 3)[: len(self.names)]

    def answer(self):
        """Return {name: [points, range of Cycles' values, share within a thousandth of it, largest difference over it]}."""
        scene, columns, rows = self.scene, self.COLUMNS, -(-len(self.names) // self.COLUMNS)
        view = stage.camera(type="ORTHO", ortho_scale=float(max(columns, rows)))
        view.location, view.rotation_euler = (columns / 2, rows / 2, 1), (0, 0, 0)
        scene.render.resolution_x, scene.render.resolution_y = columns * self.side, rows * self.side
        scene.cycles.samples, scene.cycles.pixel_filter_type, scene.cycles.use_denoising = 1, "BOX", False
        scene.cycles.use_adaptive_sampling = False
        scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0.0
        theirs = self.rendered().astype(float) - LIFT
        self.tree = self._material("coordinates")
        place = self.tree.nodes.new("ShaderNodeTexCoord")
        self._show(place.outputs["UV"])
        scene.view_layers[0].material_override = bpy.data.materials["coordinates"]
        places = self.rendered()[:, :, :2]
        scene.view_layers[0].material_override = None
        ours = self._ours(places)
        result = {}
        for name, a, b in zip(self.names, theirs, ours, strict=True):
            span = max(float(a.max() - a.min()), 1e-3)
            apart = np.abs(a - b).max(axis=1) / span
            result[name] = [len(a), span, float((apart <= 1e-3).mean()), float(apart.max())]
        return result

    def _snapshot(self):
        return export()

    def _ours(self, places):
        snapshot = self._snapshot()
        numbers = {material.name: number for number, material in enumerate(snapshot.materials)}
        with Scene.upload(snapshot) as scene:
            for name, uv in zip(self.names, places, strict=True):
                emission = snapshot.materials[numbers[name]].emission
                yield scene.node(numbers[name], emission.node, uv)[:, :3].astype(float) - LIFT


def choices(node, field):
    """Return the values of an enumerated property in this Blender, or [] if there is no such property."""
    field = node.bl_rna.properties.get(field)
    return [] if field is None else [item.identifier for item in field.enum_items]


def _find(sockets, name):
    """Return the enabled socket with that identifier, or None."""
    return next((socket for socket in sockets if socket.enabled and socket.identifier == name), None)


class Setting:
    """A node with properties, and numbers for its inputs; inputs that this Blender lacks are ignored."""

    def __init__(self, kind, properties, numbers, output, color=False):
        self.kind, self.properties, self.numbers, self.output, self.color = kind, properties, numbers, output, color

    def name(self):
        numbers = [f"{name} {value:g}" for name, value in self.numbers.items() if isinstance(value, float)]
        words = [*map(str, self.properties.values()), *numbers]
        return " ".join([*words, self.output])[:60]

    def __call__(self, tree, vector):
        node = tree.nodes.new(self.kind)
        for field, value in self.properties.items():
            if hasattr(node, field):
                setattr(node, field, value)
        for name, value in self.numbers.items():
            socket = _find(node.inputs, name)
            if socket is not None:
                socket.default_value = value
        if _find(node.inputs, "Vector") is not None:
            tree.links.new(vector, _find(node.inputs, "Vector"))
        if _find(node.inputs, "W") is not None:
            # The fourth coordinate differs from the others: equal ones would give equal distances along them.
            parts, total = tree.nodes.new("ShaderNodeSeparateXYZ"), tree.nodes.new("ShaderNodeMath")
            tree.links.new(vector, parts.inputs[0])
            tree.links.new(parts.outputs[0], total.inputs[0])
            tree.links.new(parts.outputs[1], total.inputs[1])
            tree.links.new(total.outputs[0], _find(node.inputs, "W"))
        return _find(node.outputs, self.output)


def rendered(settings, side):
    board = Board(int(side))
    for number, setting in enumerate(settings):
        board.square(f"{number:03} {setting.name()}"[:63], setting)
    return board.answer()


def probe(kind):
    tree = bpy.data.node_groups.new("asked", "ShaderNodeTree")
    return tree.nodes.new(kind)


def noise(side):
    # Coordinates of the second and third channel are above 200, where they are rounded by 2^-17. The octaves multiply the
    # rounding by up to 2.5^4 = 39 here, which moves noise of a slope about 2 by 6e-4.
    rng, settings = random.Random(1), []
    kinds = choices(probe("ShaderNodeTexNoise"), "noise_type") or ["FBM"]
    for dimensions, kind, output in itertools.product(("1D", "2D", "3D", "4D"), kinds, ("Fac", "Color")):
        for plain in (True, False):
            numbers = {
                "Scale": rng.uniform(2, 9),
                "Detail": 2.0 if plain else rng.uniform(0, 4),
                "Roughness": rng.uniform(0.2, 1.1),
                "Distortion": 0.0 if plain else rng.uniform(-1, 2),
                "Lacunarity": 2.0 if plain else rng.uniform(1.5, 2.5),
                "Offset": rng.uniform(-0.2, 1.0),
                "Gain": rng.uniform(0.5, 3.0),
            }
            properties = {"noise_dimensions": dimensions, "noise_type": kind, "normalize": plain}
            settings.append(Setting("ShaderNodeTexNoise", properties, numbers, output))
    # Far from the origin, where floats have few digits left, and beyond the noise's period: up to where a multiple of the
    # period is no longer exact in single precision; some versions of Cycles round it.
    for scale in (3e4, 1e5, 2e6):
        settings.append(Setting("ShaderNodeTexNoise", {"noise_dimensions": "3D"}, {"Scale": scale, "Detail": 0.0}, "Fac"))
    return rendered(settings, side)


def musgrave(side):
    rng, settings = random.Random(2), []
    kinds = choices(probe("ShaderNodeTexMusgrave"), "musgrave_type")
    for dimensions, kind, detail in itertools.product(("1D", "2D", "3D", "4D"), kinds, (0.0, 0.6, 2.0, 4.3)):
        numbers = {
            "Scale": rng.uniform(2, 9),
            "Detail": detail,
            "Dimension": rng.uniform(0.1, 2.0),
            "Lacunarity": rng.uniform(1.5, 3.5),
            "Offset": rng.uniform(-0.2, 1.0),
            "Gain": rng.uniform(0.5, 3.0),
        }
        properties = {"musgrave_dimensions": dimensions, "musgrave_type": kind}
        settings.append(Setting("ShaderNodeTexMusgrave", properties, numbers, "Fac"))
    return rendered(settings, side)


def voronoi(side):
    rng, settings = random.Random(3), []
    asked = probe("ShaderNodeTexVoronoi")
    metrics = choices(asked, "distance")
    for dimensions, feature in itertools.product(("1D", "2D", "3D", "4D"), choices(asked, "feature")):
        has_cells = feature in ("F1", "F2", "SMOOTH_F1")
        outputs = ["Radius"] if feature == "N_SPHERE_RADIUS" else ["Distance"]
        if has_cells:
            outputs += ["Color"] + (["Position"] if dimensions != "1D" else []) + (["W"] if dimensions in ("1D", "4D") else [])
        for output, metric in itertools.product(outputs, metrics if has_cells and dimensions != "1D" else metrics[:1]):
            octaves = bpy.app.version >= _WIDE and rng.random() < 0.4 and dimensions != "4D"
            numbers = {
                "Scale": rng.uniform(2, 7),
                "Randomness": rng.choice((1.0, rng.uniform(0.2, 1.0))),
                "Smoothness": rng.choice((_SHARPEST, rng.uniform(0.1, 1.0))),
                "Exponent": rng.uniform(0.4, 3.0),
                "Detail": rng.uniform(0.0, 3.0) if octaves else 0.0,
                "Roughness": rng.uniform(0.2, 0.9),
                "Lacunarity": rng.uniform(1.5, 3.0),
            }
            properties = {
                "voronoi_dimensions": dimensions,
                "feature": feature,
                "distance": metric,
                "normalize": rng.random() < 0.4,
            }
            settings.append(Setting("ShaderNodeTexVoronoi", properties, numbers, output))
    return rendered(settings, side)


def gradient(side):
    kinds = choices(probe("ShaderNodeTexGradient"), "gradient_type")
    return rendered([Setting("ShaderNodeTexGradient", {"gradient_type": kind}, {}, "Fac") for kind in kinds], side)


def curves(side):
    board = Board(int(side))
    rng = random.Random(4)
    for kind, extend, wide in itertools.product(("RGB", "Vector", "Float"), ("EXTRAPOLATED", "HORIZONTAL"), (False, True)):
        board.square(f"{kind} {extend} {wide}", _curve(kind, extend, wide, rng))
    for mode, interpolation in itertools.product(("RGB", "HSV", "HSL"), ("EASE", "CARDINAL", "LINEAR", "B_SPLINE", "CONSTANT")):
        for output in ("Color", "Alpha"):
            board.square(f"ramp {mode} {interpolation} {output}", _ramp(mode, interpolation, output))
    for interpolation in ("EASE", "LINEAR", "CONSTANT"):
        board.square(f"narrow ramp {interpolation}", _narrow_ramp(interpolation))
    return board.answer()


def color_models(side):
    """Separate, combine and shift the hue, saturation and value of varying colours."""
    board = Board(int(side))
    for mode in ("HSV", "HSL"):
        for i in range(3):
            board.square(f"separate {mode} {i}", _converted("ShaderNodeSeparateColor", i, mode=mode))
        board.square(f"combine {mode}", _converted("ShaderNodeCombineColor", 0, mode=mode))
    for hue, saturation, value in ((0.2, 1.0, 1.0), (0.5, 0.4, 1.5), (0.9, 2.5, 0.7)):
        numbers = {"Hue": hue, "Saturation": saturation, "Value": value}
        board.square(f"turned by {hue}", _converted("ShaderNodeHueSaturation", 0, numbers))
    return board.answer()


def _converted(kind, output, numbers=None, **properties):
    def build(tree, vector):
        positive, node = tree.nodes.new("ShaderNodeVectorMath"), tree.nodes.new(kind)
        positive.operation = "ABSOLUTE"
        tree.links.new(vector, positive.inputs[0])
        for name, value in properties.items():
            setattr(node, name, value)
        for name, value in (numbers or {}).items():
            node.inputs[name].default_value = value
        if kind != "ShaderNodeCombineColor":
            tree.links.new(positive.outputs[0], node.inputs["Color"])
            return node.outputs[output]
        parts = tree.nodes.new("ShaderNodeSeparateXYZ")
        tree.links.new(positive.outputs[0], parts.inputs[0])
        for part, socket in zip(parts.outputs, node.inputs, strict=True):
            tree.links.new(part, socket)
        return node.outputs[output]

    return build


def _curve(kind, extend, wide, rng):
    def build(tree, vector):
        node = tree.nodes.new(
            {"RGB": "ShaderNodeRGBCurve", "Vector": "ShaderNodeVectorCurve", "Float": "ShaderNodeFloatCurve"}[kind]
        )
        mapping = node.mapping
        mapping.use_clip = False
        mapping.extend = extend
        for curve in mapping.curves:
            low = curve.points[0].location[0]
            for _ in range(3):
                curve.points.new(rng.uniform(low, 1.0), rng.uniform(low, 1.0))
            if wide:
                curve.points.new(1.6, rng.uniform(0.0, 1.5))
        mapping.update()
        node.inputs[0].default_value = rng.uniform(0.5, 1.0)
        tree.links.new(vector, node.inputs[1])
        return node.outputs[0]

    return build


def _ramp(mode, interpolation, output):
    def build(tree, vector):
        node = tree.nodes.new("ShaderNodeValToRGB")
        ramp = node.color_ramp
        ramp.color_mode = mode
        if mode == "RGB":
            ramp.interpolation = interpolation
        else:
            ramp.hue_interpolation = {"EASE": "NEAR", "CARDINAL": "FAR", "LINEAR": "CW"}.get(interpolation, "CCW")
        ramp.elements[0].color = (0.9, 0.1, 0.3, 0.2)
        ramp.elements[1].color = (0.2, 0.3, 0.8, 1.0)
        ramp.elements.new(0.31).color = (0.1, 0.8, 0.2, 0.9)
        parts = tree.nodes.new("ShaderNodeSeparateXYZ")
        tree.links.new(vector, parts.inputs[0])
        tree.links.new(parts.outputs[0], node.inputs[0])
        return node.outputs[output]

    return build


def _narrow_ramp(interpolation):
    """Return a builder of a ramp whose stops lie between values of Cycles' table, at factors about them."""

    def build(tree, vector):
        node = tree.nodes.new("ShaderNodeValToRGB")
        ramp = node.color_ramp
        ramp.interpolation = interpolation
        ramp.elements[0].position, ramp.elements[1].position = 0.4985, 0.5015
        parts, near = tree.nodes.new("ShaderNodeSeparateXYZ"), tree.nodes.new("ShaderNodeMath")
        near.operation, near.inputs[1].default_value, near.inputs[2].default_value = "MULTIPLY_ADD", 0.01, 0.5
        tree.links.new(vector, parts.inputs[0])
        tree.links.new(parts.outputs[0], near.inputs[0])
        tree.links.new(near.outputs[0], node.inputs[0])
        return node.outputs["Color"]

    return build
