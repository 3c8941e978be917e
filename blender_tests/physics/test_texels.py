"""Bakes: what texels of a surface show, in closed form; the surface that each sample begins on."""

import dataclasses

import numpy as np
import pytest
from tiny_scenes import lambert, look_at, move, plane, quad, rotate_x, rotate_y, scene, veiled

from addon.bindings.abi import BakeLacks, BakeView, Catchers, InstanceFlag, LancerError, LightKind, LobeKind, Pass, PassKind
from addon.bindings.numbered_pass import NumberedPass
from addon.bindings.session import Scene, Session
from addon.bindings.snapshot import Camera, Instance, InstanceTable, Light, Lobe, Material
from addon.bindings.texels import DTYPE, EMPTY, Texels

SIZE = 8
SIDE = 2.0


def texels(size=SIZE, instance=0, view=BakeView.ABOVE, lacks=0):
    """Return Texels that map a quad of two triangles, corners (0, 1, 2) and (0, 2, 3), onto an image."""
    middle = (np.arange(size) + 0.5) / size
    u, v = np.meshgrid(middle, middle)
    rows = np.zeros((size, size), DTYPE)
    lower = u >= v
    # Weights of (0, 0), (1, 0), (1, 1): 1 - u, u - v, v; of (0, 0), (1, 1), (0, 1): 1 - v, u, v - u.
    rows["triangle"] = np.where(lower, 0, 1)
    rows["weights"] = np.stack([np.where(lower, 1 - u, 1 - v), np.where(lower, u - v, u)], axis=-1)
    step = 1.0 / size
    rows["dx"] = np.where(lower[..., None], [-step, step], [0.0, step])
    rows["dy"] = np.where(lower[..., None], [0.0, -step], [-step, 0.0])
    return Texels(rows, instance, view, lacks)


def places(size=SIZE):
    """Return x and y of the middle of each texel."""
    middle = SIDE * ((np.arange(size) + 0.5) / size - 0.5)
    return np.meshgrid(middle, middle)


def bake(snapshot, asked, *passes, samples=None, threads=1):
    plain = (each for each in passes if isinstance(each, Pass))
    settings = dataclasses.replace(snapshot.settings, passes=(Pass.COMBINED, *plain), threads=threads)
    height, width = asked.rows.shape
    camera = dataclasses.replace(snapshot.camera, width=width, height=height, region_width=width, region_height=height)
    with Scene.upload(snapshot) as uploaded, Session.bake(uploaded, camera, settings, asked) as session:
        session.render_all(samples or settings.samples)
        found = [session.read(which) for which in (*passes, Pass.COMBINED)]
        assert session.statistics().invalid_samples == 0
    return found[0] if len(found) == 1 else found


def lit_quad(matrix=None, **settings):
    """Return a quad below a point lamp at a height of 2."""
    lamp = Light("lamp", move(z=2.0), LightKind.POINT, emission=(3.0, 3.0, 3.0))
    instance = Instance(mesh=0, materials=(0,), **({} if matrix is None else {"matrix": matrix}))
    return scene([instance], [lambert(0.5)], [lamp], meshes=[quad(SIDE)], **{"samples": 64, **settings})


def test_texels_show_their_places():
    """The pass of the first sample is of the middle, to single precision."""
    x, y = places()
    matrix = move(3.0, 1.0, -2.0) @ rotate_y(0.7)
    position, normal, _ = bake(lit_quad(matrix), texels(), Pass.POSITION, Pass.NORMAL)
    expected = np.stack([x, y, np.zeros_like(x)], axis=-1) @ matrix[:3, :3].T + matrix[:3, 3]
    np.testing.assert_allclose(position, expected, atol=1e-5)
    np.testing.assert_allclose(normal, np.broadcast_to(matrix[:3, 2], normal.shape), atol=1e-6)


def test_irradiance_of_a_lamp():
    """The light of a point at a height h falls with cos^3 of the angle from the axis.

    The mean over a texel of side d differs from its middle's value by half the variance d^2 / 12 of each coordinate times a
    second derivative of at most 6 / h^2, relative to the middle; the places of 1024 samples add a hundredth of the change over
    the texel, at most 4 d / h.
    """
    height, side = 2.0, SIDE / SIZE
    x, y = places()
    shape = (height**2 / (x**2 + y**2 + height**2)) ** 1.5
    level = bake(lit_quad(), texels(), samples=1024)[..., 0] / shape
    bound = 2.0 * 6.0 / height**2 * side**2 / 24.0 + 0.01 * 4.0 * side / height
    np.testing.assert_allclose(level, level.mean(), rtol=bound)


def test_even_light_is_seen_as_it_is():
    """Under an even sky a surface shows the sky's light times its albedo: every sample has that value, but for rounding."""
    snapshot = scene([Instance(mesh=0, materials=(0,))], [lambert(0.5)], meshes=[quad(SIDE)], world=2.0, samples=16)
    np.testing.assert_allclose(bake(snapshot, texels())[..., :3], 1.0, rtol=1e-5)


