"""The core's own tests of every lobe on all roughnesses and heights, with many more samples than `make test` gives them."""

import os
import subprocess

import pytest
from conftest import ROOT


@pytest.mark.slow
@pytest.mark.parametrize("tests", ["BsdfFalling.*", "BsdfLaws.*", "BsdfGrid.*"])
def test_every_lobe(tests):
    program = os.path.join(ROOT, "build", "core", "lancer_tests")
    assert os.path.exists(program), "the core's tests are missing: make core-tests"
    environment = {**os.environ, "LANCER_SLOW_TESTS": "1"}
    done = subprocess.run([program, f"--gtest_filter={tests}"], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:]
