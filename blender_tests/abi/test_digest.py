"""The digest of a scene: equal for equal scenes, also from files, and different for any other one."""

import dataclasses
import io

import numpy as np
from rich_snapshot import changed, leaves, rich
from tiny_scenes import lambert, quad, rgb

from addon.bindings.digest import scene_digest
from addon.bindings.snapshot import Image, Light, Material, MeshData, SceneSnapshot, World


def loaded(snapshot):
    file = io.BytesIO()
    snapshot.save(file)
    file.seek(0)
    return SceneSnapshot.load(file)


def test_equal_scenes_have_equal_digests():
    digest = scene_digest(rich())
    assert len(digest) == 32
    assert digest == scene_digest(rich()) == scene_digest(loaded(rich())) == scene_digest(loaded(loaded(rich())))


def test_any_change_of_the_scene_changes_it_and_none_of_the_picture():
    snapshot, kept, refused = rich(), set(), set()
    names = [field.name for field in dataclasses.fields(snapshot)]
    # Digest the changed part of the scene alone, which is quicker.
    alone = {name: SceneSnapshot(**{name: getattr(snapshot, name)}) for name in names}
    before = {name: scene_digest(alone[name]) for name in names}
    paths = list(leaves(snapshot))
    for path in paths:
        try:
            if scene_digest(changed(alone[path[0]], path)) == before[path[0]]:
                kept.add(path)
        except ValueError:
            refused.add(path)
    assert len(paths) > 200 and {path[0] for path in paths} == set(names)
    # A mesh has no attribute of another domain, no pass has a number beyond the last, and each has the channels of its kind.
    assert {path[-1] for path in refused if path[0] != "settings"} == {"domain", "channels", "kind"}
    assert kept == {path for path in paths if path[0] in ("camera", "settings", "named_passes")} - refused


def test_no_digest_is_by_chance_that_of_another_scene():
    """Scenes of the same numbers and letters in other places, forms or order."""
    mesh, black = quad(), np.zeros((1, 2, 1), np.uint8)
    zeros = np.zeros((4, 3), np.float32)
    scenes = [
        SceneSnapshot(),
        SceneSnapshot(meshes=(mesh,)),
        SceneSnapshot(meshes=(mesh, mesh)),
        SceneSnapshot(meshes=(dataclasses.replace(mesh, normals=zeros),)),
        SceneSnapshot(meshes=(dataclasses.replace(mesh, positions=zeros),)),
        SceneSnapshot(meshes=(dataclasses.replace(mesh, positions=-zeros),)),
        SceneSnapshot(meshes=(dataclasses.replace(mesh, material_slots=[0, 0]),)),
        SceneSnapshot(meshes=(dataclasses.replace(mesh, polygons=[0, 0]),)),
        SceneSnapshot(meshes=(MeshData("quad"),)),
        SceneSnapshot(images=(Image("a", black), Image("b", black))),
        SceneSnapshot(images=(Image("b", black), Image("a", black))),
        SceneSnapshot(images=(Image("ab", black), Image("", black))),
        SceneSnapshot(images=(Image("a", black), Image("b", black.reshape(2, 1, 1)))),
        SceneSnapshot(images=(Image("a", black), Image("b", np.zeros((1, 1, 1), np.uint16)))),
        SceneSnapshot(images=(Image("a", black), Image("b\udcff", black))),
        SceneSnapshot(materials=(Material("a"), lambert())),
        SceneSnapshot(materials=(Material("a"),), lights=(Light("a"),)),
        SceneSnapshot(lights=(Light("a"),)),
        SceneSnapshot(world=rgb(0.5)),
        SceneSnapshot(world=World(ambient=rgb(0.5))),
        SceneSnapshot(world=World(ambient=rgb(0.0))),
        SceneSnapshot(world=World(ambient=(0.0, float("nan"), 0.0))),
    ]
    assert len({scene_digest(one) for one in scenes}) == len(scenes)
    assert [scene_digest(loaded(one)) for one in scenes] == [scene_digest(one) for one in scenes]


def test_numbers_of_numpy_are_plain_ones():
    """An export may bring either; a file has plain ones."""
    plain = Light(radius=0.5, kind=1, soft_falloff=True, no_shadow=False)
    numpys = Light(radius=np.float32(0.5), kind=np.uint32(1), soft_falloff=np.bool_(True), no_shadow=np.bool_(False))
    digests = [scene_digest(SceneSnapshot(lights=(light,))) for light in (plain, numpys)]
    assert digests[0] == digests[1] == scene_digest(loaded(SceneSnapshot(lights=(numpys,))))


def test_the_order_of_bytes_is_not_the_machines():
    snapshot = SceneSnapshot(meshes=(quad(),))
    swapped = quad().replaced(positions=quad().positions.astype(">f4"), triangles=np.asfortranarray(quad().triangles))
    assert scene_digest(SceneSnapshot(meshes=(swapped,))) == scene_digest(snapshot)
