"""Mattes: the shares of pixels that objects, materials and assets cover, by their ids."""

import dataclasses
import math

import numpy as np
import pytest
from tiny_scenes import lambert, move, pencil, plane, quad, scale, scene, showroom, sphere, veiled

from addon.bindings.abi import Features, InstanceFlag, Integrator, Pass, PassKind
from addon.bindings.enums import MOST_MATTES
from addon.bindings.numbered_pass import NumberedPass
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance

ALL = 7


def mattes(snapshot, kind=PassKind.OBJECT_MATTES, levels=8):
    """Return {id: share} of each pixel, and the order of ids, as lists of rows."""
    with Session.upload(snapshot) as session:
        assert session.render_all()
        read = [session.read(NumberedPass(kind, level)) for level in range(levels)]
    planes = np.concatenate(read, axis=2)
    numbers = np.ascontiguousarray(planes[..., 0::2]).view(np.uint32)
    shares = planes[..., 1::2]
    return [
        [
            {int(key): float(share) for key, share in zip(*pixel, strict=True) if key}
            for pixel in zip(numbers[row], shares[row], strict=True)
        ]
        for row in range(len(planes))
    ]


def one(snapshot, kind=PassKind.OBJECT_MATTES):
    return mattes(snapshot, kind)[0][0]


def test_solid_objects_share_each_pixel_out():
    """Every sample falls on one object, so shares are counts: they add up to 1 exactly."""
    balls = [sphere(0, move(x) @ scale(0.3), object_matte=3 + n, asset_matte=9) for n, x in enumerate((-0.5, 0.4))]
    camera = dataclasses.replace(pencil((0, 0, 5), width=2.0), width=7, height=7, region_width=7, region_height=7)
    for integrator in Integrator:
        shown = scene(
            [plane(0, move(z=-1), object_matte=2, asset_matte=8), *balls],
            [dataclasses.replace(lambert(), matte=5)],
            camera=camera,
            samples=16,
            mattes=ALL,
            integrator=integrator,
        )
        objects = [pixel for row in mattes(shown) for pixel in row]
        assert all(sum(pixel.values()) == 1.0 and list(pixel.values()) == sorted(pixel.values())[::-1] for pixel in objects)
        assert {key for pixel in objects for key in pixel} == {2, 3, 4}
        assert all(share * 16 == int(share * 16) for pixel in objects for share in pixel.values())
        # Mattes by asset and material: both balls are one asset, and all surfaces have one material.
        for of_objects, of_assets in zip(objects, sum(mattes(shown, PassKind.ASSET_MATTES), []), strict=True):
            assert of_assets.get(9, 0.0) == of_objects.get(3, 0.0) + of_objects.get(4, 0.0)
        assert all(pixel == {5: 1.0} for pixel in sum(mattes(shown, PassKind.MATERIAL_MATTES), []))


def test_veils_share_by_their_opacity():
    """A sample counts a veil by its opacity, and what is behind by the light that passes; half of the veil's light passes."""
    veil, ground = Instance(mesh=0, materials=(1,), object_matte=6), plane(0, move(z=-1), object_matte=2)
    shown = scene([ground, veil], [lambert(), veiled(lambert(), 0.25)], meshes=[quad()], samples=4096, mattes=1)
    found = one(shown)
    assert found[6] == 0.25
    # Paths pass with probability p and weight 0.75 / p, and so have at most the variance (0.75 / p)^2 p (1 - p), of p >= 0.5 at
    # most 0.57: four standard errors of 4096 independent samples; stratified ones have less.
    assert abs(found[2] - 0.75) < 4.0 * math.sqrt(0.5625 / 4096)


def test_holes_count_where_something_of_them_is_left():
    """As in Cycles: a holdout object gives no matte, and what it hides neither."""
    hole = Instance(mesh=0, materials=(0,), object_matte=6, flags=InstanceFlag.HOLDOUT)
    shown = scene([plane(0, move(z=-1), object_matte=2), hole], [lambert()], meshes=[quad()], samples=4, mattes=1)
    assert one(shown) == {}


def test_objects_without_an_id_leave_none():
    assert one(scene([plane(0)], [lambert()], samples=4, mattes=1)) == {}


def test_a_crowd_in_one_pixel_keeps_the_largest():
    """More objects than a pixel keeps, stripes of rising width: none gets the share of another, and no number is left out.

    Sums that drop ids see them in part of the samples only: the largest shares are those of the wider half, less what is
    dropped.
    """
    count = MOST_MATTES + 36
    widths = np.linspace(1.0, 3.0, count)
    edges = np.concatenate([[0.0], np.cumsum(widths)]) / widths.sum() * 2.0 - 1.0
    stripes = [
        Instance(
            mesh=0,
            matrix=move(0.5 * (edges[n] + edges[n + 1])) @ scale(0.5 * (edges[n + 1] - edges[n]), 1.0, 1.0),
            object_matte=n + 1,
        )
        for n in range(count)
    ]
    shown = scene(stripes, [lambert()], meshes=[quad()], camera=pencil((0, 0, 5), width=2.0), samples=16384, mattes=1)
    with Session.upload(shown) as session:
        assert session.render_all()
        levels = [session.read(NumberedPass(PassKind.OBJECT_MATTES, level)) for level in range(MOST_MATTES // 2 + 1)]
    assert not levels[-1].any()
    planes = np.concatenate(levels[:-1], axis=2)[0, 0]
    numbers, shares = planes[0::2].view(np.uint32), planes[1::2]
    assert len(set(numbers.tolist())) == MOST_MATTES and (np.diff(shares) <= 0).all()
    assert set(numbers[:16].tolist()) <= set(range(count // 2, count + 1)) and count in numbers
    # Sobol points find an edge of a stripe up to few of 16384 points.
    assert (shares <= np.diff(edges)[numbers - 1] / 2.0 + 64 / 16384).all()


def test_the_features_change_nothing_and_mattes_cost_no_bit():
    plain = showroom(24, passes=(Pass.COMBINED,), mattes=0, light_groups=0, aov_colors=0, aov_values=0)
    asked = showroom(24, passes=(Pass.COMBINED,))
    with Session.upload(plain) as one_, Session.upload(asked) as other:
        one_.render_all()
        other.render_all()
        assert one_.read().tobytes() == other.read().tobytes()
        expected = [other.read(NumberedPass(PassKind.OBJECT_MATTES, level)).tobytes() for level in range(4)]
    with Session.upload(showroom(24, passes=(Pass.COMBINED,), features=Features.ALL)) as session:
        session.render_all()
        assert [session.read(NumberedPass(PassKind.OBJECT_MATTES, level)).tobytes() for level in range(4)] == expected


def test_a_pass_that_is_not_kept_is_refused():
    with Session.upload(scene([plane(0)], [lambert()], mattes=1)) as session:
        session.render_all()
        for which, fault in (
            (NumberedPass(PassKind.ASSET_MATTES), "not stored"),
            (NumberedPass(PassKind.LIGHT_GROUP), "not stored"),
            (NumberedPass(PassKind.AOV_COLOR, 3), "not stored"),
        ):
            with pytest.raises(Exception, match=fault):
                session.read(which)
