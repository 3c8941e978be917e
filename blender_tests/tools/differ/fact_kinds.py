"""The nodes of random graphs that tell of rays, particles, strands and time, or look around, as node_kinds has the rest."""

from .node_kinds import NORMAL, SWITCH, TEXTURE, C, F, Kind, V

FACTS = {
    "ShaderNodeTexIES": Kind({"Vector": TEXTURE, "Strength": F}, {"Fac": "f"}, special=("photometry",)),
    "ShaderNodeTexWhiteNoise": Kind(
        {"Vector": TEXTURE, "W": F}, {"Value": "f", "Color": "c"}, {"noise_dimensions": ("1D", "2D", "3D", "4D")}, 0.5
    ),
    "ShaderNodeLightFalloff": Kind(
        {"Strength": F, "Smooth": ("f", 0.0, 2.0)}, {"Quadratic": "f", "Linear": "f", "Constant": "f"}, weight=0.5
    ),
    "ShaderNodeParticleInfo": Kind(
        {},
        {
            "Index": "f", "Random": "f", "Age": "f", "Lifetime": "f", "Location": "v", "Size": "f", "Velocity": "v",
            "Angular Velocity": "v",
        },
        weight=0.3,
    ),
    "ShaderNodeHairInfo": Kind(
        {},
        {"Is Strand": "f", "Intercept": "f", "Length": "f", "Thickness": "f", "Tangent Normal": "v", "Random": "f"},
        weight=0.3,
    ),
    "ShaderNodePointInfo": Kind({}, {"Position": "v", "Radius": "f", "Random": "f"}, weight=0.3),
    "ShaderNodeVolumeInfo": Kind({}, {"Color": "c", "Density": "f", "Flame": "f", "Temperature": "f"}, weight=0.3),
    "FunctionNodeInputBool": Kind({}, {"Boolean": "f"}, {"boolean": SWITCH}, 0.3),
    "FunctionNodeInputInt": Kind({}, {"Integer": "f"}, {"integer": (-1, 0, 1, 2)}, 0.3),
    "FunctionNodeInputVector": Kind({}, {"Vector": "v"}, {"vector": ([0.3, -0.5, 0.8], [0.0, 1.0, 0.25])}, 0.3),
    "GeometryNodeInputSceneTime": Kind({}, {"Seconds": "f", "Frame": "f"}, weight=0.3),
    "ShaderNodeAmbientOcclusion": Kind(
        {"Color": C, "Distance": ("f", 0.0, 2.0), "Normal": NORMAL},
        {"Color": "c", "AO": "f"},
        {"samples": (1, 4, 16), "inside": SWITCH, "only_local": SWITCH},
        0.3,
    ),
    "ShaderNodeBevel": Kind({"Radius": ("f", 0.0, 0.3), "Normal": NORMAL}, {"Normal": "v"}, {"samples": (2, 4, 8)}, 0.3),
    "ShaderNodeRaycast": Kind(
        {"Position": TEXTURE, "Direction": V, "Length": ("f", 0.2, 5.0)},
        {
            "Is Hit": "f", "Self Hit": "f", "Hit Distance": "f", "Hit Position": "v", "Hit Normal": "v", "Attribute_0": "c",
            "Attribute_0_Alpha": "f",
        },
        {"only_local": SWITCH},
        0.3,
        special=("sampled",),
    ),
    "ShaderNodeTexPointDensity": Kind(
        {"Vector": TEXTURE},
        {"Color": "c", "Density": "f"},
        {
            "space": ("OBJECT", "WORLD"), "interpolation": ("Linear", "Closest", "Cubic"), "resolution": (4, 12),
            "radius": (0.2, 0.5),
        },
        0.3,
        special=("points",),
    ),
}  # fmt: skip
# Nodes of surfaces alone: those that send rays, and Point Density, which is undefined in worlds and lamps.
OF_SURFACES = {"ShaderNodeAmbientOcclusion", "ShaderNodeBevel", "ShaderNodeRaycast", "ShaderNodeTexPointDensity"}
