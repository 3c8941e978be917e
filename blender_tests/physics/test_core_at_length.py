"""The core's own tests with many more rays and samples than in `make test`."""

import os
import subprocess

import pytest
from conftest import ROOT

# 12 scenes, 4 accelerators, 10 000 rays each: 1e8 in all.
TIMES = 210


def run(tests, **environment):
    program = os.path.join(ROOT, "build", "core", "lancer_tests")
    assert os.path.exists(program), "the core's tests are missing: make core-tests"
    command = [program, f"--gtest_filter={tests}"]
    done = subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:]


@pytest.mark.slow
def test_a_hundred_million_rays_cross_closed_surfaces_in_pairs():
    run("Crossings.*:Coincident.*", LANCER_TEST_RAYS=str(TIMES))


@pytest.mark.slow
@pytest.mark.parametrize("tests", ["BsdfFalling.*", "BsdfLaws.*", "BsdfGrid.*"])
def test_every_lobe_at_all_roughnesses_and_heights(tests):
    run(tests, LANCER_SLOW_TESTS="1")
