"""The features of a scene, compared with the core's list, and the scene without each feature."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes as tiny

from addon.bindings.enums import AreaShape, Coordinate, LightKind, LobeKind, NodeKind, Pass, Shading
from addon.bindings.parameters import without_idle_nodes
from addon.bindings.session import Session
from addon.bindings.shading import Image, Lobe, Material, Node, NodeRef, Principled, World
from addon.bindings.snapshot import Instance, InstanceTable, Light
from addon.measure import scene_features, simpler_scene
from addon.measure.scene_features import kernel_in_words, used_features, without

# The add-on's and the core's names of the same feature.
SAME = {
    "glass": "glass",
    "transparency": "transparency",
    "emission": "emitters",
    "displacement": "displacement",
    "lens": "lens",
    **{
        name: name
        for name in (
            "triangles", "instances", "spheres", "planes", "cylinders", "cones", "point-lights", "spot-lights", "sun-lights",
            "area-lights", "environment", "environment-map", "visibility",
        )
    },
}  # fmt: skip
PICTURE = NodeRef(1)
PICTURE_NODES = (Node(NodeKind.COORDINATE, option=Coordinate.UV), Node(NodeKind.IMAGE, inputs=(NodeRef(0),), image_count=1))


def principled(name, nodes=(), **values):
    lobe = Lobe(LobeKind.PRINCIPLED, color=(1, 1, 1), principled=Principled(**values))
    return Material(name, lobes=(lobe,), nodes=nodes)


def checks():
    texels = np.zeros((8, 8, 4), np.uint8)
    texels[:, :4] = (204, 51, 0, 255)
    texels[:, 4:] = (0, 51, 102, 255)
    return Image("checks", texels)


def everything():
    """Return the showroom with the features that it lacks."""
    base = tiny.showroom(passes=(Pass.COMBINED, Pass.DEPTH), max_bounces=8)
    bump = Node(NodeKind.BUMP, inputs=(1.0, 0.1, NodeRef(1), NodeRef(2), 0.1), first=0)
    normal = Node(NodeKind.COORDINATE, option=Coordinate.SHADING_NORMAL)
    facing = Node(NodeKind.LAYER_WEIGHT, inputs=(0.5, NodeRef(0)), option=1)
    extra = [
        principled("pictured", PICTURE_NODES, base_color=PICTURE),
        Material("bumpy", lobes=(Lobe(normal=NodeRef(3)),), nodes=(*PICTURE_NODES, normal, bump)),
        principled("coated", coat=1.0, sheen=0.5, anisotropic=0.5, metallic=0.5, diffuse_roughness=0.4),
        Material("leaf", lobes=(Lobe(LobeKind.TRANSLUCENT),)),
        Material("computed", lobes=(Lobe(color=NodeRef(1)),), nodes=(normal, facing)),
        Material("moved", displacement=(0.0, 0.0, 0.1)),
        Material("never placed", lobes=(Lobe(LobeKind.SHEEN),)),
    ]
    first = len(base.materials)
    placed = [
        Instance(mesh=1, matrix=tiny.move(i, 0, 1), materials=(first + i,), name=f"extra {i}", shading=Shading.PHONG)
        for i in range(len(extra) - 1)
    ]
    table = InstanceTable.build(
        _instances(base) + placed + [tiny.plane(0, hidden_from=4, name="hidden", matrix=tiny.move(z=-1))]
    )
    sky = World(
        radiance=NodeRef(1),
        nodes=(Node(NodeKind.COORDINATE), Node(NodeKind.ENVIRONMENT, inputs=(NodeRef(0),), image_count=1)),
    )
    uv = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], np.float32)
    return dataclasses.replace(
        base,
        meshes=(*base.meshes, dataclasses.replace(tiny.quad(), uvs=uv)),
        instances=table,
        materials=(*base.materials, *extra),
        images=(checks(),),
        world=sky,
    )


def _instances(snapshot):
    """Return the table as a list of Instance."""
    table = snapshot.instances
    return [
        Instance(
            kind=int(table.kinds[i]),
            mesh=int(table.meshes[i]),
            matrix=table.matrices[i],
            materials=tuple(table.slots[table.first_slots[i] :][: table.slot_counts[i]].tolist()),
            name=table.names[table.name_indices[i]],
        )
        for i in range(len(table))
    ]


def names(snapshot):
    return {feature.name for feature in used_features(snapshot)}


def core_names(snapshot):
    with Session.upload(snapshot) as session:
        return set(session.statistics().features.split())


REMOVABLE = [feature.name for feature in used_features(everything()) if feature.without]


def test_the_whole_scene_has_all_that_can_be_taken_away():
    assert REMOVABLE == [kind.name for kind in scene_features._KINDS if kind.without]


@pytest.mark.parametrize("name", [None, *REMOVABLE])
def test_the_core_finds_the_same(name):
    """Add-on and core list the same features, for the whole scene and without each feature."""
    snapshot = everything()
    before = names(snapshot)
    if name is not None:
        snapshot = without(snapshot, name)
    ours, core = names(snapshot), core_names(snapshot)
    assert {core_name for own, core_name in SAME.items() if own in ours} == core & set(SAME.values())
    if name is not None:
        # The feature is gone and no new one appears.
        assert name not in ours and ours <= before


@pytest.mark.parametrize("name", REMOVABLE)
def test_what_is_left_can_be_rendered(name):
    picture = tiny.render(without(everything(), name), samples=1)
    assert np.isfinite(picture).all() and picture[..., :3].mean() > 0.0


def test_counts_and_owners():
    found = {feature.name: feature for feature in used_features(everything())}
    assert (found["glass"].count, found["glass"].owners, found["glass"].text) == (1, ("glass",), "1 material uses refraction")
    # The floor, and the plane that is hidden from reflections.
    assert found["planes"].count == 2 and found["planes"].owners == ("floor", "hidden")
    assert found["soft-lamps"].owners == ("point", "area", "sun")
    assert found["bounces"].text == "Light is followed for 8 bounces"
    assert found["sheen"].owners == ("coated",)


def test_owners_are_counted_and_only_the_first_named():
    snapshot = tiny.scene([tiny.sphere(name=f"ball {i}") for i in range(2000)], [tiny.lambert()])
    found = {feature.name: feature for feature in used_features(snapshot)}["spheres"]
    assert found.text == "2 000 exact spheres" and found.owners == tuple(f"ball {i}" for i in range(8))


def test_a_mesh_is_shared_by_two():
    meshes = [tiny.quad(), tiny.quad()]
    apart, shared = (
        names(tiny.scene([Instance(mesh=0), Instance(mesh=other)], [tiny.lambert()], meshes=meshes)) for other in (1, 0)
    )
    assert shared - apart == {"instances"}


def test_an_empty_scene_uses_nothing():
    assert used_features(tiny.scene()) == []


def test_pictures_become_their_mean():
    """Half of the image is (204, 51, 0) of 255, half (0, 51, 102)."""
    material = next(m for m in without(everything(), "textures").materials if m.name == "pictured")
    # Interpolated texels are floats of rounded sums: a few units of 2^-24.
    assert material.lobes[0].principled.base_color == pytest.approx((0.4, 0.2, 0.2), rel=1e-6)
    assert material.nodes == ()


def test_what_pictures_cut_out_stays():
    """A leaf's alpha controls both its lobe and its transmittance: only its colour becomes a constant."""
    alpha = Node(NodeKind.ALPHA, inputs=(NodeRef(1),))
    rest = Node(NodeKind.MATH, inputs=(1.0, NodeRef(2)), option=1)
    lobe = Lobe(color=PICTURE, weight=NodeRef(2))
    leaf = Material("leaf", lobes=(lobe,), transmittance=NodeRef(3), nodes=(*PICTURE_NODES, alpha, rest))
    snapshot = dataclasses.replace(
        tiny.scene([Instance()], [leaf], meshes=[tiny.quad()], world=1.0), images=(checks(),), world=World(radiance=1.0)
    )
    plain = without(snapshot, "textures").materials[0]
    assert plain.lobes[0].color == pytest.approx((0.4, 0.2, 0.2), rel=1e-6)
    assert (plain.lobes[0].weight, plain.transmittance, len(plain.nodes)) == (NodeRef(2), NodeRef(3), 4)
    solid = without(snapshot, "transparency").materials[0]
    assert (solid.transmittance, solid.lobes[0].weight) == ((0, 0, 0), (1, 1, 1))
    assert (solid.lobes[0].color, len(solid.nodes)) == (PICTURE, 2)


