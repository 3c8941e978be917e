"""A job as a script of Slurm, submitted to Debian's Slurm, which runs on this machine during these tests."""

import subprocess

import pytest
from farm_programs import Programs, commands
from small_slurm import SmallSlurm

from addon.farm import slurm as form

DONE, FAILED = ("COMPLETED", 0), ("FAILED", 1)


@pytest.fixture(scope="module")
def slurm():
    with SmallSlurm() as running:
        yield running


@pytest.fixture
def programs(tmp_path):
    return Programs(tmp_path)


def submit(slurm, programs, job, tasks):
    script = programs.folder / "job.sh"
    script.write_text(form.text(job, tasks))
    code, jobs = slurm.submit(script)
    assert code == 0
    slurm.wait()
    return {step: slurm.ends(number) for step, number in jobs.items()}


def test_an_array_tells_which_frames_failed_and_the_next_has_only_these(slurm, programs):
    job = programs.frames()
    programs.fail("5,7")
    assert submit(slurm, programs, job, job.tasks()) == {"render": {1: DONE, 2: FAILED, 3: DONE}}
    assert programs.starts() == commands(job.tasks())
    programs.fail()
    rest = job.missing()
    assert submit(slurm, programs, job, rest) == {"render": {2: DONE}}
    assert programs.starts() == commands(rest)
    assert not job.missing()


def test_a_still_is_merged_when_all_parts_are_done(slurm, programs):
    job = programs.still()
    ends = submit(slurm, programs, job, job.tasks())
    assert ends == {"part": {1: DONE, 2: DONE, 3: DONE}, "merge": {4: DONE}}
    # The stand-in for the merge reads the parts: it fails if it starts before they are there.
    assert programs.starts() == commands(job.tasks())
    assert not job.missing()


def test_a_merge_without_all_parts_is_cancelled_and_later_made(slurm, programs):
    job = programs.still()
    programs.fail("2/3")
    ends = submit(slurm, programs, job, job.tasks())
    assert ends == {"part": {1: DONE, 2: FAILED, 3: DONE}, "merge": {4: ("CANCELLED", 0)}}
    programs.fail("merge")
    programs.starts()
    ends = submit(slurm, programs, job, job.missing())
    assert ends == {"part": {2: DONE}, "merge": {4: FAILED}}
    assert programs.starts() == commands([job.tasks()[1], job.tasks()[3]])
    programs.fail()
    assert submit(slurm, programs, job, job.missing()) == {"merge": {4: DONE}}
    assert not job.missing()


def test_options_go_to_sbatch_and_its_exit_code_is_that_of_the_tasks(slurm, programs):
    job = programs.frames()
    script = programs.folder / "job.sh"
    script.write_text(form.text(job, job.tasks()))
    assert slurm.submit(script, "--no-such-option") == (2, {})
    programs.fail("1,3")
    assert slurm.submit(script, "--wait")[0] == 1
    assert programs.starts() == commands(job.tasks())


@pytest.mark.parametrize("variables", [{"SLURM_ARRAY_TASK_ID": "9", "SLURM_JOB_ID": "1"}, {"SLURM_JOB_ID": "1"}])
def test_a_task_that_the_job_has_not_is_wrong_use(programs, variables):
    script = programs.folder / "job.sh"
    script.write_text(form.text(programs.frames(), programs.frames().tasks()))
    done = subprocess.run(["sh", script], env={"PATH": "/usr/bin:/bin", **variables}, capture_output=True)
    assert done.returncode == 2 and not programs.starts()
