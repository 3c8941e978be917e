"""The verdicts of `make parity`: arithmetic without Blender, Cycles against itself, and the fast scenes by both engines."""

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM

from scenes.parity import figures

EXACT, LOBES, PIXELS, FURNACE = (figures.KINDS[name] for name in ("EXACT", "LOBES", "PIXELS", "FURNACE"))


def _halves(picture, sigma=0.0, seed=0):
    source = np.random.default_rng(seed)
    return tuple(picture + sigma * source.standard_normal(picture.shape) for _ in range(2))


def _judge(ours, theirs, kind=EXACT, **noise):
    numbers = figures.measure(_halves(ours, **noise), _halves(theirs, **{**noise, "seed": 9}), kind)
    return numbers, figures.judge(numbers, kind.limit)


@pytest.fixture
def picture():
    y, x = np.mgrid[0:64, 0:96]
    return np.stack([0.2 + x / 96, 0.5 + 0.3 * np.sin(y / 9), 0.4 + 0.2 * np.cos(x / 7)], axis=-1)


def test_blocks_are_means(picture):
    got = figures.blocks(picture, 8)
    assert got.shape == (8, 12, 3)
    assert np.allclose(got[2, 3], picture[16:24, 24:32].mean(axis=(0, 1)), rtol=1e-12)
    ragged = figures.blocks(picture[:60, :90], 8)
    assert ragged.shape == (8, 12, 3)
    assert np.allclose(ragged[7, 11], picture[56:60, 88:90].mean(axis=(0, 1)), rtol=1e-12)


@pytest.mark.parametrize("kind", [EXACT, LOBES, PIXELS, FURNACE])
def test_equal_pictures_pass(picture, kind):
    numbers, verdict = _judge(picture, picture, kind)
    assert (numbers.mean, numbers.p99, verdict) == (0.0, 0.0, ("pass", True))


@pytest.mark.parametrize("factor, verdict", [(1.004, "pass"), (1.006, "fail"), (0.994, "fail")])
def test_general_difference(picture, factor, verdict):
    numbers, got = _judge(factor * picture, picture)
    assert numbers.mean == pytest.approx(abs(factor - 1), rel=1e-9)
    assert got.name == verdict


def test_noise_of_few_lit_blocks_is_no_difference():
    """Two lit blocks give two values of noise, of which some are small by chance; their pixels give 128.

    A block exceeds 3 deviations once in 370, and their mean does so as seldom: of 200 pictures 2 or 3 do, and more than 10 once
    in 10 000 times. Without the pixels' deviations 62 do.
    """
    lit = np.zeros((32, 48, 3))
    lit[:8, :16] = 0.5
    failed = 0
    for seed in range(200):
        source = np.random.default_rng(seed)
        ours, theirs = (tuple(lit * (1 + source.normal(0, 0.3, (32, 48, 1))) for _ in range(2)) for _ in range(2))
        failed += figures.judge(figures.measure(ours, theirs, EXACT), EXACT.limit).name == "fail"
    assert failed <= 10
    # A difference of half of the light remains one.
    ours = tuple(1.5 * half for half in ours)
    assert figures.judge(figures.measure(ours, theirs, EXACT), EXACT.limit).name == "fail"


def test_one_wrong_corner_fails():
    """Two of 96 blocks are wrong, which the mean does not show."""
    theirs = np.full((64, 96, 3), 0.5)
    ours = theirs.copy()
    ours[:8, :16] *= 1.019
    assert _judge(ours, theirs)[1].name == "pass"
    ours[:8, :16] = 1.021 * theirs[:8, :16]
    numbers, verdict = _judge(ours, theirs)
    assert numbers.mean < EXACT.limit.mean / 4 and verdict.name == "fail"


def test_a_fault_in_one_block_of_few_fails():
    """Two channels of one block in 96 are wrong: less than a hundredth of the values."""
    theirs = np.full((64, 96, 3), 0.5)
    ours = theirs.copy()
    ours[:8, :8, :2] *= 1.7
    assert _judge(ours, theirs)[1].name == "fail"


def test_one_block_of_150_fails():
    """A hundredth of 150 blocks would be one and a half."""
    theirs = np.full((80, 120, 3), 0.5)
    ours = theirs.copy()
    ours[:8, :8] *= 1.1
    assert _judge(ours, theirs)[1].name == "fail"


@pytest.mark.parametrize("wrong, verdict", [(3, "pass"), (5, "fail")])
def test_a_hundredth_of_many_blocks_may_differ(wrong, verdict):
    """A hundredth of 400 blocks is four."""
    theirs = np.full((160, 160, 3), 0.5)
    ours = theirs.copy()
    ours[:8, : 8 * wrong, 0] *= 1.1
    assert _judge(ours, theirs)[1].name == verdict


