"""The C interface with wrong values: each call returns a status and a message that names object and value."""

import ctypes
import re

import numpy as np
import pytest
from raw import IDENTITY, add, refused

from addon.bindings import abi
from addon.bindings.abi import Status

NAN, INF = float("nan"), float("inf")


# ---- meshes and instances ----


def test_index_out_of_range_names_mesh_and_index(raw):
    scene = raw.scene()
    positions = np.zeros((800, 3))
    mesh = raw.mesh(positions=positions, triangles=[(0, 1, 2), (3, 812, 5)])
    result = add(raw, scene, "mesh", mesh)
    assert result == (Status.ERROR_ARGUMENT, "mesh 'Cube': index 812 >= 800 vertices")
    refused(add(raw, scene, "mesh", raw.mesh(triangles=[(0, 1, 2**32 - 1)])), "mesh 'Cube'", "4294967295", "4 vertices")
    refused(add(raw, scene, "mesh", raw.mesh(triangles=[(0, 1, 4)])), "mesh 'Cube'", "index 4", "4 vertices")
    # Nothing was added: the next mesh is number 0, and number 1 does not exist.
    assert add(raw, scene, "mesh", raw.mesh())[0] == Status.OK
    assert add(raw, scene, "material", raw.material())[0] == Status.OK
    assert raw.add_instances(scene, [raw.instance(mesh=0)])[0] == Status.OK
    refused(raw.add_instances(scene, [raw.instance(mesh=1)]), "Thing", "mesh", "1")


def test_wrong_numbers_in_instances(raw):
    scene = raw.filled()
    refused(raw.add_instances(scene, [raw.instance(kind=5)]), "Thing", "kind", "5")
    refused(raw.add_instances(scene, [raw.instance(shading=9)]), "Thing", "shading", "9")
    refused(raw.add_instances(scene, [raw.instance(mesh=7)]), "Thing", "7")
    refused(raw.add_instances(scene, [raw.instance(mesh=1)]), "Thing", "mesh 1", "1 meshes")
    refused(raw.add_instances(scene, [raw.instance()], slots=(44,)), "material 44", "1 materials")
    refused(raw.add_instances(scene, [raw.instance(first_slot=5)]), "Thing", "5")
    refused(raw.add_instances(scene, [raw.instance(first_slot=2**32 - 1, slot_count=2)]), "Thing", "slot")
    refused(raw.add_instances(scene, [raw.instance(name=6)]), "name")
    refused(raw.add_instances(scene, [raw.instance(hidden_from=128)]), "Thing", "hidden_from", "128")
    refused(raw.add_instances(scene, [raw.instance(flags=4)]), "Thing", "flags", "4")
    refused(raw.add_instances(scene, [raw.instance()], names=b"endless"), "name")


def test_a_failed_call_adds_no_instance(raw):
    scene = raw.filled()
    refused(raw.add_instances(scene, [raw.instance(), raw.instance(mesh=7)]), "7")
    assert raw.commit(scene)[0] == Status.OK
    session = raw.session(scene)
    statistics = abi.Statistics()
    assert raw.call("lancer_session_statistics", session, ctypes.byref(statistics))[0] == Status.OK
    assert statistics.instances == 1


def test_wrong_normal_domain(raw):
    refused(add(raw, raw.scene(), "mesh", raw.mesh(normal_domain=3)), "mesh 'Cube'", "3")


def test_bad_faces_are_left_out_and_reported(raw):
    scene = raw.scene()
    positions = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (NAN, 0, 0), (INF, 1, 0), (2, 0, 0)]
    triangles = [(0, 3, 1), (0, 1, 2), (0, 4, 1), (0, 1, 5), (1, 1, 2)]
    assert add(raw, scene, "mesh", raw.mesh(positions=positions, triangles=triangles))[0] == Status.OK
    add(raw, scene, "material", raw.material())
    raw.add_instances(scene, [raw.instance()])
    assert raw.commit(scene)[0] == Status.OK
    text = raw.messages(scene)
    left_out = [int(number) for number in re.findall(r"mesh 'Cube': (\d+) faces", text)]
    assert sum(left_out) == 4, text
    # The remaining face keeps its original number.
    hit = (abi.Hit * 1)()
    numbers = [np.array(x, np.float64) for x in ([0.25, 0.25, 1], [0, 0, -1], [0], [10])]
    assert (
        raw.call("lancer_probe_intersect", scene, 1, *[x.ctypes.data for x in numbers], ctypes.addressof(hit))[0] == Status.OK
    )
    assert hit[0].instance == 0 and hit[0].primitive == 1 and hit[0].t == 1.0


