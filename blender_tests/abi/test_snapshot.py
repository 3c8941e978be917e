"""Snapshots in files: a loaded snapshot is equal, comparison covers every number, and renders have the same bits."""

import dataclasses
import weakref

import numpy as np
import pytest
from rich_snapshot import changed, leaves, rich
from tiny_scenes import showroom

from addon.bindings import structs
from addon.bindings.abi import Pass
from addon.bindings.npz import save_npz
from addon.bindings.session import Session
from addon.bindings.snapshot import Light, Lobe, Material, Principled, SceneSnapshot, World


@pytest.fixture
def saved(tmp_path):
    path = str(tmp_path / "scene.npz")
    rich().save(path)
    return path


def differs(item, path, from_this):
    """Whether a change at the path makes records unequal, or raises ValueError for an invalid table or pass."""
    try:
        return changed(item, path) != from_this
    except ValueError as error:
        return any(text in str(error) for text in ("rows in domain", "is not a valid Pass", "has the channels"))


def test_a_loaded_snapshot_equals_the_saved_one(saved):
    loaded = SceneSnapshot.load(saved)
    assert loaded == rich()
    assert loaded.meshes[1].uvs.dtype == np.float32 and loaded.instances.matrices.dtype == np.float64
    assert loaded.meshes[0].normals is None


def test_what_is_no_number_is_the_same_data():
    """Arrays and numbers that are NaN at the same place; beside a number, or of another type, they differ."""
    wild = changed_to_nan()
    assert wild == changed_to_nan() and wild != rich()
    assert Light(radius=float("nan")) == Light(radius=float("nan")) != Light(radius=0.0)
    halves = dataclasses.replace(rich().images[0], texels=np.zeros((1, 1, 1), np.uint8))
    assert halves != dataclasses.replace(halves, texels=np.zeros((1, 1, 1), np.uint16))


def changed_to_nan():
    matrix = np.eye(4)[:3].copy()
    matrix[1, 3] = np.nan
    return dataclasses.replace(rich(), camera=dataclasses.replace(rich().camera, matrix=matrix))


def test_a_file_of_another_record_is_refused(tmp_path):
    path = str(tmp_path / "lobe.npz")
    save_npz(Lobe(), path)
    with pytest.raises(ValueError, match="holds no scene snapshot"):
        SceneSnapshot.load(path)


def test_one_number_makes_a_difference(saved):
    """The smallest step of each field makes snapshots unequal."""
    loaded, paths = SceneSnapshot.load(saved), list(leaves(rich()))
    assert len(paths) > 200
    assert [path for path in paths if not differs(loaded, path, rich())] == []


def test_the_smallest_step_survives_the_file(tmp_path):
    other = changed(rich(), ("lights", 1, "emission", 2))
    path = str(tmp_path / "other.npz")
    other.save(path)
    assert SceneSnapshot.load(path) == other and SceneSnapshot.load(path) != rich()


def test_the_loaded_snapshot_renders_the_same_bits(saved):
    def bits(snapshot):
        with Session.upload(snapshot) as session:
            assert session.render_all()
            return {which.name: session.read(which).tobytes() for which in Pass}

    first, again = bits(rich()), bits(SceneSnapshot.load(saved))
    assert [name for name in first if first[name] != again[name]] == []
    # The pictures must not be constant.
    assert np.frombuffer(first["COMBINED"], np.float32).std() > 0.01


def test_a_released_snapshot_renders_the_same_bits_and_is_let_go():
    kept, given = showroom(), showroom()
    arrays = [weakref.ref(mesh.positions) for mesh in given.meshes]
    assert arrays and given == kept
    with Session.upload(kept) as first, Session.upload(given, release=True) as second:
        assert (given.meshes, given.materials, given.lights, len(given.instances)) == ((), (), (), 0)
        assert not any(array() is not None for array in arrays)
        assert first.render_all(2) and second.render_all(2)
        assert np.array_equal(first.read(Pass.COMBINED), second.read(Pass.COMBINED))
    assert given != kept and len(kept.meshes) == len(arrays)


@pytest.mark.parametrize("record", [Principled, Lobe, Material, World])
def test_a_record_has_the_parameters_of_its_struct(record):
    """The record accepts all parameters of its struct, whether the class names them or not."""
    names = [name for name, kind in getattr(structs, record.__name__)._fields_ if kind is structs.Parameter]
    assert names and set(names) <= {field.name for field in dataclasses.fields(record)}
    given = record(**{name: number for number, name in enumerate(names)})
    assert [getattr(given, name) for name in names] == [float(number) for number in range(len(names))]


def test_a_parameter_that_is_not_named_is_zero():
    assert (Principled().coat, Lobe().rotation, Material().holdout) == (0.0, 0.0, 0.0)
    assert Principled().base_color == (0.8, 0.8, 0.8)
