"""The core's own tests with many times as many rays as `make test` gives them."""

import os
import subprocess

import pytest
from conftest import ROOT

# 12 scenes, 4 accelerators, 10 000 rays each: 1e8 in all.
TIMES = 210


@pytest.mark.slow
def test_a_hundred_million_rays_cross_closed_surfaces_in_pairs():
    program = os.path.join(ROOT, "build", "core", "lancer_tests")
    assert os.path.exists(program), "the core's tests are missing: make core-tests"
    environment = {**os.environ, "LANCER_TEST_RAYS": str(TIMES)}
    done = subprocess.run([program, "--gtest_filter=Crossings.*:Coincident.*"], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:]
