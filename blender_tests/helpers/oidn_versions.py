"""Open Image Denoise of this Python's bpy module, version 2, and a wrapper with the functions of version 1."""

import glob
import importlib.util
import os
import subprocess


def newer():
    """Return the path of version 2."""
    spec = importlib.util.find_spec("bpy")
    assert spec is not None, "bpy is missing: pip install bpy"
    found = glob.glob(os.path.join(os.path.dirname(spec.origin), "lib", "libOpenImageDenoise.so.*"))
    assert len(found) == 1
    return found[0]


def older(folder):
    """Build the wrapper in folder; return (path, environment variables that it needs)."""
    path = os.path.join(str(folder), "libOpenImageDenoise.so.1.4.3")
    source = os.path.join(os.path.dirname(__file__), "oidn_of_version_1.cpp")
    subprocess.run([os.environ.get("CXX", "g++"), "-shared", "-fPIC", "-o", path, source, "-ldl"], check=True)
    return path, {"LANCER_TEST_OIDN": newer()}