@pytest.mark.parametrize(
    "matrix",
    [(0,) * 12, (1,) + (0,) * 11, (NAN,) + IDENTITY[1:], IDENTITY[:3] + (INF,) + IDENTITY[4:]],
    ids=["zero", "line", "nan", "infinite"],
)
def test_instances_without_a_usable_matrix_are_left_out_and_reported(raw, matrix):
    scene = raw.filled()
    assert raw.add_instances(scene, [raw.instance(matrix=matrix)], names=b"Broken\0")[0] == Status.OK
    assert raw.commit(scene)[0] == Status.OK
    assert "Broken" in raw.messages(scene)


def test_messages_are_cut_at_the_given_size(raw):
    scene = raw.filled()
    assert raw.add_instances(scene, [raw.instance(matrix=(0,) * 12)], names=b"Broken\0")[0] == Status.OK
    assert raw.commit(scene)[0] == Status.OK
    text = ctypes.create_string_buffer(b"#" * 16, 16)
    assert raw.call("lancer_scene_messages", scene, text, 4, None)[0] == Status.OK
    assert text.raw[4:] == b"#" * 12 and b"\0" in text.raw[:4]


# ---- materials, lights, world ----


def test_wrong_materials(raw):
    scene = raw.scene()

    def refused_with(lobe, *words):
        refused(add(raw, scene, "material", raw.material(lobes=[lobe])), "material 'Paint'", *words)

    refused_with(raw.lobe(kind=19), "kind", "19")
    refused(add(raw, scene, "material", raw.material(lobes=[raw.lobe()] * 65)), "material 'Paint'", "65")
    refused_with(raw.lobe(kind=abi.LobeKind.PRINCIPLED), "rincipled")
    for kind in (abi.LobeKind.GLOSSY, abi.LobeKind.GLASS, abi.LobeKind.SHEEN):
        lobe = raw.lobe(kind=kind)
        lobe.distribution = 4
        refused_with(lobe, "distribution", "4")
    for field, value in (("rules", 5), ("distribution", 4), ("option", 2)):
        principled = raw.principled()
        setattr(principled, field, value)
        refused_with(raw.lobe(kind=abi.LobeKind.PRINCIPLED, principled=principled), field, str(value))


def test_references_to_nodes_that_are_not_there(raw):
    """References of a lobe, a Principled lobe, a material and a world: each message names owner and node."""
    scene = raw.scene()
    one = raw.nodes(raw.node())
    lobe = raw.lobe()
    lobe.color = raw.reference(3)
    refused(add(raw, scene, "material", raw.material(lobes=[lobe], **one)), "material 'Paint'", "node 3")
    principled = raw.principled()
    principled.coat_tint = raw.reference(1)
    lobe = raw.lobe(kind=abi.LobeKind.PRINCIPLED, principled=principled)
    refused(add(raw, scene, "material", raw.material(lobes=[lobe], **one)), "material 'Paint'", "node 1")
    for field in ("emission", "transmittance", "holdout", "ambient", "displacement", "normal"):
        for node in (1, -2):
            material = raw.material(**{field: raw.reference(node)}, **one)
            refused(add(raw, scene, "material", material), "material 'Paint'", field, str(node))
    world = raw.world(radiance=0.0, **one)
    world.radiance = raw.reference(7)
    refused(raw.call("lancer_scene_set_world", scene, ctypes.byref(world)), "world", "node 7")
    # A reference to an existing node is valid.
    assert add(raw, scene, "material", raw.material(emission=raw.reference(0), **one))[0] == Status.OK


