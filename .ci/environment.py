"""environment.py FOLDER GROUP...: a virtual environment that holds the named groups of pyproject.toml.

Does nothing where it already does. A changed pyproject.toml or another Python makes it anew. Any Python 3 must get as far
as the sentence that refuses them, so this file keeps to plain syntax.
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SUPPORTED = ((3, 11), (3, 13))


def dotted(version):
    return ".".join(map(str, version))


def read_groups():
    import tomllib

    with open(os.path.join(ROOT, "pyproject.toml"), "rb") as file:
        return tomllib.load(file)["project"]["optional-dependencies"]


def read_record(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}


def main(folder, wanted):
    if sys.version_info[:2] not in SUPPORTED:
        sys.exit(
            f"Blender's Python module needs Python {' or '.join(map(dotted, SUPPORTED))}, and {sys.executable} is "
            f"{dotted(sys.version_info[:2])}: name another one, as in `make render PYTHON=python{dotted(SUPPORTED[0])}`."
        )
    groups = read_groups()
    identity = hashlib.sha256(json.dumps([groups, sys.version, sys.base_prefix], sort_keys=True).encode()).hexdigest()
    record_path = os.path.join(folder, "lancer.json")
    record = read_record(record_path)
    installed = record.get("groups", []) if record.get("identity") == identity else []
    missing = [name for name in wanted if name not in installed]
    if not missing:
        return

    python = os.path.join(folder, "bin", "python")
    if not installed:
        print(f"== python: new environment {folder} ({dotted(sys.version_info[:2])})", flush=True)
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    requirements = [line for name in missing for line in groups[name]]
    names = ", ".join(line.split(";")[0] for line in requirements if applies(line))
    print(f"== python: {names}", flush=True)
    install = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"] + requirements
    if subprocess.run(install).returncode:
        sys.exit("pip could not install the Python packages above: see its message, then run the same command again.")
    with open(record_path, "w", encoding="utf-8") as file:
        json.dump({"identity": identity, "groups": sorted(set(installed + missing))}, file)


def applies(requirement):
    """Whether a line of ours is meant for this Python; the only marker in use is python_version."""
    return "python_version" not in requirement or f"'{dotted(sys.version_info[:2])}'" in requirement


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
