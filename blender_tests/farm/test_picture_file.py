"""Files of pictures: a region of the image, 16 bits, transparency, what Blender reads; and the progress of the command."""

import dataclasses
import io
import os

import blenders
import exr
import numpy as np
import OpenImageIO as oiio
import pytest
from blenders import MODULE
from tiny_scenes import pencil, scene, showroom

from addon.bindings.abi import LancerError, Pass
from addon.bindings.pass_names import NAMES
from addon.farm import picture_file
from addon.farm.progress_bar import ProgressBar
from addon.farm.render_snapshot import load, render


def sky(*radiance, **settings):
    """Return what a camera of 4 x 2 pixels sees of a uniform sky."""
    camera = dataclasses.replace(pencil(), width=4, height=2, region_width=4, region_height=2)
    return scene(world=radiance, camera=camera, **settings)


def pixels_of(path, kind="float"):
    file = oiio.ImageInput.open(str(path))
    return file.read_image(kind), file.spec()


def test_one_pass_has_plain_channels(tmp_path):
    render(sky(0.25, 0.5, 1.0)).save(tmp_path / "sky.exr")
    pixels, spec = pixels_of(tmp_path / "sky.exr")
    assert spec.channelnames == ("R", "G", "B", "A") and spec.format == "float"
    assert (pixels == (0.25, 0.5, 1.0, 1.0)).all() and os.listdir(tmp_path) == ["sky.exr"]


def test_a_region_lies_at_its_place_in_the_image(tmp_path):
    whole = showroom(16, samples=1)
    camera = dataclasses.replace(whole.camera, x=2, y=9, region_width=8, region_height=4)
    rendered = render(dataclasses.replace(whole, camera=camera))
    rendered.save(tmp_path / "region.exr")
    pixels, spec = pixels_of(tmp_path / "region.exr")
    # Rows 9 to 12 from the bottom of 16 are rows 3 to 6 from the top.
    assert (spec.x, spec.y, spec.width, spec.height) == (2, 3, 8, 4)
    assert (spec.full_x, spec.full_y, spec.full_width, spec.full_height) == (0, 0, 16, 16)
    position = [spec.channelnames.index(f"ViewLayer.Position.{axis}") for axis in "XYZ"]
    expected = render(whole).passes["Position"][3:7, 2:10]
    np.testing.assert_array_equal(pixels[..., position], expected)


def test_half_keeps_data_exact_and_colours_finite(tmp_path):
    passes = (Pass.COMBINED, Pass.DEPTH, Pass.ERROR)
    rendered = render(sky(1e6, 0.1, 0.5, passes=passes))
    rendered.passes["Depth"][:] = 1e30
    rendered.save(tmp_path / "half.exr", half=True)
    pixels, spec = pixels_of(tmp_path / "half.exr")
    kinds = dict(zip(spec.channelnames, map(str, spec.channelformats), strict=True))
    assert {name for name, kind in kinds.items() if kind == "half"} == {f"ViewLayer.Combined.{c}" for c in "RGBA"}
    got = dict(zip(spec.channelnames, pixels[0, 0], strict=True))
    assert got["ViewLayer.Combined.R"] == 65504.0 and got["ViewLayer.Combined.G"] == np.float16(0.1)
    assert got["ViewLayer.Depth.Z"] == np.float32(1e30)


def test_colours_on_a_screen_are_not_multiplied_by_alpha():
    picture = np.float32([[[0.25, 0.5, 1.0, 1.0], [0.125, 0.25, 0.5, 0.5], [0, 0, 0, 0], [0.001, 9.0, -1.0, 2.0]]])
    # Known values of the sRGB curve: 0.25, 0.5 and 1 are 137, 188 and 255.
    assert picture_file.on_screen(picture).tolist() == [
        [[137, 188, 255, 255], [137, 188, 255, 128], [0, 0, 0, 0], [3, 255, 0, 255]]
    ]


def test_transparency_is_kept_in_png(tmp_path):
    rendered = render(sky(0.25, 0.5, 1.0))
    rendered.picture[0] = (0.125, 0.25, 0.5, 0.5)
    rendered.save(tmp_path / "sky.png")
    # Let the reader multiply nothing either.
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", 1)
    got = oiio.ImageInput.open(str(tmp_path / "sky.png"), config).read_image("uint8")
    assert got.tolist() == [[[137, 188, 255, 128]] * 4, [[137, 188, 255, 255]] * 4]


class FullDisk:
    """A writer that fails in the middle of a file."""

    @staticmethod
    def create(path):
        return FullDisk()

    def open(self, path, spec):
        with open(path, "w") as file:
            file.write("half of the new one")
        return True

    def write_image(self, pixels):
        return False

    def geterror(self):
        return "the disk is full"


