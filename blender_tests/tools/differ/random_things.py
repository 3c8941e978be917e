"""Random objects: meshes with attributes, what becomes a mesh at the render, modifiers, parents, transforms, instances."""

from .record import Record

# Each fills about a unit; the share of scenes that hold it.
_SHAPES = {"ball": 4, "cube": 3, "plane": 2, "grid": 2, "cone": 1, "torus": 1, "heap": 1, "monkey": 1}
_DOMAINS = ("POINT", "FACE", "CORNER", "EDGE")
# Surfaces that keep an area, and no second side, when they are flattened.
_OPEN = ("plane", "grid")
# By name: the types that an attribute of it may have.
_ATTRIBUTES = {
    "Number": ("FLOAT",),
    "Whole": ("INT", "INT8"),
    "Vector": ("FLOAT_VECTOR",),
    "Color": ("FLOAT_COLOR", "BYTE_COLOR"),
    "Byte": ("BYTE_COLOR", "FLOAT_COLOR"),
    "Flag": ("BOOLEAN",),
    "Pair": ("FLOAT2",),
    "Four": ("QUATERNION", "FLOAT4"),
    # Blender 4 crashes by itself where a modifier meets an attribute of type FLOAT4X4.
    "Odd": ("INT16_2D", "INT32_2D"),
}
_RAYS = ("camera", "diffuse", "glossy", "transmission", "shadow")


