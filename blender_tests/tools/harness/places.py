"""The places of the project, its library and its results; the machine and commit of a run."""

import hashlib
import os
import platform
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
TOOLS = ROOT / "blender_tests" / "tools"
BUILD = ROOT / "build"
# The page with the tables of all programs, and the page for users.
TABLES, README = ROOT / "blender_tests" / "README.md", ROOT / "README.md"
# Instruction sets that renderers have kernels for, by the processor's flag, the widest first.
_VECTORS = {"avx512vl": "AVX-512", "avx2": "AVX2"}


def machine():
    facts = {
        "processor": platform.machine(),
        "processors": os.cpu_count(),
        "system": platform.system(),
    }
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            facts["processor"] = line.split(":", 1)[1].strip()
        elif line.startswith("flags"):
            flags = line.split()
            widest = next((name for flag, name in _VECTORS.items() if flag in flags), None)
            facts["processor"] += f" with {widest}" if widest else ""
            break
    facts["memory_gib"] = round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30, 1)
    # The load of other processes at the start affects all figures.
    facts["load"] = round(os.getloadavg()[0], 2)
    return facts


def commit():
    """Return the commit of the tree, with a + if files differ from it."""
    name, changed = (
        subprocess.run(["git", *command], cwd=ROOT, capture_output=True, text=True).stdout.strip()
        for command in (("rev-parse", "--short", "HEAD"), ("status", "--porcelain"))
    )
    return (name or "unknown") + ("+" if changed else "")


def header(quick):
    """Return the fields that every program's record has."""
    return {"machine": machine(), "commit": commit(), "quick": quick}


def digest_of_file(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]


def digest_of_files(paths):
    """Return a digest of the names and contents of files of the project."""
    digest = hashlib.sha256()
    for path in sorted(paths):
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def digest_of_library():
    return digest_of_file(ROOT / "addon" / "lib" / "liblancer.so")
