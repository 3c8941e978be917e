"""The tests of a fault, run in a copy: whether one of them fails, and with which words."""

import os
import re
import subprocess
import sys

from .tree import Broken

# A test that hangs with a fault is no proof.
_LONGEST = 900.0
_GTEST = re.compile(r"^\[  FAILED  \] (\S+)", re.MULTILINE)
_PYTEST = re.compile(r"^FAILED (.+)$", re.MULTILINE)


def targets(faults):
    """The names of what has to be built for their tests."""
    needed = {"lancer_tests": any(fault.gtest for fault in faults), "lancer": any(fault.pytest for fault in faults)}
    return [name for name, is_needed in needed.items() if is_needed]


def failed(tree, fault, number=0):
    """The first failure of a fault's tests as a line, a crash too, or None where all pass. Raises Broken where they do not end.

    number: of the fault of the core that is switched on.
    """
    # A file that is written twice within a second would leave the compiled code of the first.
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "LANCER_FAULT": str(number)}
    if fault.gtest:
        command = [tree.program, "--gtest_brief=1", f"--gtest_filter={fault.gtest}"]
        if failure := _failure(tree, command, environment, _GTEST):
            return failure
    if fault.pytest:
        options = ["-q", "-x", "-p", "no:cacheprovider", "-o", "addopts=-rf --strict-markers"]
        command = [sys.executable, "-m", "pytest", *options, *(f"blender_tests/{name}" for name in fault.pytest)]
        return _failure(tree, command, environment, _PYTEST)
    return None


def _failure(tree, command, environment, pattern):
    settings = {"cwd": tree.root, "capture_output": True, "text": True, "errors": "replace", "env": environment}
    try:
        done = subprocess.run([str(word) for word in command], timeout=_LONGEST, **settings)
    except subprocess.TimeoutExpired as late:
        raise Broken(f"not done after {late.timeout:.0f} s") from None
    said = done.stdout + done.stderr
    if done.returncode == 0 and "[  PASSED  ] 0 tests" not in said:
        return None
    if done.returncode < 0:
        return f"ended by signal {-done.returncode}"
    found = pattern.search(said)
    if done.returncode == 1 and found:
        return found.group(1)[:300]
    raise Broken("\n".join([f"exit code {done.returncode}", *said.strip().splitlines()[-20:]]))
