"""Extremes of motion, light groups, AOVs, mattes, links and bakes: none at all, the most there may be, and one more."""

import dataclasses
import json

import numpy as np
import pytest
from tiny_scenes import lambert, move, pencil, plane, quad, render, scene

from addon.bindings.abi import CameraKind, LancerError, LightKind, Pass, PassKind, PixelFilter
from addon.bindings.mattes import hashes, ids, manifest
from addon.bindings.numbered_pass import NumberedPass
from addon.bindings.session import Scene, Session
from addon.bindings.snapshot import Camera, Instance, InstanceMotion, Light, Material, Motion, Output
from addon.bindings.texels import DTYPE, EMPTY, Texels

GLOW = Material("glow", lobes=(), emission=(1.0, 1.0, 1.0))
MOST = 1024  # light groups and AOVs of a kind
OPEN = np.ones(2, np.float32)


def strip(place, keys=None, shutter=OPEN, samples=256):
    """Return a shining square of side 2 around a place, in a dark strip of pixels of 1/8 seen from above.

    keys: how far it has moved along x, at equal steps of time.
    """
    camera = Camera(
        move(*place) @ move(z=5), CameraKind.ORTHOGRAPHIC, width=64, height=1, window=(-4.0, 4.0, -0.0625, 0.0625),
        clip_start=0.1, clip_end=10.0,
    )  # fmt: skip
    settings = {"samples": samples, "pixel_filter": PixelFilter.BOX, "filter_width": 1.0}
    shown = scene(
        [Instance(mesh=0, matrix=move(*place), materials=(0,))], [GLOW], meshes=[quad(2.0)], camera=camera, **settings
    )
    if keys is None:
        return shown
    matrices = np.array([[(move(*place) @ move(x))[:3] for x in keys]])
    table = dataclasses.replace(shown.instances, motions=(InstanceMotion(instances=[0], matrices=matrices),))
    return shown.replaced(instances=table, motion=Motion(shutter=shutter))


def test_a_shutter_that_is_open_for_no_time_shows_the_sharp_picture():
    """All keys are of one time, or samples have one time: the bits are those of the picture that stands still."""
    place = (0.3, 0.0, 0.0)
    sharp = render(strip(place)).tobytes()
    assert render(strip(place, keys=(0.0, 0.0, 0.0))).tobytes() == sharp
    assert render(strip(place, keys=(-3.0, 0.0, 3.0), shutter=None)).tobytes() == sharp
    assert render(strip(place, keys=(-3.0, 0.0, 3.0))).tobytes() != sharp


@pytest.mark.parametrize("far", [1e6, 1e9])
def test_motion_far_from_the_origin_is_that_near_it(far):
    """Places are doubles: at 1e9 their steps of 1e-7 move an edge by 1e-6 of a pixel, so few samples may change sides.

    Of 16 384 samples, one of them changes the mean of a pixel by 1/256; two of a pixel are not expected.
    """
    near, away = (render(strip((x, 0.0, 0.0), keys=(-1.0, 0.0, 1.0)))[0, :, 0] for x in (0.0, far))
    assert np.abs(near - away).max() <= 1.0 / 256
    assert 0.0 < near[20] < 1.0


def test_motion_of_a_million_widths_is_seen_for_a_millionth_of_the_time():
    """The square is in the picture for 1e-6 of the shutter: 16 384 samples meet it 0.02 times, never three times."""
    found = render(strip((0.0, 0.0, 0.0), keys=(-4e6, 0.0, 4e6)))
    assert np.isfinite(found).all() and found[0, :, 0].sum() * 256 <= 3.0


def test_a_thousand_light_groups_sum_to_the_picture():
    """A lamp for each group. A group has the light of a hundred samples at most: as in test_light_groups."""
    lamps = [Light("lamp", move(0.01 * n - 5, 0, 1), emission=(1.0,) * 3, light_group=n + 1) for n in range(1000)]
    shown = scene([plane(0)], [lambert(0.5)], lamps, samples=256, light_groups=1000)
    with Session.upload(shown) as session:
        assert session.render_all()
        groups = [session.read(NumberedPass(PassKind.LIGHT_GROUP, number)).astype(np.float64) for number in range(1000)]
        picture = session.read()[..., :3].astype(np.float64)
    assert sum(group.max() > 0.0 for group in groups) > 100
    # A sum of a thousand positive terms in double, each rounded once to float.
    assert np.abs(sum(groups) - picture).max() <= 100 * 2.0**-24 * picture.max()


@pytest.mark.parametrize("setting", ["light_groups", "aov_colors", "aov_values"])
def test_one_pass_too_many_is_refused_by_its_name(setting):
    shown = scene([plane(0)], [lambert(0.5)], samples=1, **{setting: MOST + 1})
    with pytest.raises(LancerError, match=setting), Session.upload(shown):
        pass