def test_threads_do_not_change_the_bits():
    snapshot = lit_quad(world=0.3)
    one, two = (bake(snapshot, texels(size=48), samples=8, threads=threads) for threads in (1, 2))
    assert one.tobytes() == two.tobytes()


def test_a_cover_shadows_the_surface():
    """A plane just above the quad hides the lamp: the bake begins below the plane."""
    snapshot = lit_quad()
    covered = scene(
        [Instance(mesh=0, materials=(0,)), plane(1, move(z=0.01))],
        [lambert(0.5), lambert(0.5)],
        snapshot.lights,
        meshes=[quad(SIDE)],
        samples=4,
        max_bounces=0,
    )
    assert bake(covered, texels())[..., :3].max() == 0.0
    assert bake(covered, texels())[..., 3].min() == 1.0


def test_an_emitter_shows_its_own_light():
    glow = Material("glow", lobes=(), emission=(1.0, 2.0, 3.0))
    snapshot = scene([Instance(mesh=0, materials=(0,))], [glow], meshes=[quad(SIDE)], samples=4)
    np.testing.assert_allclose(bake(snapshot, texels())[..., :3], np.broadcast_to([1.0, 2.0, 3.0], (SIZE, SIZE, 3)))


def test_empty_texels_are_black_and_clear():
    asked = texels()
    asked.rows["triangle"][:3] = EMPTY
    asked.rows["triangle"][3] = 77  # beyond the mesh
    asked.rows["weights"][4] = np.nan
    found = bake(lit_quad(), asked)
    assert np.all(found[:5] == 0.0) and np.all(found[5:, :, 3] == 1.0) and found[5:, :, 0].min() > 0.0


def test_the_sky_is_seen_from_the_middle_of_the_world():
    """The texels of a quad at z = 1 look at it from the origin: an even sky is seen whole, behind the quad."""
    snapshot = scene([Instance(mesh=0, materials=(0,), matrix=move(z=1.0))], [lambert(0.5)], meshes=[quad(SIDE)], world=0.25)
    found, _ = bake(snapshot, texels(view=BakeView.SKY), Pass.ENVIRONMENT)
    np.testing.assert_array_equal(found, np.full((SIZE, SIZE, 3), 0.25, np.float32))


def test_a_view_from_the_camera_mirrors_the_other_side():
    """A mirror seen from the camera at 45 degrees shows the glow on the other side; from above it shows the dark overhead."""
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(1.0, 1.0, 1.0)),))
    glow = Material("glow", lobes=(), emission=(1.0, 1.0, 1.0))
    wall = look_at((20.0, 0.0, 20.0), (0.0, 0.0, 0.0))
    instances = [Instance(mesh=0, materials=(0,)), Instance(mesh=1, materials=(1,), matrix=wall)]
    camera = Camera(look_at((-20.0, 0.0, 20.0), (0.0, 0.0, 0.0)))
    snapshot = scene(instances, [mirror, glow], meshes=[quad(SIDE), quad(8.0)], camera=camera, samples=4)
    assert bake(snapshot, texels(view=BakeView.CAMERA))[..., :3].min() == 1.0
    assert bake(snapshot, texels())[..., :3].max() == 0.0


def under_an_even_sky(*lobes):
    material = Material("mixed", lobes=lobes)
    return scene([Instance(mesh=0, materials=(0,))], [material], meshes=[quad(SIDE)], world=1.0, samples=16)


# Smooth glass: a part of the light is mirrored and the rest refracted, half of the whole in all.
GLASS = Lobe(LobeKind.GLASS, color=(0.5,) * 3, ior=1.5, roughness=0.0)


@pytest.mark.parametrize(
    ("lacks", "level"),
    [
        (BakeLacks(0), 0.3 + 0.2),
        (BakeLacks.DIFFUSE, 0.2),
        (BakeLacks.GLOSSY, 0.3),
        (BakeLacks.TRANSMISSION, 0.3 + 0.2),
        (BakeLacks.DIFFUSE | BakeLacks.GLOSSY, 0.0),
    ],
)
def test_a_surface_lacks_the_lobes_that_are_left_out(lacks, level):
    """Every lobe shows the sky's light times its colour: single samples, and their mean, have that value, but for rounding.

    A path takes one of both lobes, by their shares of the light.
    """
    lobes = (Lobe(LobeKind.LAMBERT, color=(0.3,) * 3), Lobe(LobeKind.MIRROR, color=(0.2,) * 3))
    np.testing.assert_allclose(bake(under_an_even_sky(*lobes), texels(lacks=lacks))[..., :3], level, rtol=1e-5)


