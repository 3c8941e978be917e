"""Attributes of the instances that Geometry Nodes make, of each type and at each depth."""

import bpy

from .. import parts
from .boards import shining, size_of, tile_mesh, view_board
from .catalogue import case
from .inputs_objects import covered, instancer, source_object, with_alpha

_WIDTH = 8
_SINCE = (4, 5)  # the first Blender that exposes them


class _Maker:
    """A tree of Geometry Nodes under construction, whose input is a row of points."""

    def __init__(self):
        self.tree = bpy.data.node_groups.new("Maker", "GeometryNodeTree")
        for direction in ("INPUT", "OUTPUT"):
            self.tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
        self.points = self.add("NodeGroupInput").outputs[0]

    def add(self, kind, props=None, **inputs):
        node = self.tree.nodes.new(kind)
        for name, value in (props or {}).items():
            setattr(node, name, value)
        for name, value in inputs.items():
            socket = next(socket for socket in node.inputs if socket.name == name.replace("_", " ") and socket.enabled)
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            elif value is not None:
                socket.default_value = value
        return node

    def source(self, thing):
        """The instances of an object or a collection."""
        if isinstance(thing, bpy.types.Collection):
            return self.add("GeometryNodeCollectionInfo", Collection=thing).outputs[0]
        node = self.add("GeometryNodeObjectInfo", Object=thing, As_Instance=True)
        return next(socket for socket in node.outputs if socket.name == "Geometry")

    def instances(self, points, instance):
        return self.add("GeometryNodeInstanceOnPoints", Points=points, Instance=instance).outputs[0]

    def line(self, count, step):
        return self.add("GeometryNodeMeshLine", Count=count, Offset=(step, 0, 0)).outputs[0]

    def by_index(self, factor, offset):
        index = self.add("GeometryNodeInputIndex").outputs[0]
        node = self.add("ShaderNodeMath", {"operation": "MULTIPLY_ADD"})
        self.tree.links.new(index, node.inputs[0])
        node.inputs[1].default_value, node.inputs[2].default_value = factor, offset
        return node.outputs[0]

    def store(self, instances, name, value, kind="FLOAT"):
        props = {"domain": "INSTANCE", "data_type": kind}
        return self.add("GeometryNodeStoreNamedAttribute", props, Geometry=instances, Name=name, Value=value).outputs[0]

    def end(self, instances):
        self.tree.links.new(instances, self.add("NodeGroupOutput").inputs[0])
        return self.tree


def _host(scene, tree, x, y, count=_WIDTH):
    """An object with points in a row, which become instances."""
    mesh = parts.mesh_from_points("Points", [(number, 0, 0) for number in range(count)], [])
    thing = instancer(scene, (x + 0.5, y + 0.5, 0), mesh)
    thing.modifiers.new("Maker", "NODES").node_group = tree
    return thing


def _source(scene, name="given"):
    """An object below the board that shows the attribute of its instances."""
    thing = source_object(scene, covered(tile_mesh(), shining(with_alpha("INSTANCER", name))))
    thing.location = (0, -50, 0)
    return thing