class Things:
    def __init__(self, dice, materials):
        self.dice, self.materials = dice, materials
        self.records = []
        self.names = []
        self._meshes = []

    def fill(self):
        """A floor or a wall now and then, and one to three things."""
        dice = self.dice
        if dice.chance(0.6):
            self._mesh("Ground mesh", "plane", uv_maps=["UVMap"] if dice.chance(0.7) else [])
            self._object(
                "Ground",
                "Ground mesh",
                location=[0.0, 0.0, 0.0],
                scale=[dice.number(4, 8)] * 3,
                rotation=[0, 0, dice.number(0, 3)],
            )
        count = dice.pick({1: 5, 2: 4, 3: 1})
        for number in range(count):
            x = (number - (count - 1) / 2) * 1.9
            self._thing(number + 1, [round(x + dice.number(-0.2, 0.2), 3), dice.number(-0.5, 0.5), dice.number(0.9, 1.2)])
        if dice.chance(0.12):
            self._instances()
        if dice.chance(0.1):
            self._collection()

    def _thing(self, number, place):
        dice = self.dice
        name = f"Thing {number}"
        kind = dice.pick({"mesh": 12, "curve": 1, "text": 1, "metaball": 1, "surface": 1})
        if kind != "mesh":
            self.records.append(Record(kind, f"Data {number}", {"materials": [self._material()], "seed": dice.whole(0, 99)}))
            self._object(name, f"Data {number}", place)
        else:
            if self._meshes and dice.chance(0.2):
                mesh = dice.pick(self._meshes)
            else:
                mesh = f"Mesh {number}"
                self._mesh(mesh, dice.pick(_SHAPES))
            self._object(name, mesh, place, scale=self._flat_scale() if self._is_open(mesh) and dice.chance(0.08) else None)
            for _ in range(dice.pick({0: 12, 1: 4, 2: 1})):
                self._modifier(name)
        if dice.chance(0.25):
            self._parent(name, number)

    def _material(self):
        return f"@{self.dice.pick(self.materials)}" if self.dice.chance(0.95) else None

    def _mesh(self, name, shape, uv_maps=None):
        dice = self.dice
        if uv_maps is None:
            uv_maps = dice.some(("UVMap", "Second"), 0.6)
        fields = {
            "shape": shape,
            "materials": [self._material() for _ in range(1 if dice.chance(0.85) else 2)],
            "uv_maps": uv_maps,
        }
        fields["smooth"] = dice.pick(("yes", "yes", "no", "mixed")) if shape != "plane" else "no"
        if len(uv_maps) > 1 and dice.chance(0.5):
            fields["active_uv_map"] = "Second"
        if dice.chance(0.15):
            fields["sharp_edges"] = dice.number(0.1, 0.5)
        if dice.chance(0.08):
            fields["custom_normals"] = dice.number(0.05, 0.4)
        self._meshes.append(name)
        self.records.append(Record("mesh", name, fields))
        for attribute in dice.some(_ATTRIBUTES, 0.4):
            domain = dice.pick(_DOMAINS)
            type_ = dice.pick(_ATTRIBUTES[attribute])
            if "COLOR" in type_ and domain in ("FACE", "EDGE") and dice.chance(0.8):
                domain = "CORNER"
            fields = {"mesh": f"@{name}", "type": type_, "domain": domain, "seed": dice.whole(0, 99)}
            self.records.append(Record("attribute", attribute, fields))

    def _object(self, name, data, location, rotation=None, scale=None):
        dice = self.dice
        fields = {
            "data": f"@{data}",
            "location": location,
            "rotation": dice.vector(-3.0, 3.0) if rotation is None else rotation,
            "scale": self._scale() if scale is None else scale,
        }
        if dice.chance(0.1):
            fields["material"] = self._material()
        settings = {}
        for ray in dice.some(_RAYS, 0.03):
            settings[f"visible_{ray}"] = False
        if dice.chance(0.03):
            settings["is_holdout"] = True
        if dice.chance(0.2):
            settings["pass_index"] = dice.whole(0, 9)
        if dice.chance(0.2):
            settings["color"] = [*dice.color(), dice.number()]
        if dice.chance(0.015):
            settings["hide_render"] = True
        if dice.chance(0.05):
            settings["delta_scale"] = self._scale()
        if dice.chance(0.05):
            settings["delta_location"] = dice.vector(-0.3, 0.3)
        if settings:
            fields["settings"] = settings
        if dice.chance(0.1):
            fields["terminator"] = dice.number(0.0, 1.0)
        self.names.append(name)
        self.records.append(Record("object", name, fields))

    def _scale(self):
        dice = self.dice
        size = dice.number(0.5, 0.9)
        kind = dice.pick({"even": 3, "uneven": 3, "mirrored": 1})
        if kind == "even":
            return [size] * 3
        scale = [round(size * dice.number(0.5, 1.4), 3) for _ in range(3)]
        return [-x if kind == "mirrored" and dice.chance(0.5) else x for x in scale]

    def _is_open(self, mesh):
        fields = next(record.fields for record in self.records if record.verb == "mesh" and record.name == mesh)
        return fields["shape"] in _OPEN and fields["smooth"] == "no"

    def _flat_scale(self):
        scale = self._scale()
        scale[self.dice.whole(0, 2)] = 0.0
        return scale

    def _parent(self, child, number):
        """An empty that stretches what is turned below it: shear."""
        dice = self.dice
        fields = {
            "location": dice.vector(-0.2, 0.2),
            "rotation": dice.vector(-0.5, 0.5),
            "scale": [dice.number(0.7, 1.3) for _ in range(3)],
        }
        if dice.chance(0.2):
            fields["scale"][dice.whole(0, 2)] *= -1
        self.records.append(Record("object", f"Parent {number}", fields))
        self.records.append(Record("parent", child, {"parent": f"@Parent {number}", "inverse": dice.chance(0.3)}))
        if dice.chance(0.3):
            above = {"rotation": dice.vector(-0.5, 0.5), "scale": [dice.number(0.7, 1.3) for _ in range(3)]}
            self.records.append(Record("object", f"Grandparent {number}", above))
            self.records.append(Record("parent", f"Parent {number}", {"parent": f"@Grandparent {number}", "inverse": False}))

    def _modifier(self, name):
        dice = self.dice
        kind = dice.pick(
            (
                "SUBSURF",
                "MIRROR",
                "ARRAY",
                "BEVEL",
                "SOLIDIFY",
                "SIMPLE_DEFORM",
                "DISPLACE",
                "TRIANGULATE",
                "WEIGHTED_NORMAL",
                "EDGE_SPLIT",
            )
        )
        fields = {
            "SUBSURF": {
                "levels": 0, "render_levels": dice.whole(1, 2),
                "subdivision_type": dice.pick(("CATMULL_CLARK", "CATMULL_CLARK", "SIMPLE")),
            },
            "MIRROR": {"use_axis": [True, False, False], "use_bisect_axis": [True, False, False]},
            "ARRAY": {
                "count": 2, "use_relative_offset": False, "use_constant_offset": True,
                "constant_offset_displace": dice.vector(-1.2, 1.2),
            },
            "BEVEL": {"width": dice.number(0.05, 0.2), "segments": dice.whole(1, 3)},
            "SOLIDIFY": {"thickness": dice.number(0.05, 0.2)},
            "SIMPLE_DEFORM": {
                "deform_method": dice.pick(("TWIST", "BEND", "TAPER", "STRETCH")),
                "factor": dice.number(-0.8, 0.8),
            },
            "DISPLACE": {"strength": dice.number(-0.2, 0.2)},
        }.get(kind, {})  # fmt: skip
        record = {"object": f"@{name}", "type": kind, "settings": fields}
        if kind == "SUBSURF" and dice.chance(0.4):
            record["dicing_rate"] = dice.number(1.0, 8.0)
        self.records.append(Record("modifier", f"{kind.title()}", record))

    def _instances(self):
        """The first thing again, by a collection or on the corners or faces of another mesh."""
        dice = self.dice
        if dice.chance(0.5):
            fields = {"objects": ["@Thing 1", *(["@Lamp 1 object"] if dice.chance(0.5) else [])], "only": dice.chance(0.3)}
            self.records.append(Record("collection", "Copies", fields))
            for number in range(dice.whole(1, 2)):
                place = {
                    "collection": "@Copies",
                    "location": [dice.number(-1.5, 1.5), dice.number(0.5, 1.5), dice.number(0.0, 1.0)],
                }
                place |= {"rotation": dice.vector(-1.0, 1.0), "scale": self._scale()}
                if dice.chance(0.3):
                    place["settings"] = {"color": [*dice.color(), dice.number()]}
                self.records.append(Record("object", f"Copy {number + 1}", place))
            return
        self._mesh("Seats mesh", dice.pick(("plane", "cube")), uv_maps=[])
        fields = {"data": "@Seats mesh", "location": [0.0, 1.0, 1.0], "rotation": dice.vector(-1, 1), "scale": self._scale()}
        fields["instances"] = {
            "type": dice.pick(("VERTS", "FACES")), "shown": dice.chance(0.7),
            "use_instance_vertices_rotation": dice.chance(0.5),
            "use_instance_faces_scale": dice.chance(0.5),
        }  # fmt: skip
        self.records.append(Record("object", "Seats", fields))
        self._mesh("Seed mesh", dice.pick(("cube", "ball")))
        self._object("Seed", "Seed mesh", [0.0, 0.0, 0.0], scale=[0.3, 0.3, 0.2])
        self.records.append(Record("parent", "Seed", {"parent": "@Seats", "inverse": False}))
        if dice.chance(0.3):
            # A lamp on each seat, as far away as lamps are.
            self.records.append(Record("parent", "Lamp 1 object", {"parent": "@Seats", "inverse": True}))

    def _collection(self):
        dice = self.dice
        switch = dice.pick(("exclude", "holdout", "indirect_only", "hide_render", "none"))
        name = dice.pick([name for name in self.names if name != "Ground"])
        self.records.append(Record("collection", "Apart", {"objects": [f"@{name}"], "only": True, "switch": switch}))
