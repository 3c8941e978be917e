"""The description of a job: its tasks, what is missing, what is refused, and its plain lines; the command that writes forms."""

import argparse
import json
import os
import subprocess

import pytest
from farm_programs import Programs, commands

from addon.farm import flamenco, frames_command, lines, openjd, slurm
from addon.farm.frame_files import read_frames, written
from addon.farm.in_blender import CHECK, PREPARE
from addon.farm.job import Frames, JobError, Still, load, of_fields

SHOT = {"kind": "frames", "file": "/s/shot.blend", "frames": "1-7x2,8", "pictures": "/r/f_####.png", "chunk": 2}
STILL = {
    "kind": "still",
    "snapshot": "/s/a.npz",
    "samples": 64,
    "parts": 12,
    "part_files": "/p/#.npz",
    "picture": "/r/a.exr",
}


@pytest.fixture
def programs(tmp_path):
    return Programs(tmp_path)


def test_command_of_frames():
    first, second, third = of_fields({**SHOT, "frames": "1-4,7", "extra": ["--scene", "Dusk"]}).tasks()
    assert first.arguments == [
        "blender", "-b", "/s/shot.blend", "--scene", "Dusk", "-E", "LANCER", "-o", "/r/f_####.png", "-x", "1",
        "--python-exit-code", "1", "--python-expr", PREPARE, "-f", "1,2", "--python-expr", CHECK,
    ]  # fmt: skip
    assert [task.files for task in (first, second, third)] == [
        ("/r/f_0001.png", "/r/f_0002.png"), ("/r/f_0003.png", "/r/f_0004.png"), ("/r/f_0007.png",),
    ]  # fmt: skip
    assert not first.needs + second.needs + third.needs


def test_commands_of_a_still():
    *parts, merge = of_fields(STILL).tasks()
    start = ["python3", "-m", "lancer.farm"]
    assert [task.arguments for task in parts] == [
        [*start, "part", "/s/a.npz", "--samples", "64", "--part", f"{i}/12", "--output", f"/p/{i}.npz"] for i in range(1, 13)
    ]
    assert merge.arguments == [*start, "merge", *(f"/p/{i}.npz" for i in range(1, 13)), "--output", "/r/a.exr"]
    assert [task.files for task in (parts[2], merge)] == [("/p/3.npz",), ("/r/a.exr",)]
    assert merge.needs == tuple(task.number for task in parts) == tuple(range(1, 13))
    assert not any(task.needs for task in parts)


@pytest.mark.parametrize(
    "text, frames, short",
    [("7", [7], "7"), ("0-2", [0, 1, 2], "0..2"), ("1-10x4", [1, 5, 9], "1,5,9"), ("8, 1-3,2", [1, 2, 3, 8], "1..3,8"),
     ("1,2,4-4", [1, 2, 4], "1,2,4")],
)  # fmt: skip
def test_ranges_of_frames(text, frames, short):
    assert read_frames(text) == frames
    assert written(frames, "..") == short


@pytest.mark.parametrize("fields", [SHOT, {**SHOT, "extra": ["-t", "4"]}, STILL])
def test_a_saved_description_is_the_same(fields, tmp_path):
    job = of_fields(fields)
    job.save(tmp_path / "job.json")
    assert load(tmp_path / "job.json") == job
    assert json.loads((tmp_path / "job.json").read_text()).items() >= fields.items()


REFUSALS = [
    (SHOT, "kind", "movie"),
    (SHOT, "file", ""),
    (SHOT, "file", "a\nb.blend"),
    (SHOT, "file", None),
    (SHOT, "frames", 12),
    (SHOT, "frames", "1-"),
    (SHOT, "frames", "-5"),
    (SHOT, "frames", "9-3"),
    (SHOT, "frames", "1-9x0"),
    (SHOT, "frames", "1-9999999"),
    (SHOT, "pictures", "/r/f.png"),
    (SHOT, "pictures", "/r/##/f_##.png"),
    (SHOT, "pictures", "/r/#_#.png"),
    (SHOT, "pictures", "/r/f_####"),
    (SHOT, "pictures", "/r/{scene}_####.png"),
    (SHOT, "chunk", 0),
    (SHOT, "chunk", True),
    (SHOT, "chunk", "2"),
    (SHOT, "extra", "-F"),
    (SHOT, "samples", 4),
    (STILL, "samples", 8.0),
    (STILL, "parts", 65),
    (STILL, "part_files", "/p/part.npz"),
    (STILL, "module", ""),
]