def test_wrong_nodes(raw):
    scene = raw.scene()
    kinds = abi.NodeKind

    def refused_with(*nodes, words):
        result = add(raw, scene, "material", raw.material(**raw.nodes(*nodes)))
        refused(result, "material 'Paint'", f"node {len(nodes) - 1}", *words)

    plain = raw.node()
    none = max(kinds) + 1
    refused_with(raw.node(kind=none), words=["kind", str(none)])
    for kind, options in (
        (kinds.COORDINATE, 16),
        (kinds.MATH, 41),
        (kinds.VECTOR_MATH, 24),
        (kinds.MIX, 19),
        (kinds.MAPPING, 4),
        (kinds.SEPARATE, 3),
        (kinds.NOISE, 5),
        (kinds.VORONOI, 5),
        (kinds.GRADIENT, 7),
        (kinds.WAVE, 3),
        (kinds.MAGIC, 11),
        (kinds.GABOR, 2),
        (kinds.RADIAL_TILING, 2),
        (kinds.VECTOR_TRANSFORM, 3),
        (kinds.VOXELS, 3),
        (kinds.SKY, 5),
        (kinds.OBJECT_INFO, 5),
        (kinds.LIGHT_PATH, 15),
    ):
        refused_with(raw.node(kind=kind, option=options), words=["option", str(options)])
    for flags in (3, 3 << 2):
        refused_with(raw.node(kind=kinds.VECTOR_TRANSFORM, flags=flags), words=["flags", str(flags)])
    # A node may refer only to nodes before it.
    for node in (0, 1, 2**31 - 1, -2):
        refused_with(raw.node(kind=kinds.GAMMA, inputs=[raw.reference(node)]), words=[str(node)])
    refused_with(plain, raw.node(kind=kinds.BUMP, first=2), words=["first", "2"])
    refused_with(raw.node(kind=kinds.IMAGE, image_count=1), words=["image", "0 images"])
    refused_with(raw.node(kind=kinds.CURVES), words=["image 0", "0 images"])
    refused_with(raw.node(kind=kinds.SKY), words=["image 0", "0 images"])
    refused_with(raw.node(kind=kinds.VOXELS), words=["image 0", "0 images"])
    assert raw.call("lancer_scene_add_image", scene, ctypes.byref(raw.image(kind=abi.TexelKind.FLOAT)))[0] == Status.OK
    refused_with(raw.node(kind=kinds.IMAGE, image=2**32 - 1, image_count=2), words=["1 images"])
    # The picture has no row of eleven texels of three channels.
    refused_with(raw.node(kind=kinds.SKY), words=["image 0", "table of the sky"])
    for value in (NAN, INF):
        refused_with(raw.node(kind=kinds.GAMMA, inputs=[raw.parameter(value)]), words=["is", "inf" if value == INF else "nan"])
        wild = raw.node(kind=kinds.TRANSFORM)
        wild.matrix[5] = value
        refused_with(wild, words=["matrix"])
    refused(add(raw, scene, "material", raw.material(nodes=None, node_count=1)), "material 'Paint'", "nodes", "NULL")
    refused(add(raw, scene, "material", raw.material(node_count=5000)), "material 'Paint'", "5000", "4096")


@pytest.mark.parametrize(
    "field, value",
    [("width", 0), ("height", 0), ("width", 2**31), ("channels", 2), ("channels", 5), ("kind", 3), ("transfer", 2)]
    + [("alpha", 4), ("texels", None)],
)
def test_wrong_images(raw, field, value):
    scene = raw.scene()
    image = raw.image()
    setattr(image, field, value)
    result = raw.call("lancer_scene_add_image", scene, ctypes.byref(image))
    refused(result, "image 'Picture'", field, *([] if value is None else [str(value)]))


def test_a_picture_with_a_wild_matrix(raw):
    image = raw.image()
    image.matrix[4] = NAN
    refused(raw.call("lancer_scene_add_image", raw.scene(), ctypes.byref(image)), "image 'Picture'", "matrix")


