"""The commands `part` and `merge`: files of parts on farms that only run programs and share files."""

import dataclasses
import itertools
import os
import random
import resource
import stat

import numpy as np
import OpenImageIO as oiio
import pytest
from command_line import called
from picture_parts import all_of, joiner, opened, rendered
from tiny_scenes import lambert, showroom, with_settings

from addon.bindings.abi import LancerError, Status
from addon.bindings.parts import describe_part
from addon.bindings.session import Pass, Scene, Session
from addon.farm import parts_command
from addon.farm.__main__ import main

# Numbers of lights and paths are searched for at least 16 samples.
SAMPLES = 18
SCENE = showroom(16, split_lights=0, split_paths=0, target_error=0.01, time_limit=1e-3)
# Without the search.
FIXED = with_settings(SCENE, split_lights=2, split_paths=1)


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """Return a folder with the scene, which is the current one."""
    monkeypatch.chdir(tmp_path)
    SCENE.save("scene.npz")
    FIXED.save("fixed.npz")
    return tmp_path


@pytest.fixture
def lancer(capsys):
    """Return a function that runs the command and returns (exit code, standard error)."""
    return lambda *words: called(capsys, *words)[::2]


def part_words(number, parts, output, scene="scene.npz", samples=SAMPLES):
    return "part", scene, "--samples", samples, "--part", f"{number}/{parts}", "--output", output


@pytest.fixture(scope="module")
def five(tmp_path_factory):
    """Return {name: bytes} of five parts, of other numbers of threads."""
    folder = tmp_path_factory.mktemp("five")
    SCENE.save(folder / "scene.npz")
    for number in range(1, 6):
        words = part_words(number, 5, folder / f"part-{number}.lancer", folder / "scene.npz")
        assert main([str(word) for word in (*words, "--threads", number % 3)]) == 0
    return {name: (folder / name).read_bytes() for name in listed(folder) if name.startswith("part-")}


@pytest.fixture
def parts(five, place):
    """Return the names of files of five parts."""
    return [write(name, data) for name, data in five.items()]


def write(name, data):
    with open(name, "wb") as file:
        file.write(data)
    return name


def read(name):
    with open(name, "rb") as file:
        return file.read()


def pixels_of(path):
    file = oiio.ImageInput.open(str(path))
    return file.read_image("float"), file.spec()


def listed(folder="."):
    return sorted(os.listdir(folder))


def test_parts_are_merged_to_the_picture_of_one_render(lancer, parts):
    # The word render may be left out.
    assert lancer("scene.npz", "--samples", SAMPLES, "-o", "one.exr") == (0, "")
    expected, spec = pixels_of("one.exr")
    assert [describe_part(read(name)).end for name in parts] == [3, 7, 10, 14, 18]
    for seed in range(3):
        random.Random(seed).shuffle(parts)
        assert lancer("merge", *parts, "--output", f"{seed}.exr") == (0, "")
        merged, told = pixels_of(f"{seed}.exr")
        assert told.channelnames == spec.channelnames and len(told.channelnames) > 60
        np.testing.assert_array_equal(merged, expected)
        for name in ("samples", "error", "error_cannot_exclude", "ended_by", "split_lights", "split_paths", "version"):
            assert told[f"lancer.ViewLayer.{name}"] == spec[f"lancer.ViewLayer.{name}"], name
        assert told["lancer.ViewLayer.split_lights"] == "2" and told["lancer.ViewLayer.ended_by"] == "samples"


def test_parts_are_merged_to_parts(lancer, parts):
    """In two steps, to the bytes of the part that has all samples, and on to a picture."""
    assert lancer("merge", parts[3], parts[0], "--output", "two.lancer") == (0, "")
    assert lancer("merge", parts[1], parts[4], "two.lancer", parts[2], "--output", "all.lancer") == (0, "")
    assert lancer(*part_words(1, 1, "whole.lancer")) == (0, "")
    assert read("all.lancer") == read("whole.lancer")
    assert lancer("merge", "all.lancer", "--output", "all.png") == (0, "")
    assert lancer("render", "scene.npz", "--samples", SAMPLES, "-o", "one.png") == (0, "")
    np.testing.assert_array_equal(pixels_of("all.png")[0], pixels_of("one.png")[0])


