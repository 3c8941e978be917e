"""Scenes of faults that `make differ` has found and that are mended, in a few records each; `make test` renders them again.

Whoever mends a fault adds the scene that shows it.
"""

from .record import Record

_WHITE = [0.8, 0.8, 0.8]
_SUN = [
    Record("lamp", "Lamp 1", {"type": "SUN", "settings": {"energy": 3.0, "angle": 0.1}}),
    Record("object", "Lamp 1 object", {"data": "@Lamp 1", "location": [1.0, -2.0, 3.0], "target": [0.0, 0.0, 1.0]}),
]
_SKY = [
    Record("world", "World", {}),
    Record("node", "World/1", {"tree": "World", "kind": "ShaderNodeBackground", "inputs": {"Color": [0.2, 0.4, 0.8]}}),
    Record(
        "node",
        "World/2",
        {"tree": "World", "kind": "ShaderNodeOutputWorld", "inputs": {"Surface": ["@World/1", "Background"]}},
    ),
]


def _frame(**fields):
    return Record("frame", "Frame", {"bounces": 0, "size": [48, 32], **fields})


def _thing(shape, *nodes, displacement="BUMP", mesh=(), own=(), **fields):
    """An object whose material has these nodes, numbered from 1; the last is the output. own: fields of the material."""
    mesh = {"shape": shape, "materials": ["@M"], **dict(mesh)}
    place = {"data": "@Mesh", "location": [0.0, 0.0, 1.0], **fields}
    head = [
        Record("material", "M", {"displacement": displacement, **dict(own)}),
        Record("mesh", "Mesh", mesh),
        Record("object", "Thing", place),
    ]
    return head + [Record("node", f"M/{number}", {"tree": "M", **node}) for number, node in enumerate(nodes, 1)]


def _node(kind, inputs=None, **props):
    return {"kind": f"ShaderNode{kind}", "props": props, "inputs": inputs or {}}


def _shown(link):
    return _node("OutputMaterial", {"Surface": link})


def _bumped(number, output, *nodes):
    """A diffuse torus with a bump whose height is an output of a node."""
    nodes = (
        *nodes,
        _node("VectorMath", {"Vector": [f"@M/{number}", output], "Vector_001": [0.5, 0.7, 0.3]}, operation="DOT_PRODUCT"),
        _node("Bump", {"Distance": 1.0, "Height": [f"@M/{number + 1}", "Value"]}),
        _node("BsdfDiffuse", {"Color": _WHITE, "Normal": [f"@M/{number + 2}", "Normal"]}),
        _shown([f"@M/{number + 3}", "BSDF"]),
    )
    return [_frame(), *_SUN, *_thing("torus", *nodes, mesh={"smooth": "yes", "uv_maps": ["UVMap"]})]


def _alpha(level):
    nodes = (
        _node("NewGeometry"),
        _node(
            "VectorMath",
            {"Vector": ["@M/1", "Position"], "Vector_001": [0.01] * 3, "Vector_002": [level] * 3},
            operation="MULTIPLY_ADD",
        ),
        _node("BsdfPrincipled", {"Alpha": ["@M/2", "Vector"]}),
        _shown(["@M/3", "BSDF"]),
    )
    return [_frame(bounces=1), *_SUN, *_SKY, *_thing("cube", *nodes)]


def _of_world(node, output):
    """A world that shows an output of a node."""
    return [
        _frame(),
        Record("world", "World", {}),
        Record("node", "World/1", {"tree": "World", **node}),
        Record("node", "World/2", {"tree": "World", **_node("OutputWorld", {"Surface": ["@World/1", output]})}),
    ]


def _hidden_sun(rays, shader, **inputs):
    """A ball of one shader under a sun that a class of rays does not see."""
    sun, place = _SUN
    place = place._replace(fields={**place.fields, "settings": {f"visible_{rays}": False}})
    nodes = _node(f"Bsdf{shader}", inputs), _shown(["@M/1", "BSDF"])
    return [_frame(bounces=1), sun, place, *_thing("ball", *nodes, mesh={"smooth": "yes"})]