@pytest.mark.parametrize("fields, name, value", REFUSALS)
def test_refusals_name_the_field_and_the_value(fields, name, value):
    with pytest.raises(JobError) as refused:
        of_fields({**fields, name: value})
    assert str(refused.value).startswith(f"{name}: {value!r} "), refused.value


@pytest.mark.parametrize("taken", ["-E", "--engine", "-o", "-f", "-a", "--"])
def test_arguments_of_the_job_are_not_for_others(taken):
    with pytest.raises(JobError, match="extra: '" + taken):
        of_fields({**SHOT, "extra": ["-t", "4", taken]})


def test_a_missing_field_and_a_broken_file_are_named(tmp_path):
    with pytest.raises(JobError, match="pictures: None"):
        of_fields({name: value for name, value in SHOT.items() if name != "pictures"})
    for text in ("{", "[]"):
        (tmp_path / "job.json").write_text(text)
        with pytest.raises(JobError, match="job.json"):
            load(tmp_path / "job.json")


def test_paths_become_absolute(tmp_path):
    job = Frames("a/shot.blend", "1", "//out/f_#.png", blender="bin/blender").resolved("/work")
    assert job.tasks()[0].files == ("/work/a/out/f_1.png",)
    assert (job.file, job.blender) == ("/work/a/shot.blend", "/work/bin/blender")
    assert Frames("a.blend", "1", "f_#.png").resolved("/work").tasks()[0].arguments[0] == "blender"
    windows = Frames("C:/a/shot.blend", "1", "C:\\out\\f_#.png").resolved("/work")
    assert (windows.file, windows.tasks()[0].files) == ("C:/a/shot.blend", ("C:\\out/f_1.png",))
    still = Still("a.npz", 2, 2, "p/#.npz", "a.exr").resolved("/work")
    assert [file for task in still.tasks() for file in task.files] == ["/work/p/1.npz", "/work/p/2.npz", "/work/a.exr"]


def test_frames_are_missing_until_their_file_has_something_in_it(programs):
    job = programs.frames()
    first, second, third = job.tasks()
    assert job.missing() == [first, second, third]
    os.makedirs(os.path.dirname(job.pictures))
    for file in (*first.files, *second.files):
        open(file, "w").close()
    assert job.missing() == [first, second, third]
    for file in (*first.files, second.files[0]):
        with open(file, "w") as picture:
            picture.write("picture")
    assert job.missing() == [second, third]


def test_a_still_is_merged_again_with_a_new_part(programs):
    job = programs.still()
    *parts, merge = job.tasks()
    os.makedirs(os.path.dirname(job.part_files))
    for file in [file for task in (*parts, merge) for file in task.files]:
        with open(file, "w") as part:
            part.write("part")
    assert not job.missing()
    os.remove(parts[1].files[0])
    assert job.missing() == [parts[1], merge]


def run_lines(job, folder, *arguments, tasks=None):
    script = folder / "job.sh"
    script.write_text(lines.text(job, job.tasks() if tasks is None else tasks))
    return subprocess.run(["sh", script, *arguments], capture_output=True, text=True).returncode


@pytest.mark.parametrize("kind", ["frames", "still"])
def test_lines_run_the_commands_of_the_tasks(programs, kind, tmp_path):
    job = getattr(programs, kind)()
    assert run_lines(job, tmp_path) == 0
    assert programs.starts() == commands(job.tasks())
    assert not job.missing()


def test_lines_of_frames_make_what_is_missing(programs, tmp_path):
    job = programs.frames()
    first, second, third = job.tasks()
    programs.fail("8,20")
    assert run_lines(job, tmp_path) == 1
    assert programs.starts() == commands([first, second, third])
    os.remove(first.files[1])
    open(second.files[0], "w").close()
    programs.fail()
    assert run_lines(job, tmp_path) == 0
    assert programs.starts() == commands([first, second, third])
    os.remove(first.files[0])
    assert run_lines(job, tmp_path) == 0
    assert programs.starts() == commands([first])
    assert run_lines(job, tmp_path) == 0
    assert not programs.starts()


