"""Random node trees: from the output upstream, each input left alone, set, or linked to a node that gives a value for it."""

from . import closure_kinds, fact_kinds, node_kinds, random_images, random_properties
from .record import Record

UV_MAPS = ("UVMap", "Second", "", "Missing")
# Shares: attributes that meshes may have, names with a meaning of their own, and none of either.
ATTRIBUTES = {
    "Number": 2, "Whole": 2, "Vector": 2, "Color": 2, "Byte": 2, "Flag": 2, "Pair": 2, "Four": 1, "Odd": 1, "UVMap": 2,
    "generated": 0.5, "uv": 0.5, "vertex_color": 0.5, "pointiness": 0.3, "random_per_island": 0.3, "position": 0.3,
    "material_index": 0.2, "Missing": 1, "": 0.3,
}  # fmt: skip
COLORS = ("Color", "Byte", "Color", "Byte", "", "Missing")
_ALPHAS = (1.0, 1.0, 0.5, 0.0)
_DEEPEST = 4

WORLDS = ("World", "Other world")
_VALUES = {**node_kinds.VALUES, **fact_kinds.FACTS}
# Nodes about surfaces, which worlds and lamps are not, and about objects, which worlds are not: there Cycles reads the
# transform of an object, and crashes now and then.
_OF_SURFACES = {"ShaderNodeNormalMap", "ShaderNodeTangent", "ShaderNodeBump"} | fact_kinds.OF_SURFACES
_OF_OBJECTS = _OF_SURFACES | {"ShaderNodeTexIES"}
# Infinite where light comes from afar.
_OF_LENGTHS = {"ShaderNodeLightFalloff"}