@pytest.mark.parametrize(
    ("lacks", "level"),
    [(BakeLacks.GLOSSY, 0.5), (BakeLacks.TRANSMISSION, 0.5), (BakeLacks.GLOSSY | BakeLacks.TRANSMISSION, 0.0)],
)
def test_glass_is_left_out_as_a_whole(lacks, level):
    np.testing.assert_allclose(bake(under_an_even_sky(GLASS), texels(lacks=lacks))[..., :3], level, rtol=1e-5)


def test_rays_meet_the_lobes_that_are_left_out():
    """A mirror below a lit wall of the same material shows the wall's diffuse lobe."""
    lobes = (Lobe(LobeKind.LAMBERT, color=(0.5,) * 3), Lobe(LobeKind.MIRROR, color=(0.5,) * 3))
    wall = move(z=2.0) @ rotate_x(np.pi)
    instances = [Instance(mesh=0, materials=(0,)), Instance(mesh=1, materials=(0,), matrix=wall)]
    lamp = Light("lamp", move(z=1.0), LightKind.POINT, emission=(1.0,) * 3)
    snapshot = scene(instances, [Material("mixed", lobes=lobes)], [lamp], meshes=[quad(SIDE), quad(8.0)], samples=4)
    snapshot = snapshot.replaced(settings=dataclasses.replace(snapshot.settings, max_bounces=1))
    assert bake(snapshot, texels(lacks=BakeLacks.DIFFUSE))[..., 0].min() > 0.0


def test_what_passes_straight_is_a_hole():
    """Of a surface with an opacity of 3/4 no texel shows the glow behind it; all lack a quarter of their alpha."""
    glow = Material("glow", lobes=(), emission=(5.0,) * 3)
    behind = Instance(mesh=0, materials=(1,), matrix=move(z=-1.0))
    instances = [Instance(mesh=0, materials=(0,)), behind]
    snapshot = scene(instances, [veiled(lambert(0.5), 0.75), glow], meshes=[quad(SIDE)], world=1.0, samples=16)
    found = bake(snapshot, texels())
    np.testing.assert_allclose(found[..., :3], 0.5 * 0.75, rtol=1e-5)
    np.testing.assert_allclose(found[..., 3], 0.75, rtol=1e-6)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda asked: dataclasses.replace(asked, rows=asked.rows[:4]), "texels"),
        (lambda asked: dataclasses.replace(asked, view=9), "view"),
        (lambda asked: dataclasses.replace(asked, lacks=8), "lacks"),
    ],
)
def test_what_fits_no_picture_is_refused(change, says):
    snapshot = lit_quad()
    camera = dataclasses.replace(snapshot.camera, width=SIZE, height=SIZE, region_width=SIZE, region_height=SIZE)
    with Scene.upload(snapshot) as uploaded, pytest.raises(LancerError, match=says):
        Session.bake(uploaded, camera, snapshot.settings, change(texels()))


def test_an_instance_that_is_missing_leaves_all_texels_empty():
    assert bake(lit_quad(), texels(instance=5)).max() == 0.0


def test_shadows_of_texels():
    """A texel of a shadow catcher tells the share of its light that other objects leave: none or all of a point lamp's."""
    blocker = Instance(mesh=0, matrix=move(x=1.0, z=1.0), materials=(0,))
    shown = lit_quad(catchers=Catchers.APART)
    table = InstanceTable.build([Instance(mesh=0, materials=(0,), flags=InstanceFlag.CATCHER), blocker])
    asked = texels()
    asked.rows["triangle"][0] = EMPTY
    factor, _ = bake(dataclasses.replace(shown, instances=table), asked, NumberedPass(PassKind.SHADOW_CATCHER))
    # The blocker at half of the lamp's height covers x > 0 there, and so the right half of the quad.
    dark = np.broadcast_to(places()[0] > 0.0, (SIZE, SIZE)).copy()
    dark[0] = False
    assert (factor[dark] == 0.0).all() and (factor[~dark] == 1.0).all()


@pytest.mark.parametrize("bare", [0.0, 1.0])
def test_roughness_without_a_lobe_that_counts(bare):
    """Diffuse lobes do not count; light that passes straight counts as that of a mirror."""
    matt = dataclasses.replace(texels(), bare_roughness=bare)
    np.testing.assert_array_equal(bake(lit_quad(blended_features=True), matt, Pass.ROUGHNESS, samples=4)[0], bare)
    veil = dataclasses.replace(lambert(0.5), transmittance=(0.5,) * 3)
    veiled = lit_quad(blended_features=True).replaced(materials=(veil,))
    np.testing.assert_array_equal(bake(veiled, matt, Pass.ROUGHNESS, samples=4)[0], 0.0)


@pytest.mark.parametrize("bare", [-0.5, 2.0, float("nan")])
def test_a_roughness_out_of_range_is_refused(bare):
    with pytest.raises(LancerError, match="bare roughness"):
        bake(lit_quad(), dataclasses.replace(texels(), bare_roughness=bare))
