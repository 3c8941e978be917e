"""The nodes that random graphs are made of: their settings, inputs with ranges, and outputs. Knows nothing of Blender.

Sockets are named by their identifiers, or by their names where identifiers change. Types: f number, c colour, v vector,
s shader, n normal, t place on a texture; the last two mean something else where nothing is linked.
Nodes, settings and sockets that a Blender lacks are left out when a scene is built.
"""

from typing import NamedTuple


class Kind(NamedTuple):
    inputs: dict  # {identifier: (type, low, high)}
    outputs: dict  # {identifier: type}
    props: dict = {}  # {setting: choices}
    weight: float = 1.0
    special: tuple = ()  # settings of other kinds than a choice; see random_nodes
    always: tuple = ()  # inputs that are linked whenever there is anything to link


# Inputs: (type, lowest and highest constant).
F = ("f", 0.0, 1.0)
C = ("c", 0.0, 1.0)
V = ("v", -1.0, 1.0)
NORMAL = ("n", 0.0, 0.0)
TANGENT = ("a", 0.0, 0.0)
TEXTURE = ("t", 0.0, 0.0)
SWITCH = (False, True)
FROM_INSTANCER = (False, False, False, False, False, True)

_BLENDS = (
    "MIX", "DARKEN", "MULTIPLY", "BURN", "LIGHTEN", "SCREEN", "DODGE", "ADD", "OVERLAY", "SOFT_LIGHT", "LINEAR_LIGHT",
    "DIFFERENCE", "EXCLUSION", "SUBTRACT", "DIVIDE", "HUE", "SATURATION", "COLOR", "VALUE",
)  # fmt: skip
_MATHS = (
    "ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "POWER", "LOGARITHM", "SQRT", "INVERSE_SQRT", "ABSOLUTE",
    "EXPONENT", "MINIMUM", "MAXIMUM", "LESS_THAN", "GREATER_THAN", "SIGN", "COMPARE", "SMOOTH_MIN", "SMOOTH_MAX", "ROUND",
    "FLOOR", "CEIL", "TRUNC", "FRACT", "MODULO", "FLOORED_MODULO", "WRAP", "SNAP", "PINGPONG", "SINE", "COSINE", "TANGENT",
    "ARCSINE", "ARCCOSINE", "ARCTANGENT", "ARCTAN2", "SINH", "COSH", "TANH", "RADIANS", "DEGREES",
)  # fmt: skip
_VECTOR_MATHS = (
    "ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "CROSS_PRODUCT", "PROJECT", "REFLECT", "REFRACT", "FACEFORWARD",
    "DOT_PRODUCT", "DISTANCE", "LENGTH", "SCALE", "NORMALIZE", "ABSOLUTE", "MINIMUM", "MAXIMUM", "FLOOR", "CEIL", "FRACTION",
    "MODULO", "WRAP", "SNAP", "SINE", "COSINE", "TANGENT", "POWER", "SIGN", "ROUND",
)  # fmt: skip
_DIMENSIONS = ("1D", "2D", "3D", "4D")
# Settings of the Sky Texture, without the disc of the sun. Blender 5.0 has renamed dust.
SKIES = {
    "sky_type": ("NISHITA", "SINGLE_SCATTERING", "MULTIPLE_SCATTERING", "PREETHAM", "HOSEK_WILKIE"),
    "sun_direction": ([0.0, 0.0, 1.0], [0.6, -0.5, 0.6], [-0.3, 0.9, 0.15]),
    "turbidity": (1.0, 2.2, 5.7, 10.0),
    "ground_albedo": (0.0, 0.3, 1.0),
    "sun_elevation": (-0.05, 0.05, 0.3, 1.0, 1.5707964),
    "sun_rotation": (0.0, 2.0, -1.0),
    "altitude": (0.0, 100.0, 8000.0, 60000.0),
    "air_density": (1.0, 0.3, 4.0),
    "dust_density": (1.0, 0.0, 6.0),
    "aerosol_density": (1.0, 0.0, 6.0),
    "ozone_density": (1.0, 0.0, 6.0),
}