def test_a_bright_part_excuses_no_other():
    """A lamp in view raises the mean by a factor of 9; the floor beside it is 4 % wrong, which is 0.5 % of that mean."""
    theirs = np.full((64, 96, 3), 0.1)
    theirs[:16, :16] = 20.0
    ours = theirs.copy()
    ours[16:] *= 1.04
    numbers, verdict = _judge(ours, theirs)
    assert numbers.mean < EXACT.limit.mean and verdict.name == "fail"
    # Three quarters are wrong; the lamp's light is limited to twice that of the floor, in a twenty-fourth of the picture.
    assert numbers.dim.mean == pytest.approx(0.04 * 0.75 / (1 + 1 / 24), rel=1e-9)


def test_a_bright_part_is_compared_with_its_own_light():
    """In a bright part the difference is relative to its own light; relative to the picture's level it stays as large."""
    theirs = np.full((64, 96, 3), 0.1)
    theirs[:16, :16] = 20.0
    numbers, _ = _judge(1.004 * theirs, theirs)
    assert numbers.dim.p99 == pytest.approx(0.004, rel=1e-9)
    assert numbers.p99 == pytest.approx(0.004 * 20.0 / theirs.mean(), rel=1e-9)


def test_wrong_channel_and_wrong_place_fail(picture):
    assert _judge(picture[..., ::-1], picture)[1].name == "fail"
    assert _judge(picture[:, ::-1], picture)[1].name == "fail"
    assert _judge(np.roll(picture, 1, axis=1), picture)[1].name == "fail"


def test_noise_is_told_from_difference(picture):
    """Noise of 8 % in each pixel is 1 % in a block: it is measured as noise, and does not excuse a difference of 10 %."""
    numbers, verdict = _judge(picture, picture, sigma=0.08 * picture.mean())
    # The difference of two pictures, each the mean of two halves, is as noisy as one half.
    assert numbers.sigma == pytest.approx(0.01, rel=0.15)
    assert numbers.noise_mean == pytest.approx(np.sqrt(2 / np.pi) * 0.01, rel=0.15)
    assert verdict == ("noise", False)
    assert _judge(1.1 * picture, picture, sigma=0.08 * picture.mean())[1].name == "fail"


def test_verdict_settles_only_beyond_noise(picture):
    near, _ = _judge(1.01 * picture, picture, sigma=0.08 * picture.mean())
    far, _ = _judge(1.5 * picture, picture, sigma=0.08 * picture.mean())
    assert not figures.hopeless(near, EXACT.limit) and figures.hopeless(far, EXACT.limit)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_pixel_that_is_no_number_fails(picture, bad):
    ours = picture.copy()
    ours[5, 7, 1] = bad
    assert _judge(ours, picture)[1].name == "fail"


def test_black_against_black_and_light_against_black():
    black = np.zeros((16, 16, 3))
    assert _judge(black, black)[1].name == "pass"
    assert _judge(black + 0.1, black)[1].name == "fail"
    assert _judge(black, black + 0.1)[1].name == "fail"


def test_furnace_judges_each_tile(picture):
    """A dark tile that is 1 % wrong fails, although its light is negligible beside the bright tiles."""
    theirs = np.ones((64, 80, 3))
    theirs[:16, :16] = 0.01
    ours = theirs.copy()
    ours[:16, :16] *= 1.01
    assert _judge(ours, theirs, EXACT)[1].name == "pass"
    assert _judge(ours, theirs, FURNACE)[1].name == "fail"


def test_scale_of_the_caller(picture):
    """A difference of 0.001 at distance 2 counts as 0.0005, whatever the picture's level."""
    distance = np.full((64, 96, 1), 2.0)
    numbers = figures.measure(_halves(picture + 0.001), _halves(picture), PIXELS, distance)
    assert numbers.mean == pytest.approx(0.0005, rel=1e-9)


def test_positions_are_judged_by_pixels(picture):
    ours = picture.copy()
    # Up to a hundredth of the pixels lie on outlines.
    ours[0, :50] += 1.0
    assert _judge(ours, picture, PIXELS._replace(limit=figures.Limit(1.0, 1e-4)))[1].name == "pass"
    assert _judge(picture + 2e-4 * picture.mean(), picture, PIXELS)[1].name == "fail"