def test_a_veil_becomes_the_whole_of_its_surface():
    snapshot = tiny.scene([Instance()], [tiny.veiled(tiny.lambert(0.5), 0.25)], meshes=[tiny.quad()])
    assert without(snapshot, "transparency").materials[0] == dataclasses.replace(tiny.lambert(0.5))


def test_single_numbers_are_the_first_of_three():
    material = Material("red", lobes=(Lobe(weight=0.5),), transmittance=0.75)
    snapshot = tiny.scene([tiny.sphere()], [material])
    assert without(snapshot, "transparency").materials[0].lobes[0].weight == pytest.approx((2 / 3, 0.0, 0.0))
    metal = Material("metal", lobes=(Lobe(LobeKind.CONDUCTOR, option=1, color=2.0, edge=0.0),))
    assert "metal" in names(tiny.scene([tiny.sphere()], [metal]))


def test_a_sky_becomes_its_mean():
    image = Image("sky", np.full((4, 8, 3), 0.7, np.float32))
    nodes = (Node(NodeKind.COORDINATE), Node(NodeKind.ENVIRONMENT, inputs=(NodeRef(0),), image_count=1))
    snapshot = dataclasses.replace(tiny.scene(), images=(image,), world=World(radiance=NodeRef(1), nodes=nodes))
    # Weights of four equal texels sum to 1 within three roundings, and their products are rounded once each.
    assert without(snapshot, "environment-map").world.radiance == pytest.approx((0.7,) * 3, rel=8 * 2.0**-24)