VALUES = {
    "ShaderNodeValue": Kind({}, {"Value": "f"}, special=("value",)),
    "ShaderNodeRGB": Kind({}, {"Color": "c"}, special=("color",)),
    "ShaderNodeMath": Kind(
        {"Value": ("f", -1.0, 2.0), "Value_001": ("f", -1.0, 2.0), "Value_002": F},
        {"Value": "f"},
        {"operation": _MATHS, "use_clamp": SWITCH},
        3.0,
    ),
    "ShaderNodeVectorMath": Kind(
        {"Vector": V, "Vector_001": V, "Vector_002": V, "Scale": ("f", -1.0, 2.0)},
        {"Vector": "v", "Value": "f"},
        {"operation": _VECTOR_MATHS},
        2.0,
    ),
    "ShaderNodeClamp": Kind(
        {"Value": ("f", -1.0, 2.0), "Min": F, "Max": F}, {"Result": "f"}, {"clamp_type": ("MINMAX", "RANGE")}
    ),
    "ShaderNodeMapRange": Kind(
        {
            "Value": F, "From Min": ("f", -0.5, 0.4), "From Max": ("f", 0.5, 1.5), "To Min": F, "To Max": F,
            "Steps": ("f", 1.0, 6.0), "Vector": V, "From_Min_FLOAT3": ("v", -0.5, 0.4), "From_Max_FLOAT3": ("v", 0.5, 1.5),
            "To_Min_FLOAT3": V, "To_Max_FLOAT3": V, "Steps_FLOAT3": ("v", 1.0, 6.0),
        },
        {"Result": "f", "Vector": "v"},
        {
            "data_type": ("FLOAT", "FLOAT", "FLOAT_VECTOR"),
            "interpolation_type": ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"),
            "clamp": SWITCH,
        },
    ),
    "ShaderNodeCombineXYZ": Kind({"X": F, "Y": F, "Z": F}, {"Vector": "v"}),
    "ShaderNodeSeparateXYZ": Kind({"Vector": V}, {"X": "f", "Y": "f", "Z": "f"}),
    "ShaderNodeNormal": Kind({"Normal": V}, {"Normal": "v", "Dot": "f"}, special=("normal",)),
    "ShaderNodeVectorRotate": Kind(
        {"Vector": V, "Center": V, "Axis": V, "Angle": ("f", -3.0, 3.0), "Rotation": ("v", -3.0, 3.0)},
        {"Vector": "v"},
        {"rotation_type": ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ"), "invert": SWITCH},
        special=("constant",),
    ),
    "ShaderNodeMix": Kind(
        {
            "Factor_Float": ("f", -0.2, 1.2), "Factor_Vector": V, "A_Float": F, "B_Float": F, "A_Vector": V, "B_Vector": V,
            "A_Color": C, "B_Color": C,
        },
        {"Result_Float": "f", "Result_Vector": "v", "Result_Color": "c"},
        {
            "data_type": ("RGBA", "RGBA", "FLOAT", "VECTOR"), "blend_type": _BLENDS, "clamp_factor": SWITCH,
            "clamp_result": SWITCH, "factor_mode": ("UNIFORM", "NON_UNIFORM"),
        },
        3.0,
    ),
    "ShaderNodeMixRGB": Kind(
        {"Fac": ("f", -0.2, 1.2), "Color1": C, "Color2": C},
        {"Color": "c"},
        {"blend_type": _BLENDS, "use_clamp": SWITCH, "use_alpha": (False, False, True)},
    ),
    "ShaderNodeGamma": Kind({"Color": C, "Gamma": ("f", 0.3, 3.0)}, {"Color": "c"}),
    "ShaderNodeInvert": Kind({"Fac": F, "Color": C}, {"Color": "c"}),
    "ShaderNodeBrightContrast": Kind({"Color": C, "Bright": ("f", -0.3, 0.3), "Contrast": ("f", -0.5, 0.5)}, {"Color": "c"}),
    "ShaderNodeHueSaturation": Kind(
        {"Hue": F, "Saturation": ("f", 0.0, 2.0), "Value": ("f", 0.0, 1.5), "Fac": F, "Color": C}, {"Color": "c"}
    ),
    "ShaderNodeRGBToBW": Kind({"Color": C}, {"Val": "f"}),
    "ShaderNodeCombineColor": Kind({"Red": F, "Green": F, "Blue": F}, {"Color": "c"}, {"mode": ("RGB", "HSV", "HSL")}),
    "ShaderNodeSeparateColor": Kind(
        {"Color": C}, {"Red": "f", "Green": "f", "Blue": "f"}, {"mode": ("RGB", "HSV", "HSL")}
    ),
    "ShaderNodeCombineRGB": Kind({"R": F, "G": F, "B": F}, {"Image": "c"}, weight=0.3),
    "ShaderNodeSeparateRGB": Kind({"Image": C}, {"R": "f", "G": "f", "B": "f"}, weight=0.3),
    "ShaderNodeCombineHSV": Kind({"H": F, "S": F, "V": F}, {"Color": "c"}, weight=0.3),
    "ShaderNodeSeparateHSV": Kind({"Color": C}, {"H": "f", "S": "f", "V": "f"}, weight=0.3),
    "ShaderNodeVectorTransform": Kind(
        {"Vector": V},
        {"Vector": "v"},
        {
            "vector_type": ("POINT", "VECTOR", "NORMAL"), "convert_from": ("WORLD", "OBJECT", "CAMERA"),
            "convert_to": ("WORLD", "OBJECT", "CAMERA"),
        },
        0.5,
    ),
    "ShaderNodeValToRGB": Kind({"Fac": F}, {"Color": "c", "Alpha": "f"}, special=("ramp",), weight=2.0, always=("Fac",)),
    "ShaderNodeRGBCurve": Kind({"Fac": F, "Color": C}, {"Color": "c"}, special=("curves",)),
    "ShaderNodeVectorCurve": Kind({"Fac": F, "Vector": V}, {"Vector": "v"}, special=("curves",)),
    "ShaderNodeFloatCurve": Kind({"Factor": F, "Value": F}, {"Value": "f"}, special=("curves",)),
    "ShaderNodeBlackbody": Kind({"Temperature": ("f", 800.0, 12000.0)}, {"Color": "c"}, weight=0.5),
    "ShaderNodeFresnel": Kind({"IOR": ("f", 1.0, 2.0), "Normal": NORMAL}, {"Fac": "f"}),
    "ShaderNodeLayerWeight": Kind({"Blend": F, "Normal": NORMAL}, {"Fresnel": "f", "Facing": "f"}),
    "ShaderNodeTexImage": Kind(
        {"Vector": TEXTURE},
        {"Color": "c", "Alpha": "f"},
        {
            "interpolation": ("Linear", "Linear", "Closest", "Cubic", "Smart"),
            "projection": ("FLAT", "FLAT", "BOX", "SPHERE", "TUBE"),
            "extension": ("REPEAT", "EXTEND", "CLIP", "MIRROR"),
            "projection_blend": (0.0, 0.3),
        },
        5.0,
        special=("image", "mapping"),
    ),
    "ShaderNodeTexEnvironment": Kind(
        {"Vector": TEXTURE},
        {"Color": "c"},
        {"interpolation": ("Linear", "Closest", "Cubic"), "projection": ("EQUIRECTANGULAR", "MIRROR_BALL")},
        0.5,
        special=("image", "mapping"),
    ),
    "ShaderNodeTexNoise": Kind(
        {
            "Vector": TEXTURE, "W": F, "Scale": ("f", 0.5, 4.0), "Detail": ("f", 0.0, 3.0), "Roughness": F,
            "Lacunarity": ("f", 1.5, 2.5), "Offset": F, "Gain": ("f", 0.5, 1.5), "Distortion": ("f", 0.0, 1.0),
        },
        {"Fac": "f", "Color": "c"},
        {
            "noise_dimensions": _DIMENSIONS, "normalize": SWITCH,
            "noise_type": ("FBM", "FBM", "MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN"),
        },
        2.0,
        special=("mapping",),
    ),
    "ShaderNodeTexMusgrave": Kind(
        {
            "Vector": TEXTURE, "W": F, "Scale": ("f", 0.5, 4.0), "Detail": ("f", 0.0, 3.0), "Dimension": ("f", 0.3, 2.0),
            "Lacunarity": ("f", 1.5, 2.5), "Offset": F, "Gain": ("f", 0.5, 1.5),
        },
        {"Fac": "f"},
        {
            "musgrave_dimensions": _DIMENSIONS,
            "musgrave_type": ("FBM", "MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN"),
        },
        0.5,
        special=("mapping",),
    ),
    "ShaderNodeTexVoronoi": Kind(
        {
            "Vector": TEXTURE, "W": F, "Scale": ("f", 0.5, 4.0), "Detail": ("f", 0.0, 2.0), "Roughness": F,
            "Lacunarity": ("f", 1.5, 2.5), "Smoothness": F, "Exponent": ("f", 0.5, 3.0), "Randomness": F,
        },
        {"Distance": "f", "Color": "c", "Position": "v", "W": "f", "Radius": "f"},
        {
            "voronoi_dimensions": _DIMENSIONS, "normalize": SWITCH,
            "feature": ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS"),
            "distance": ("EUCLIDEAN", "MANHATTAN", "CHEBYCHEV", "MINKOWSKI"),
        },
        2.0,
        special=("mapping",),
    ),
    "ShaderNodeTexGradient": Kind(
        {"Vector": TEXTURE},
        {"Color": "c", "Fac": "f"},
        {"gradient_type": ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL")},
        special=("mapping",),
    ),
    "ShaderNodeTexWave": Kind(
        {
            "Vector": TEXTURE, "Scale": ("f", 0.3, 2.0), "Distortion": ("f", 0.0, 4.0), "Detail": ("f", 0.0, 3.0),
            "Detail Scale": ("f", 0.5, 2.0), "Detail Roughness": F, "Phase Offset": ("f", -3.0, 3.0),
        },
        {"Color": "c", "Fac": "f"},
        {
            "wave_type": ("BANDS", "RINGS"), "bands_direction": ("X", "Y", "Z", "DIAGONAL"),
            "rings_direction": ("X", "Y", "Z", "SPHERICAL"), "wave_profile": ("SIN", "SAW", "TRI"),
        },
        special=("mapping",),
    ),
    "ShaderNodeTexMagic": Kind(
        {"Vector": TEXTURE, "Scale": ("f", 0.5, 3.0), "Distortion": ("f", 0.3, 2.0)},
        {"Color": "c", "Fac": "f"},
        {"turbulence_depth": (0, 1, 2, 3, 5)},
        special=("mapping",),
    ),
    "ShaderNodeTexChecker": Kind(
        {"Vector": TEXTURE, "Color1": C, "Color2": C, "Scale": ("f", 1.0, 6.0)},
        {"Color": "c", "Fac": "f"},
        special=("mapping",),
    ),
    "ShaderNodeTexBrick": Kind(
        {
            "Vector": TEXTURE, "Color1": C, "Color2": C, "Mortar": C, "Scale": ("f", 1.0, 5.0), "Mortar Size": ("f", 0.0, 0.1),
            "Mortar Smooth": F, "Bias": ("f", -0.5, 0.5), "Brick Width": ("f", 0.2, 0.8), "Row Height": ("f", 0.1, 0.5),
        },
        {"Color": "c", "Fac": "f"},
        {"offset": (0.0, 0.5, 0.3), "offset_frequency": (1, 2, 3), "squash": (1.0, 0.6), "squash_frequency": (1, 2)},
        special=("mapping",),
    ),
    "ShaderNodeTexGabor": Kind(
        {
            "Vector": TEXTURE, "Scale": ("f", 0.5, 3.0), "Frequency": ("f", 0.5, 3.0), "Anisotropy": F,
            "Orientation 2D": ("f", -3.0, 3.0), "Orientation 3D": V,
        },
        {"Value": "f", "Phase": "f", "Intensity": "f"},
        {"gabor_type": ("2D", "3D")},
        0.5,
        special=("mapping",),
    ),
    "ShaderNodeRadialTiling": Kind(
        {"Vector": TEXTURE, "Sides": ("f", 3.0, 7.0), "Roundness": F},
        {"Segment Coordinates": "v", "Segment ID": "f", "Segment Width": "f", "Segment Rotation": "f"},
        {"normalize": SWITCH},
        0.5,
        always=("Vector",),
    ),
    "ShaderNodeWavelength": Kind({"Wavelength": ("f", 360.0, 800.0)}, {"Color": "c"}, weight=0.5),
    "ShaderNodeCameraData": Kind({}, {"View Vector": "v", "View Z Depth": "f", "View Distance": "f"}, weight=0.5),
    "ShaderNodeWireframe": Kind({"Size": ("f", 0.0, 0.2)}, {"Fac": "f"}, {"use_pixel_size": SWITCH}, 0.5),
    # A wide sun of little light: few pixels show a narrow one, which is as bright as all others together.
    "ShaderNodeTexSky": Kind(
        {"Vector": TEXTURE},
        {"Color": "c"},
        {**SKIES, "sun_disc": SWITCH, "sun_size": (0.4, 1.5), "sun_intensity": (0.01, 0.1)},
        0.5,
        special=("mapping",),
    ),
    "ShaderNodeTexCoord": Kind(
        {},
        {"Generated": "v", "Normal": "v", "UV": "v", "Object": "v", "Camera": "v", "Window": "v", "Reflection": "v"},
        {"from_instancer": FROM_INSTANCER},
        special=("object",),
        weight=3.0,
    ),
    "ShaderNodeUVMap": Kind({}, {"UV": "v"}, {"from_instancer": FROM_INSTANCER}, special=("uv_map",)),
    "ShaderNodeAttribute": Kind(
        {}, {"Color": "c", "Vector": "v", "Fac": "f", "Alpha": "f"}, special=("attribute",), weight=4.0
    ),
    "ShaderNodeVertexColor": Kind({}, {"Color": "c", "Alpha": "f"}, special=("layer",), weight=2.0),
    "ShaderNodeNewGeometry": Kind(
        {},
        {
            "Position": "v", "Normal": "v", "Tangent": "v", "True Normal": "v", "Incoming": "v", "Backfacing": "f",
            "Parametric": "v", "Pointiness": "f", "Random Per Island": "f",
        },
        weight=2.0,
    ),
    "ShaderNodeObjectInfo": Kind(
        {}, {"Location": "v", "Color": "c", "Alpha": "f", "Object Index": "f", "Material Index": "f", "Random": "f"}
    ),
    "ShaderNodeLightPath": Kind(
        {},
        {
            "Is Camera Ray": "f", "Is Shadow Ray": "f", "Is Diffuse Ray": "f", "Is Glossy Ray": "f", "Is Singular Ray": "f",
            "Is Reflection Ray": "f", "Is Transmission Ray": "f", "Ray Length": "f", "Ray Depth": "f", "Diffuse Depth": "f",
            "Glossy Depth": "f", "Transparent Depth": "f", "Transmission Depth": "f", "Is Volume Scatter Ray": "f",
            "Portal Depth": "f",
        },
        weight=0.5,
    ),
    # About x and y, a plane has no tangents.
    "ShaderNodeTangent": Kind(
        {}, {"Tangent": "v"}, {"direction_type": ("RADIAL", "UV_MAP"), "axis": ("Z",)}, special=("uv_map",)
    ),
    "ShaderNodeMapping": Kind(
        {"Vector": TEXTURE, "Location": V, "Rotation": ("v", -2.0, 2.0), "Scale": ("v", 0.5, 2.0)},
        {"Vector": "v"},
        {"vector_type": ("POINT", "TEXTURE", "VECTOR", "NORMAL")},
        2.0,
        always=("Vector",),
    ),
    "ShaderNodeNormalMap": Kind(
        {"Strength": ("f", 0.0, 1.0), "Color": ("c", 0.4, 1.0)},
        {"Normal": "v"},
        {"space": ("TANGENT", "TANGENT", "OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD")},
        special=("uv_map",),
        always=("Color",),
    ),
    "ShaderNodeBump": Kind(
        {"Strength": F, "Distance": ("f", 0.0, 0.3), "Filter Width": ("f", 0.1, 1.0), "Height": F, "Normal": NORMAL},
        {"Normal": "v"},
        {"invert": SWITCH},
        always=("Height",),
    ),
}  # fmt: skip

# What gives a place to look textures up at.
PLACES = (
    "ShaderNodeTexCoord",
    "ShaderNodeUVMap",
    "ShaderNodeMapping",
    "ShaderNodeNewGeometry",
    "ShaderNodeAttribute",
    "ShaderNodeVectorMath",
)
# What gives a normal.
NORMALS = (
    "ShaderNodeBump",
    "ShaderNodeBump",
    "ShaderNodeNormalMap",
    "ShaderNodeNormalMap",
    "ShaderNodeNewGeometry",
    "ShaderNodeVectorMath",
)
