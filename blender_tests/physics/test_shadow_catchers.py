"""Shadow catchers: the factor of light that other objects leave to them, and the picture without them."""

import dataclasses

import numpy as np
import pytest
from tiny_scenes import lambert, move, plane, quad, render, rotate_x, scene, showroom, veiled, with_settings

from addon.bindings import shadowed
from addon.bindings.abi import Catchers, Features, InstanceFlag, LightKind, LobeKind, Pass, PassKind
from addon.bindings.numbered_pass import NumberedPass
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, InstanceTable, Light, Lobe, Material

CATCHER, MATTE = NumberedPass(PassKind.SHADOW_CATCHER), NumberedPass(PassKind.CATCHER_MATTE)
FLOOR = plane(0, flags=InstanceFlag.CATCHER)


def read(snapshot, *passes):
    with Session.upload(snapshot) as session:
        assert session.render_all()
        return [session.read(which) for which in passes]


def under_suns(*others, glow=0.0, **fields):
    """Return a floor that catches shadows under a sun from above and one from the side, seen by a pencil below the others."""
    materials = [lambert(0.5), Material("glow", lobes=(), emission=(glow,) * 3)]
    suns = (
        Light("above", np.eye(4), LightKind.SUN, emission=(2.0,) * 3),
        Light("aside", rotate_x(1.0), LightKind.SUN, emission=(3.0,) * 3),
    )
    given = {"samples": 4096, "catchers": Catchers.APART, "meshes": [quad()], **fields}
    return scene([FLOOR, *others], materials, given.pop("lights", suns), **given)


BLOCKER = Instance(mesh=0, matrix=move(z=1.5), materials=(1,))


def test_the_factor_is_the_share_of_the_light_that_arrives():
    (factor,) = read(under_suns(BLOCKER), CATCHER)
    lit = 3.0 * np.cos(1.0)
    # Sobol points choose a sun up to few of 4096 points.
    assert factor[0, 0] == pytest.approx([lit / (2.0 + lit)] * 3, abs=64 / 4096)


def test_light_of_other_objects_brightens_the_catcher():
    """A lamp that is no catcher counts as one of the other objects, and so does a glowing mesh."""
    above = Light("above", np.eye(4), LightKind.SUN, emission=(2.0,) * 3)
    aside = Light("aside", rotate_x(1.0), LightKind.SUN, emission=(3.0,) * 3, no_catchers=True)
    (factor,) = read(under_suns(lights=(above, aside)), CATCHER)
    assert factor[0, 0] == pytest.approx([1.0 + 1.5 * np.cos(1.0)] * 3, abs=2 * 64 / 4096)
    # A square of side 2 at 10 above the floor: the solid angle times the cosine is its area over 100 within 2 %.
    lamp = Instance(mesh=0, matrix=move(x=0.001, z=10.0) @ rotate_x(np.pi), materials=(1,))
    (factor,) = read(under_suns(lamp, glow=50.0, lights=(aside_lamp(),)), CATCHER)
    assert factor[0, 0] == pytest.approx([1.0 + 50.0 * 0.04 / (3.0 * np.cos(1.0))] * 3, rel=0.03)


def aside_lamp():
    return Light("aside", rotate_x(1.0), LightKind.SUN, emission=(3.0,) * 3)


def test_the_world_behind_clear_catchers_is_in_its_pass_three_times():
    """As in Cycles: where the catcher is met, and through it by the path among all objects and by that among catchers."""
    clear = dataclasses.replace(lambert(0.0), lobes=(), transmittance=(1.0, 1.0, 1.0))
    shown = scene([FLOOR], [clear], world=0.25, samples=4, catchers=Catchers.APART, passes=(Pass.COMBINED, Pass.ENVIRONMENT))
    assert read(shown, Pass.ENVIRONMENT)[0][0, 0].tolist() == [0.75] * 3


@pytest.mark.parametrize("settings", [{}, {"split_paths": 4, "split_lights": 2}, {"clamp_indirect": 0.1, "clamp_direct": 0.2}])
def test_catchers_alone_keep_all_their_light(settings):
    """Where every object is a catcher, both paths are the same, to the last bit."""
    shown = showroom(16, samples=8, passes=(Pass.COMBINED,), catchers=Catchers.APART, **settings)
    table = dataclasses.replace(shown.instances, flags=np.full(len(shown.instances), int(InstanceFlag.CATCHER), np.uint32))
    factor, matte = read(dataclasses.replace(shown, instances=table), CATCHER, MATTE)
    assert (factor == 1.0).all()
    # The sky alone is no catcher.
    assert matte[..., 3].min() == 0.0 and not matte[matte[..., 3] == 0.0].any()


def showroom_with_floor(**settings):
    shown = showroom(24, **{"samples": 8, "passes": (Pass.COMBINED,), **settings})
    flags = np.where(np.arange(len(shown.instances)) == 0, int(InstanceFlag.CATCHER), 0).astype(np.uint32)
    return dataclasses.replace(shown, instances=dataclasses.replace(shown.instances, flags=flags))


def test_the_picture_keeps_its_bits_beside_the_passes():
    """The halves of the samples of the whole picture tell of its bits."""
    passes = (Pass.COMBINED, Pass.HALVES)
    plain, shown = (showroom_with_floor(catchers=kind, passes=passes) for kind in (Catchers.OBJECTS, Catchers.APART))
    assert render(plain, Pass.HALVES).tobytes() == render(shown, Pass.HALVES).tobytes()


