"""Scenes that come by edits: the bits of scenes made anew, whatever number of whatever record has changed, and flat memory."""

import dataclasses
import gc

import numpy as np
import pytest
from rich_snapshot import changed, leaves, rich
from tiny_scenes import lambert, move, plane, quad, scene, with_settings

from addon.bindings.abi import LancerError
from addon.bindings.enums import Pass
from addon.bindings.session import Scene, Session
from addon.bindings.snapshot import Instance, MeshData
from addon.bindings.stock import Stock
from addon.host import shared_scenes
from addon.host.shared_scenes import Ahead

_PASSES = (Pass.COMBINED, Pass.NORMAL, Pass.DIFFUSE_DIRECT)


def pictures(uploaded, snapshot):
    with Session(uploaded, snapshot.camera, snapshot.settings) as session:
        session.render_all()
        return [session.read(which).tobytes() for which in _PASSES]


def outcome(snapshot, before=None, stock=None):
    """Return the pictures and the messages of a snapshot, or the error that its upload raises."""
    try:
        with Scene.upload(snapshot, before=before, stock=stock) as uploaded:
            return pictures(uploaded, snapshot), uploaded.messages()
    except LancerError as error:
        return str(error)


def other(value):
    """Return another value for a leaf that makes a difference to the picture, as far as the leaf can."""
    if isinstance(value, np.ndarray):
        copy = value.copy()
        flat = copy.reshape(-1)
        if copy.dtype.kind == "f":
            flat[...] = flat * 0.75 + 0.0625
            return copy
        return None
    return value * 0.75 + 0.0625 if isinstance(value, float) else None


def leaf(item, path):
    for key in path:
        item = item[key] if isinstance(item, tuple) else getattr(item, key)
    return item


def replaced(item, path, value):
    if not path:
        return value
    key, rest = path[0], path[1:]
    if isinstance(item, tuple):
        return (*item[:key], replaced(item[key], rest, value), *item[key + 1 :])
    return dataclasses.replace(item, **{key: replaced(getattr(item, key), rest, value)})


@pytest.mark.parametrize("part", ["meshes", "materials", "lights", "images", "instances", "world"])
def test_every_number_that_changes_gives_the_bits_of_a_scene_made_anew(part):
    """By one chain of edits: each differs from the one before in two numbers, its own and that of the edit before."""
    base = with_settings(rich(), samples=1, passes=_PASSES, max_bounces=3, threads=1)
    base = base.replaced(camera=dataclasses.replace(base.camera, width=8, height=8, region_width=8, region_height=8))
    stock, different, tried = Stock(), 0, 0
    before = Scene.upload(base, stock=stock)
    plain = outcome(base)
    for path in leaves(getattr(base, part), (part,)):
        if path[-1] == "name":
            continue
        value = other(leaf(base, path))
        try:
            edit = changed(base, path) if value is None else replaced(base, path, value)
        except ValueError:
            # The record itself refuses it.
            continue
        found, anew = outcome(edit, before, stock), outcome(edit)
        assert found == anew, path
        tried += 1
        different += anew != plain
        if not isinstance(anew, str):
            following = Scene.upload(edit, before=before, stock=stock)
            before.close()
            before = following
    before.close()
    assert different >= 3 and tried > different


def balls(count=3, faces=400):
    angles = np.linspace(0.0, 6.28, faces)
    ring = np.stack([np.cos(angles), np.sin(angles), np.zeros(faces)], axis=1)
    places = np.concatenate([[[0, 0, 1]], ring])
    triangles = [(0, i, i + 1) for i in range(1, faces)]
    meshes = [quad(4.0), *(MeshData(f"fan {i}", places * (1 + i), triangles) for i in range(count))]
    things = [Instance(mesh=i, matrix=move(z=i), materials=(i % 2,)) for i in range(count + 1)]
    return scene([*things, plane(0, move(z=-1))], [lambert(0.5), lambert(0.25)], meshes=meshes, samples=1, passes=_PASSES)