def test_a_picture_that_cannot_be_written_leaves_the_old_one(tmp_path, monkeypatch):
    path = tmp_path / "picture.exr"
    path.write_text("the old one")
    rendered = render(sky(1.0, 1.0, 1.0))
    with pytest.raises(LancerError, match=r"the name of a picture ends in .exr or .png"):
        rendered.save(tmp_path / "picture.jpg")
    monkeypatch.setattr(oiio, "ImageOutput", FullDisk)
    with pytest.raises(LancerError, match="could not be written: the disk is full"):
        rendered.save(path)
    assert path.read_text() == "the old one" and os.listdir(tmp_path) == ["picture.exr"]


def test_blender_reads_all_passes_as_of_its_own(tmp_path):
    path = tmp_path / "all.exr"
    render(showroom(16, samples=1)).save(path)
    got = blenders.run(MODULE, tmp_path, "picture_file_cases", "layers", path)
    assert (got["type"], got["layer"]) == ("MULTILAYER", "ViewLayer")
    # Blender adds the alpha of Combined.
    assert set(got["passes"]) == {named.name for named in NAMES.values()} | {"Alpha"}


def test_passes_with_names_are_those_of_blenders_file(tmp_path):
    """Light groups, AOVs, mattes with their manifests, Shadow Catcher and Vector."""
    snapshot, picture, path = (tmp_path / name for name in ("room.npz", "blender.exr", "lancer.exr"))
    blenders.run(MODULE, tmp_path, "picture_file_cases", "named_passes", snapshot, picture)
    rendered = render(snapshot)
    theirs = exr.read(picture)
    levels = [f"Crypto{kind}{level:02d}" for kind in ("Object", "Material") for level in range(3)]
    assert set(theirs) == {"Combined", "Vector", "Shadow Catcher", "Combined_key", "Tint", "Number", *levels}
    for name, values in theirs.items():
        np.testing.assert_array_equal(rendered.passes[name], values, name)
    rendered.save(path, half=True)
    pixels, spec = pixels_of(path)
    names = {f"ViewLayer.{name}.{letter}" for name, letters in rendered.channels.items() for letter in letters}
    assert set(spec.channelnames) == names
    # Ids of mattes are bits of whole floats.
    first = [spec.channelnames.index(f"ViewLayer.CryptoObject00.{letter}") for letter in "rgba"]
    np.testing.assert_array_equal(pixels[..., first], theirs["CryptoObject00"])
    told = {name: text for name, text in exr.attributes(picture).items() if name.startswith("cryptomatte/")}
    assert len(told) == 8 and {name: spec.getattribute(name) for name in told} == told


def test_settings_of_the_snapshot_end_the_render(tmp_path):
    told = []
    room = showroom(16, samples=1024, target_error=0.5, passes=(Pass.COMBINED,))
    room.save(tmp_path / "room.npz")
    rendered = render(tmp_path / "room.npz", tell=lambda fraction, text: told.append((fraction, text)))
    assert rendered.statistics["ended_by"] == "target error" and 16 <= rendered.statistics["samples"] < 1024
    assert told[0] == (0.0, "building the scene") and "/1024 samples" in told[-1][1]
    # A number of samples is a wish without conditions.
    samples = 2 * rendered.statistics["samples_most"] + 1
    exact = render(load(tmp_path / "room.npz"), samples=samples, threads=1)
    assert exact.statistics["samples"] == exact.statistics["samples_most"] == samples
    assert exact.statistics["ended_by"] == "samples" and exact.statistics["threads"] == 1


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_progress_rewrites_a_line_of_a_terminal_and_adds_few_to_a_log():
    terminal, log, quick = Terminal(), io.StringIO(), io.StringIO()
    shown, logged, unseen = ProgressBar(terminal, 0.0), ProgressBar(log, 0.0), ProgressBar(quick, 1e9)
    for step in range(101):
        for bar in (shown, logged, unseen):
            bar(step / 100, f"{'x' * (step < 50)}{step} samples")
    for bar in (shown, logged, unseen):
        bar.close()
    lines = terminal.getvalue().split("\r")
    assert lines[0] == "" and len(lines) == 102 and lines[-1] == f"[{'#' * 30}] 100 %  100 samples\n"
    # A shorter text covers the longer one before it.
    assert len(lines[51]) == len(lines[50])
    assert [int(line.split("]")[1].split("%")[0]) for line in log.getvalue().splitlines()] == list(range(0, 101, 10))
    assert quick.getvalue() == ""
