"""Textures of patterns and the spectrum, drawn and computed as in procedural_cases.py."""

import itertools
import random

from procedural_cases import Board, Setting, rendered


def waves(side):
    rng, settings = random.Random(5), []
    directions = [("BANDS", d) for d in ("X", "Y", "Z", "DIAGONAL")] + [("RINGS", d) for d in ("X", "Y", "Z", "SPHERICAL")]
    for (kind, direction), profile, is_bent in itertools.product(directions, ("SIN", "SAW", "TRI"), (False, True)):
        numbers = {
            "Scale": rng.uniform(0.3, 4.0),
            "Distortion": rng.uniform(-3.0, 6.0) if is_bent else 0.0,
            "Detail": rng.uniform(0.0, 5.0),
            "Detail Scale": rng.uniform(-2.0, 3.0),
            "Detail Roughness": rng.uniform(0.0, 1.2),
            "Phase Offset": rng.uniform(-20.0, 20.0),
        }
        properties = {
            "wave_type": kind,
            "wave_profile": profile,
            "bands_direction" if kind == "BANDS" else "rings_direction": direction,
        }
        settings.append(Setting("ShaderNodeTexWave", properties, numbers, rng.choice(("Fac", "Color"))))
    return rendered(settings, side)


def magic(side):
    rng, settings = random.Random(6), []
    for depth, output in itertools.product(range(11), ("Color", "Fac")):
        # Deeper waves without distortion are even.
        for distortion in (rng.uniform(-2.0, 3.0), rng.uniform(-2.0, 3.0) if depth else 0.0):
            # Far places fold by the period of the waves.
            numbers = {"Scale": rng.choice((rng.uniform(0.1, 6.0), 40.0)), "Distortion": distortion}
            settings.append(Setting("ShaderNodeTexMagic", {"turbulence_depth": depth}, numbers, output))
    return rendered(settings, side)


def cells(side):
    """Checkers and bricks."""
    rng, settings = random.Random(7), []
    colors = {"Color1": (0.9, 0.2, 0.1, 1.0), "Color2": (0.1, 0.4, 0.8, 1.0), "Mortar": (0.3, 0.9, 0.4, 1.0)}
    for scale, output in itertools.product((0.0, -3.3, 2.0, 7.1, 1e4), ("Color", "Fac")):
        settings.append(Setting("ShaderNodeTexChecker", {}, {"Scale": scale, **_two(colors)}, output))
    for offset_rows, squash_rows, output in itertools.product((1, 2, 5), (1, 3), ("Color", "Fac")):
        for smooth in (0.0, rng.uniform(0.05, 1.0)):
            properties = {
                "offset": rng.uniform(0.0, 1.0),
                "offset_frequency": offset_rows,
                "squash": rng.uniform(0.3, 2.0),
                "squash_frequency": squash_rows,
            }
            numbers = {
                "Scale": rng.uniform(-8.0, 8.0),
                "Mortar Size": rng.uniform(0.0, 0.1),
                "Mortar Smooth": smooth,
                "Bias": rng.uniform(-1.0, 1.0),
                "Brick Width": rng.uniform(0.1, 1.0),
                "Row Height": rng.uniform(0.1, 0.6),
                **colors,
            }
            settings.append(Setting("ShaderNodeTexBrick", properties, numbers, output))
    return rendered(settings, side)


def _two(colors):
    return {name: colors[name] for name in ("Color1", "Color2")}


def white_noise(side):
    settings = [
        Setting("ShaderNodeTexWhiteNoise", {"noise_dimensions": dimensions}, {}, output)
        for dimensions, output in itertools.product(("1D", "2D", "3D", "4D"), ("Value", "Color"))
    ]
    return rendered(settings, side)


def gabor(side):
    """The node of Blender 4.3 and newer."""
    rng, settings = random.Random(8), []
    for kind, output in itertools.product(("2D", "3D"), ("Value", "Phase", "Intensity")):
        for anisotropy in (0.0, 1.0, rng.uniform(0.1, 0.9)):
            numbers = {
                "Scale": rng.uniform(1.0, 8.0),
                "Frequency": rng.uniform(0.0, 6.0),
                "Anisotropy": anisotropy,
                "Orientation 2D": rng.uniform(-4.0, 4.0),
                "Orientation 3D": [rng.uniform(-1.0, 1.0) for _ in range(3)],
            }
            settings.append(Setting("ShaderNodeTexGabor", {"gabor_type": kind}, numbers, output))
    return rendered(settings, side)


def radial_tiling(side):
    """The node of Blender 5.0 and newer."""
    rng, settings = random.Random(9), []
    outputs = ("Segment Coordinates", "Segment ID", "Segment Width", "Segment Rotation")
    for output, sides, roundness in itertools.product(
        outputs, (2.0, 3.0, 6.0, rng.uniform(2.2, 2.8), rng.uniform(4.1, 7.9)), (0.0, 0.3, 1.0)
    ):
        # With two sides the tangent of a right angle is whatever rounding makes it.
        if sides == 2.0 and roundness not in (0.0, 1.0):
            continue
        properties = {"normalize": rng.random() < 0.5}
        settings.append(Setting("ShaderNodeRadialTiling", properties, {"Sides": sides, "Roundness": roundness}, output))
    return rendered(settings, side)


def spectrum(side):
    """Wavelengths from beyond the visible on both sides. No point is at a step: Cycles' table begins at 375 nm."""
    board = Board(int(side))
    for number, (low, high) in enumerate(((297.0, 899.0), (370.0, 390.0), (690.0, 790.0), (500.0, 510.0))):
        board.square(f"{number} {low:g}", _wavelengths(low, high))
    return board.answer()


def _wavelengths(low, high):
    def build(tree, vector):
        parts, scaled = tree.nodes.new("ShaderNodeSeparateXYZ"), tree.nodes.new("ShaderNodeMath")
        node = tree.nodes.new("ShaderNodeWavelength")
        tree.links.new(vector, parts.inputs[0])
        tree.links.new(parts.outputs[2], scaled.inputs[0])
        scaled.operation = "MULTIPLY_ADD"
        scaled.inputs[1].default_value, scaled.inputs[2].default_value = 0.5 * (high - low), 0.5 * (high + low)
        tree.links.new(scaled.outputs[0], node.inputs[0])
        return node.outputs[0]

    return build