class Trees:
    """Writes records of nodes; groups are written before the trees that use them."""

    def __init__(self, dice, images, objects, luminaires):
        self.dice = dice
        self.images, self.objects, self.luminaires = images, objects, luminaires
        self.left_out = {world: _OF_OBJECTS | _OF_LENGTHS for world in WORLDS}  # kinds of nodes by trees of no surface
        self.records = []
        self._count = 0
        self._groups, self._group_count = [], 0
        self.budget = 0  # nodes that this tree may still have
        # Data behind a half transparent surface are those of a path that Cycles chooses by chance.
        self.is_opaque = False

    def add_lamp(self, tree, is_far):
        """Note that a tree is a lamp's."""
        self.left_out[tree] = _OF_SURFACES | _OF_LENGTHS if is_far else _OF_SURFACES

    def material(self, tree):
        """The tree of a material: surface, and now and then displacement."""
        dice = self.dice
        self.budget = dice.whole(1, 12)
        inputs = {"Surface": self._shader(tree, 0)}
        if dice.chance(0.03):
            inputs["Surface"] = self.value(tree, "c", 1)
        if dice.chance(0.08):
            self.budget += 3
            inputs["Displacement"] = self._node(
                tree, dice.pick(list(closure_kinds.DISPLACEMENTS)), "v", 1, closure_kinds.DISPLACEMENTS
            )
        self.write(tree, "ShaderNodeOutputMaterial", {}, inputs)

    # ---- nodes ----

    def write(self, tree, kind, props, inputs, mute=False, **more):
        self._count += 1
        name = f"{tree}/{self._count}"
        fields = {"tree": tree, "kind": kind, "props": props, "inputs": inputs, **more}
        if mute:
            fields["mute"] = True
        self.records.append(
            Record("node", name, {key: value for key, value in fields.items() if value or key in ("tree", "kind")})
        )
        return f"@{name}"

    def _shader(self, tree, depth):
        kinds = {name: kind.weight for name, kind in closure_kinds.SHADERS.items()}
        if self.dice.chance(0.07) and depth < 2:
            return self._passed_on(tree, self._group(tree, "s", depth))
        left_out = closure_kinds.MIXED if depth > 2 or self.budget <= 2 else set()
        if self.is_opaque:
            left_out = left_out | closure_kinds.CLEAR
        kinds = {name: weight for name, weight in kinds.items() if name not in left_out}
        return self._passed_on(tree, self._node(tree, self.dice.pick(kinds), "s", depth, closure_kinds.SHADERS))

    def value(self, tree, wanted, depth):
        """A link to a node that gives a value."""
        if self.dice.chance(0.08) and depth < 3:
            return self._passed_on(tree, self._group(tree, wanted, depth))
        if self.budget > 2 and self.dice.chance(0.03):
            return self._passed_on(tree, self._zone(tree, wanted, depth))
        left_out = self.left_out.get(tree, ())
        kinds = {name: kind.weight for name, kind in _VALUES.items() if name not in left_out}
        if self.images and "ShaderNodeTexImage" in kinds:
            # A scene that has images shows them.
            kinds["ShaderNodeTexImage"] = 8 * _VALUES["ShaderNodeTexImage"].weight
        return self._passed_on(tree, self._node(tree, self.dice.pick(kinds), wanted, depth, _VALUES))

    def _passed_on(self, tree, link):
        """The link, now and then by way of a reroute."""
        if self.dice.chance(0.05):
            return [self.write(tree, "NodeReroute", {}, {"0": link}), "0"]
        return link

    def _node(self, tree, name, wanted, depth, kinds):
        """A link to an output of a new node of the kind."""
        dice, kind = self.dice, kinds[name]
        self.budget -= 1
        props = {key: dice.pick(choices) for key, choices in kind.props.items()}
        outputs = [key for key, type_ in kind.outputs.items() if type_ == wanted and dice.chance(0.7)] or list(kind.outputs)
        if tree in self.left_out:
            outputs = [key for key in outputs if key not in ("Tangent", "Ray Length")] or list(kind.outputs)[:1]
        output = dice.pick(outputs)
        if "data_type" in props and name == "ShaderNodeMix":
            output = {"RGBA": "Result_Color", "FLOAT": "Result_Float", "VECTOR": "Result_Vector"}[props["data_type"]]
        if name == "ShaderNodeMapRange":
            output = "Result" if props["data_type"] == "FLOAT" else "Vector"
        more = {}
        for special in kind.special:
            self._special(special, props, more)
        inputs = {}
        for key, (type_, low, high) in kind.inputs.items():
            value = None if self.is_opaque and key == "Alpha" else self._input(tree, kind, key, type_, low, high, depth)
            if value is not None:
                inputs[key] = value
        return [self.write(tree, name, props, inputs, mute=wanted != "s" and dice.chance(0.04), **more), output]

    def _input(self, tree, kind, key, type_, low, high, depth):
        """A value for an input: constant, a link, or None for the node's own."""
        dice = self.dice
        can_link = self.budget > 0 and depth < _DEEPEST
        if type_ == "s":
            return self._shader(tree, depth + 1) if dice.chance(0.93) else None
        if type_ in "na":
            can_link = can_link and tree not in self.left_out
            wanted = node_kinds.NORMALS if type_ == "n" else ("ShaderNodeTangent",)
            link = self._at(tree, dice.pick(wanted), "v", depth) if can_link and dice.chance(0.12) else None
            # Whether light is before or behind a tangent, rounding decides; and which way a tangent along a normal points.
            return link if link is None or (link[1] == "Tangent") == (type_ == "a") else None
        if type_ == "t":
            return self._at(tree, dice.pick(node_kinds.PLACES), "v", depth) if can_link and dice.chance(0.6) else None
        share = 0.85 if key in kind.always else 0.25
        if can_link and "constant" not in kind.special and dice.chance(0.4 * share if "sparse" in kind.special else share):
            return self.value(tree, type_, depth + 1)
        if dice.chance(0.75 if "sparse" in kind.special else 0.15):
            return None
        if type_ == "f":
            return dice.number(low, high)
        return [dice.number(low, high) for _ in range(3)]

    def _at(self, tree, name, wanted, depth):
        return self._passed_on(tree, self._node(tree, name, wanted, depth + 1, _VALUES))

    def _group(self, tree, wanted, depth):
        """A link to a group of a few nodes and its input; groups of one kind of output are used again."""
        dice = self.dice
        # No group holds itself: those that are not finished are not known yet.
        # None has nodes that the tree may not have.
        left_out = self.left_out.get(tree, set())
        known = [group for group in self._groups if group[1] == wanted and self.left_out.get(group[0], set()) >= left_out]
        if known and dice.chance(0.4):
            name, _, source = dice.pick(known)
        else:
            self._group_count += 1
            name, source = f"Group {self._group_count}", dice.pick("fcv")
            if left_out:
                self.left_out[name] = left_out
            kept, self.records = self.records, []
            budget, self.budget = self.budget, dice.whole(2, 5)
            read = [self.write(name, "NodeGroupInput", {}, {}), "In"]
            result = self._mixed_shaders(name, source, read) if wanted == "s" else self._mixed_values(name, wanted, read)
            self.write(name, "NodeGroupOutput", {}, {"Out": result})
            group = Record("group", name, {"inputs": {"In": source}, "outputs": {"Out": wanted}})
            self.records = [group, *self.records, *kept]
            self.budget = budget
            self._groups.append((name, wanted, source))
        value = self.value(tree, source, depth + 1) if self.budget > 0 and dice.chance(0.6) else None
        inputs = {} if value is None else {"In": value}
        mute = wanted != "s" and dice.chance(0.05)
        return [self.write(tree, "ShaderNodeGroup", {"node_tree": f"@{name}"}, inputs, mute=mute), "Out"]

    def _zone(self, tree, wanted, depth):
        """A link to a repeat zone, whose item each iteration mixes with another value."""
        dice = self.dice
        self.budget -= 3
        start = self.value(tree, wanted, depth + 1) if dice.chance(0.6) else None
        end = self.write(tree, "GeometryNodeRepeatOutput", {}, {}, zone=wanted)
        inputs = {"Iterations": dice.whole(0, 3), **({} if start is None else {"Item": start})}
        read = [self.write(tree, "GeometryNodeRepeatInput", {}, inputs, pair=end), "Item"]
        item = self._mixed_values(tree, wanted, read)
        self.records.append(Record("link", f"{end[1:]} item", {"node": end, "input": "Item", "source": item}))
        return [end, "Item"]

    def _mixed_values(self, group, wanted, read):
        inside = self.value(group, wanted, 1)
        mixed = {"Fac": self.dice.number(), "Color1": inside, "Color2": read}
        return [self.write(group, "ShaderNodeMixRGB", {"blend_type": "MIX"}, mixed), "Color"]

    def _mixed_shaders(self, group, source, read):
        """Two shaders mixed by the group's input, or a shader in its colour."""
        if source == "f":
            shaders = {"Fac": read, "Shader": self._shader(group, 2), "Shader_001": self._shader(group, 2)}
            return [self.write(group, "ShaderNodeMixShader", {}, shaders), "Shader"]
        return [self.write(group, "ShaderNodeBsdfDiffuse", {}, {"Color": read}), "BSDF"]

    # ---- settings that are no choice ----

    def _special(self, special, props, more):
        dice = self.dice
        if special == "value":
            more["output"] = dice.number(-0.5, 1.5)
        elif special == "color":
            more["output"] = dice.color(0.0, 1.0)
        elif special == "normal":
            more["output"] = dice.vector()
        elif special == "image":
            if self.images and dice.chance(0.97):
                props["image"] = f"@{dice.pick(self.images)}"
                more["user"] = random_images.user(dice)
        elif special == "photometry":
            props["mode"] = "INTERNAL"
            if self.luminaires and dice.chance(0.97):
                props["ies"] = f"@{dice.pick(self.luminaires)}"
        elif special == "mapping":
            if dice.chance(0.08):
                more["mapping"] = {
                    "vector_type": dice.pick(("POINT", "TEXTURE", "VECTOR", "NORMAL")),
                    "translation": dice.vector(), "rotation": dice.vector(-2.0, 2.0), "scale": dice.vector(0.5, 2.0),
                    "mapping_x": dice.pick("XYZ"), "mapping_y": dice.pick("XYZ"),
                    "mapping_z": dice.pick(("X", "Y", "Z", "NONE")),
                }  # fmt: skip
        elif special == "object":
            if self.objects and dice.chance(0.15):
                props["object"] = f"@{dice.pick(self.objects)}"
        elif special == "points":
            if self.objects and dice.chance(0.9):
                props["object"] = f"@{dice.pick(self.objects)}"
        elif special == "sampled":
            more["sampled"] = dice.pick(ATTRIBUTES)
        elif special == "uv_map":
            props["uv_map"] = dice.pick(UV_MAPS)
        elif special == "attribute":
            kind = dice.pick(random_properties.TYPES)
            if kind != "GEOMETRY":
                props["attribute_type"] = kind
            props["attribute_name"] = dice.pick(ATTRIBUTES if kind == "GEOMETRY" else random_properties.NAMES)
        elif special == "layer":
            props["layer_name"] = dice.pick(COLORS)
        elif special == "ramp":
            places = sorted(dice.number() for _ in range(dice.whole(2, 4)))
            more["ramp"] = {
                "interpolation": dice.pick(("LINEAR", "LINEAR", "CONSTANT", "EASE", "CARDINAL", "B_SPLINE")),
                "color_mode": dice.pick(("RGB", "RGB", "HSV", "HSL")),
                "hue_interpolation": dice.pick(("NEAR", "FAR", "CW", "CCW")),
                "elements": [[place, [*dice.color(0.0, 1.0), dice.pick(_ALPHAS)]] for place in places],
            }
        elif special == "curves":
            more["curves"] = [[dice.number(0.2, 0.8), dice.number(0.1, 0.9)] for _ in range(dice.whole(1, 4))]
