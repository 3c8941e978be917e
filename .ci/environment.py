"""environment.py FOLDER GROUP... [--optional GROUP...]: makes a virtual environment with the named groups of pyproject.toml.

Does nothing if the environment is up to date. A changed pyproject.toml or another Python makes it anew. A group after
--optional
that cannot be installed is reported, and is no failure. Any Python 3 must reach the message that refuses its version, so this
file keeps to plain syntax."""

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


def read_groups(names):
    """Returns the optional dependencies of the project, and the named groups of tools."""
    import tomllib

    with open(os.path.join(ROOT, "pyproject.toml"), "rb") as file:
        told = tomllib.load(file)
    tools = {name: lines for name, lines in told["dependency-groups"].items() if name in names}
    return {**told["project"]["optional-dependencies"], **tools}


def read_record(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}


def main(folder, wanted, optional):
    if sys.version_info[:2] not in SUPPORTED:
        sys.exit(
            f"Blender's Python module needs Python {' or '.join(map(dotted, SUPPORTED))}, and {sys.executable} is "
            f"{dotted(sys.version_info[:2])}: use another one, as in `make render PYTHON=python{dotted(SUPPORTED[0])}`."
        )
    groups = read_groups(wanted)
    identity = hashlib.sha256(json.dumps([groups, sys.version, sys.base_prefix], sort_keys=True).encode()).hexdigest()
    record_path = os.path.join(folder, "lancer.json")
    record = read_record(record_path)
    installed = record.get("groups", []) if record.get("identity") == identity else []
    missing = [name for name in wanted if name not in installed]
    missing_optional = [name for name in optional if name not in installed]
    if not missing and not missing_optional:
        return

    if not installed:
        print(f"== python: new environment {folder} ({dotted(sys.version_info[:2])})", flush=True)
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    # pip keeps what is there only if it is asked for together with what is missing.
    if missing and not install(folder, [line for name in wanted for line in groups[name]]):
        sys.exit("pip could not install the Python packages above: see its message, then run the same command again.")
    for name in missing_optional:
        if install(folder, groups[name]):
            missing.append(name)
        else:
            print(f"== python: {name} could not be installed; features that need it are missing", flush=True)
    with open(record_path, "w", encoding="utf-8") as file:
        json.dump({"identity": identity, "groups": sorted(set(installed + missing))}, file)


def install(folder, requirements):
    print("== python: " + ", ".join(line.split(";")[0] for line in requirements if applies(line)), flush=True)
    pip = [os.path.join(folder, "bin", "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    return subprocess.run(pip + requirements).returncode == 0


def applies(requirement):
    """Whether a requirement applies to this Python; the only marker in use is python_version."""
    return "python_version" not in requirement or f"'{dotted(sys.version_info[:2])}'" in requirement


if __name__ == "__main__":
    names = sys.argv[2:]
    split = names.index("--optional") if "--optional" in names else len(names)
    main(sys.argv[1], names[:split], names[split + 1 :])