def test_pixels_that_show_nothing_are_no_agreement():
    """Four in ten pixels show a surface; a fiftieth of these is wrong, less than a hundredth of all."""
    theirs = np.zeros((100, 200, 3))
    theirs[60:] = 1.0
    ours = theirs.copy()
    ours[60:62, :80] += 0.01
    assert _judge(ours, theirs, PIXELS)[1].name == "fail"
    ours[60:62, 20:80] = 1.0
    assert _judge(ours, theirs, PIXELS._replace(limit=figures.Limit(0.005, 1e-4)))[1].name == "pass"


def test_surfaces_must_be_the_same_but_for_their_outlines():
    theirs = np.full((64, 96, 1), 1e10)
    theirs[16:48, 16:80] = 5.0
    outline, hole = theirs.copy(), theirs.copy()
    outline[16, 16:20] = 1e10
    hole[30, 40] = 1e10
    assert _judge(outline, theirs, PIXELS)[1].name == "pass"
    assert _judge(hole, theirs, PIXELS)[1].name == "fail"
    assert _judge(theirs, hole, PIXELS)[1].name == "fail"


def test_the_judge_finds_cycles_equal_to_itself(tmp_path):
    got = blenders.run(
        MODULE, tmp_path, "parity_cases", "subset", "CYCLES", "point_soft,image_flat,camera_perspective,principled_alpha"
    )
    wrong = [line for line in got["lines"] if not line.startswith("pass")]
    assert got["counts"] == {"pass": 4}, "\n".join(wrong)


# The scenes of `make test` whose settings do not exist in a Blender: they came later, or are gone.
_KINDS = ("point", "spot", "sun", "area")
_SINCE_45 = {"temperature_warm", "attribute_of_instance"} | {
    f"light_{name}_{kind}" for name in ("exposure", "normalize_off", "temperature") for kind in _KINDS
}
_RAYCASTS = {"raycast_in_diffuse"} | {f"raycast_value_{name}" for name in ("distance", "normal", "beside", "local")}
_SINCE_52 = {"constants_and_joined_bundles", "principled_wall_glass_smooth"} | _RAYCASTS
_NOON = {"sky_single_scattering_noon", "sky_multiple_scattering_noon"}
_SINCE_50 = _SINCE_52 | _NOON | {"repeat_zones", "closure_zones", "bundles", "menus_and_groups"}
_NOT_IN_3 = {"light_true_sphere_point", "light_true_sphere_spot", "pass_denoising_last_surface", "principled_film_thin"}
_POINT_DENSITY = {
    f"point_density_{name}"
    for name in ("closest", "linear", "cubic", "of_vertices", "of_particles", "at_the_limits", "as_bump")
}
_GONE_50 = {"sky_nishita_noon"} | _POINT_DENSITY
_ABSENT = {
    "3.4": _SINCE_50 | _SINCE_45 | _NOT_IN_3,
    "4.2": _SINCE_50 | _SINCE_45,
    "4.5": _SINCE_50,
    "5.0": _SINCE_52 | _GONE_50,
    "5.2": _GONE_50,
}


# The scenes that show the older rules of the program.
_RULES = (
    "principled_*,property_*,glossy_*,glass_*,diffuse_*,mix_*,bump_*,normals_*,image_*,color_attribute_*,object_info_random,point_soft,"
    "temperature_warm,light_spot_*,light_area_*,light_sun_soft,light_true_*,camera_*,film_*,pass_*,point_density_*"
)
_SHARES = {
    "lights": "lights_*",
    "materials": "materials_*,textures_*,point_density",
    "nodes": "inputs,inputs_objects,inputs_instances,inputs_places,zones,zones_bundles,left_out,settings_of_nodes,looking",
    "others": "objects,subdivisions*,cameras,passes_*,worlds,skies,films,catchers,motion,light_paths,fast_gi",
}


@pytest.mark.parametrize("which, names, least", [
    *(pytest.param(MODULE, names, 15, id=share) for share, names in _SHARES.items()),
    pytest.param(PROGRAM, _RULES, 25, id="older rules"),
])  # fmt: skip
def test_fast_scenes(which, names, least, tmp_path):
    got = blenders.run(which, tmp_path, "parity_cases", "subset", "LANCER", names)
    wrong = [line for line in got["lines"] if not line.startswith(("pass", "absent"))]
    assert not wrong, "\n".join(wrong)
    assert set(got["absent"]) == _ABSENT[got["version"]] & set(got["names"])
    assert got["counts"]["pass"] == len(got["lines"]) - len(got["absent"]) >= least


def test_the_shares_are_all_fast_scenes(tmp_path):
    got = blenders.run(MODULE, tmp_path, "parity_cases", "fast_names", *_SHARES.values())
    assert sorted(got["all"]) == sorted(got["shares"])
