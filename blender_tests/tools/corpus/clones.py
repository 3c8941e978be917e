"""Check out files from local clones of repositories, bare or not: a folder of a commit, without changing the clone."""

import os
import subprocess
from pathlib import Path

LFS = b"version https://git-lfs.github.com/spec/"
_LINK = b"120000"


class Missing(Exception):
    """A clone, commit or file is missing; the text is for the page."""


def find(clones, repository):
    """Return the git directory of owner/name below a folder of clones; raises Missing."""
    owner, _, name = repository.partition("/")
    for base in (clones / f"{owner}+{name}", clones / owner / name, clones / owner / f"{name}.git", clones / name):
        for git in (base, base / ".git", base / "repo", base / "repo" / ".git"):
            if (git / "HEAD").is_file() and (git / "objects").is_dir():
                return git
    raise Missing(f"no clone of {repository} in {clones}")


def check_out(git, commit, root, folder):
    """Write the commit's files below root into folder, once; raises Missing."""
    done = folder / ".complete"
    if done.exists():
        return
    if _git(git, "cat-file", "-e", f"{commit}^{{commit}}").returncode:
        raise Missing(f"the clone lacks commit {commit[:12]}")
    listed = _git(git, "ls-tree", "-r", "-z", commit, *([f"{root.strip('/')}/"] if root else []))
    if listed.returncode or not listed.stdout:
        raise Missing(f"the commit has no folder {root}")
    entries = [entry.split(b"\t", 1) for entry in listed.stdout.split(b"\0") if entry]
    with _Objects(git) as objects:
        for head, name in entries:
            mode, kind, number = head.split()
            data = objects.read(number) if kind == b"blob" else None
            if data is not None:
                _write(folder, os.fsdecode(name), data, mode)
    done.touch()


def _write(folder, name, data, mode):
    path = folder / name
    if not Path(os.path.normpath(path)).is_relative_to(folder):
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    if mode == _LINK:
        target = Path(os.path.normpath(path.parent / os.fsdecode(data)))
        # A link out of the repository points to a file of another machine.
        if target.is_relative_to(folder) and not os.path.lexists(path):
            path.symlink_to(os.fsdecode(data))
        return
    path.write_bytes(data)


def _git(git, *arguments):
    return subprocess.run(["git", "--git-dir", git, *arguments], capture_output=True)


class _Objects:
    """Contents of objects by their hashes; None for objects that a partial clone lacks."""

    def __init__(self, git):
        command = ["git", "--git-dir", git, "cat-file", "--batch"]
        environment = {**os.environ, "GIT_NO_LAZY_FETCH": "1", "GIT_TERMINAL_PROMPT": "0"}
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()

    def read(self, number):
        self._process.stdin.write(number + b"\n")
        self._process.stdin.flush()
        head = self._process.stdout.readline().split()
        if len(head) != 3:
            return None
        data = self._process.stdout.read(int(head[2]))
        self._process.stdout.read(1)
        return data
