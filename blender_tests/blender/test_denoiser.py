"""Open Image Denoise through ctypes, outside Blender, with the library of this Python's bpy module.

Each test runs twice: with that library, version 2, and with a wrapper that has the functions of version 1.
"""

import threading

import numpy as np
import oidn_versions
import pytest

from addon.bindings import abi
from addon.bindings.abi import LancerError
from addon.bindings.session import Cancelled
from addon.denoise import denoiser, oidn, plan
from addon.denoise.loaded_libraries import on_linux

HEIGHT, WIDTH = 96, 128


def luminance(picture):
    return picture[..., :3].astype(np.float64) @ (0.2126, 0.7152, 0.0722)


@pytest.fixture(scope="module", params=[2, 1], ids=["version 2", "version 1"])
def library(request, tmp_path_factory):
    if request.param == 2:
        yield oidn.load(oidn_versions.newer())
        return
    path, environment = oidn_versions.older(tmp_path_factory.mktemp("oidn"))
    with pytest.MonkeyPatch.context() as patch:
        for name, value in environment.items():
            patch.setenv(name, value)
        yield oidn.load(path)


@pytest.fixture(scope="module")
def pictures():
    """Return a chequered wall under light that increases to the right: exact, noisy, albedo, normal."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    even = ((x // 20 + y // 20) % 2 == 0)[..., None]
    albedo = np.where(even, np.float32([0.8, 0.2, 0.1]), np.float32([0.1, 0.3, 0.7]))
    truth = albedo * (0.2 + x / WIDTH).astype(np.float32)[..., None]
    noise = np.random.default_rng(1).gamma(0.5, 2.0, (HEIGHT, WIDTH, 1)).astype(np.float32)
    normal = np.broadcast_to(np.float32([0.0, 0.0, 1.0]), albedo.shape)
    return truth, truth * noise, albedo, normal


def error(image, truth):
    """Return the relative mean square error, in double to avoid overflow."""
    image, truth = image.astype(np.float64), truth.astype(np.float64)
    return np.mean((image - truth) ** 2 / (truth**2 + 0.01 * np.mean(truth) ** 2))


def test_noise_goes_and_guides_help(library, pictures):
    truth, noisy, albedo, normal = pictures
    guided = denoiser.denoise(noisy, albedo, normal, library=library)
    alone = denoiser.denoise(noisy, library=library)
    assert error(guided.image, truth) < error(alone.image, truth) < error(noisy, truth)
    assert guided.seconds > 0.0
    assert guided.version == "1.4.3" or "1.4.3" not in library._name and guided.version.startswith("2.")
    # At least the images: colours and two guides of three floats.
    assert guided.memory_bytes >= 3 * 12 * HEIGHT * WIDTH


def test_what_is_given_stays_and_alpha_too(library, pictures):
    _, noisy, albedo, normal = pictures
    alpha = np.random.default_rng(2).random((HEIGHT, WIDTH, 1), np.float32)
    given = np.concatenate([noisy, alpha], axis=2), albedo, normal
    before = [array.tobytes() for array in given]
    image = denoiser.denoise(*given, library=library).image
    assert [array.tobytes() for array in given] == before
    assert image[..., 3].tobytes() == alpha[..., 0].tobytes()
    assert np.array_equal(image[..., :3], denoiser.denoise(noisy, albedo, normal, library=library).image)


@pytest.mark.parametrize("exponent", [-100, -40, 40, 100])
def test_brightness_does_not_matter(library, pictures, exponent):
    """Scaling by a power of two changes no digit of the result."""
    _, noisy, albedo, normal = pictures
    image = denoiser.denoise(noisy, albedo, normal, library=library).image
    scaled = denoiser.denoise(np.ldexp(noisy, exponent), albedo, normal, library=library).image
    assert np.array_equal(np.ldexp(scaled, -exponent), image)


def test_one_bright_pixel_spoils_nothing(library, pictures):
    truth, noisy, albedo, normal = pictures
    bright = noisy.copy()
    bright[40, 50] = 1e30
    assert error(denoiser.denoise(bright, albedo, normal, library=library).image, truth) < error(noisy, truth)


def test_a_lamp_in_the_picture_stays_as_bright(library, pictures):
    truth, noisy, albedo, normal = pictures
    lamp = noisy.copy()
    lamp[30:50, 40:60] = 1e30
    image = denoiser.denoise(lamp, albedo, normal, library=library).image
    # The network keeps at least half of a lamp's radiance, or removes it as noise.
    assert (image[32:48, 42:58] > 0.5e30).all()
    # Away from the lamp the wall is denoised as usual.
    assert error(image[70:], truth[70:]) < error(noisy[70:], truth[70:])


def test_black_stays_black(library, pictures):
    _, noisy, albedo, normal = pictures
    assert not denoiser.denoise(np.zeros_like(noisy), albedo, normal, library=library).image.any()


@pytest.mark.parametrize(
    "shapes, words",
    [
        (((8, 8), None, None), "colours of shape"),
        (((8, 8, 2), None, None), "colours of shape"),
        (((0, 8, 3), None, None), "colours of shape"),
        (((8, 8, 3), (8, 7, 3), None), "albedo of shape"),
        (((8, 8, 3), (8, 8, 4), None), "albedo of shape"),
        (((8, 8, 3), (8, 8, 3), (4, 8, 3)), "normal of shape"),
        (((8, 8, 3), None, (8, 8, 3)), "needs an albedo"),
    ],
)
def test_wrong_shapes_are_errors(library, shapes, words):
    arrays = [None if shape is None else np.ones(shape, np.float32) for shape in shapes]
    with pytest.raises(LancerError, match=words):
        denoiser.denoise(*arrays, library=library)


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("which, name", [(0, "colour"), (1, "albedo"), (2, "normal")])
def test_what_is_not_finite_is_an_error(library, value, which, name):
    arrays = [np.ones((8, 8, 3), np.float32) for _ in range(3)]
    arrays[which][3, 4, 1] = value
    with pytest.raises(LancerError, match=f"{name} is not finite"):
        denoiser.denoise(*arrays, library=library)


def test_it_ends_when_it_is_told_to(library, pictures):
    _, noisy, albedo, normal = pictures
    seen = []
    with pytest.raises(Cancelled):
        denoiser.denoise(noisy, albedo, normal, library=library, poll=lambda: len(seen) > 0, tell=seen.append)
    assert len(seen) == 1 and not working()
    # The library still works afterwards.
    denoiser.denoise(noisy, albedo, normal, library=library, tell=seen.append)
    assert seen[1:] == sorted(seen[1:]) and 0.0 <= seen[1] and seen[-1] <= 1.0


def test_an_interrupted_caller_leaves_no_work_behind(library, pictures):
    def poll():
        raise KeyboardInterrupt

    _, noisy, albedo, normal = pictures
    with pytest.raises(KeyboardInterrupt):
        denoiser.denoise(noisy, albedo, normal, library=library, poll=poll)
    assert not working()


def working():
    return [thread for thread in threading.enumerate() if "denoising" in thread.name]


@pytest.mark.parametrize(
    "mapped, beside, found",
    [
        (("a/libOpenImageDenoise.so.2", "b/libtbb.so.12"), ("b/libOpenImageDenoise.so.2",), "a/libOpenImageDenoise.so.2"),
        (("a/libOpenImageDenoise_core.so.2.3.3", "a/libtbb.so.12.8"), ("a/libOpenImageDenoise.so.2",), None),
        (("a b/libtbb.so.12.8",), ("a b/libOpenImageDenoise.so.1", "a b/libOpenImageDenoise.so.2"), None),
        (("a/libOpenImageDenoise.so.2 (deleted)", "a/libtbb.so.2"), ("c/libOpenImageDenoise.so.2",), ""),
        (("a/libm.so.6",), ("a/libOpenImageDenoise.so.2",), ""),
    ],
    ids=["the one in use", "beside the TBB in use", "the newest", "deleted", "another TBB would come"],
)
def test_where_it_is_looked_for(tmp_path, mapped, beside, found):
    """found: None means the last file of beside, "" no file."""
    for name in (*mapped, *beside):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        if "deleted" not in name:
            path.touch()
    maps = tmp_path / "maps"
    rows = ["7f00-7f01 r-xp 00000000 08:01 1234  \n", "7f01-7f02 rw-p 00000000 00:00 0 [heap]\n"]
    rows += [f"7f02-7f03 r-xp 00000000 08:01 1234       {tmp_path / name}\n" for name in mapped]
    maps.write_text("".join(rows * 2))
    wanted = beside[-1] if found is None else found
    assert oidn.find(on_linux(str(maps))) == (str(tmp_path / wanted) if wanted else None)


def test_a_missing_library_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(oidn, "find", lambda: None)
    with pytest.raises(LancerError, match="Open Image Denoise is missing"):
        oidn.load()
    with pytest.raises(LancerError, match="cannot be loaded"):
        oidn.load(tmp_path / "nowhere.so")


def test_a_wrong_library_is_told(tmp_path, library):
    with pytest.raises(LancerError, match="has no function oidn"):
        oidn.load(abi.library_path())
    cut = tmp_path / "libOpenImageDenoise.so.2"
    with open(library._name, "rb") as file:
        cut.write_bytes(file.read(5000))
    with pytest.raises(LancerError, match="is cut short"):
        oidn.load(cut)


def test_the_error_is_told_with_the_noise_of_the_samples(library, pictures):
    truth, _, albedo, normal = pictures
    # Sixteen samples in two halves.
    samples = truth * np.random.default_rng(2).gamma(0.5, 2.0, (16, HEIGHT, WIDTH, 1)).astype(np.float32)
    noisy, halves = samples.mean(axis=0), 0.5 * (samples[:8].mean(axis=0) - samples[8:].mean(axis=0))
    nothing = np.zeros_like(albedo)
    noise = denoiser.Noise(halves, nothing, nothing)
    given = [array.copy() for array in (noisy, *noise[:3])]
    plain = denoiser.denoise(noisy, albedo, normal, library=library)
    alone = denoiser.denoise(noisy, albedo, normal, noise, combines=False, library=library)
    got = denoiser.denoise(noisy, albedo, normal, noise, library=library)
    assert all(np.array_equal(array, before) for array, before in zip((noisy, *noise[:3]), given, strict=True))
    assert plain.combined is None and got.combined.bars.shape == (HEIGHT, WIDTH)
    for found in (alone, got):
        level = luminance(truth) + 0.01 * luminance(truth).mean()
        true = float(np.sqrt(np.mean(((luminance(found.image) - luminance(truth)) / level) ** 2)))
        # The error of twelve thousand pixels, whose denoised values depend on each other over some tens: a few per cent of
        # spread, and what the interval tells of the method.
        assert 0.5 * found.combined.low < true < 2.0 * found.combined.high
        assert error(found.image, truth) < 0.2 * error(noisy, truth)
    assert error(alone.image, truth) < 1.3 * error(plain.image, truth)
    # The two results differ by the part of the noise that denoising leaves: that of a mean over at most 200 pixels.
    first, second = got.pair[2:4]
    assert np.mean((first - second) * halves) > 0.005 * np.mean(halves**2)


def test_noise_is_that_of_each_guide(library, pictures):
    truth, noisy, albedo, normal = pictures
    with pytest.raises(LancerError, match="noise of albedo of shape"):
        denoiser.denoise(noisy, albedo, normal, denoiser.Noise(truth), library=library)
    broken = truth.copy()
    broken[3, 4, 1] = np.nan
    with pytest.raises(LancerError, match="noise of color is not finite"):
        denoiser.denoise(noisy, noise=denoiser.Noise(broken), library=library)


def test_large_pictures_of_few_samples_get_a_fast_network():
    small, large = 240 * 180, 1920 * 1080
    assert plan.plan(small, 1) == plan.plan(large, 1024) == plan.PLANS[0]
    chosen = [plan.plan(large, samples) for samples in (1, 16, 32, 64, 128, 256)]
    assert chosen == sorted(chosen, key=plan.PLANS.index, reverse=True) and chosen[0] == plan.FASTEST
    # Denoising takes at most a tenth of the time of samples, where the fastest network does.
    for samples in (32, 64, 128):
        assert plan.plan(large, samples).cost <= 0.1 * 1.25 * samples