SCENES = {
    "color pass of the last of the transparent layers": [
        _frame(transparent_bounces=1, passes=["Diffuse Color"]),
        *_thing("grid", _node("BsdfPrincipled", {"Alpha": 0.1}), _shown(["@M/1", "BSDF"]), location=[0.0, 0.0, 0.0]),
    ],
    "empty slot of an object": [
        _frame(),
        *_SUN,
        *_thing("plane", _node("Emission", {"Color": [0.1, 0.6, 0.2]}), _shown(["@M/1", "Emission"]), material=None),
    ],
    "tangent in a height": _bumped(1, "Tangent", _node("Tangent", axis="X")),
    "tangent of a map in a height": _bumped(1, "Tangent", _node("Tangent", direction_type="UV_MAP", uv_map="UVMap")),
    "normal map in a height": _bumped(1, "Normal", _node("NormalMap", {"Color": [0.8, 0.7, 0.9]}, uv_map="UVMap")),
    "normal coordinate in a height": _bumped(1, "Normal", _node("TexCoord")),
    "bump without a height as light": [_frame(), *_thing("cube", _node("Bump"), _shown(["@M/1", "Normal"]))],
    "bump without a height as displacement": [
        _frame(passes=["UV"]),
        *_thing(
            "cube",
            _node("Bump"),
            _node("OutputMaterial", {"Displacement": ["@M/1", "Normal"]}),
            displacement="DISPLACEMENT",
            mesh={"uv_maps": ["UVMap"]},
        ),
    ],
    "normal map in the world": _of_world(_node("NormalMap", space="WORLD"), "Normal"),
    "tangent of the world": _of_world(_node("NewGeometry"), "Tangent"),
    "generated coordinates of the world by name": _of_world(_node("Attribute", attribute_name="generated"), "Color"),
    "their alpha": _of_world(_node("Attribute", attribute_name="generated"), "Alpha"),
    "world hidden from diffuse rays behind paper": [
        _frame(bounces=2),
        Record("world", "World", {"hidden_from": ["diffuse"]}),
        *_SKY[1:],
        *_thing("ball", _node("BsdfTranslucent"), _shown(["@M/1", "BSDF"])),
    ],
    "displacement of a surface without a shader": [
        _frame(kind="DATA", passes=["Normal"]),
        *_thing(
            "ball",
            _node("NewGeometry"),
            _node("TexNoise", {"Vector": ["@M/1", "Position"]}),
            _node("OutputMaterial", {"Displacement": ["@M/2", "Fac"]}),
        ),
    ],
    "vector displacement as a bump": [
        _frame(kind="DATA", passes=["Normal"]),
        *_thing(
            "plane",
            _node("VectorDisplacement", {"Vector": [0.3, 0.8, 0.4], "Scale": 0.2}),
            _node("BsdfDiffuse"),
            _node("OutputMaterial", {"Surface": ["@M/2", "BSDF"], "Displacement": ["@M/1", "Displacement"]}),
            mesh={"uv_maps": ["UVMap"], "custom_normals": 0.18},
        ),
    ],
    "alpha above 1": _alpha(1.6),
    "alpha below 0": _alpha(-0.4),
    "text as the first object": [
        _frame(),
        *_SKY,
        Record("text", "Text", {}),
        Record("object", "Thing", {"data": "@Text"}),
    ],
    "pass of velvet": [
        _frame(passes=["Glossy Color"]),
        *_SKY,
        *_thing("plane", _node("BsdfSheen", distribution="ASHIKHMIN"), _shown(["@M/1", "BSDF"])),
    ],
    "velvet about a normal that leans away": [
        _frame(),
        *_SKY,
        *_thing(
            "plane",
            _node("CombineXYZ", {"X": -0.1, "Y": -0.2, "Z": -0.2}),
            _node("BsdfSheen", {"Normal": ["@M/1", "Vector"]}, distribution="ASHIKHMIN"),
            _shown(["@M/2", "BSDF"]),
            scale=[5.0] * 3,
        ),
    ],
    "normal of a map that is not there, above a bump": [
        _frame(kind="DATA", passes=["Normal"]),
        *_thing(
            "torus",
            _node("NewGeometry"),
            _node("VectorMath", {"Vector": ["@M/1", "Position"], "Vector_001": [0.5, 0.7, 0.3]}, operation="DOT_PRODUCT"),
            _node("NormalMap", {"Color": [0.8, 0.7, 0.9]}, uv_map="Missing"),
            _node("BsdfDiffuse", {"Normal": ["@M/3", "Normal"]}),
            _node("OutputMaterial", {"Surface": ["@M/4", "BSDF"], "Displacement": ["@M/2", "Value"]}),
            mesh={"smooth": "yes"},
        ),
    ],
    "negative light under sheen": [
        _frame(),
        *_thing(
            "plane",
            _node("NewGeometry"),
            _node("VectorMath", {"Vector": ["@M/1", "Normal"], "Vector_001": [-0.5] * 3}, operation="MULTIPLY"),
            _node("BsdfPrincipled", {"Sheen Weight": 0.3, "Emission Color": _WHITE, "Emission Strength": ["@M/2", "Vector"]}),
            _shown(["@M/3", "BSDF"]),
        ),
    ],
    "mapping of a constant place": [
        _frame(),
        *_thing(
            "plane",
            _node("VectorMath", {"Vector": [0.3, 0.2, 0.1]}),
            {**_node("TexNoise", {"Vector": ["@M/1", "Vector"]}), "mapping": {"translation": [0.6, 0.4, 0.9]}},
            _shown(["@M/2", "Color"]),
        ),
    ],
    "mist of a holdout object that is clear": [
        _frame(passes=["Mist"]),
        *_thing("ball", _node("BsdfPrincipled", {"Alpha": 0.3}), _shown(["@M/1", "BSDF"]), settings={"is_holdout": True}),
    ],
    "depth guide behind the last of the glass": [
        _frame(bounces=1, passes=["Denoising Depth"]),
        *_thing("ball", _node("BsdfGlass"), _shown(["@M/1", "BSDF"]), mesh={"smooth": "yes"}),
    ],
    "group without an output": [
        _frame(),
        Record("group", "Group", {"inputs": {}, "outputs": {"Out": "f"}}),
        *_thing(
            "plane",
            _node("Group", node_tree="@Group"),
            _node("Emission", {"Color": [0.2, 0.3, 0.4], "Strength": 2.0}),
            _node("MixShader", {"Fac": ["@M/1", "Out"], "Shader": ["@M/2", "Emission"]}),
            _shown(["@M/3", "Shader"]),
        ),
    ],
    "muted node between a colour, a number and a colour": [
        _frame(),
        Record("world", "World", {}),
        Record("node", "World/1", {"tree": "World", "kind": "ShaderNodeRGB", "output": [0.6, 0.2, 0.9]}),
        Record(
            "node",
            "World/2",
            {"tree": "World", "kind": "ShaderNodeCombineRGB", "inputs": {"B": ["@World/1", "Color"]}, "mute": True},
        ),
        Record("node", "World/3", {"tree": "World", **_node("Background", {"Color": ["@World/2", "Image"]})}),
        Record("node", "World/4", {"tree": "World", **_node("OutputWorld", {"Surface": ["@World/3", "Background"]})}),
    ],
    "metal that absorbs little": [
        _frame(),
        *_SKY,
        *_thing(
            "plane",
            _node("BsdfMetallic", {"IOR": [0.5, 0.3, 0.2], "Extinction": [0.8, 0.4, 0.2]}, fresnel_type="PHYSICAL_CONDUCTOR"),
            _shown(["@M/1", "BSDF"]),
        ),
    ],
    "guides of a sky in a rough mirror": [
        _frame(bounces=1, passes=["Denoising Albedo"]),
        *_SKY,
        *_thing("plane", _node("BsdfGlossy", {"Color": _WHITE, "Roughness": 0.2}), _shown(["@M/1", "BSDF"]), scale=[7.0] * 3),
    ],
    "occlusion of a holdout object": [
        _frame(passes=["Ambient Occlusion"]),
        *_thing("plane", _node("BsdfPrincipled", {"Alpha": 0.9}), _shown(["@M/1", "BSDF"]), settings={"is_holdout": True}),
    ],
    "sun hidden from glossy rays on rough glass": _hidden_sun("glossy", "Glass", Roughness=0.4),
    "sun hidden from transmitted rays on rough glass": _hidden_sun("transmission", "Glass", Roughness=0.4),
    "sun hidden from diffuse rays on paper": _hidden_sun("diffuse", "Translucent"),
    "sun hidden from transmitted rays on paper": _hidden_sun("transmission", "Translucent"),
    "mist of a layer with another world": [
        _frame(passes=["Mist", "Ambient Occlusion"]),
        Record("world", "World", {"mist": {"start": 1.0, "depth": 6.0}, "occlusion_distance": 0.2}),
        Record("world", "Other", {"apart": True, "mist": {"start": 3.0, "depth": 2.0}, "occlusion_distance": 1.0}),
        *_thing("cube", _node("BsdfDiffuse"), _shown(["@M/1", "BSDF"])),
        Record("mesh", "Floor", {"shape": "plane"}),
        Record("object", "Floor object", {"data": "@Floor", "scale": [5.0] * 3}),
        Record("layer", "Layer", {"world_override": "@Other"}),
    ],
    "lost pictures of a wide gamut": [
        _frame(),
        Record("image", "Image", {"format": "PNG8", "size": [5, 2], "space": "Display P3", "source": "SEQUENCE", "seed": 52}),
        Record("world", "World", {}),
        Record(
            "node",
            "World/1",
            {"tree": "World", **_node("TexImage", image="@Image"), "user": [0, 0, -2, False, True]},
        ),
        Record("node", "World/2", {"tree": "World", **_node("OutputWorld", {"Surface": ["@World/1", "Color"]})}),
    ],
    "a photometric file without a direction": [
        _frame(),
        Record(
            "photometry", "Lamp", {"type": 3, "across": [0, 90], "down": [-90, 90], "values": [[38, 14], [10, 36]]}
        ),
        *_thing(
            "cube", _node("Mapping"), _node("TexIES", {"Vector": ["@M/1", "Vector"]}, ies="@Lamp"), _shown(["@M/2", "Fac"])
        ),
    ],
    "a thin film whose normal faces away": [
        _frame(),
        *_SKY,
        *_thing(
            "cube",
            _node("BsdfPrincipled", {"Thin Film Thickness": 101.784}),
            _shown(["@M/1", "BSDF"]),
            mesh={"smooth": "yes"},
            own={"no_bump_correction": True},
        ),
    ],
    "AOVs of trees that show nothing": [
        _frame(),
        Record("aov", "Tint", {"type": "COLOR"}),
        Record("world", "World", {}),
        Record("node", "World/1", {"tree": "World", **_node("OutputAOV", {"Color": [0.2, 3.0, -0.5]}), "aov": "Tint"}),
        *_thing("cube", {**_node("OutputAOV", {"Color": _WHITE}), "aov": "Tint"}),
    ],
    "light below a coat at the end of a path": [
        _frame(bounces=0),
        *_thing(
            "ball",
            _node("BsdfPrincipled", {"Transmission Weight": 1.0, "Coat Weight": 1.0, "Emission Strength": 0.2}),
            _shown(["@M/1", "BSDF"]),
        ),
    ],
}  # fmt: skip