def test_lines_of_a_still_merge_only_whole_sets_of_parts(programs, tmp_path):
    job = programs.still()
    *parts, merge = job.tasks()
    programs.fail("2/3")
    assert run_lines(job, tmp_path) == 1
    assert programs.starts() == commands(parts)
    programs.fail("merge")
    assert run_lines(job, tmp_path, tasks=job.missing()) == 1
    assert programs.starts() == commands([parts[1], merge])
    programs.fail()
    assert run_lines(job, tmp_path, tasks=job.missing()) == 0
    assert programs.starts() == commands([merge])
    with open(job.picture) as picture:
        assert picture.read().split() == ["1/3", "2/3", "3/3"]


def test_lines_take_no_arguments(programs, tmp_path):
    assert run_lines(programs.frames(), tmp_path, "--help") == 2
    assert not programs.starts()


def command(*arguments):
    """Run the command as `python -m addon.farm frames` does, and return its exit code."""
    parser = argparse.ArgumentParser()
    frames_command.add_parser(parser.add_subparsers(required=True))
    read = parser.parse_args(["frames", *map(str, arguments)])
    return read.run(read)


@pytest.mark.parametrize("kind", ["frames", "still"])
def test_command_writes_each_form(programs, kind, tmp_path):
    job = getattr(programs, kind)()
    job.save(tmp_path / "job.json")
    texts = {
        "openjd": openjd.text(job, job.tasks(), tmp_path),
        "slurm": slurm.text(job, job.tasks()),
        "flamenco": flamenco.text(job, job.tasks()),
        "lines": lines.text(job, job.tasks()),
    }
    for form, text in texts.items():
        assert command(tmp_path / "job.json", "--form", form, "--output", tmp_path / "form") == 0
        assert (tmp_path / "form").read_text() == text
    assert list(texts) == list(frames_command.FORMS)


def test_command_takes_options_for_a_description(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options = ["--file", "a.blend", "--frames", "1-4", "--pictures", "//f_#.png", "--chunk", "2", "--extra=-F", "--extra=PNG"]
    assert command(*options, "--save", "job.json") == 0
    saved = Frames(str(tmp_path / "a.blend"), "1-4", "//f_#.png", chunk=2, extra=("-F", "PNG"))
    assert load("job.json") == saved
    options = ["--snapshot", "a.npz", "--samples", "8", "--parts", "2", "--part-files", "p/#.npz", "--picture", "a.exr"]
    assert command(*options, "--save", "job.json") == 0
    assert load("job.json") == Still("a.npz", 8, 2, "p/#.npz", "a.exr").resolved(tmp_path)


def test_a_description_is_relative_to_its_folder(tmp_path, capsys):
    (tmp_path / "shots").mkdir()
    Frames("a.blend", "1,2", "out/f_#.png").save(tmp_path / "shots" / "job.json")
    assert command(tmp_path / "shots" / "job.json", "--missing") == 1
    assert capsys.readouterr().out.split() == [str(tmp_path / "shots" / "out" / name) for name in ("f_1.png", "f_2.png")]


def test_command_tells_and_writes_what_is_missing(programs, tmp_path, capsys):
    job = programs.frames()
    job.save(tmp_path / "job.json")
    for file in job.tasks()[0].files + job.tasks()[1].files[:1]:
        os.makedirs(os.path.dirname(file), exist_ok=True)
        with open(file, "w") as picture:
            picture.write("picture")
    assert command(tmp_path / "job.json", "--missing") == 1
    assert capsys.readouterr().out.splitlines() == [*job.tasks()[1].files[1:], *job.tasks()[2].files]
    assert command(tmp_path / "job.json", "--missing", "--form", "slurm", "--output", tmp_path / "job.sh") == 0
    assert "#SBATCH --array=2,3\n" in (tmp_path / "job.sh").read_text()
    assert run_lines(job, tmp_path) == 0
    assert command(tmp_path / "job.json", "--missing") == 0
    assert not capsys.readouterr().out
    assert command(tmp_path / "job.json", "--missing", "--form", "lines", "--output", tmp_path / "rest.sh") == 0
    assert not (tmp_path / "rest.sh").exists() and "Nothing is missing" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["job.json"], "--form"),
        (["job.json", "--form", "lines"], "--output"),
        (["job.json", "--chunk", "3", "--missing"], "chunk"),
        (["none.json", "--missing"], "none.json"),
        (["--file", "a.blend", "--frames", "x", "--pictures", "f_#.png", "--missing"], "frames: 'x'"),
    ],
)
def test_command_refuses_wrong_use(arguments, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    of_fields(SHOT).save("job.json")
    assert command(*arguments) == 2
    assert said in capsys.readouterr().err