def test_only_what_differs_is_uploaded_and_built():
    base = balls()
    stock = Stock()
    first = Scene.upload(base, stock=stock)
    assert first.made()["mesh_trees"] == 3 and first.made()["materials"] == 2
    moved = dataclasses.replace(base.instances, matrices=base.instances.matrices + 0.125)
    fan = dataclasses.replace(base.meshes[1], positions=base.meshes[1].positions * 2.0)
    cases = {
        "nothing": (base.replaced(), {}),
        "an object": (base.replaced(instances=moved), {"placements": 1, "plane_searches": 1}),
        "a material": (base.replaced(materials=(base.materials[0], lambert(0.75))), {"materials": 1}),
        "a mesh": (
            base.replaced(meshes=(base.meshes[0], fan, *base.meshes[2:])),
            {"placements": 1, "plane_searches": 1, "mesh_trees": 1, "triangles": 399},
        ),
    }
    for name, (edit, expected) in cases.items():
        steps = Scene(before=first, stock=stock)
        uploads = sum(1 for _ in steps.filling(edit))
        steps.commit()
        made = {kind: count for kind, count in steps.made().items() if count}
        assert made == expected, name
        assert uploads == (0 if name == "nothing" else 1), name
        steps.close()
    first.close()


def test_scenes_of_one_stock_share_equal_meshes_and_images():
    """Also by value: another export of the same mesh is the same object."""
    base, stock = balls(), Stock()
    with Scene.upload(base, stock=stock) as one:
        again = base.replaced(meshes=tuple(dataclasses.replace(mesh, positions=mesh.positions.copy()) for mesh in base.meshes))
        with Scene.upload(again, before=one, stock=stock) as two:
            assert not any(two.made().values())
            # The first may end while the second lives.
            one.close()
            assert pictures(two, again) == outcome(base)[0]


def test_meshes_that_came_ahead_are_those_of_the_scene():
    base, ahead = balls(), Ahead(threads=1)
    for mesh in base.meshes:
        ahead.mesh(mesh)
    with Scene(stock=shared_scenes.stock) as uploaded:
        uploads = sum(1 for _ in uploaded.filling(base))
        ahead.end()
        uploaded.commit()
        assert uploads == len(base.materials) + len(base.lights) + len(base.images) + 2  # the world, the instances
        assert pictures(uploaded, base) == outcome(base)[0]


def test_the_nearest_scene_is_open_and_has_some_of_the_meshes():
    base = balls()
    fewer = base.replaced(
        meshes=base.meshes[:1], instances=dataclasses.replace(base.instances, meshes=base.instances.meshes * 0)
    )
    strange = base.replaced(meshes=tuple(dataclasses.replace(mesh, name="strange") for mesh in base.meshes))
    with Scene.upload(base) as near, Scene.upload(fewer) as far:
        shared_scenes.remember(near)
        shared_scenes.remember(far)
        assert shared_scenes.nearest(base) is near
        assert shared_scenes.nearest(strange) is None
        near.close()
        assert shared_scenes.nearest(base) is far
    assert shared_scenes.nearest(base) is None


def test_a_scene_that_another_thread_has_closed_is_as_none():
    base = balls()
    before = Scene.upload(base)
    before.close()
    with Scene.upload(base, before=before) as uploaded:
        assert pictures(uploaded, base) == outcome(base)[0]


def test_a_hundred_edits_leave_no_memory_behind():
    base = balls(2, 4000)
    scenes = Scene.upload(base)
    used = []
    for step in range(100):
        mesh = dataclasses.replace(base.meshes[1], positions=base.meshes[1].positions * (1.0 + step / 64))
        edit = base.replaced(meshes=(base.meshes[0], mesh, *base.meshes[2:]))
        following = Scene.upload(edit, before=scenes)
        scenes.close()
        scenes = following
        gc.collect()
        with open("/proc/self/statm", encoding="ascii") as told:
            used.append(int(told.read().split()[1]) * 4096)
    scenes.close()
    # A mesh and its tree take 0.7 MB: half of the last fifty that stay would show.
    assert max(used[50:]) < max(used[10:50]) + 15e6
