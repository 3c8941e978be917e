"""The tests of a fault, run in the copy: whether one of them fails, by which assertion."""

import os
import re
import subprocess
import sys

from .tree import Broken

# A test that hangs with a fault is no proof: it says nothing within this many seconds.
_LONGEST = 600.0
_GTEST = re.compile(r"^\[  FAILED  \] (\S+)", re.MULTILINE)
_PYTEST = re.compile(r"^FAILED (.+)$", re.MULTILINE)


def targets(faults):
    """The names of what has to be built for their tests."""
    needed = {"lancer_tests": any(fault.gtest for fault in faults), "lancer": any(fault.pytest for fault in faults)}
    return [name for name, is_needed in needed.items() if is_needed]


def failed(tree, gtest, pytest):
    """The first failure of these tests as a line, or None where all pass. Raises Broken where they do not come to their end."""
    return (_run_gtest(tree, gtest) if gtest else None) or (_run_pytest(tree, pytest) if pytest else None)


def _run_gtest(tree, names):
    code, said = _run(tree, [tree.build_folder / "lancer_tests", "--gtest_brief=1", f"--gtest_filter={names}"])
    if "[  PASSED  ] 0 tests" in said:
        raise Broken(f"no test is called {names}")
    return _judged(code, said, _GTEST, code == 0)


def _run_pytest(tree, names):
    options = ["-q", "-x", "-p", "no:cacheprovider", "-o", "addopts=-rf --strict-markers"]
    code, said = _run(tree, [sys.executable, "-m", "pytest", *options, *(f"blender_tests/{name}" for name in names)])
    return _judged(code, said, _PYTEST, code == 0)


def _judged(code, said, pattern, passed):
    if passed:
        return None
    found = pattern.search(said)
    if code == 1 and found:
        return found.group(1)[:300]
    raise Broken("\n".join([f"exit code {code}", *said.strip().splitlines()[-20:]]))


def _run(tree, command):
    # A file that is written twice within a second would leave the compiled code of the first.
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        done = subprocess.run(
            [str(word) for word in command],
            cwd=tree.root,
            capture_output=True,
            text=True,
            errors="replace",
            env=environment,
            timeout=_LONGEST,
        )
    except subprocess.TimeoutExpired as late:
        raise Broken(f"not done after {late.timeout:.0f} s") from None
    return done.returncode, done.stdout + done.stderr
