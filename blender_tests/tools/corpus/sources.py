"""The files of a run: all of a folder, or those that scenes/corpus.toml names, from local clones."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import tomllib

from tools.harness.terminal import wanted

from . import clones


@dataclass(frozen=True)
class File:
    name: str  # the path below the folder, or owner/name and the path in the repository
    path: Path | None  # None: the file is missing
    kind: str = ""
    note: str = ""
    missing: str = ""  # why it is missing

    @property
    def slug(self):
        """Return a unique file name for the kept results of this file."""
        plain = "".join(c if c.isalnum() or c in "-." else "_" for c in self.name)
        return f"{plain[-80:]}-{hashlib.sha256(self.name.encode()).hexdigest()[:8]}"


def in_folder(folder):
    """Return all .blend files below a folder, sorted by name."""
    if not folder.is_dir():
        raise SystemExit(f"{folder} is no folder")
    paths = sorted(path for path in folder.rglob("*.blend") if path.is_file())
    return [_checked(File(str(path.relative_to(folder)), path)) for path in paths]


def in_list(listing, clone_folder, into):
    """Return the files of corpus.toml; those that are not in the clones have the reason in missing.

    [[file]]: repository (owner/name), commit, path; kind, note; root, optional: the folder of the repository with everything
    that the file needs.
    """
    with open(listing, "rb") as file:
        rows = tomllib.load(file).get("file", [])
    return [_from_clone(row, clone_folder, into) for row in rows]


def _from_clone(row, clone_folder, into):
    name = f"{row['repository']}/{row['path']}"
    known = {"name": name, "kind": row.get("kind", ""), "note": row.get("note", "")}
    try:
        if clone_folder is None:
            raise clones.Missing(f"not looked for: name the folder of clones with a copy of {row['repository']}: CLONES=folder")
        git = clones.find(clone_folder, row["repository"])
        root = row.get("root", "")
        place = f"{row['commit'][:12]}{'-' + hashlib.sha256(root.encode()).hexdigest()[:6] if root else ''}"
        folder = into / row["repository"].replace("/", "+") / place
        clones.check_out(git, row["commit"], root, folder)
        path = folder / row["path"]
        if not path.is_file():
            raise clones.Missing("the clone does not hold the file")
    except clones.Missing as reason:
        return File(path=None, missing=str(reason), **known)
    return _checked(File(path=path, **known))


def _checked(file):
    with open(file.path, "rb") as stream:
        if stream.read(len(clones.LFS)) == clones.LFS:
            return File(file.name, None, file.kind, file.note, "only a git-lfs pointer is there")
    return file


def chosen(files, only):
    return [file for file in files if wanted(only, file.name, Path(file.name).name, file.kind)]