def test_the_last_of_all_aovs_has_its_value():
    outputs = Output(number=MOST - 1, value=(0.25, 2.0, -1.0)), Output(number=MOST - 1, is_color=False, value=7.0)
    beyond = Output(number=MOST, value=(9.0, 9.0, 9.0)), Output(number=2**32 - 1, is_color=False, value=9.0)
    surface = dataclasses.replace(lambert(), outputs=(*outputs, *beyond))
    shown = scene([plane(0)], [surface], samples=2, aov_colors=MOST, aov_values=MOST)
    with Session.upload(shown) as session:
        assert session.render_all()
        found = [
            session.read(NumberedPass(kind, number))[0, 0].tolist()
            for kind in (PassKind.AOV_COLOR, PassKind.AOV_VALUE)
            for number in (0, MOST - 1)
        ]
    assert found == [[0.0] * 4, [0.25, 2.0, -1.0, 1.0], [0.0], [7.0]]


def _murmur(data):
    """Return the MurmurHash3 (32 bits, seed 0) of bytes, one after the other, as its definition says."""
    mask, state = 0xFFFFFFFF, 0

    def turned(value, bits):
        return (value << bits | value >> (32 - bits)) & mask

    for at in range(0, len(data), 4):
        word = int.from_bytes(data[at : at + 4], "little")
        state ^= turned(word * 0xCC9E2D51 & mask, 15) * 0x1B873593 & mask
        if at + 4 <= len(data):
            state = (turned(state, 13) * 5 + 0xE6546B64) & mask
    state ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        state = (state ^ state >> shift) * factor & mask
    return state ^ state >> 16


def test_a_manifest_of_a_hundred_thousand_names():
    """Names of all lengths up to 60 bytes, with letters of two to four bytes and what JSON escapes."""
    names = [f'{"Würfel 立方体 🧊"[: n % 13]}{n}{" " * (n % 47)}"\\' for n in range(100_000)]
    told = json.loads(manifest(names))
    assert list(told) == names
    hashed, known = hashes(names), ids(names)
    assert [int(key, 16) for key in told.values()] == hashed.tolist()
    for n in range(0, 100_000, 997):
        assert hashed[n] == _murmur(names[n].encode()), names[n]
    # The id is a finite float that is not subnormal, and differs from the hash in the exponent alone.
    exponents = known >> np.uint32(23) & np.uint32(0xFF)
    assert exponents.min() >= 1 and exponents.max() <= 254
    assert not np.any((known ^ hashed) & np.uint32(0x807FFFFF))
    # Some pairs of 1e5 hashes of 32 bits are equal by chance: 1.2 are expected, and 12 are not.
    assert len(np.unique(hashed)) > 100_000 - 12


@pytest.mark.parametrize("number", [1000, 2**32 - 1])
@pytest.mark.parametrize("links", [lambda number: (number, 0, 0, 0), lambda number: (0, number, 0, 0)])
def test_a_set_of_links_beyond_the_last_is_refused_by_its_number(links, number):
    shown = scene([plane(0, links=links(number))], [lambert(0.5)], samples=1)
    with pytest.raises(LancerError, match=f"{number}"), Session.upload(shown):
        pass


def bake(rows, **instance):
    lamp = Light("lamp", move(z=2.0), LightKind.POINT, emission=(3.0, 3.0, 3.0))
    shown = scene([Instance(mesh=0, materials=(0,), **instance)], [lambert(0.5)], [lamp], meshes=[quad(2.0)], samples=4)
    height, width = rows.shape
    camera = dataclasses.replace(pencil(), width=width, height=height, region_width=width, region_height=height)
    with Scene.upload(shown) as uploaded, Session.bake(uploaded, camera, shown.settings, Texels(rows, 0)) as session:
        assert session.render_all()
        return session.read(Pass.COMBINED)


def middle(size):
    rows = np.zeros((size, size), DTYPE)
    rows["weights"] = 0.3
    return rows


def test_a_bake_of_one_texel():
    found = bake(middle(1))
    assert found.shape == (1, 1, 4) and found[0, 0, 0] > 0.0 and found[0, 0, 3] == 1.0


@pytest.mark.parametrize("size", [1, 17])
def test_a_bake_whose_texels_are_all_invalid_is_black_and_clear(size):
    for spoil in (("triangle", EMPTY), ("triangle", 2), ("weights", np.nan), ("weights", np.inf), ("dx", np.nan)):
        rows = middle(size)
        rows[spoil[0]] = spoil[1]
        assert not bake(rows).any(), spoil
    # So are those of an object that is left out: its matrix has no inverse.
    assert not bake(middle(size), matrix=np.diag([1.0, 0.0, 1.0, 1.0])).any()


def test_a_bake_of_no_texel_is_refused():
    with pytest.raises((LancerError, ValueError)):
        bake(np.zeros((0, 4), DTYPE))