def _types(scene, row):
    """A tile for each type of attribute, and for one that is named as a property of the instancer."""
    values = {
        "FLOAT": 0.3, "INT": 2, "BOOLEAN": True, "INT8": 1, "FLOAT2": (0.1, 0.2, 0.3), "FLOAT_VECTOR": (0.1, 0.2, 0.3),
        "FLOAT_COLOR": (0.1, 0.2, 0.3, 0.4), "BYTE_COLOR": (0.2, 0.4, 0.6, 0.8), "QUATERNION": None, "FLOAT4X4": None,
    }  # fmt: skip
    names = ["given"] * len(values) + ["of both", "of instancer", "of object", "position", "id", ".reference_index"]
    for number, name in enumerate(names):
        maker = _Maker()
        kind = list(values)[number] if number < len(values) else "FLOAT"
        made = maker.instances(maker.points, maker.source(_source(scene, name)))
        made = maker.store(made, "of both" if name == "of both" else "given", values[kind], kind)
        _host(scene, maker.end(made), number % _WIDTH, row + number // _WIDTH, 1)


def _numbered(scene, row):
    """By the number of the instance."""
    maker = _Maker()
    made = maker.instances(maker.points, maker.source(_source(scene)))
    _host(scene, maker.end(maker.store(made, "given", maker.by_index(0.1, 0.1))), 0, row)


def _with_ids(scene, row):
    """Ids in another order than the instances."""
    maker = _Maker()
    made = maker.instances(maker.points, maker.source(_source(scene)))
    made = maker.store(made, "id", maker.by_index(-10, 500), "INT")
    _host(scene, maker.end(maker.store(made, "given", maker.by_index(0.1, 0.1))), 0, row)


def _with_equal_ids(scene, row):
    maker = _Maker()
    made = maker.instances(maker.points, maker.source(_source(scene)))
    made = maker.store(made, "id", 7, "INT")
    _host(scene, maker.end(maker.store(made, "given", maker.by_index(0.1, 0.1))), 0, row)


def _of_geometry(scene, row):
    """Instances of a geometry without an object."""
    maker = _Maker()
    grid = maker.add("GeometryNodeMeshGrid", Size_X=1, Size_Y=1, Vertices_X=2, Vertices_Y=2).outputs[0]
    grid = maker.add("GeometryNodeSetMaterial", Geometry=grid, Material=shining(with_alpha("INSTANCER", "given"))).outputs[0]
    made = maker.instances(maker.points, grid)
    _host(scene, maker.end(maker.store(made, "given", maker.by_index(0.1, 0.1))), 0, row)


def _beside_a_mesh(scene, row):
    """Instances in one geometry with a mesh, which they hide, inside another instance."""
    maker = _Maker()
    grid = maker.add("GeometryNodeMeshGrid", Size_X=1, Size_Y=1, Vertices_X=2, Vertices_Y=2).outputs[0]
    below = maker.add("GeometryNodeTransform", Geometry=grid, Translation=(0, 0, -1)).outputs[0]
    made = maker.instances(maker.points, maker.source(_source(scene)))
    made = maker.store(made, "given", maker.by_index(0.1, 0.1))
    both = maker.add("GeometryNodeJoinGeometry")
    for geometry in (made, below):
        maker.tree.links.new(geometry, both.inputs[0])
    _host(scene, maker.end(maker.instances(maker.line(1, 1), both.outputs[0])), 0, row)


def _nested(scene, row):
    """Two instances of four: the inner attribute comes first."""
    for name, inner_has_it in (("given", True), ("outer", False)):
        maker = _Maker()
        inner = maker.instances(maker.line(4, 1), maker.source(_source(scene, name)))
        if inner_has_it:
            inner = maker.store(inner, name, maker.by_index(0.1, 0.1))
        made = maker.instances(maker.line(2, 4), inner)
        _host(scene, maker.end(maker.store(made, name, maker.by_index(0.2, 0.5))), 0, row)
        row += 1


def _of_collection(scene, row):
    group = bpy.data.collections.new("Pair")
    for place in (0, 4):
        thing = _source(scene)
        scene.collection.objects.unlink(thing)
        group.objects.link(thing)
        thing.location = place, 0, 0
    scene.collection.children.link(group)
    bpy.context.view_layer.layer_collection.children[group.name].exclude = True
    maker = _Maker()
    made = maker.instances(maker.points, maker.source(group))
    _host(scene, maker.end(maker.store(made, "given", maker.by_index(0.1, 0.1))), 0, row, 4)


def _made_below(scene, row, wrap):
    """The maker of the instances is an instance itself."""
    maker = _Maker()
    made = maker.instances(maker.points, maker.source(_source(scene)))
    host = _host(scene, maker.end(maker.store(made, "given", maker.by_index(0.1, 0.1))), 0, row)
    wrap(scene, host)


def _by_collection(scene, host):
    group, place = bpy.data.collections.new("Group"), tuple(host.location)
    scene.collection.objects.unlink(host)
    group.objects.link(bpy.data.objects.new("Before", None))
    group.objects.link(host)
    maker = instancer(scene, place)
    maker.instance_type, maker.instance_collection = "COLLECTION", group
    host.location = 0, 0, 0


def _by_vertex(scene, host):
    maker = instancer(scene, tuple(host.location), parts.mesh_from_points("Seat", [(0, 0, 0)], []))
    maker.instance_type = "VERTS"
    host.location, host.parent = (0, 0, 0), maker


def _by_geometry(scene, host):
    maker, place = _Maker(), tuple(host.location)
    made = maker.instances(maker.points, maker.source(host))
    _host(scene, maker.end(maker.store(made, "given", 0.9)), place[0] - 0.5, place[1] - 0.5, 1)
    host.location = 0, -60, 0


@case(size=size_of(13 * _WIDTH), bounces=0, since=_SINCE, quick=True)
def attribute_of_instance(scene):
    """Of each type and at each depth, in rows of instances."""
    row = 2
    _types(scene, 0)
    for make in (_numbered, _with_ids, _with_equal_ids, _of_geometry, _beside_a_mesh, _nested, _of_collection):
        make(scene, row)
        row += 2 if make is _nested else 1
    for wrap in (_by_collection, _by_vertex, _by_geometry):
        _made_below(scene, row, wrap)
        row += 1
    view_board(scene, 13 * _WIDTH)
