"""A job as a template of OpenJD, checked and run by openjd-cli as by a farm's worker."""

import json
import subprocess
import sys

import pytest
from farm_programs import Programs, commands

from addon.farm import openjd
from addon.farm.job import JobError


@pytest.fixture
def programs(tmp_path):
    return Programs(tmp_path)


def cli(*arguments):
    done = subprocess.run([sys.executable, "-m", "openjd", *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def write(programs, job, tasks=None):
    """Write the template into the folder of the job's files, and return its path."""
    path = programs.folder / "job.json"
    path.write_text(openjd.text(job, job.tasks() if tasks is None else tasks, programs.folder))
    return path


def run(*arguments):
    code, said = cli("run", *arguments)
    assert ("Session ended successfully" in said) == (code == 0), said
    return code


@pytest.mark.parametrize("kind", ["frames", "still"])
def test_templates_are_valid_and_run_the_commands_of_the_tasks(programs, kind):
    job = getattr(programs, kind)()
    path = write(programs, job)
    code, said = cli("check", path)
    assert code == 0, said
    assert run(path) == 0
    assert programs.starts() == commands(job.tasks())
    assert not job.missing()


def test_a_failed_frame_fails_the_run_and_the_rest_is_made_by_the_next(programs):
    job = programs.frames()
    programs.fail("8,20")
    assert run(write(programs, job)) == 1
    programs.fail()
    rest = job.missing()
    assert [task.number for task in rest] == [3]
    programs.starts()
    assert run(write(programs, job, rest)) == 0
    assert programs.starts() == commands(rest)
    assert not job.missing()


def test_parts_are_merged_only_if_all_are_rendered(programs):
    job = programs.still()
    *parts, merge = job.tasks()
    programs.fail("2/3")
    assert run(write(programs, job), "--step", "merge", "--run-dependencies") == 1
    assert not any(start in programs.starts() for start in commands([merge]))
    programs.fail()
    assert run(write(programs, job, job.missing())) == 0
    assert programs.starts() == commands([*parts[1:], merge])


def test_only_the_merge_is_left(programs):
    job = programs.still()
    programs.fail("merge")
    assert run(write(programs, job)) == 1
    programs.fail()
    programs.starts()
    merge = job.missing()
    assert run(write(programs, job, merge)) == 0
    assert programs.starts() == commands(merge) and not job.missing()


def test_a_farm_replaces_paths_and_maps_them(programs, tmp_path):
    """A parameter replaces a path of the description; a rule of the farm maps a path of another machine."""
    job = programs.frames(frames="4,5")
    path = write(programs, job)
    there = programs.frames(frames="4,5", pictures=str(tmp_path / "there" / "f_####.png"))
    assert run(path, "-p", f"PictureFolder={tmp_path / 'there'}") == 0
    assert programs.starts() == commands(there.tasks())
    rule = {"source_path_format": "POSIX", "source_path": "/elsewhere", "destination_path": str(tmp_path / "there")}
    rules = json.dumps({"version": "pathmapping-1.0", "path_mapping_rules": [rule]})
    assert run(path, "-p", "PictureFolder=/elsewhere", "--path-mapping-rules", rules) == 0
    assert programs.starts() == commands(there.tasks())


def test_paths_outside_the_templates_folder_must_be_given(programs, tmp_path):
    job = programs.frames(file=str(tmp_path / "shot.blend"), frames="7")
    path = write(programs, job)
    code, said = cli("run", path)
    assert code == 1 and "BlendFile" in said
    assert not programs.starts()
    assert run(path, "-p", f"BlendFile={job.file}") == 0
    assert programs.starts() == commands(job.tasks())


def test_frames_one_by_one_have_no_limit_and_chunks_have(programs):
    job = programs.frames(frames="1-3000", chunk=1)
    code, said = cli("summary", write(programs, job))
    assert code == 0 and "3000 total Tasks" in said, said
    with pytest.raises(JobError, match="frames: 1500"):
        write(programs, programs.frames(frames="1-3000", chunk=2))
    assert cli("check", write(programs, programs.frames(frames="1-2048", chunk=2)))[0] == 0


def test_what_openjd_would_replace_is_refused(programs):
    with pytest.raises(JobError, match="argument: '{{Param.Blender}}'"):
        write(programs, programs.frames(extra=("--scene", "{{Param.Blender}}")))
