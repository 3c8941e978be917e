"""The benchmark's adapters convert snapshots; their renderers are not needed."""

import bpy
import numpy as np
import pytest

import addon
import scenes
from addon.bindings.enums import AlphaMode, CameraKind, Shading, Transfer
from addon.bindings.session import Scene
from addon.bindings.snapshot import Camera, Image, Instance, InstanceTable, Light, Lobe, Material, MeshData, SceneSnapshot
from addon.export.scene import export_scene
from tools.bench.peers import Cannot, geometry, plain, povray, view


@pytest.fixture(scope="module", autouse=True)
def registered():
    addon.register()
    yield
    addon.unregister()


def _snapshot(name):
    scenes.load(name)
    return export_scene(bpy.context.evaluated_depsgraph_get())[0]


@pytest.mark.parametrize("name", ["triangle", "room"])
def test_view_gives_the_cameras_own_rays(name):
    """The rays through the corners of the picture meet the camera's frame as Blender draws it."""
    snapshot = _snapshot(name)
    found = view.read_view(snapshot.camera)
    for axis in (found.right, found.up, found.forward):
        assert np.linalg.norm(axis) == pytest.approx(1.0)
    assert np.cross(found.right, found.up) == pytest.approx(-found.forward)
    thing = bpy.context.scene.camera
    frame = [thing.matrix_world @ corner for corner in thing.data.view_frame(scene=bpy.context.scene)]
    # Blender's frame: upper right, lower right, lower left, upper left.
    for corner, (x, y) in zip(frame, [(1, 1), (1, 0), (0, 0), (0, 1)], strict=True):
        seen = np.array(corner) - found.origin
        ours = found.direction(x, y)
        # Blender's matrices have single precision, 2^-24, here after some ten operations.
        assert ours / np.linalg.norm(ours) == pytest.approx(seen / np.linalg.norm(seen), abs=1e-6)


def test_horizontal_angle_is_blenders():
    snapshot = _snapshot("triangle")
    found = view.read_view(snapshot.camera)
    assert found.horizontal_angle == pytest.approx(np.degrees(bpy.context.scene.camera.data.angle_x), rel=1e-6)


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"kind": CameraKind.ORTHOGRAPHIC}, "orthographic"),
        ({"lens_radius": 0.1}, "depth of field"),
        ({"window": (-0.4, 0.6, -0.5, 0.5)}, "shifted"),
        ({"window": (-0.5, 0.5, -0.4, 0.4)}, "square"),
        ({"x": 8}, "part"),
    ],
)
def test_cameras_that_others_have_not(fields, reason):
    with pytest.raises(Cannot, match=reason):
        view.read_view(Camera(**fields))


def test_surfaces_of_the_scenes():
    models = {plain.read_surface(material).model for material in _snapshot("glass_metal").materials}
    assert models == {"glass", "mirror", "principled", "diffuse"}
    leaves = [plain.read_surface(material) for material in _snapshot("leaves").materials]
    assert [surface.cut_out is not None for surface in leaves].count(True) == 1
    assert any(isinstance(surface.color, plain.Texture) for surface in leaves)
    assert {plain.read_surface(material).model for material in _snapshot("spheres600").materials} == {"course"}


def test_materials_that_others_have_not():
    two = Material("two", lobes=(Lobe(weight=(0.5,) * 3), Lobe(weight=(0.5,) * 3)))
    for material, reason in ((two, "mixes 2"), (Material("pane", transmittance=(0.5,) * 3), "transparent")):
        with pytest.raises(Cannot, match=reason):
            plain.read_surface(material)


def test_texels_are_linear():
    image = Image("grey", np.full((1, 1, 4), 188, np.uint8), transfer=Transfer.SRGB, alpha=AlphaMode.STRAIGHT)
    # sRGB's curve at 188/255 is near a half; alpha is linear.
    assert plain.texels(image)[0, 0] == pytest.approx([0.5029] * 3 + [188 / 255], abs=1e-4)


def _corners_differ():
    """Return two triangles that share an edge, smooth at one end of it and sharp at the other."""
    positions = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 1)]
    normals = np.zeros((2, 3, 3), np.float32)
    normals[..., 2] = 1.0
    normals[1, 1] = (1.0, 0.0, 0.0)
    return MeshData("fold", positions, [(0, 1, 2), (0, 2, 3)], normals=normals)


def test_corners_become_vertices_where_they_differ():
    (slot, part), *others = geometry._parts(_corners_differ(), flat=False)
    assert (slot, others) == (0, [])
    # Four positions, one of them with two normals.
    assert len(part.positions) == 5
    assert part.positions[part.triangles] == pytest.approx(_corners_differ().positions[_corners_differ().triangles])
    assert part.normals[part.triangles] == pytest.approx(_corners_differ().normals)


def test_placed_parts_stand_where_instances_do():
    """Baked triangles lie where the library hits the instance, also under mirroring and shearing."""
    matrix = np.array([[-2.0, 0.3, 0.0, 1.0], [0.0, 1.0, 0.5, -2.0], [0.0, 0.0, 3.0, 0.5]])
    table = InstanceTable.build([Instance(matrix=matrix, shading=Shading.FLAT)])
    snapshot = SceneSnapshot(meshes=(_corners_differ(),), instances=table, materials=(Material(),))
    (placed,) = geometry.placements(snapshot)
    assert placed.part.normals is None and geometry.is_baked(placed)
    baked = placed.part.placed(placed.matrices[0])
    with Scene.upload(snapshot) as scene:
        for triangle in baked.triangles:
            a, b, c = baked.positions[triangle].astype(float)
            normal, middle = np.cross(b - a, c - a), (a + b + c) / 3
            normal /= np.linalg.norm(normal)
            hit = scene.intersect([middle + normal], [-normal])[0]
            # Positions have single precision: at a distance of 1, t has an error of some 2^-24 of coordinates below 8.
            assert hit.t == pytest.approx(1.0, abs=1e-5)
            # The front side stays outside.
            assert hit.geometric_normal @ normal == pytest.approx(1.0, abs=1e-5)


def test_hidden_objects_are_not_passed_over():
    table = InstanceTable.build([Instance(name="Ghost", hidden_from=1)])
    with pytest.raises(Cannot, match="Ghost"):
        list(geometry.placements(SceneSnapshot(meshes=(_corners_differ(),), instances=table, materials=(Material(),))))


def test_povray_text_holds_the_scene():
    snapshot = _snapshot("spheres600")
    povray.check(snapshot)
    text = povray.Renderer(snapshot, 2).text
    assert (text.count("sphere {"), text.count("plane {"), text.count("light_source {")) == (600, 1, 2)
    with pytest.raises(Cannot, match="course's model"):
        povray.check(_snapshot("triangle"))


def test_povray_refuses_soft_lamps():
    snapshot = SceneSnapshot(lights=(Light(name="Ball", radius=0.5),))
    with pytest.raises(Cannot, match="Ball"):
        povray.check(snapshot)
