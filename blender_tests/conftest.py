"""Roads to the project and to its library, for all tests."""

import os
import sys

import pytest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)

# `import bindings` is the add-on's own package, reached without the add-on's top, which needs bpy.
for folder in (ROOT, HERE, os.path.join(HERE, "helpers")):
    if folder not in sys.path:
        sys.path.insert(0, folder)


def pytest_configure(config):
    # Workers send their reports to the process that has started them.
    if not hasattr(config, "workerinput"):
        from room_times import RoomTimes

        config.pluginmanager.register(RoomTimes())


# Files whose tests take a minute or more: workers begin with these, so that none of them is left alone with one at the end.
LONGEST = ("test_parity", "test_viewport", "test_window", "test_course_groups", "test_materials", "test_controls", "test_addon")


def pytest_collection_modifyitems(items):
    items.sort(key=lambda item: LONGEST.index(item.path.stem) if item.path.stem in LONGEST else len(LONGEST))


@pytest.fixture(scope="session")
def library():
    """The library under test with typed functions; where it is missing, every test of the core fails with the reason."""
    from addon.bindings import abi

    return abi.load_library()


@pytest.fixture(autouse=True)
def all_samples_finite(request):
    """No render of any test may drop a sample, unless the test is about that."""
    from invalid_samples import watched

    from addon.bindings.session import Session

    with watched(Session) as found:
        yield
    assert not found or request.node.get_closest_marker("overflows"), found


@pytest.fixture
def raw(library):
    """The C interface itself, with records that are right until a test spoils them."""
    from raw import Raw

    return Raw(library)