def test_wrong_attributes(raw):
    scene = raw.scene()
    good = np.zeros((4, 2))

    def refused_with(word, **fields):
        attribute = raw.attribute(good)
        for field, value in fields.items():
            setattr(attribute, field, value)
        refused(add(raw, scene, "mesh", raw.mesh(**raw.attributes(attribute))), "mesh 'Cube'", word)

    refused_with("domain", domain=3)
    refused_with("channels", channels=0)
    refused_with("channels", channels=5)
    refused_with("values", values=None)
    refused(add(raw, scene, "mesh", raw.mesh(attribute_count=1)), "mesh 'Cube'", "attributes")
    assert add(raw, scene, "mesh", raw.mesh(**raw.attributes(raw.attribute(good))))[0] == Status.OK


WORDS = {"color": "colour", "roughness": "roughness", "ior": "IOR", "shininess": "shininess"}


@pytest.mark.parametrize("field", WORDS)
@pytest.mark.parametrize("value", [NAN, INF, -INF, -1.0])
def test_wild_values_of_a_lobe_are_refused_or_replaced_with_a_message(raw, field, value):
    scene = raw.scene()
    kind = abi.LobeKind.PHONG if field == "shininess" else abi.LobeKind.BECKMANN
    result = add(raw, scene, "material", raw.material(lobes=[raw.lobe(kind=kind, **{field: value})]))
    if field == "ior" and value == INF:
        assert result[0] == Status.OK, result
        return
    if result[0] == Status.OK:
        assert raw.commit(scene)[0] == Status.OK
        assert "Paint" in raw.messages(scene) and WORDS[field] in raw.messages(scene)
    else:
        refused(result, "material 'Paint'", WORDS[field])


def test_wrong_lights(raw):
    scene = raw.scene()
    refused(add(raw, scene, "light", raw.light(kind=4)), "light 'Lamp'", "4")
    refused(add(raw, scene, "light", raw.light(kind=abi.LightKind.AREA, shape=2)), "light 'Lamp'", "2")
    refused(add(raw, scene, "light", raw.light(falloff=6)), "light 'Lamp'", "6")


@pytest.mark.parametrize("field", ["emission", "radius", "size", "matrix", "spot_angle", "sun_angle"])
@pytest.mark.parametrize("value", [NAN, -INF, -1.0])
def test_wild_values_of_a_light_are_refused_or_replaced_with_a_message(raw, field, value):
    scene = raw.scene()
    kind = {"size": abi.LightKind.AREA, "spot_angle": abi.LightKind.SPOT, "sun_angle": abi.LightKind.SUN}
    light = raw.light(kind=kind.get(field, abi.LightKind.POINT))
    if field == "emission":
        light.emission = (value, 1, 1)
    elif field == "size":
        light.size = (value, 1)
    elif field == "matrix":
        light.matrix[3] = value
    else:
        setattr(light, field, value)
    result = add(raw, scene, "light", light)
    if result[0] == Status.OK:
        assert raw.commit(scene)[0] == Status.OK
        legal = field in ("matrix", "emission") and value == -1.0
        assert legal or "Lamp" in raw.messages(scene)
    else:
        refused(result, "light 'Lamp'")


def test_an_undefined_number_of_a_light_is_its_least(raw):
    scene = raw.scene()
    for field in ("radius", "spot_blend"):
        assert add(raw, scene, "light", raw.light(kind=abi.LightKind.SPOT, **{field: NAN}))[0] == Status.OK
    assert raw.commit(scene)[0] == Status.OK
    lines = raw.messages(scene).splitlines()
    assert [line.endswith("nan was replaced by 0") for line in lines] == [True, True], lines


def test_wild_worlds(raw):
    for value in (NAN, INF, -INF):
        scene = raw.scene()
        world = raw.world()
        world.radiance.value[0] = value
        result = raw.call("lancer_scene_set_world", scene, ctypes.byref(world))
        if result[0] == Status.OK:
            assert raw.commit(scene)[0] == Status.OK
            assert "orld" in raw.messages(scene)
        else:
            refused(result, "world")


def test_the_message_belongs_to_the_last_call(raw):
    refused(raw.call("lancer_scene_destroy", 0), status=Status.ERROR_HANDLE)
    assert raw.library.lancer_last_error()
    scene = raw.scene()
    assert raw.library.lancer_last_error() == b""
    assert raw.call("lancer_scene_destroy", scene)[0] == Status.OK