def test_a_finished_part_is_left_as_it_is(lancer, parts, monkeypatch):
    before = [os.stat(name) for name in parts]

    def upload(*_, **__):
        raise AssertionError("the part is rendered again")

    monkeypatch.setattr(Scene, "upload", upload)
    for number, name in enumerate(parts, 1):
        assert lancer(*part_words(number, 5, name), "--threads", 2) == (0, "")
        after = os.stat(name)
        assert (after.st_mtime_ns, after.st_ino) == (before[number - 1].st_mtime_ns, before[number - 1].st_ino)


def cut_short(data):
    return data[:-100]


def spoiled(data):
    return data[: len(data) // 2] + bytes([data[len(data) // 2] ^ 1]) + data[len(data) // 2 + 1 :]


def in_python(ranges, snapshot=SCENE, samples=SAMPLES):
    """Return the bytes of a part of these ranges, or of those that a function returns for a session."""
    with opened(snapshot, in_parts=True, samples=samples, threads=1) as worker:
        return rendered(worker, ranges(worker) if callable(ranges) else ranges).tobytes()


def part_2(snapshot=FIXED, first=3, count=4, samples=SAMPLES):
    return in_python(lambda worker: all_of(worker, first, count), snapshot, samples)


def repainted(snapshot):
    return dataclasses.replace(snapshot, materials=(lambert(0.5), *snapshot.materials[1:]))


OTHER_CAMERA = dataclasses.replace(FIXED, camera=dataclasses.replace(FIXED.camera, lens_radius=0.5))


def with_a_hole():
    """Return samples 3 and 5 to 6 of all pixels: the first and the last one are those of a whole part."""
    with (
        opened(FIXED, in_parts=True, samples=SAMPLES, threads=1) as worker,
        joiner(FIXED, samples=SAMPLES, in_parts=True) as both,
    ):
        for first, count in ((3, 1), (5, 2)):
            both.add(rendered(worker, all_of(worker, first, count)))
        return both.export().tobytes()


# Files that may lie where part 2 of 5 belongs, with samples 3 to 6.
OTHERS = {
    "of another scene": lambda right: part_2(repainted(FIXED)),
    "of another camera": lambda right: part_2(OTHER_CAMERA),
    "of another seed": lambda right: part_2(with_settings(FIXED, seed=3)),
    "of other passes": lambda right: part_2(with_settings(FIXED, passes=(Pass.COMBINED,))),
    "of other splits": lambda right: part_2(with_settings(FIXED, split_paths=7)),
    "of a picture of other samples": lambda right: part_2(samples=36),
    "of other samples": lambda right: part_2(first=2),
    "of more samples": lambda right: part_2(count=5),
    "of one tile": lambda right: in_python([(0, 3, 4)], FIXED),
    "with a hole": lambda right: with_a_hole(),
    "damaged": spoiled,
    "cut short": cut_short,
    "empty": lambda right: b"",
    "no part": lambda right: b"PK" + right,
}


@pytest.mark.parametrize("name", OTHERS)
def test_anything_else_of_that_name_is_rendered_anew(lancer, name):
    assert lancer(*part_words(2, 5, "part.lancer", "fixed.npz")) == (0, "")
    right = read("part.lancer")
    write("part.lancer", OTHERS[name](right))
    assert read("part.lancer") != right
    assert lancer(*part_words(2, 5, "part.lancer", "fixed.npz")) == (0, "")
    assert read("part.lancer") == right
    assert listed() == ["fixed.npz", "part.lancer", "scene.npz"]


@pytest.fixture
def full_disk():
    """Let files end after 10000 bytes."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (10000, limits[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def test_an_interrupted_write_leaves_no_file(lancer, full_disk):
    code, said = lancer(*part_words(1, 2, "part.lancer"))
    assert (code, said.count("\n")) == (1, 1) and "File too large" in said and said.startswith("lancer: ")
    assert listed() == ["fixed.npz", "scene.npz"]


def test_an_interrupted_write_leaves_the_old_file(lancer, parts, monkeypatch):
    write("two.lancer", b"the old one")
    before = listed()

    def interrupted(*_):
        assert len(listed()) == len(before) + 1
        raise KeyboardInterrupt

    monkeypatch.setattr(parts_command.os, "replace", interrupted)
    assert lancer("merge", *parts[:2], "--output", "two.lancer") == (1, "lancer: interrupted\n")
    assert listed() == before and read("two.lancer") == b"the old one"


def test_files_may_be_read_by_those_whom_the_user_lets(lancer, parts):
    """A farm's machines may have other users: a file of a part is like any other new file."""
    write("other", b"")
    lancer("merge", *parts, "--output", "all.lancer")
    assert {stat.S_IMODE(os.stat(name).st_mode) for name in (*parts, "all.lancer", "other")} == {0o666 & ~umask()}


def umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


# Files for merge beside or instead of five right parts, and the words about the file that is named.
WRONG = {
    "missing": (lambda parts: [*parts[:4], "nothing.lancer"], "nothing.lancer: there is no such file"),
    "repeated": (
        lambda parts: [*parts, parts[2]],
        "part-3.lancer: part: sample 7 of tile 0: the session has them already",
    ),
    "damaged": (lambda parts: [write("bad", spoiled(read(parts[0]))), *parts[1:]], "bad: part: it is damaged: "),
    "cut short": (lambda parts: [*parts[1:], write("bad", cut_short(read(parts[0])))], "bad: part: it is incomplete: "),
    "no part": (lambda parts: ["scene.npz", *parts], "scene.npz: part: these bytes are no part of a picture"),
    "empty": (lambda parts: [*parts, write("bad", b"")], "bad: part: these bytes are no part of a picture"),
    "of another scene": (
        lambda parts: [*parts[1:], write("bad", in_python(lambda worker: all_of(worker, 0, 3), repainted(SCENE)))],
        "bad: part: it is of another scene",
    ),
    # Eighteen samples with a gap before the last nine are no picture of eighteen.
    "of another number of samples": (
        lambda parts: [*parts, write("bad", in_python(lambda worker: all_of(worker, 18, 9), samples=36))],
        "bad: part: its picture has 36 samples, that of the first part 18",
    ),
    "of other splits": (
        lambda parts: [
            *parts[1:],
            write("bad", in_python(lambda worker: all_of(worker, 0, 3), with_settings(SCENE, split_paths=7))),
        ],
        "bad: part: its samples have 1 lights and 7 paths, the session's 2 lights and 1 paths",
    ),
    "beyond the last sample": (
        lambda parts: [*parts[1:], write("bad", in_python(lambda worker: all_of(worker, 18, 3)))],
        "bad: part: it has sample 20 of a picture of 18 samples",
    ),
    "too few": (lambda parts: parts[:2] + parts[3:], "3 of 18 samples are missing: give all parts"),
    "of one tile": (
        lambda parts: [*parts[1:], write("tile", in_python([(0, 0, 3)]))],
        "3 of 18 samples are missing: give all parts",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_parts_are_one_sentence(lancer, parts, name):
    make, words = WRONG[name]
    given = make(parts)
    before = listed()
    code, said = lancer("merge", *given, "--output", "picture.exr")
    assert (code, said.count("\n"), listed()) == (2, 1, before)
    assert said.startswith(f"lancer: {words}")


@pytest.mark.parametrize("output, words", [
    ("nowhere/picture.exr", "nowhere: there is no such folder\n"),
    ("nowhere/picture.lancer", "nowhere: there is no such folder\n"),
    ("picture.tga", "lancer: picture.tga: the name of a picture ends in .exr or .png\n"),
])  # fmt: skip
def test_a_place_without_hope_is_told_before_the_parts_are_read(lancer, output, words):
    code, said = lancer("merge", "part-1.lancer", "--output", output)
    assert code == 2 and said.count("\n") == 1 and said.endswith(words)


def test_a_part_with_no_place_is_told_before_the_render(lancer, monkeypatch):
    monkeypatch.setattr(Scene, "upload", None)
    code, said = lancer(*part_words(1, 2, "nowhere/part.lancer"))
    assert code == 2 and said.count("\n") == 1 and said.endswith("nowhere: there is no such folder\n")
    os.mkdir("folder.lancer")
    code, said = lancer(*part_words(1, 2, "folder.lancer"))
    assert code == 1 and said.count("\n") == 1 and "folder.lancer" in said


def test_missing_memory_is_no_wrong_file(lancer, parts, monkeypatch):
    """Another try may have it."""

    def add(*_):
        raise LancerError("out of memory", Status.ERROR_MEMORY)

    monkeypatch.setattr(Session, "add", add)
    assert lancer("merge", *parts, "--output", "all.lancer") == (1, f"lancer: {parts[0]}: out of memory\n")


def test_every_order_of_three_parts_is_the_same(lancer):
    names = [f"{number}.lancer" for number in (1, 2, 3)]
    for number, name in enumerate(names, 1):
        assert lancer(*part_words(number, 3, name, samples=3)) == (0, "")
    made = set()
    for order in itertools.permutations(names):
        assert lancer("merge", *order, "--output", "all.lancer") == (0, "")
        made.add(read("all.lancer"))
    assert len(made) == 1