def test_an_area_lamp_keeps_its_power():
    """An area lamp becomes a point lamp with equal power and equal intensity over the half space."""
    lamp = Light("area", kind=LightKind.AREA, emission=(3.0, 3.0, 3.0), size=(2.0, 0.5))
    point = simpler_scene.point_lamps(tiny.scene(lights=[lamp])).lights[0]
    assert point.kind == LightKind.SPOT and point.spot_angle == math.pi
    # Power of the area: pi L A. Of the point: 2 pi I.
    assert 2.0 * math.pi * point.emission[0] == pytest.approx(math.pi * 3.0 * 1.0, rel=1e-12)
    round_one = dataclasses.replace(lamp, shape=AreaShape.ELLIPSE)
    point = simpler_scene.point_lamps(tiny.scene(lights=[round_one])).lights[0]
    assert 2.0 * math.pi * point.emission[0] == pytest.approx(math.pi * 3.0 * math.pi / 4.0, rel=1e-12)


def test_idle_nodes_go_and_the_picture_stays():
    """Removing unused nodes renumbers a bump's range of nodes and keeps the picture."""
    snapshot = everything()
    number = next(i for i, m in enumerate(snapshot.materials) if m.name == "bumpy")
    material = snapshot.materials[number]
    idle = Node(NodeKind.COORDINATE, option=Coordinate.CAMERA)

    def shifted(value):
        return NodeRef(value.node + 2) if isinstance(value, NodeRef) else value

    nodes = [
        dataclasses.replace(n, inputs=tuple(map(shifted, n.inputs)), first=2 if n.kind == NodeKind.BUMP else 0)
        for n in material.nodes
    ]
    crowded = dataclasses.replace(material, nodes=(idle, idle, *nodes), lobes=(Lobe(normal=NodeRef(5)),))
    assert without_idle_nodes(crowded) == material
    pictures = []
    for variant in (crowded, without_idle_nodes(crowded)):
        materials = (*snapshot.materials[:number], variant, *snapshot.materials[number + 1 :])
        pictures.append(tiny.render(dataclasses.replace(snapshot, materials=materials), samples=2))
    assert np.array_equal(*pictures)


def test_exact_shapes_become_meshes_of_nearly_the_same_outline():
    """Seen from above, 48 sides cover 48/(2 pi) sin(2 pi/48) of a disk."""
    share = 48 / (2 * math.pi) * math.sin(2 * math.pi / 48)
    for shape in (tiny.sphere, None):
        instance = tiny.sphere() if shape else Instance(kind=3, materials=(0,))
        camera = tiny.pencil((0, 0, 5), width=3.0, pixels=256)
        glow = Material("glow", lobes=(), emission=(1, 1, 1))
        snapshot = tiny.scene([instance], [glow], camera=camera)
        round_, flat = (tiny.render(s, samples=4)[..., 0].sum() for s in (snapshot, without(snapshot, "exact-shapes")))
        # Only the 2 pi 85 pixels of the outline have an error, each of at most 1/4.
        assert flat / round_ == pytest.approx(share, abs=1e-3)


def test_texture_bytes_are_by_themselves():
    snapshot = everything()
    with Session.upload(snapshot) as session:
        with_picture = session.statistics()
    assert with_picture.texture_bytes == 8 * 8 * 4
    larger = dataclasses.replace(snapshot, images=(dataclasses.replace(checks(), texels=np.zeros((64, 64, 4), np.uint8)),))
    with Session.upload(larger) as session:
        statistics = session.statistics()
    assert statistics.texture_bytes == 64 * 64 * 4
    assert statistics.accelerator_bytes == with_picture.accelerator_bytes


def test_kernels_have_words():
    """Every kernel has a description."""
    kernels = set()
    for snapshot in (everything(), without(everything(), "transparency"), tiny.scene([tiny.plane()], [tiny.lambert()])):
        for integrator in (0, 1, 2):
            with Session.upload(tiny.with_settings(snapshot, integrator=integrator)) as session:
                kernels.add(session.statistics().kernel)
    assert len(kernels) == 3
    assert all(kernel_in_words(kernel) != kernel for kernel in kernels)
    assert kernel_in_words("unheard of") == "unheard of"
