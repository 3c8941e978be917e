"""Roads and markers for all tests."""

import os
import sys

import pytest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)

# `import bindings` is the add-on's own package, reached without the add-on's top, which needs bpy.
for folder in (os.path.join(ROOT, "addon"), ROOT, HERE):
    if folder not in sys.path:
        sys.path.insert(0, folder)


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: takes more than a few seconds; left out by `make test`")


@pytest.fixture(scope="session")
def library():
    """The library under test with typed functions; where it is missing, every test of the core fails with the reason."""
    from bindings import abi

    return abi.load_library()


@pytest.fixture(scope="session")
def root():
    return ROOT