@pytest.mark.parametrize("settings", [{"threads": 2}, {"tile_size": 5}, {"features": Features.ALL}])
def test_the_passes_do_not_depend_on_how_they_are_computed(settings):
    first, second = (
        read(showroom_with_floor(catchers=Catchers.SHADOWS, **given), Pass.COMBINED, CATCHER, MATTE) for given in ({}, settings)
    )
    assert all(one.tobytes() == other.tobytes() for one, other in zip(first, second, strict=True))
    assert first[1].min() < 0.9 and first[2][..., 3].min() == 0.0 and first[2][..., 3].max() == 1.0


@pytest.mark.parametrize("transparent", [False, True])
def test_shadows_lie_over_the_sky_or_in_the_alpha(transparent):
    """The picture follows from its parts; they are rounded to float, and a factor or an alpha is below 16."""
    shown = showroom_with_floor(catchers=Catchers.SHADOWS, film_transparent=transparent)
    with Session.upload(shown) as session:
        assert session.render_all()
        picture, parts = session.read(), shadowed.parts_of(session)
    assert np.abs(picture - shadowed.compose(parts)).max() <= 16 * 2.0**-23
    clear = parts.matte[..., 3] == 0.0
    shadow = 1.0 - np.clip(parts.catcher.mean(axis=2), 0.0, 1.0)
    assert clear.any() and shadow[clear].max() > 0.1
    if transparent:
        assert parts.environment is None and np.allclose(picture[..., 3][clear], shadow[clear], atol=1e-6)
        assert not picture[..., :3][clear].any()
    else:
        # The world is of one colour, and lies behind the floor too.
        sky = np.array([0.1, 0.15, 0.2], np.float32)
        assert np.allclose(parts.environment[clear], sky) and (picture[..., 3] == 1.0).all()
        assert np.allclose(picture[clear][:, :3], sky * (1.0 - shadow[clear])[:, None], atol=1e-6)


def test_the_light_of_a_catcher_is_in_no_pass_of_light():
    passes = (Pass.COMBINED, Pass.DIFFUSE_DIRECT, Pass.DIFFUSE_COLOR)
    direct, group, color = read(
        under_suns(passes=passes, samples=16, light_groups=1, lights=(dataclasses.replace(aside_lamp(), light_group=1),)),
        Pass.DIFFUSE_DIRECT,
        NumberedPass(PassKind.LIGHT_GROUP),
        Pass.DIFFUSE_COLOR,
    )
    assert not direct.any() and not group.any() and np.allclose(color, 0.5)


def test_mirrors_show_catchers_as_objects():
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(1.0,) * 3),))
    ceiling = Instance(mesh=0, matrix=move(z=3.0), materials=(0,), flags=InstanceFlag.CATCHER)
    given = {"meshes": [quad()], "samples": 64, "max_bounces": 4, "catchers": Catchers.APART}
    shown = scene([plane(1), ceiling], [lambert(0.5, emission=(1.0,) * 3), mirror], **given)
    picture, factor, matte = read(shown, Pass.COMBINED, CATCHER, MATTE)
    assert (factor == 1.0).all() and picture[0, 0, 0] > 0.9 and picture[0, 0, 3] == 1.0 and (matte == picture).all()


def test_a_veil_before_a_catcher_is_in_the_matte():
    """A quarter of the light of the floor passes the veil, whose own light is in the matte."""
    veil = Instance(mesh=0, matrix=move(z=0.5), materials=(1,))
    materials = [lambert(0.5), veiled(lambert(0.0, emission=(1.0,) * 3), 0.75)]
    given = {"meshes": [quad()], "samples": 4096, "max_bounces": 4, "catchers": Catchers.APART}
    (matte,) = read(scene([FLOOR, veil], materials, [aside_lamp()], **given), MATTE)
    # Paths pass with the probability of a quarter, up to few of 4096 points.
    assert matte[0, 0] == pytest.approx([0.75] * 4, abs=64 / 4096)


def test_a_hole_is_no_catcher():
    hole = plane(0, flags=InstanceFlag.CATCHER | InstanceFlag.HOLDOUT)
    shown = scene([hole], [lambert(0.5)], [aside_lamp()], samples=16, catchers=Catchers.SHADOWS)
    picture, factor = read(shown, Pass.COMBINED, CATCHER)
    assert not picture[..., :3].any() and (factor == 1.0).all()


def test_without_catchers_the_factor_is_one():
    shown = under_suns(BLOCKER, samples=16)
    factor, matte = read(shown, CATCHER, MATTE)
    assert (factor < 1.0).all() and not matte.any()
    shown = dataclasses.replace(shown, instances=InstanceTable.build([plane(0), BLOCKER]))
    factor, matte = read(shown, CATCHER, MATTE)
    assert (factor == 1.0).all() and matte.tobytes() == render(with_settings(shown, catchers=0)).astype(np.float32).tobytes()


def test_passes_that_are_not_kept_are_refused():
    with Session.upload(with_settings(under_suns(samples=1), catchers=Catchers.OBJECTS)) as session:
        session.render_all()
        for which in (CATCHER, MATTE):
            with pytest.raises(Exception, match="not stored"):
                session.read(which)


def test_parts_of_other_shapes_are_refused():
    parts = shadowed.Parts(Catchers.SHADOWS, np.zeros((2, 3, 4)), np.zeros((2, 3, 4)), None)
    with pytest.raises(Exception, match="parts of shapes"):
        shadowed.compose(parts)
